#pragma once
// Checks that the bodies that an edit's definitions refer to exist; internal to the cable library.

#include <string>
#include <string_view>

#include "cable/edit_draft.h"

namespace sheave {

/// Path of a fault of the object in slot `slot` of a list of the draft.
[[nodiscard]] std::string edit_path(std::string_view list, std::size_t slot);

/// Adds a fault for each mount, joint, collider and link on a body that does not exist, and for
/// each cable whose name is empty or not unique.
void check_references(EditDraft& draft);

}  // namespace sheave
