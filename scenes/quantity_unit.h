#pragma once
// Units of observables by their names, for axes and tables that have no scene at hand.

#include <optional>
#include <string>
#include <string_view>

namespace sheave {

/// The unit of "t", "weight.vy", "rope.1.tension", "door.angle_rate", ...: empty for a pure number,
/// nothing for a name that no quantity has. Where the joint decides ("door.drive_force"), both:
/// "N, N m".
[[nodiscard]] std::optional<std::string> quantity_unit(std::string_view name);

}  // namespace sheave
