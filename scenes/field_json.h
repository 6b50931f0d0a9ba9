#pragma once

#include <functional>
#include <string_view>

#include <nlohmann/json.hpp>

#include "scenes/format.h"

namespace sheave {

/// The name of a body, for references.
using BodyNamer = std::function<std::string(BodyId)>;

/// The value of a field as in a scene file; null for an optional field without a value.
[[nodiscard]] nlohmann::ordered_json field_json(const Field& field, const FieldSlot& slot,
                                                const BodyNamer& name_of);

}  // namespace sheave
