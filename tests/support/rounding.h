#pragma once

#include <limits>

namespace sheave::test {

/// Relative distance of neighbouring doubles at 1: twice the largest relative rounding error of one
/// operation.
inline constexpr double eps = std::numeric_limits<double>::epsilon();

}  // namespace sheave::test
