// Floors of ropes with weight at time 0: the settings, the ends above the floor, and anchors.

#include <algorithm>
#include <cmath>

#include "cable/cable_compiler.h"
#include "cable/floor_friction.h"
#include "engine/index.h"
#include "engine/number_text.h"

namespace sheave {

void CableCompiler::check_floor(const CableDef& def) {
  if (!def.floor) {
    if (def.floor_friction == 0.0) return;
    return fail("/floor_friction",
                "friction needs a floor on which the rope lies; give \"floor\" [m], or leave "
                "floor_friction out");
  }
  if (def.floor_friction > 0.0 && def.is_damped()) {
    fail("/floor_friction",
         "a rope with a damper lies on a floor without friction; leave damping, axial_damping or "
         "floor_friction out");
  }
  if (!(def.linear_density > 0.0)) {
    fail("/floor",
         "a rope lies on a floor by its weight; give it \"linear_density\" [kg/m], or leave "
         "floor out");
  } else if (is_zero(now_->gravity)) {
    fail("/floor",
         "a floor is level, which needs gravity; give the scene gravity, or leave floor out");
  } else if (def.axial_inertia) {
    fail("/floor",
         "a rope with inertia does not lie on a floor: its spans move as straight lines; leave "
         "floor or axial_inertia out");
  }
}

void CableCompiler::check_above_floor(const CableDef& def, int first, int second) {
  constexpr double rounding = 1e-9;
  const Vector3 up = -now_->gravity.normalized();
  const SpanGeometry& span = geometry_.back();
  for (const auto& [link, point] : {std::pair{first, span.start}, std::pair{second, span.end}}) {
    const double height = up.dot(point) - *def.floor;
    if (height >= -rounding * bodies_.scale()) continue;
    fail("/floor",
         link_name(link) + " is " + number_text(-height) +
             " m below the floor, and a rope lies on its floor from above; lift the link, "
             "lower the floor to " +
             number_text(up.dot(point)) + " m, or leave floor out");
    return;
  }
}

bool CableCompiler::is_anchor(const CableDef& def, bool first) const {
  const std::size_t link = first ? 0 : def.links.size() - 1;
  const LinkGeometry& end = links_[link];
  if (def.closed || end.feeds || def.links[link]->type() != "attachment") return false;
  const int body = end.touched();
  if (body < bodies_.count() && bodies_[body].mobility != Mobility::fixed) return false;
  const SpanGeometry& span = first ? geometry_.front() : geometry_.back();
  constexpr double rounding = 1e-9;
  const double height = -now_->gravity.normalized().dot(first ? span.start : span.end);
  return std::abs(height - *def.floor) <= rounding * std::max(bodies_.scale(), span.length);
}

void CableCompiler::find_anchors(const CableDef& def, CompiledCable& cable) {
  if (!(def.floor_friction > 0.0) || !weighs(def)) return;
  cable.anchored = {is_anchor(def, true), is_anchor(def, false)};
  // A rope that lies whole has one anchor.
  if (def.span_count() == 1 && cable.anchored[0]) cable.anchored[1] = false;
  if (cable.anchored[0] || cable.anchored[1]) return;
  fail("/floor_friction",
       "friction holds rope between an anchor on the floor and the next link; put the first or the "
       "last link, an attachment on the world or on a static body, at the height of the floor, " +
           number_text(*def.floor) + " m, or leave floor_friction out");
}

void CableCompiler::make_floors(bool fresh) {
  CableSystem& s = *system_;
  s.floor_places_.assign(s.spans_.size(), -1);
  int places = 0;
  for (const CompiledCable& cable : s.cables_) {
    if (cable.anchored[0]) s.floor_places_[at(cable.first_span)] = places++;
    if (cable.anchored[1])
      s.floor_places_[at(cable.first_span + cable.listed_spans - 1)] = places++;
  }
  s.laid_.resize(at(places));
  s.initial_.reals.resize(s.floor_index(places), 0.0);
  const int stray = FloorFriction::lay(s, *now_, s.initial_);
  // A running world keeps the tensions and lengths of its state; finish() of a substep looks there.
  if (stray < 0 || !fresh) return;
  errors_.push_back({"/cables/" + std::to_string(s.spans_[at(stray)].cable) + "/floor_friction",
                     FloorFriction::stray_fault(s, stray)});
}

}  // namespace sheave
