#pragma once
// Changes a setting in the text of a scene without changing any other character: comments, order
// and blanks stay.

#include <string>
#include <string_view>
#include <vector>

#include "engine/result.h"
#include "scenes/scene.h"

namespace sheave {

/// `text` with the setting's value replaced, or with the setting added behind the last one of its
/// object; "/step" is created if it is missing. `value` is JSON. An error if the text is not JSON,
/// or if the setting has no place in it.
[[nodiscard]] Result<std::string> with_setting(std::string_view text, std::string_view pointer,
                                               std::string_view value);

/// The overrides that give the scene `from` the step settings of `to` and its cables' tangent
/// updates, without settings that are equal already. Both must have the same number of cables.
[[nodiscard]] std::vector<Override> step_changes(const Scene& from, const Scene& to);

}  // namespace sheave
