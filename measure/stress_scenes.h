#pragma once
// Scenes of the repository that stability maps are made of, as part of the program.

#include <array>
#include <optional>
#include <string_view>

namespace sheave::measure {

/// What they are called: hand, gym, bow.
inline constexpr std::array<std::string_view, 3> stress_scene_names{"hand", "gym", "bow"};

/// The text of the scene of that name, as in scenes/paper; nothing if there is none.
[[nodiscard]] std::optional<std::string_view> stress_scene(std::string_view name);

}  // namespace sheave::measure
