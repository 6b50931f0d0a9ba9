#pragma once
// Settings that controllers and triggers can change during a run, by name.

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cable/simulation.h"
#include "scenes/control/load.h"
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
    excitation,
  };
  Kind kind = Kind::body_drive;
  int entity = 0;  ///< index of the body, joint, cable or load
  /// index of the coordinate, the link, the component, or of an excitation in State::memory; -1: its
  /// place is not known, and set() only checks the value
  int item = 0;
  bool takes_time = false;  ///< a drive to an angle or a position, which needs time to reach it

  /// Sets the value. A drive or a feed reaches the value in `over` seconds. Without `over`, an angle
  /// or a position is reached in `interval` seconds, a speed in a substep, and any other value at
  /// once. An error if the value is impossible, or if `over` is given for a control that
  /// can_take_time() excludes.
  [[nodiscard]] Errors set(Simulation& simulation, double value, double interval,
                           std::optional<double> over = {}) const;
  /// Whether the value can be reached over a given time: drives of bodies and joints, and feeds.
  [[nodiscard]] bool can_take_time() const;
  /// Restores the value of the scene.
  [[nodiscard]] Errors clear(Simulation& simulation) const;
};

/// The names of all control points, for the documentation.
[[nodiscard]] std::span<const QuantityGroup> control_groups();

/// The control point with this name; of an excitation without its place in the memory. The error
/// suggests similar names.
[[nodiscard]] Result<ControlPoint> find_control(
    std::string_view name, const Model& model, const std::vector<CableDef>& cables,
    std::span<const std::shared_ptr<const LoadDef>> loads = {});

}  // namespace sheave
