#pragma once

#include <cstddef>

namespace sheave {

/// The position of element `index` (0 or more) in a container. Indices are `int` in every
/// interface, because -1 means "none" and differences are signed; containers count in size_t.
constexpr std::size_t at(int index) { return static_cast<std::size_t>(index); }

}  // namespace sheave
