#pragma once
// The bits of numbers. std::bit_cast would be enough, but emscripten's library lacks it.

#include <cstdint>

namespace sheave {

/// The IEEE 754 layout: sign, 11 bits of exponent, 52 bits of mantissa.
[[nodiscard]] constexpr std::uint64_t bits_of(double x) {
  return __builtin_bit_cast(std::uint64_t, x);
}
[[nodiscard]] constexpr double double_of(std::uint64_t bits) {
  return __builtin_bit_cast(double, bits);
}

}  // namespace sheave
