// Floors of ropes with weight in a run: an end that comes below its floor, and gravity that turns.

#include <cmath>

#include "cable/cable_system.h"
#include "cable/heavy_spans.h"
#include "engine/index.h"
#include "engine/number_text.h"

namespace sheave {

std::string HeavySpans::floor_fault(const CableSystem& system, const Substep& substep) {
  if (!system.weighs_ || substep.at_rest) return {};
  // A body that rests on the ground of the scene sinks in by the residual of its contact. The rope
  // counts the height of such an end as 0.
  constexpr double contact = 1e-6;
  for (std::size_t k = 0; k < system.spans_.size(); ++k) {
    const SpanSetup& setup = system.spans_[k];
    const CompiledCable& cable = system.cables_[at(setup.cable)];
    if (!setup.active || !cable.has_floor() || !system.weighs_now(substep, cable)) continue;
    constexpr double rounding = 1e-9;
    const Vector3 up = -substep.gravity / substep.gravity.norm();
    if ((up - cable.floor_up).norm() > rounding) {
      return "cable \"" + cable.name +
             "\" lies on a level floor, and gravity has turned: keep its direction, or leave "
             "\"floor\" out";
    }
    const SpanGeometry span = system.geometry_of(substep, static_cast<int>(k));
    for (const auto& [link, point] :
         {std::pair{setup.first, span.start}, std::pair{setup.second, span.end}}) {
      const double depth = cable.floor - dot(point, up);
      const double allowed = contact * substep.bodies.scale();
      const bool lifted = depth < -allowed && cable.is_anchor(link);
      if (depth <= allowed && !lifted) continue;
      const int body = system.links_[at(link)].touched();
      return "cable \"" + cable.name + "\" has come " + number_text(std::abs(depth), 3) +
             (lifted ? " m above" : " m below") + " its floor at link " +
             std::to_string(link - cable.first_link) + " on \"" +
             (body == substep.bodies.count() ? "world" : substep.bodies.name(body)) +
             (lifted
                  ? "\", the anchor of a rope with \"floor_friction\": keep the body in its place"
                  : "\", and a rope lies on its floor from above: end the run before that, let the "
                    "body rest on the ground, or lower the \"floor\"");
    }
  }
  return {};
}

}  // namespace sheave
