#include <algorithm>
#include <cmath>

#include "cable/cable_compiler.h"
#include "cable/link_contact.h"
#include "engine/field_check.h"
#include "engine/index.h"

namespace sheave {
namespace {

/// A length as text in a message.
std::string metres(double length) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.6g m", length);
  return buffer;
}

}  // namespace

void CableCompiler::compile_spans(const CableDef& def) {
  spans_.clear();
  geometry_.clear();
  lay_openings();
  lay_surfaces(def.closed);
  for (int k = 0; k < def.span_count(); ++k) {
    const int second = (k + 1) % static_cast<int>(links_.size());
    const LinkGeometry& a = links_[at(k)];
    const LinkGeometry& b = links_[at(second)];
    SpanSetup setup;
    setup.cable = static_cast<int>(system_->cables_.size());
    const int base = static_cast<int>(system_->links_.size());
    setup.first = base + k;
    setup.second = base + second;
    choose_kind(setup, a, b);
    spans_.push_back(setup);
    if (a.starts_lifted) {  // no span begins here at time 0
      geometry_.emplace_back();
      continue;
    }
    const int reached = next_touched(k);
    choose_kind(setup, a, links_[at(reached)]);
    geometry_.push_back(span_geometry(*now_, setup, a, links_[at(reached)]));
    if (!runs_) check_span(def, k, reached);
    if (def.linear_density > 0.0) check_heavy_span(setup, k, reached);
    if (def.floor && weighs(def)) check_above_floor(def, k, reached);
  }
  give_rest_lengths(def);
  if (!weighs(def) && !runs_ && errors_.empty()) share_strain(def);
  if (weighs(def) && !runs_ && errors_.empty()) share_lengths(def);
}

void CableCompiler::give_rest_lengths(const CableDef& def) {
  given_lengths_ = def.rest_lengths;
  if (!def.pretension && def.pretensions.empty()) return;
  for (int k = 0; k < def.span_count(); ++k) {
    const double tension = def.pretension ? *def.pretension : def.pretensions[at(k)];
    const double length = geometry_[at(k)].length;
    // length = rest length (1 + tension / EA), or rest length + compliance x tension
    double rest_length = def.axial_stiffness ? length / (1.0 + tension / *def.axial_stiffness)
                                             : length - def.compliance.value_or(0.0) * tension;
    if (law_) rest_length = length / (1.0 + law_->strain(tension));
    if (memory_) rest_length = length / (1.0 + memory_->first_strain(tension));
    if (def.axial_stiffness && weighs(def)) rest_length = hanging_length(def, k, tension);
    given_lengths_.push_back(rest_length);
    if (def.has_material() || rest_length > 0.0 || links_[at(k)].starts_lifted || runs_) continue;
    fail(def.pretension ? "/pretension" : "/pretensions/" + std::to_string(k),
         "span " + std::to_string(k) + " of " + metres(length) +
             " would be stretched by its whole length; with this compliance its pretension must be "
             "below " +
             number_text(length / def.compliance.value_or(0.0)) + " N");
  }
}

int CableCompiler::next_touched(int link) const {
  const int count = static_cast<int>(links_.size());
  int next = (link + 1) % count;
  while (links_[at(next)].starts_lifted && next != link) next = (next + 1) % count;
  return next;
}

void CableCompiler::choose_kind(SpanSetup& setup, const LinkGeometry& a,
                                const LinkGeometry& b) const {
  if (!a.wraps() && !b.wraps() && !a.sheath && !b.sheath) {
    setup.kind = SpanKind::straight;
    return;
  }
  setup.outlined = a.outline || b.outline;
  if (a.groove || b.groove) {
    setup.kind = SpanKind::grooved;
    return;
  }
  if (has_two_ends(a) || has_two_ends(b)) {
    setup.kind = SpanKind::spatial;
    return;
  }
  const LinkCircle circle_a = circle_of(*now_, a);
  const LinkCircle circle_b = circle_of(*now_, b);
  setup.normal = a.wraps() ? circle_a.normal : circle_b.normal;
  setup.first_radius = a.signed_radius;
  setup.second_radius = b.signed_radius;
  bool planar = bodies_.stays_in_plane(a.carrier, setup.normal) &&
                bodies_.stays_in_plane(b.carrier, setup.normal);
  const double offset = setup.normal.dot(circle_b.center - circle_a.center);
  planar = planar && std::abs(offset) <= 1e-9 * bodies_.scale();
  if (a.wraps() && b.wraps()) {
    planar = planar && circle_a.normal.cross(circle_b.normal).norm() <= 1e-9;
    if (circle_a.normal.dot(circle_b.normal) < 0.0) {
      setup.second_radius = -setup.second_radius;
      setup.second_sense = -1.0;
    }
  }
  setup.kind = planar ? SpanKind::planar : SpanKind::spatial;
}

void CableCompiler::check_span(const CableDef& def, int first, int second) {
  const LinkGeometry& a = links_[at(first)];
  const LinkGeometry& b = links_[at(second)];
  const SpanGeometry& span = geometry_.back();
  const std::string field = "/links/" + std::to_string(second);
  const std::string pair = link_name(first) + " and " + link_name(second);
  if (!a.wraps() && !b.wraps()) {
    // A span between points of the world is useful if a wrappable body may come against it.
    const bool waits = a.body == bodies_.count() && def.most_wraps > 0 && any_wrappable();
    const bool weighs = def.linear_density > 0.0 && a.body == bodies_.count();
    if (a.body == b.body && !a.passes() && !b.passes() && !waits && !weighs && !a.sheath &&
        !b.sheath)
      fail(field, pair +
                      " are points of one body; the span between them "
                      "would do nothing");
    return check_rest_length(def, first, span);
  }
  if (on_one_outline(a, b)) {
    return fail(field, pair +
                           " run over one outline, one behind the other: no span can be between "
                           "them; use \"turns\" for more of it");
  }
  if (span.has_tangent) return check_rest_length(def, first, span);
  explain_missing_tangent(first, second);
}

void CableCompiler::explain_missing_tangent(int first, int second) {
  const LinkGeometry& a = links_[at(first)];
  const LinkGeometry& b = links_[at(second)];
  const std::string field = "/links/" + std::to_string(second);
  const std::string pair = link_name(first) + " and " + link_name(second);
  const double ra = std::abs(a.signed_radius);
  const double rb = std::abs(b.signed_radius);
  const double distance = (link_center(*now_, b) - link_center(*now_, a)).norm();
  // Whether the span leaves the wheel's plane instead of passing through the wheel.
  const auto leans = [&](const LinkGeometry& wheel, const LinkGeometry& other) {
    const LinkCircle circle = circle_of(*now_, wheel);
    const Vector3 apart = link_center(*now_, other) - circle.center;
    return wheel.wraps() && cross(circle.normal, apart).norm() > ra + rb;
  };
  if (a.geodesic || b.geodesic) {
    if (fail_if_inside(first, second) || fail_if_inside(second, first)) return;
    // The span behind the body would tell its own fault.
    if (b.geodesic && fail_if_inside(next_touched(second), second)) return;
    const int link = b.geodesic ? second : first;
    fail("/links/" + std::to_string(link),
         link_name(link) +
             ": no shortest way leads over the body on the side that \"winding\", \"side\" or "
             "\"side_point\" says; give the other side, another \"normal\", or make the body "
             "\"wrappable\" if the cable does not touch it at time 0");
  } else if (a.outline || b.outline) {
    fail(field, "no tangent joins " + pair +
                    ": one of them lies inside the other's outline, or the outlines overlap");
  } else if ((ra == 0.0 || leans(a, b)) && (rb == 0.0 || leans(b, a))) {
    fail(field,
         "the span between " + pair +
             " leans so far out of the plane of a wheel that no groove would hold it: at the "
             "distance d from the axle it may lie (d^2 - r^2) / 2r out of the plane of a "
             "wheel of radius r; turn the wheel, or give the link another \"normal\"");
  } else if (ra == 0.0 || rb == 0.0) {
    fail(field, "the attachment at " + link_name(ra == 0.0 ? first : second) +
                    " lies inside the wheel of " + link_name(ra == 0.0 ? second : first) +
                    ": it is " + metres(distance) +
                    " from the wheel's centre and must be more "
                    "than the radius, " +
                    metres(ra + rb));
  } else if (distance <= std::abs(ra - rb)) {
    fail(field, "no tangent joins " + pair + ": one wheel lies inside the other");
  } else {
    fail(field, "no tangent joins " + pair +
                    ": the wheels overlap, and with opposite windings "
                    "the cable would cross between them; their centres are " +
                    metres(distance) + " apart and must be more than " + metres(ra + rb) +
                    " apart");
  }
}

void CableCompiler::check_rest_length(const CableDef& def, int span, const SpanGeometry& geometry) {
  if (def.rest_lengths.empty()) return;
  const double rest_length = def.rest_lengths[at(span)];
  if (def.is_elastic() || rest_length >= geometry.length * (1.0 - 1e-9)) return;
  fail("/rest_lengths/" + std::to_string(span),
       "a rigid span cannot start stretched: its ends are " + metres(geometry.length) +
           " apart and the rest length is only " + metres(rest_length));
}

double CableCompiler::start_wrap(int link, const SpanGeometry& incoming,
                                 const SpanGeometry& outgoing) const {
  constexpr double touch = 1e-9;  // [rad] a slightly negative angle is a touch, not a full turn
  const LinkGeometry& wheel = links_[at(link)];
  double angle = 0.0;
  if (wheel.geodesic) {
    angle = std::max(wheel.geodesic->turned, 0.0);
  } else if (wheel.outline) {
    angle = wheel.side * (normal_angle(*now_, wheel, outgoing.direction) -
                          normal_angle(*now_, wheel, incoming.direction));
    angle -= 2.0 * pi * std::floor((angle + touch) / (2.0 * pi));
  } else {
    const LinkCircle circle = circle_of(*now_, wheel);
    angle = wheel.side * angle_between(radial(circle, incoming.end, incoming.direction),
                                       radial(circle, outgoing.start, outgoing.direction),
                                       circle.normal);
    if (angle < -touch) angle += 2.0 * pi;
    angle = std::max(angle, 0.0);
  }
  return angle;
}

double CableCompiler::arc(int link, const SpanGeometry& incoming,
                          const SpanGeometry& outgoing) const {
  const LinkGeometry& wheel = links_[at(link)];
  const double length =
      arc_between(*now_, wheel, incoming, outgoing, start_wrap(link, incoming, outgoing)) +
      wheel.extra_turns * wheel.perimeter();
  // A geodesic that only touches its body may be shorter than 0 by rounding.
  return wheel.geodesic ? std::max(length, 0.0) : length;
}

double CableCompiler::start_strain(const CableDef& def, int link) const {
  if (weighs(def)) return heavy_start_strain(def, link);
  if (!def.has_material() || given_lengths_.empty()) return 0.0;
  double sum = 0.0;
  int count = 0;
  for (int k = 0; k < def.span_count(); ++k) {
    if (links_[at(k)].starts_lifted || (k != link && next_touched(k) != link)) continue;
    const double rest_length = given_lengths_[at(k)];
    if (rest_length > 0.0) sum += std::max(geometry_[at(k)].length / rest_length - 1.0, 0.0);
    ++count;
  }
  return count > 0 ? sum / count : 0.0;
}

std::vector<double> CableCompiler::start_lengths(const CableDef& def) {
  const int span_count = def.span_count();
  const auto link_count = static_cast<int>(links_.size());
  std::vector<double> lengths;
  for (int k = 0; k < span_count; ++k) {
    lengths.push_back(links_[at(k)].starts_lifted ? 0.0
                      : given_lengths_.empty()    ? geometry_[at(k)].length
                                                  : given_lengths_[at(k)]);
  }
  for (int i = 0; i < link_count; ++i) {
    const LinkGeometry& link = links_[at(i)];
    int incoming = i > 0 ? i - 1 : span_count - 1;
    while (links_[at(incoming)].starts_lifted) {
      incoming = incoming > 0 ? incoming - 1 : span_count - 1;
    }
    const bool stores = link.wraps() && !link.starts_lifted;
    const double strain = stores ? start_strain(def, i) : 0.0;
    start_strains_.push_back(strain);
    lengths.push_back(link.sheath ? start_in_sheath(def, i)
                      : !stores   ? 0.0
                      : std::isnan(link.given_stored_length)
                          ? arc(i, geometry_[at(incoming)], geometry_[at(i)]) / (1.0 + strain)
                          : link.given_stored_length);
  }
  return lengths;
}

}  // namespace sheave
