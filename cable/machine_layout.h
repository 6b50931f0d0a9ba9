#pragma once
// The meaning of the numbers of a state.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "cable/cable.h"
#include "engine/model.h"

namespace sheave {

/// A line for each body, joint, cable, link and collider, in their order: its kind, and its name or
/// its body.
[[nodiscard]] std::string machine_layout_text(const Model& model,
                                              const std::vector<CableDef>& cables);

/// Hash of that text: State::layout.
[[nodiscard]] std::uint64_t layout_of(const Model& model, const std::vector<CableDef>& cables);

/// FNV-1a; never 0, which stands for an unknown hash.
[[nodiscard]] std::uint64_t hash_of_text(std::string_view text);

}  // namespace sheave
