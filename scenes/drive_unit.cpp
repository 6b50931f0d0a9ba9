#include "scenes/drive_unit.h"

#include "scenes/format.h"

namespace sheave {

std::optional<std::array<std::string_view, 3>> drive_units(std::string_view unit) {
  const std::size_t comma = unit.find(", ");
  const std::size_t either = unit.find(" or ");
  if (comma == std::string_view::npos || either == std::string_view::npos) return {};
  return std::array{unit.substr(0, comma), unit.substr(comma + 2, either - comma - 2),
                    unit.substr(either + 4)};
}

std::string_view drive_of(std::string_view field) {
  return field.substr(0, field.find("drive") + std::string_view("drive").size());
}

std::string_view setting_unit(const Field& field, std::span<const Field> table,
                              const void* object) {
  const auto units = drive_units(field.unit);
  if (!units) return field.unit;
  const std::string_view drive = drive_of(field.name);
  for (const Field& other : table) {
    if (other.name != drive) continue;
    const FieldSlot slot = slot_of(other, object);
    const auto* const choice = std::get_if<ChoiceSlot>(&slot);
    const int kind = choice == nullptr ? 0 : choice->get(choice->object);
    if (kind > 0 && kind <= static_cast<int>(units->size())) {
      return (*units)[static_cast<std::size_t>(kind) - 1];
    }
  }
  return field.unit;
}

}  // namespace sheave
