#pragma once
// Changes a setting in the text of a scene and leaves every other character as it is: comments,
// order, blanks.

#include <string>
#include <string_view>
#include <vector>

#include "engine/result.h"
#include "scenes/scene.h"

namespace sheave {

/// `text` with the setting's value replaced, or with the setting added behind the last one of its
/// object; "/step" is made if it is missing. `value` is JSON. An error if the text is no JSON, or
/// if the setting has no place in it.
[[nodiscard]] Result<std::string> with_setting(std::string_view text, std::string_view pointer,
                                               std::string_view value);

/// What must be set in a scene to give it another's step settings and its cables' tangent updates;
/// nothing that is so already. Both must have the same number of cables.
[[nodiscard]] std::vector<Override> step_changes(const Scene& from, const Scene& to);

}  // namespace sheave
