#pragma once
// What can be set while a simulation runs, by name: the outputs of controllers, and what triggers
// change.

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cable/simulation.h"
#include "scenes/observables.h"

namespace sheave {

/// One setting of a running simulation.
struct ControlPoint {
  enum class Kind {
    body_drive,
    joint_drive,
    joint_limit,
    force,
    torque,
    gravity,
    feed_speed,
    link_friction,
    compliance,
    breaking_tension,
  };
  Kind kind = Kind::body_drive;
  int entity = 0;           ///< index of the body, joint or cable
  int item = 0;             ///< of the coordinate, the link, or the component
  bool takes_time = false;  ///< a drive to an angle or a position, which is not there at once

  /// Sets it, to be reached in `over` seconds if it takes time; an error if that is not possible.
  [[nodiscard]] Errors set(Simulation& simulation, double value, double over) const;
  /// It is again what the scene says.
  [[nodiscard]] Errors clear(Simulation& simulation) const;
};

/// The names of all of them, for the documentation.
[[nodiscard]] std::span<const QuantityGroup> control_groups();

/// The one with this name; an error suggests names that are nearly the same.
[[nodiscard]] Result<ControlPoint> find_control(std::string_view name, const Model& model,
                                                const std::vector<CableDef>& cables);

}  // namespace sheave
