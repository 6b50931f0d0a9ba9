// The course of a cable at time 0: its plane, its candidates for wraps, and its part of the state.

#include <algorithm>
#include <cmath>

#include "cable/cable_compiler.h"
#include "engine/index.h"

namespace sheave {

bool CableCompiler::lies_in_plane(const Vector3& normal) const {
  const Vector3 origin = link_center(*now_, links_.front());
  return std::all_of(links_.begin(), links_.end(), [&](const LinkGeometry& link) {
    const double along = normal.dot(circle_of(*now_, link).normal);
    const double offset = normal.dot(link_center(*now_, link) - origin);
    const bool parallel = !link.wraps() || std::abs(along) >= 1.0 - 1e-15;
    return parallel && !link.geodesic && !link.opening &&
           std::abs(offset) <= 1e-9 * bodies_.scale() &&
           bodies_.stays_in_plane(link.carrier, normal);
  });
}

void CableCompiler::find_plane(CompiledCable& cable) const {
  const auto wheel = std::find_if(links_.begin(), links_.end(),
                                  [](const LinkGeometry& link) { return link.wraps(); });
  if (wheel != links_.end()) {
    cable.normal = circle_of(*now_, *wheel).normal;
    cable.planar = lies_in_plane(cable.normal);
  } else {
    // Points have no plane of their own; candidates are the axes of wrappable bodies.
    for (const WrapCandidate& candidate : cable.candidates) {
      for (const WrapAxis& axis : candidate.axes) {
        if (cable.planar) break;
        cable.normal = now_->orientation(candidate.body) * axis.direction;
        cable.planar = lies_in_plane(cable.normal);
      }
    }
  }
  for (const LinkGeometry& link : links_) {
    const double along = cable.normal.dot(circle_of(*now_, link).normal);
    cable.senses.push_back(link.wraps() && along < 0.0 ? -1.0 : 1.0);
  }
}

void CableCompiler::find_candidates(const CableDef& def, CompiledCable& cable) {
  for (std::size_t i = 0; i < links_.size(); ++i) {
    if (!links_[i].geodesic) continue;
    cable.candidates.push_back(listed_candidate(links_[i]));
    cable.candidates.back().listed = static_cast<int>(i);
  }
  // A rope with weight goes through bodies that are not its links.
  if (def.most_wraps == 0 || def.linear_density > 0.0 || has_sheath()) return;
  for (int body = 0; body < bodies_.count(); ++body) {
    // A groove stays where it is in the list; a surface link is only the start of a wrap.
    // This test comes first: searching all links for every body takes minutes with 10^5 wheels.
    if (!bodies_.definition(body).wrappable) continue;
    const bool listed = std::any_of(links_.begin(), links_.end(), [&](const LinkGeometry& link) {
      return link.touched() == body && link.wraps() && !link.geodesic;
    });
    if (listed) continue;
    cable.candidates.push_back(wrap_candidate(bodies_, body));
  }
}

bool CableCompiler::any_wrappable() const {
  for (int body = 0; body < bodies_.count(); ++body) {
    if (bodies_.definition(body).wrappable) return true;
  }
  return false;
}

namespace {

/// Whether a smooth body's section with a plane is a geodesic: at right angles to the axis beside
/// the core, or through the axis, or through the centre of a ball.
bool is_shortest_in_plane(const SmoothSurface& surface, const Vector3& normal, const Vector3& point,
                          double slop) {
  if (surface.form != SurfaceForm::rounded && surface.form != SurfaceForm::cylinder) return false;
  if (surface.is_ball()) return std::abs(dot(normal, point - surface.center)) <= slop;
  const double along = std::abs(dot(normal, surface.axis));
  if (along >= 1.0 - 1e-15) {
    return surface.has_ends() || std::abs(surface.height(point)) <= surface.half_length + slop;
  }
  return along <= 1e-15 && std::abs(dot(normal, point - surface.center)) <= slop;
}

}  // namespace

bool CableCompiler::place_candidate(const CompiledCable& cable, WrapCandidate& candidate) const {
  if (candidate.listed >= 0) return true;
  if (!cable.planar || !bodies_.stays_in_plane(candidate.body, cable.normal)) return true;
  const Quaternion to_own = now_->orientation(candidate.body).conjugate();
  const Vector3 center = now_->point(candidate.body, candidate.center);
  const double offset = cable.normal.dot(link_center(*now_, links_.front()) - center);
  const std::optional<LinkGeometry> link =
      wrap_link(bodies_, candidate,
                {candidate.center + to_own * (offset * cable.normal), to_own * cable.normal});
  // The cable's plane misses the body, so the cable never touches it.
  if (!link) return false;
  if (candidate.surface &&
      !is_shortest_in_plane(*candidate.surface, to_own * cable.normal,
                            candidate.center + to_own * (offset * cable.normal),
                            1e-9 * bodies_.scale())) {
    return true;
  }
  candidate.link = *link;
  candidate.planar = true;
  return true;
}

bool CableCompiler::runs_through(const WrapCandidate& candidate, const WrapSide& side,
                                 const SpanGeometry& span) const {
  if (is_geodesic(candidate)) {
    const auto touch = surface_touch(*now_, candidate, span, side);
    return touch && touch->cuts(candidate);
  }
  std::optional<LinkGeometry> link = candidate.link;
  if (!candidate.planar) {
    const std::optional<WrapPlane> plane = wrap_plane(*now_, candidate, span);
    link = plane ? wrap_link(bodies_, candidate, *plane) : std::nullopt;
  }
  if (!link) return false;
  const Vector3 normal = now_->orientation(link->carrier) * link->normal;
  link->side = dot(normal, side.moment) >= 0.0 ? 1 : -1;
  return clearance(*now_, *link, span).cuts(*link);
}

void CableCompiler::check_candidates(const CompiledCable& cable) {
  for (int k = 0; k < cable.listed_spans; ++k) {
    if (links_[at(k)].starts_lifted) continue;
    const SpanGeometry& span = geometry_[at(k)];
    const int second = next_touched(k);
    for (const WrapCandidate& candidate : cable.candidates) {
      if (candidate.listed >= 0 || links_[at(k)].touched() == candidate.body ||
          links_[at(second)].touched() == candidate.body) {
        continue;
      }
      const WrapSide side = wrap_side(*now_, candidate, span);
      if (side.distance > candidate.reach) continue;
      if (!runs_through(candidate, side, span)) continue;
      fail("/links/" + std::to_string(second),
           "the span between " + link_name(k) + " and " + link_name(second) +
               " runs through the wrappable body \"" + bodies_.name(candidate.body) +
               "\"; put a rolling link on it between them, or move it out of the way");
    }
  }
}

void CableCompiler::set_course(CompiledCable& cable) {
  for (int i = 0; i < cable.listed_links; ++i) {
    LinkGeometry& link = links_[at(i)];
    const bool end = !cable.closed && (i == 0 || i + 1 == cable.listed_links);
    // A rope with weight stays on its wheels.
    link.lifts = !end && link.wraps() && cable.linear_density == 0.0;
    cable.course_changes = cable.course_changes || link.lifts;
    cable.has_outlines = cable.has_outlines || link.outline;
    const bool stays = !link.starts_lifted && (cable.closed || i + 1 < cable.listed_links);
    next_links_.push_back(stays ? next_touched(i) : -1);
    cable.has_sheaths = cable.has_sheaths || link.sheath;
    if (!end && !link.wraps() && !link.passes() && !link.sheath)
      cable.grips.push_back(cable.first_link + i);
    if (end || !link.passes()) continue;
    cable.shares = true;
    cable.has_friction = cable.has_friction || !link.frictionless();
  }
  if (!cable.candidates.empty()) {
    cable.course_changes = cable.shares = true;
    cable.has_friction = cable.has_friction || cable.wrap_friction > 0.0;
  }
  cable.course_changes = cable.course_changes || std::isfinite(cable.breaking_tension) ||
                         std::isfinite(cable.cut_time);
}

void CableCompiler::set_drives(CompiledCable& cable) const {
  int fast = 0;  // ends of chains that no force can move (cable/cable_drives.cpp)
  for (int i = 0; i < cable.listed_links; ++i) {
    const LinkGeometry& link = links_[at(i)];
    const bool end = !cable.closed && (i == 0 || i + 1 == cable.listed_links);
    if (link.feeds || bodies_[link.body].prescribed()) {
      cable.driven_links.push_back(cable.first_link + i);
    }
    if ((end || CableSystem::ends_chain(bodies_, link)) && !CableSystem::can_move(bodies_, link)) {
      ++fast;
    }
  }
  const bool elastic = cable.compliance > 0.0 || cable.inverse_stiffness > 0.0;
  cable.may_lock = !elastic && !cable.driven_links.empty() && fast > 1;
}

void CableCompiler::append_places(CompiledCable& cable) {
  if (cable.candidates.empty()) return;
  LinkGeometry unused;
  unused.body = unused.carrier = bodies_.count();
  links_.resize(at(cable.link_count), unused);
  next_links_.resize(next_links_.size() + at(cable.link_count - cable.listed_links), -1);
  cable.senses.resize(at(cable.link_count), 1.0);
  for (int k = static_cast<int>(spans_.size()); k < cable.span_count; ++k) {
    SpanSetup setup;
    setup.cable = static_cast<int>(system_->cables_.size());
    setup.first = setup.second = cable.first_link + k;
    setup.active = false;
    spans_.push_back(setup);
  }
}

void CableCompiler::number_planes(CompiledCable& cable) {
  cable.planes.assign(at(cable.link_count), -1);
  for (int i = cable.listed_links; i < cable.link_count; ++i) cable.planes[at(i)] = planes_++;
  for (const WrapCandidate& candidate : cable.candidates) {
    if (candidate.listed >= 0) cable.planes[at(candidate.listed)] = planes_++;
  }
}

namespace {

/// Settings that a compiled cable has as they are.
void take_settings(const CableDef& def, const Vector3& gravity, CompiledCable& cable) {
  cable.damping = def.damping;
  cable.axial_damping = def.axial_damping;
  cable.linear_density = def.linear_density;
  cable.axial_inertia = def.axial_inertia;
  if (def.floor) {
    cable.floor = *def.floor;
    cable.floor_up = -gravity.normalized();
    cable.floor_friction = def.floor_friction;
  }
  cable.tangent_update = def.tangent_update;
  cable.wrap_friction = def.wrap_friction;
  if (def.breaking_tension) cable.breaking_tension = *def.breaking_tension;
  if (def.cut_time) cable.cut_time = *def.cut_time;
  for (const auto& link : def.links) cable.link_types.push_back(link->type());
}

}  // namespace

void CableCompiler::store(const CableDef& def) {
  CableSystem& s = *system_;
  CompiledCable cable;
  cable.name = def.name;
  cable.closed = def.closed;
  cable.defined_in = frames_;
  cable.first_link = static_cast<int>(s.links_.size());
  cable.listed_links = cable.link_count = static_cast<int>(links_.size());
  cable.first_span = static_cast<int>(s.spans_.size());
  cable.listed_spans = cable.span_count = def.span_count();
  cable.compliance = def.compliance.value_or(0.0);
  cable.inverse_stiffness = def.axial_stiffness ? 1.0 / *def.axial_stiffness : 0.0;
  if (law_) {
    cable.law = law_;
    cable.memory = memory_;
    cable.inverse_stiffness = 1.0 / law_->scale();
  }
  take_settings(def, now_->gravity, cable);
  find_anchors(def, cable);
  for (int i = 0; i < cable.listed_links; ++i) {
    if (links_[at(i)].opening) cable.openings.push_back(cable.first_link + i);
  }

  find_candidates(def, cable);
  find_plane(cable);
  std::erase_if(cable.candidates, [&](WrapCandidate& c) { return !place_candidate(cable, c); });
  cable.has_geodesics = std::any_of(cable.candidates.begin(), cable.candidates.end(), is_geodesic);
  if (!runs_) check_candidates(cable);
  const bool wraps = std::any_of(cable.candidates.begin(), cable.candidates.end(),
                                 [](const WrapCandidate& c) { return c.listed < 0; });
  if (wraps) cable.link_count = cable.span_count = cable.listed_links + def.most_wraps;
  check_law_wraps(cable);
  number_planes(cable);
  set_course(cable);
  set_drives(cable);

  std::vector<double> lengths = start_lengths(def);
  double total = 0.0;
  for (const double length : lengths) total += length;
  // 50 bits for the cable's length leave 3 of a double's 53 for stretch.
  int exponent = 0;
  static_cast<void>(std::frexp(total, &exponent));
  cable.quantum = std::ldexp(1.0, exponent - 50);
  for (int k = 0; k < cable.listed_spans; ++k) {
    remainders_.push_back(lengths[at(k)] - cable.quantised(lengths[at(k)]));
  }
  for (double& length : lengths) length = cable.quantised(length);
  for (const double length : lengths) cable.start_length += length;
  const auto spans_end = lengths.begin() + cable.listed_spans;
  rest_lengths_.insert(rest_lengths_.end(), lengths.begin(), spans_end);
  stored_lengths_.insert(stored_lengths_.end(), spans_end, lengths.end());
  append_places(cable);
  rest_lengths_.resize(s.spans_.size() + spans_.size(), 0.0);
  remainders_.resize(rest_lengths_.size(), 0.0);
  stored_lengths_.resize(s.links_.size() + links_.size(), 0.0);
  start_strains_.resize(stored_lengths_.size(), 0.0);
  s.links_.insert(s.links_.end(), links_.begin(), links_.end());
  s.spans_.insert(s.spans_.end(), spans_.begin(), spans_.end());
  s.cables_.push_back(std::move(cable));
}

}  // namespace sheave
