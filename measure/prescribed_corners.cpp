#include "measure/prescribed_corners.h"

#include <algorithm>

#include "scenes/format.h"

namespace sheave::measure {
namespace {

/// Appends the values of all lists of times in a table of fields.
void append_times(std::span<const Field> table, const void* object, std::vector<double>& times) {
  for (const Field& field : table) {
    // "times" alone would be the list of another kind of object.
    if (!field.name.ends_with("drive_times") && field.name != "setpoint_times") continue;
    // Slots serve reading and writing; this code only reads.
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast)
    const FieldSlot slot = field.slot(const_cast<void*>(object));
    const auto* list = std::get_if<std::vector<double>*>(&slot);
    if (list != nullptr) times.insert(times.end(), (*list)->begin(), (*list)->end());
  }
}

}  // namespace

std::vector<double> prescribed_corners(const Scene& scene) {
  std::vector<double> times;
  for (const BodyDef& body : scene.model.bodies) {
    append_times(BodyDef::field_table(), &body, times);
  }
  for (const auto& joint : scene.model.joints) {
    const Variant* variant = joint_format().variant(joint->type());
    if (variant != nullptr) append_times(variant->table.fields, joint->settings(), times);
  }
  for (const auto& controller : scene.controllers) {
    append_times(ControllerDef::common_field_table(), controller.get(), times);
  }
  std::ranges::sort(times);
  times.erase(std::ranges::unique(times).begin(), times.end());
  return times;
}

}  // namespace sheave::measure
