#include "measure/rungs/massless_wheels.h"

#include <cmath>
#include <vector>

#include "cable/links/rolling.h"

namespace sheave::measure {
namespace {

bool is_round(const BodyDef& body, const RollingLink& link) {
  if (link.radius) return true;
  for (const PlacedShape& placed : body.shapes) {
    if (std::isfinite(placed.shape->wheel_radius())) return true;
  }
  return false;
}

bool turns_freely(const BodyDef& body) {
  return body.mobility == Mobility::rotor && body.spin_inertia != 0.0 &&
         body.drive == DriveKind::none && body.torque.norm() == 0.0 &&
         body.angular_damping == 0.0 && !body.wrappable;
}

/// Number of links on a body, and whether all of them allow a massless wheel.
struct Use {
  int links = 0;
  bool fit = true;
};

void count_links(const CableDef& cable, const std::vector<BodyDef>& bodies, std::vector<Use>& use) {
  for (std::size_t k = 0; k < cable.links.size(); ++k) {
    const LinkDef& link = *cable.links[k];
    if (link.body.index < 0) continue;
    const auto body = static_cast<std::size_t>(link.body.index);
    const auto* const rolling = dynamic_cast<const RollingLink*>(&link);
    const bool between = cable.closed || (k > 0 && k + 1 < cable.links.size());
    ++use[body].links;
    use[body].fit = use[body].fit && between && rolling != nullptr && !rolling->friction &&
                    is_round(bodies[body], *rolling);
  }
}

}  // namespace

int make_wheels_massless(Scene& scene) {
  std::vector<BodyDef>& bodies = scene.model.bodies;
  std::vector<Use> use(bodies.size());
  for (const CableDef& cable : scene.cables) count_links(cable, bodies, use);
  const auto forbid = [&](BodyId body) {
    if (body.index >= 0) use[static_cast<std::size_t>(body.index)].fit = false;
  };
  for (const auto& joint : scene.model.joints) {
    forbid(joint->body_a);
    forbid(joint->body_b);
  }
  for (const ColliderDef& collider : scene.model.colliders) forbid(collider.body);
  int count = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (!turns_freely(bodies[i]) || !use[i].fit || use[i].links != 1) continue;
    bodies[i].spin_inertia = 0.0;
    ++count;
  }
  return count;
}

}  // namespace sheave::measure
