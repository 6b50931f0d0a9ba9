#include "measure/stress_scenes.h"

#include <algorithm>

#include <stress_scene_bow.h>
#include <stress_scene_gym.h>
#include <stress_scene_hand.h>

namespace sheave::measure {

std::optional<std::string_view> stress_scene(std::string_view name) {
  const auto text = [](const unsigned char* bytes, std::size_t size) {
    return std::string_view(reinterpret_cast<const char*>(bytes), size);
  };
  const std::array<std::string_view, stress_scene_names.size()> texts{
      text(stress_scene_hand, stress_scene_hand_size),
      text(stress_scene_gym, stress_scene_gym_size), text(stress_scene_bow, stress_scene_bow_size)};
  const auto found = std::find(stress_scene_names.begin(), stress_scene_names.end(), name);
  if (found == stress_scene_names.end()) return std::nullopt;
  return texts[static_cast<std::size_t>(found - stress_scene_names.begin())];
}

}  // namespace sheave::measure
