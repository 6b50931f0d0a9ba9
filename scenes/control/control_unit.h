#pragma once
// Units of controls, of the settings of controllers, and of those of triggers that follow from a
// quantity or a control.

#include <optional>
#include <string_view>

#include "engine/result.h"
#include "scenes/expression.h"
#include "scenes/scene.h"
#include "scenes/unit.h"

namespace sheave {

/// The unit of a control: of a drive that of its kind. The error suggests similar names.
[[nodiscard]] Result<Unit> control_unit(std::string_view control, const Scene& scene);

/// The unit of a setting of a trigger: `above` and `below` have that of the quantity, `value` has
/// that of the control. Nothing if the field table has the unit. `names` are those of the scene.
[[nodiscard]] std::optional<Result<Unit>> unit_of_setting(const TriggerDef& trigger,
                                                          std::string_view setting,
                                                          const Scene& scene,
                                                          const QuantityNames& names);

/// The same of a controller: setpoints have the unit of the measured quantity, outputs that of the
/// control, and gains the ratio of both.
[[nodiscard]] std::optional<Result<Unit>> unit_of_setting(const ControllerDef& controller,
                                                          std::string_view setting,
                                                          const Scene& scene,
                                                          const QuantityNames& names);

}  // namespace sheave
