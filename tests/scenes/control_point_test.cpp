// Values that triggers set over a time.

#include "scenes/control/control_point.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/control/scene_supervisor.h"
#include "scenes/scene.h"

namespace sheave {
namespace {

/// A rotor of 2 kg m2 whose drive asks for 4, and from 0.5 s on goes to 0 within 0.5 s, at 1.5 s.
Simulation eased_rotor(const std::string& drive, int substeps) {
  const SceneResult scene = load_scene_text(
      R"({"format": "sheave-scene/1", "duration": 1.5, "gravity": [0, 0, 0],
          "step": {"substeps": )" +
          std::to_string(substeps) + R"(},
          "bodies": [{"name": "rotor", "mobility": "rotor", "mass": 1, "spin_inertia": 2,
                      "drive": ")" +
          drive + R"(", "drive_values": [4]}],
          "triggers": [{"name": "ease", "at": 0.5, "action": "set", "target": "rotor.drive",
                        "value": 0, "over": 0.5}]})",
      "s.json");
  if (!scene) throw std::runtime_error(to_string(scene.errors.front()));
  Result<Simulation> simulation = create_simulation(*scene);
  if (!simulation) throw std::runtime_error(simulation.errors().front().message);
  const long steps = std::lround(1.5 / scene->model.step.dt);
  for (long i = 0; i < steps; ++i) {
    if (!simulation->step().ok()) throw std::runtime_error("the run diverges");
  }
  return std::move(*simulation);
}

// A speed of 4 rad/s for 0.5 s and then falling to 0 within 0.5 s turns the rotor by 4 (0.5 + 0.5 / 2) = 3 rad. A torque likewise
// ends at a speed of 3 / 2 rad/s. Both are linear in time between boundaries of substeps, so the means over substeps are exact.
TEST(ControlPoint, DrivesReachAValueOverTheTimeThatIsGiven) {
  for (const int substeps : {1, 4, 16}) {
    const Simulation speed = eased_rotor("speed", substeps);
    EXPECT_NEAR(speed.world.state().bodies[0].angle, 3.0, 1e-12);
    const Simulation torque = eased_rotor("torque", substeps);
    EXPECT_NEAR(torque.world.angular_velocity(BodyId{0}).z(), 1.5, 1e-12);
  }
}

}  // namespace
}  // namespace sheave
