// Conservation of cable: the sum of rest lengths and stored lengths is that of time 0 plus the fed
// length, a span gains the length that its wheels and pinholes give, and no length is below 0.

#include <algorithm>
#include <array>
#include <cmath>

#include "cable/certificate/checks.h"
#include "cable/links/attachment.h"
#include "engine/math/portable.h"

namespace sheave::certify {
namespace {

using Kind = CertificateItem::Kind;

void check_cable(const Evidence& evidence, const CableEvidence& cable, Findings& findings) {
  const auto whole = [&] { return "\"" + std::string(cable.name) + "\""; };
  const CableReport& end = cable.end;
  double shortest = 0.0;
  double sum = 0.0;
  double fed = 0.0;
  double longest = 0.0;
  const auto add = [&](double length) {
    sum += length;
    shortest = std::min(shortest, length);
    longest = std::max(longest, std::abs(length));
  };
  if (!end.cut) {
    for (const SpanReport& span : end.spans) add(span.rest_length);
    for (const LinkReport& link : end.links) {
      add(link.stored_length);
      fed += link.fed;
    }
    for (const WrapReport& wrap : end.wraps) {
      add(wrap.span.rest_length);
      add(wrap.link.stored_length);
    }
    const double at_start = end.total_length - fed;
    findings.note(Kind::length, "m", std::abs(sum - end.total_length), std::max(longest, at_start),
                  1e-12 * longest, whole);
  }
  const double length = std::max(end.total_length, longest);
  findings.note(Kind::length, "m", std::abs(end.length_error) * length, length, 1e-12 * length,
                whole);
  const double size = std::min(length, evidence.bodies.scale());
  findings.note(Kind::length, "m", -shortest, size, 1e-12 * longest, whole);
}

/// The cable stored on a round wheel between two spans covers the arc between their contacts, up to
/// whole turns.
void check_arcs(const Evidence& evidence, const CableEvidence& cable, Findings& findings) {
  const CableReport& end = cable.end;
  if (end.cut) return;
  const double size = std::min(end.total_length, evidence.bodies.scale());
  const auto check = [&](const LinkReport& link) {
    if (!link.touched || link.winding == 0 || !(link.radius > 0.0) || !link.path.empty()) return;
    const Vector3 entry = link.entry - link.center;
    const Vector3 exit = link.exit - link.center;
    const double angle = portable::atan2(link.normal.dot(entry.cross(exit)), entry.dot(exit));
    const double lies = link.stored_length + link.stored_stretch;
    const double perimeter = 2.0 * pi * link.radius;
    const double off = std::remainder(lies - link.winding * link.radius * angle, perimeter);
    findings.note(Kind::length, "m", std::abs(off), size, 1e-12 * (size + end.total_length), [&] {
      return "\"" + std::string(cable.name) + "\" on " +
             evidence.body_name(link.body.is_world() ? evidence.bodies.count() : link.body.index);
    });
  };
  for (std::size_t i = 0; i < end.links.size(); ++i) {
    if (end.closed || (i > 0 && i + 1 < end.links.size())) check(end.links[i]);
  }
  for (const WrapReport& wrap : end.wraps) check(wrap.link);
}

/// The length that an attachment with a feed speed pays out, as long as there is cable to take in.
void check_feeds(const Evidence& evidence, const CableEvidence& cable, Findings& findings) {
  if (cable.has_changed || cable.start.cut) return;
  for (const SpanEvidence& span : cable.spans) {
    double speed = 0.0;
    bool stalled = false;
    for (const SpanSide* side : {&span.from, &span.to}) {
      if (side->place < 0) continue;
      stalled = stalled || cable.end.links[at(side->place)].stalled;
      const auto* link =
          dynamic_cast<const AttachmentLink*>(cable.definition->links[at(side->place)].get());
      if (link == nullptr) continue;
      const LinkControl* set = evidence.start.controls.links.find(cable.first_link + side->place);
      const double t0 = evidence.start.time;
      const double t1 = evidence.end.time;
      speed += set != nullptr && set->has_feed ? set->feed_speed.integral(t0, t1) / (t1 - t0)
                                               : link->feed_speed.value_or(0.0);
    }
    const double asked = speed * evidence.h;
    if (speed == 0.0 || span.rest_length[first_end] + asked <= 0.0) continue;
    // A feed that is reported as stalled may do less than its target, but not more.
    const double least = stalled ? std::min(asked, 0.0) : asked;
    const double most = stalled ? std::max(asked, 0.0) : asked;
    const double off = std::abs(span.fed - std::clamp(span.fed, least, most));
    findings.note(Kind::drive, "m", off, std::abs(asked),
                  1e-13 * (cable.end.total_length + evidence.bodies.scale()),
                  [&] { return span.name(); });
  }
}

void check_spans_of(const Evidence& evidence, const CableEvidence& cable, Findings& findings) {
  if (cable.has_changed || cable.start.cut) return;
  for (std::size_t k = 0; k < cable.spans.size(); ++k) {
    const SpanEvidence& span = cable.spans[k];
    if (!span.has_tangent || span.from.outlined || span.to.outlined) continue;
    double passed = span.fed;
    for (const PassEvidence& pass : cable.passes) {
      if (at(pass.after) == k) passed += pass.came();
      if (at(pass.before) == k) passed -= pass.left();
    }
    const double rolled = span.rest_length[last_end] - span.rest_length[first_end] - passed;
    const auto [first, second] = rim_travels(evidence, cable, span, rolled);
    // The scale is the moved length, but at least a millionth of the cable or scene.
    const double size = std::min(cable.free_length, evidence.bodies.scale());
    double moved = std::max({std::abs(first), std::abs(second), std::abs(passed)});
    for (const PassEvidence& pass : cable.passes) {
      if (at(pass.after) != k && at(pass.before) != k) continue;
      moved = std::max(moved, std::abs(pass.carried));
    }
    findings.note(Kind::length, "m", std::abs(unrolled(evidence, cable, span, rolled)),
                  std::max(moved, 1e-6 * size), 1e-12 * (size + cable.end.total_length),
                  [&] { return span.name(); });
  }
}

/// The massless wheel at this end of a span over which cable passes; null: none.
const PassEvidence* massless_wheel(const CableEvidence& cable, const SpanSide& side) {
  for (const PassEvidence& pass : cable.passes) {
    if (pass.massless && pass.link == side.place && side.place >= 0) return &pass;
  }
  return nullptr;
}

/// Rotation of a wheel about the normal of its link [rad], from its rotation about the axle.
double about_normal(const Evidence& evidence, const SpanSide& side, double turn) {
  const BodyProperties& wheel = evidence.bodies[side.body];
  Vector3 axis = wheel.axis;
  if (wheel.mount >= 0) axis = evidence.moments[first_end].orientation(wheel.mount) * axis;
  return axis.dot(side.normal[first_end]) > 0.0 ? turn : -turn;
}

double turn_on_axle(const Evidence& evidence, int body) {
  return evidence.end.bodies[at(body)].angle - evidence.start.bodies[at(body)].angle;
}

/// The part of the rim travel of a massless wheel that passing cable has caused [m]: all except the
/// rotation that continues from the last substep, if its bearing does not brake it.
double passed_travel(const Evidence& evidence, const SpanSide& side, double sense) {
  const BodyProperties& wheel = evidence.bodies[side.body];
  Vector3 axis = wheel.axis;
  if (wheel.mount >= 0) axis = evidence.moments[first_end].orientation(wheel.mount) * axis;
  double goes_on = evidence.h * axis.dot(evidence.start.bodies[at(side.body)].angular_velocity);
  if (wheel.mount >= 0) goes_on -= axis.dot(evidence.turn_of(wheel.mount));
  if (evidence.brakes(side.body)) goes_on = 0.0;
  const double turned = turn_on_axle(evidence, side.body) - goes_on;
  return -sense * side.winding * side.radius[first_end] * about_normal(evidence, side, turned);
}

/// At both ends of the substep.
std::array<double, 2> strains_of(const SpanEvidence& span) {
  std::array<double, 2> strains{};
  for (const End when : {first_end, last_end}) {
    if (span.rest_length[when] > 0.0) {
      strains[at(when)] = std::max(span.length[when] / span.rest_length[when] - 1.0, 0.0);
    }
  }
  return strains;
}

/// Least and largest length that a span gains [m] from cable that turns a massless wheel by the rim
/// travel `passed` [m]. The strain of that cable lies between those of both sides at both ends of
/// the substep.
std::array<double, 2> gain_by_passing(const CableEvidence& cable, const PassEvidence& wheel,
                                      double passed) {
  auto before = strains_of(cable.spans[at(wheel.before)]);
  auto after = strains_of(cable.spans[at(wheel.after)]);
  if (cable.definition->linear_density > 0.0) {
    before.fill(cable.spans[at(wheel.before)].to.strain);
    after.fill(cable.spans[at(wheel.after)].from.strain);
  }
  const auto [least, most] = std::minmax({before[0], before[1], after[0], after[1]});
  return {passed / (1.0 + (passed > 0.0 ? most : least)),
          passed / (1.0 + (passed > 0.0 ? least : most))};
}

/// Travel of a wheel's rim past the end of a span, from the poses alone [m]: the length that
/// rolling gives to the span at its first end (sense -1) or at its second (1). `reported` chooses
/// among whole turns.
double rim_travel(const Evidence& evidence, const SpanSide& side, double sense, double reported) {
  // Cable that slides over an arc does not move with the rim; check_arcs() and check_arc() in
  // spans.cpp check it.
  if (side.winding == 0 || side.slides || !(side.radius[first_end] > 0.0)) return 0.0;
  const Moment& start = evidence.moments[first_end];
  const Moment& end = evidence.moments[last_end];
  // In the wheel's own frame the contact moves by the rolled arc.
  const auto own = [&](const Moment& now, const Vector3& world) -> Vector3 {
    return now.orientation(side.body).conjugate() * world;
  };
  const Vector3 from = own(start, side.point[first_end] - side.center[first_end]);
  const Vector3 to = own(end, side.laid - side.center[last_end]);
  const Vector3 normal = own(start, side.normal[first_end]);
  const double angle = portable::atan2(normal.dot(from.cross(to)), from.dot(to));
  // Exact for layers, too, since their radius is linear in the angle.
  const double radius = 0.5 * (side.radius[first_end] + side.radius[last_end]);
  const double factor = sense * side.winding * radius;
  // A rotor may turn many times, and the reported length of stretched cable does not determine the
  // number. Its angle does, because the contact moves round the axle by less than half a turn.
  const bool counts =
      side.body < evidence.bodies.count() && evidence.bodies[side.body].mobility == Mobility::rotor;
  const double nearly =
      counts ? -about_normal(evidence, side, turn_on_axle(evidence, side.body)) : reported / factor;
  const double turns = std::round((nearly - angle) / (2.0 * pi));
  if (side.groove) {
    const double wound = side.wound[first_end];
    const double on = wound - sense * side.winding * (angle + 2.0 * pi * turns);
    return side.groove->place(wound).length - side.groove->place(on).length;
  }
  return factor * (angle + 2.0 * pi * turns);
}

}  // namespace

double mean_strain(const CableEvidence& cable, const PassEvidence& pass) {
  if (!cable.definition->has_material()) return 0.0;
  const auto before = strains_of(cable.spans[at(pass.before)]);
  const auto after = strains_of(cable.spans[at(pass.after)]);
  return 0.25 * (before[0] + before[1] + after[0] + after[1]);
}

void find_carried(const Evidence& evidence, CableEvidence& cable, PassEvidence& pass) {
  SpanSide& in = cable.spans[at(pass.before)].to;
  SpanSide& out = cable.spans[at(pass.after)].from;
  if (!in.outlined) {
    const double way =
        0.5 * (rim_travel(evidence, out, -1.0, 0.0) - rim_travel(evidence, in, 1.0, 0.0));
    const auto before = strains_of(cable.spans[at(pass.before)]);
    const auto after = strains_of(cable.spans[at(pass.after)]);
    const auto [least, most] = std::minmax({before[0], before[1], after[0], after[1]});
    pass.carried = way / (1.0 + mean_strain(cable, pass));
    pass.unsure = std::abs(way) * (most - least);
  }
  in.slides = out.slides = true;
  in.unsure = out.unsure = pass.unsure;
}

std::array<double, 2> rim_travels(const Evidence& evidence, const CableEvidence& cable,
                                  const SpanEvidence& span, double rolled) {
  const bool material = cable.definition->has_material();
  const double arcs = material ? rolled * (1.0 + strains_of(span)[last_end]) : rolled;
  const double first = rim_travel(evidence, span.from, -1.0, arcs);
  return {first, rim_travel(evidence, span.to, 1.0, arcs - first)};
}

double unrolled(const Evidence& evidence, const CableEvidence& cable, const SpanEvidence& span,
                double rolled) {
  const auto [first, second] = rim_travels(evidence, cable, span, rolled);
  if (!cable.definition->has_material()) return rolled - first - second;
  // Cable that comes onto a rim has the strain of the span; cable that comes off has a strain with
  // which some of it lies there. This holds for the continued rotation of a massless wheel, too.
  // The excess or deficit of that rotation passes from span to span and has not lain on the wheel.
  const auto strains = strains_of(span);
  const double mean = 0.5 * (strains[0] + strains[1]);
  double stored = 0.0;
  for (const LinkReport& link : cable.start.links) stored = std::max(stored, link.most_strain);
  for (const WrapReport& wrap : cable.start.wraps) stored = std::max(stored, wrap.link.most_strain);
  double low = 0.0;
  double high = 0.0;
  const bool heavy = cable.definition->linear_density > 0.0;
  for (const SpanSide* side : {&span.from, &span.to}) {
    const bool begins = side == &span.from;
    // The strain of a rope with weight depends on the height.
    const double strain = heavy ? side->strain : mean;
    const double most = std::max(strain, stored);
    double travel = begins ? first : second;
    low -= side->unsure;
    high += side->unsure;
    const PassEvidence* wheel = massless_wheel(cable, *side);
    if (wheel != nullptr && (heavy || !evidence.brakes(side->body))) {
      const double passed = passed_travel(evidence, *side, begins ? -1.0 : 1.0);
      const auto [least, largest] = gain_by_passing(cable, *wheel, passed);
      low += least;
      high += largest;
      travel -= passed;
    }
    low += travel / (1.0 + (travel > 0.0 ? most : strain));
    high += travel > 0.0 ? travel : travel / (1.0 + strain);
  }
  return rolled - std::clamp(rolled, low, high);
}

double spring_length(const Evidence& evidence, const CableEvidence& cable, const SpanEvidence& span,
                     double rolled) {
  const auto strains = strains_of(span);
  const double mean = 1.0 + 0.5 * (strains[0] + strains[1]);
  double on = 0.0;
  if (span.from.outlined || span.to.outlined) {
    on = std::max(-rolled, 0.0) * mean;
  } else {
    const auto travels = rim_travels(evidence, cable, span, rolled);
    for (const End at_end : {first_end, last_end}) {
      const SpanSide& side = at_end == first_end ? span.from : span.to;
      double travel = travels[at(at_end)];
      if (massless_wheel(cable, side) != nullptr) {
        travel -= passed_travel(evidence, side, at_end == first_end ? -1.0 : 1.0);
      }
      on += std::max(-travel, 0.0);
    }
  }
  const double whole = span.rest_length[first_end] + span.fed + rolled + on / mean;
  const double half = 0.5 * on / (1.0 + strains[0]);
  return whole > 0.0 ? whole * (whole / (whole + half)) : whole;
}

void check_lengths(const Evidence& evidence, Findings& findings) {
  for (const CableEvidence& cable : evidence.cables) {
    check_cable(evidence, cable, findings);
    check_arcs(evidence, cable, findings);
    check_surfaces(evidence, cable, findings);
    check_sheaths(evidence, cable, findings);
    check_spans_of(evidence, cable, findings);
    check_feeds(evidence, cable, findings);
  }
}

}  // namespace sheave::certify
