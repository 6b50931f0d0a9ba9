#pragma once
// What an edit's definitions refer to has to be there; internal to the cable library.

#include <string>
#include <string_view>

#include "cable/edit_draft.h"

namespace sheave {

/// Path of a fault of what has this slot in a list of the draft.
[[nodiscard]] std::string edit_path(std::string_view list, std::size_t slot);

/// Adds a fault to the draft for each mount, joint, collider and link on a body that is not there,
/// and for each cable without a name of its own.
void check_references(EditDraft& draft);

}  // namespace sheave
