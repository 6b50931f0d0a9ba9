#pragma once
// Units of settings that depend on the kind of a drive: "rad/s, rad or N m".

#include <array>
#include <optional>
#include <span>
#include <string_view>

#include "engine/field.h"

namespace sheave {

/// The units in a text of three, one for each choice of the drive except the first, "none"; nothing
/// for other texts.
[[nodiscard]] std::optional<std::array<std::string_view, 3>> drive_units(std::string_view unit);
/// The name of the field with the kind of the drive to which a field belongs: "twist_drive" of
/// "twist_drive_values".
[[nodiscard]] std::string_view drive_of(std::string_view field);
/// The unit of a field of an object, whose type is that of the table; all three if the object has no
/// drive.
[[nodiscard]] std::string_view setting_unit(const Field& field, std::span<const Field> table,
                                            const void* object);

}  // namespace sheave
