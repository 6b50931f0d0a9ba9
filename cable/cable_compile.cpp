// From what a user says about cables to what the step needs, with every check that needs geometry.

#include <algorithm>
#include <map>
#include <set>

#include "cable/cable_system.h"
#include "engine/field_check.h"
#include "engine/index.h"

namespace sheave {
namespace {

/// A length to be printed for people.
std::string metres(double length) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.6g m", length);
  return buffer;
}

}  // namespace

/// Builds a CableSystem cable by cable and collects all faults.
class CableCompiler {
 public:
  explicit CableCompiler(const BodySet& bodies)
      : bodies_(bodies), state_(bodies.initial_state()), now_(bodies, state_, 1.0, 1) {}

  void add(const CableDef& def) {
    path_ = "/cables/" + std::to_string(index_++);
    name_ = def.name;
    const std::size_t before = errors_.size();
    check_settings(def);
    compile_links(def);
    if (errors_.size() > before) return;
    const auto lifted = std::count_if(links_.begin(), links_.end(),
                                      [](const LinkGeometry& link) { return link.starts_lifted; });
    if (static_cast<int>(links_.size()) - lifted < 2) {
      fail("/links", "a cable must touch at least 2 links at time 0");
      return;
    }
    compile_spans(def);
    if (errors_.size() > before) return;
    store_lengths(def);
  }

  Result<std::unique_ptr<CableSystem>> finish() {
    if (!errors_.empty()) return errors_;
    CableSystem& s = *system_;
    const std::size_t spans = s.spans_.size();
    s.initial_.reals = rest_lengths_;
    s.initial_.reals.insert(s.initial_.reals.end(), stored_lengths_.begin(), stored_lengths_.end());
    s.initial_.reals.resize(s.initial_.reals.size() + 3 * spans, 0.0);  // tensions, remainders
    s.references_.resize(spans);
    s.multipliers_.resize(spans);
    s.fallbacks_.resize(spans);
    s.initial_.reals.resize(s.initial_.reals.size() + 2 * s.links_.size(), 0.0);  // slip, angle
    s.initial_.integers.assign(2 * s.links_.size(), 0);
    for (std::size_t i = 0; i < s.links_.size(); ++i) {
      if (!s.links_[i].starts_lifted) continue;
      s.initial_.integers[s.mode_index(static_cast<int>(i))] = CableSystem::lifted_mode;
    }
    s.fed_.assign(spans, 0.0);
    s.definitions_ = s.links_;
    for (const auto& [link, radius] : bare_radii_) s.definitions_[at(link)].signed_radius = radius;
    for (std::size_t i = 0; i < s.links_.size(); ++i) {
      if (s.links_[i].changes()) s.changing_links_.push_back(static_cast<int>(i));
      s.changes_ = s.changes_ || s.links_[i].changes() || s.links_[i].lifts;
    }
    s.span_definitions_ = s.spans_;
    s.slip_.assign(s.links_.size(), 0);
    s.pending_slip_ = s.flips_ = s.slip_;
    s.sweeps_.assign(s.cables_.size(), 0);
    s.stored_lengths_.resize(s.links_.size());
    return std::move(system_);
  }

 private:
  void fail(const std::string& field, const std::string& message) {
    errors_.push_back({path_ + field, "cable \"" + name_ + "\": " + message});
  }

  void check_settings(const CableDef& def) {
    check_fields(CableDef::field_table(), &def, path_, errors_);
    if (def.name.empty()) fail("/name", "a cable needs a name that is not empty");
    if (!names_.insert(def.name).second)
      fail("/name", "two cables have this name; names must differ");
    if (def.compliance && def.axial_stiffness) {
      fail("/axial_stiffness", "compliance and axial_stiffness exclude each other");
    }
    const bool elastic = def.axial_stiffness || def.compliance.value_or(0.0) > 0.0;
    if (def.damping > 0.0 && !elastic) {
      fail("/damping", "damping acts on an elastic cable only; give compliance or axial_stiffness");
    }
    if (def.links.size() < 2) {
      fail("/links", "a cable needs at least 2 links; it has " + std::to_string(def.links.size()));
    }
    if (!def.rest_lengths.empty() &&
        static_cast<int>(def.rest_lengths.size()) != def.span_count()) {
      fail("/rest_lengths", "one rest length per span is needed, " +
                                std::to_string(def.span_count()) + "; there are " +
                                std::to_string(def.rest_lengths.size()));
    }
  }

  void compile_links(const CableDef& def) {
    links_.clear();
    for (std::size_t i = 0; i < def.links.size(); ++i) {
      const std::string path = path_ + "/links/" + std::to_string(i);
      const LinkDef& link = *def.links[i];
      const std::size_t before = errors_.size();
      if (!bodies_.contains(link.body)) {
        fail("/links/" + std::to_string(i) + "/body",
             "there is no body number " + std::to_string(link.body.index));
        continue;
      }
      for (const auto& entry : link_types()) {
        if (entry.name == link.type()) check_fields(entry.fields(), link.settings(), path, errors_);
      }
      if (errors_.size() > before) continue;
      const Result<LinkGeometry> compiled = link.compile(bodies_, path);
      if (!compiled) {
        errors_.insert(errors_.end(), compiled.errors().begin(), compiled.errors().end());
        continue;
      }
      links_.push_back(*compiled);
      LinkGeometry& placed = links_.back();
      placed.centered = compiled->center.isZero(0.0);
      if (placed.layer_pitch > 0.0) {
        // With what is on it at time 0; the definition keeps the bare drum.
        bare_radii_[static_cast<int>(system_->links_.size() + i)] = placed.signed_radius;
        const double bare = placed.signed_radius;
        placed.signed_radius =
            placed.side *
            std::sqrt(bare * bare + placed.layer_pitch * placed.given_stored_length / pi);
      }
      const bool end = !def.closed && (i == 0 || i + 1 == def.links.size());
      check_stored_length(*compiled, end, "/links/" + std::to_string(i));
      check_passage(*compiled, end, "/links/" + std::to_string(i));
    }
  }

  void check_passage(const LinkGeometry& link, bool end, const std::string& field) {
    if (end && link.slides) fail(field, "a cable cannot end in a pinhole; attach it");
    if (end && link.wraps() && !std::isnan(link.friction)) {
      fail(field + "/friction", "at the end of a cable nothing can slip; leave friction out");
    }
    if (end && link.starts_lifted) {
      fail(field + "/lifted", "at its ends a cable cannot be off the wheel");
    }
    if (link.starts_lifted && link.extra_turns > 0) {
      fail(field + "/turns", "a cable that is off the wheel has no turns on it");
    }
    if (!end && link.ends_here) {
      fail(field, "this link is for an end of an open cable; between its ends use \"rolling\"");
    }
    if (!end && link.feed_speed != 0.0) {
      fail(field + "/feed_speed", "cable can be fed only at an end of an open cable");
    }
    if (!link.wraps() && bodies_[link.body].massless()) {
      fail(field + "/body", "nothing can be fixed to \"" + bodies_.name(link.body) +
                                "\", which has no spin inertia: it would turn without resistance");
    }
    if (!link.massless) return;
    const std::string& wheel = bodies_.name(link.body);
    if (end) fail(field, "a cable cannot end on \"" + wheel + "\", which has no spin inertia");
    if (link.outline) fail(field, "the massless wheel \"" + wheel + "\" must be circular");
    if (!massless_wheels_.insert(link.body).second) {
      fail(field, "the massless wheel \"" + wheel +
                      "\" can carry only one cable once: nothing would hold two together");
    }
  }

  void check_stored_length(const LinkGeometry& link, bool end, const std::string& field) {
    if (!link.wraps()) return;
    const bool given = !std::isnan(link.given_stored_length);
    if (end && !given) {
      fail(field, "a cable that ends on a wheel needs \"stored_length\", the cable wound on it");
    }
    if (!end && given && !link.ends_here) {
      fail(field + "/stored_length",
           "between the ends of a cable the stored length follows from the tangents; use \"turns\" "
           "for whole turns more");
    }
    if (end && link.extra_turns > 0) {
      fail(field + "/turns", "at the end of a cable \"stored_length\" says all; leave turns out");
    }
  }

  void compile_spans(const CableDef& def) {
    spans_.clear();
    geometry_.clear();
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
      if (a.starts_lifted) {  // no span yet
        geometry_.emplace_back();
        continue;
      }
      const int reached = next_touched(k);
      choose_kind(setup, a, links_[at(reached)]);
      geometry_.push_back(span_geometry(now_, setup, a, links_[at(reached)]));
      check_span(def, k, reached);
    }
  }

  /// The next link that the cable touches at time 0; the ends of a cable always do.
  [[nodiscard]] int next_touched(int link) const {
    const int count = static_cast<int>(links_.size());
    int next = (link + 1) % count;
    while (links_[at(next)].starts_lifted && next != link) next = (next + 1) % count;
    return next;
  }

  /// Planar if the geometry of the bodies' mobilities guarantees it for ever.
  void choose_kind(SpanSetup& setup, const LinkGeometry& a, const LinkGeometry& b) const {
    if (!a.wraps() && !b.wraps()) {
      setup.kind = SpanKind::straight;
      return;
    }
    const LinkCircle circle_a = circle_of(now_, a);
    const LinkCircle circle_b = circle_of(now_, b);
    setup.outlined = a.outline || b.outline;
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

  [[nodiscard]] std::string link_name(int i) const {
    return "link " + std::to_string(i) + " on \"" + bodies_.name(links_[at(i)].body) + "\"";
  }

  void check_span(const CableDef& def, int first, int second) {
    const LinkGeometry& a = links_[at(first)];
    const LinkGeometry& b = links_[at(second)];
    const SpanGeometry& span = geometry_.back();
    const std::string field = "/links/" + std::to_string(second);
    const std::string pair = link_name(first) + " and " + link_name(second);
    const double ra = std::abs(a.signed_radius);
    const double rb = std::abs(b.signed_radius);
    const double distance = (link_center(now_, b) - link_center(now_, a)).norm();
    if (!a.wraps() && !b.wraps()) {
      if (a.body == b.body && !a.passes() && !b.passes())
        fail(field, pair +
                        " are points of one body; the span between them "
                        "would do nothing");
      return check_rest_length(def, first, span);
    }
    if (span.has_tangent) return check_rest_length(def, first, span);
    if (a.outline || b.outline) {
      fail(field, "no tangent joins " + pair +
                      ": one of them lies inside the other's outline, or the outlines overlap");
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

  void check_rest_length(const CableDef& def, int span, const SpanGeometry& geometry) {
    if (def.rest_lengths.empty()) return;
    const double rest_length = def.rest_lengths[at(span)];
    const bool elastic = def.axial_stiffness || def.compliance.value_or(0.0) > 0.0;
    if (elastic || rest_length >= geometry.length * (1.0 - 1e-9)) return;
    fail("/rest_lengths/" + std::to_string(span),
         "a rigid span cannot start stretched: its ends are " + metres(geometry.length) +
             " apart and the rest length is only " + metres(rest_length));
  }

  /// Cable on the wheel between the incoming and the outgoing tangent.
  [[nodiscard]] double arc(int link, const SpanGeometry& incoming,
                           const SpanGeometry& outgoing) const {
    constexpr double touch = 1e-9;  // [rad] just below 0 is a touch, not a full turn
    const LinkGeometry& wheel = links_[at(link)];
    double angle = 0.0;
    if (wheel.outline) {
      angle = wheel.side * (normal_angle(now_, wheel, outgoing.direction) -
                            normal_angle(now_, wheel, incoming.direction));
      angle -= 2.0 * pi * std::floor((angle + touch) / (2.0 * pi));
    } else {
      const LinkCircle circle = circle_of(now_, wheel);
      const double radius = std::abs(wheel.signed_radius);
      angle = wheel.side * angle_between((incoming.end - circle.center) / radius,
                                         (outgoing.start - circle.center) / radius, circle.normal);
      if (angle < -touch) angle += 2.0 * pi;
      angle = std::max(angle, 0.0);
    }
    return arc_between(now_, wheel, incoming, outgoing, angle) +
           wheel.extra_turns * wheel.perimeter();
  }

  /// Whether all links stay in one plane for ever, so that any two of them can be joined by a planar span.
  void find_plane(CompiledCable& cable) const {
    const auto wheel = std::find_if(links_.begin(), links_.end(),
                                    [](const LinkGeometry& link) { return link.wraps(); });
    if (wheel == links_.end()) return;
    cable.normal = circle_of(now_, *wheel).normal;
    const Vector3 origin = link_center(now_, *wheel);
    cable.planar = true;
    for (const LinkGeometry& link : links_) {
      const double along = cable.normal.dot(circle_of(now_, link).normal);
      const double offset = cable.normal.dot(link_center(now_, link) - origin);
      const bool parallel = !link.wraps() || std::abs(along) >= 1.0 - 1e-15;
      cable.senses.push_back(link.wraps() && along < 0.0 ? -1.0 : 1.0);
      cable.planar = cable.planar && parallel && std::abs(offset) <= 1e-9 * bodies_.scale() &&
                     bodies_.stays_in_plane(link.carrier, cable.normal);
    }
  }

  void store_lengths(const CableDef& def) {
    CableSystem& s = *system_;
    CompiledCable cable;
    cable.name = def.name;
    cable.closed = def.closed;
    cable.first_link = static_cast<int>(s.links_.size());
    cable.link_count = static_cast<int>(links_.size());
    cable.first_span = static_cast<int>(s.spans_.size());
    cable.span_count = def.span_count();
    cable.compliance = def.compliance.value_or(0.0);
    cable.inverse_stiffness = def.axial_stiffness ? 1.0 / *def.axial_stiffness : 0.0;
    cable.damping = def.damping;
    cable.tangent_update = def.tangent_update;
    find_plane(cable);
    for (int i = 0; i < cable.link_count; ++i) {
      const bool end = !def.closed && (i == 0 || i + 1 == cable.link_count);
      links_[at(i)].lifts = !end && links_[at(i)].wraps();
      cable.lifts = cable.lifts || links_[at(i)].lifts;
    }
    for (int i = 0; i < cable.link_count; ++i) {
      const bool end = !def.closed && (i == 0 || i + 1 == cable.link_count);
      if (end || !links_[at(i)].passes()) continue;
      cable.shares = true;
      cable.has_friction = cable.has_friction || !links_[at(i)].frictionless();
    }
    std::vector<double> lengths;
    for (int k = 0; k < cable.span_count; ++k) {
      lengths.push_back(links_[at(k)].starts_lifted ? 0.0
                        : def.rest_lengths.empty()  ? geometry_[at(k)].length
                                                    : def.rest_lengths[at(k)]);
    }
    for (int i = 0; i < cable.link_count; ++i) {
      const LinkGeometry& link = links_[at(i)];
      cable.link_types.push_back(def.links[at(i)]->type());
      int incoming = i > 0 ? i - 1 : cable.span_count - 1;
      while (links_[at(incoming)].starts_lifted) {
        incoming = incoming > 0 ? incoming - 1 : cable.span_count - 1;
      }
      lengths.push_back(!link.wraps() || link.starts_lifted ? 0.0
                        : std::isnan(link.given_stored_length)
                            ? arc(i, geometry_[at(incoming)], geometry_[at(i)])
                            : link.given_stored_length);
    }
    double total = 0.0;
    for (const double length : lengths) total += length;
    // 50 bits for the cable's length leave 3 of a double's 53 for stretches beyond it.
    int exponent = 0;
    static_cast<void>(std::frexp(total, &exponent));
    cable.quantum = std::ldexp(1.0, exponent - 50);
    for (double& length : lengths) length = std::round(length / cable.quantum) * cable.quantum;
    for (const double length : lengths) cable.start_length += length;
    const auto spans_end = lengths.begin() + cable.span_count;
    rest_lengths_.insert(rest_lengths_.end(), lengths.begin(), spans_end);
    stored_lengths_.insert(stored_lengths_.end(), spans_end, lengths.end());
    s.links_.insert(s.links_.end(), links_.begin(), links_.end());
    s.spans_.insert(s.spans_.end(), spans_.begin(), spans_.end());
    s.cables_.push_back(std::move(cable));
  }

  const BodySet& bodies_;
  State state_;
  Substep now_;
  std::unique_ptr<CableSystem> system_{new CableSystem};
  Errors errors_;
  std::set<std::string> names_;
  std::set<int> massless_wheels_;
  std::map<int, double> bare_radii_;  // of drums with layers, by their index among all links
  std::vector<double> rest_lengths_;
  std::vector<double> stored_lengths_;
  // Of the cable that is being added.
  int index_ = 0;
  std::string path_;
  std::string name_;
  std::vector<LinkGeometry> links_;
  std::vector<SpanSetup> spans_;
  std::vector<SpanGeometry> geometry_;
};

Result<std::unique_ptr<CableSystem>> CableSystem::create(const std::vector<CableDef>& cables,
                                                         const BodySet& bodies) {
  CableCompiler compiler(bodies);
  for (const CableDef& cable : cables) compiler.add(cable);
  return compiler.finish();
}

}  // namespace sheave
