#pragma once
// Scenes of the repository for stability maps, built into the program.

#include <array>
#include <optional>
#include <string_view>

namespace sheave::measure {

/// Their names.
inline constexpr std::array<std::string_view, 3> stress_scene_names{"hand", "gym", "bow"};

/// The text of the scene with that name, as in scenes/paper; nothing if there is none.
[[nodiscard]] std::optional<std::string_view> stress_scene(std::string_view name);

}  // namespace sheave::measure
