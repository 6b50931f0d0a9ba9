#pragma once
// Units of observables by name, for axes and tables without access to the scene.

#include <optional>
#include <string>
#include <string_view>

namespace sheave {

/// The unit of "t", "weight.vy", "rope.1.tension", "door.angle_rate", "a.x - b.x", ...: empty for a
/// pure number, nothing for an unknown name. Both units if the joint determines it ("door.drive_force"): "N, N
/// m".
[[nodiscard]] std::optional<std::string> quantity_unit(std::string_view name);

}  // namespace sheave
