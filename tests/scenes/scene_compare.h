#pragma once

#include <string>

#include "scenes/scene.h"

namespace sheave::test {

/// The first difference between two scenes, field by field and bit for bit; empty if there is none.
/// Independent of the writer, so that a setting it forgets is noticed.
[[nodiscard]] std::string difference(const Scene& a, const Scene& b);

}  // namespace sheave::test
