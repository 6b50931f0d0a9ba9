#pragma once
// The bits of numbers. std::bit_cast would do, but emscripten's library does not have it yet.

#include <cstdint>

namespace sheave {

/// As IEEE 754 lays them out: sign, 11 bits of exponent, 52 of mantissa.
[[nodiscard]] constexpr std::uint64_t bits_of(double x) {
  return __builtin_bit_cast(std::uint64_t, x);
}
[[nodiscard]] constexpr double double_of(std::uint64_t bits) {
  return __builtin_bit_cast(double, bits);
}

}  // namespace sheave
