#pragma once
// Integers of 128 bits, for exact decisions in geometry.

#include <cmath>
#include <compare>
#include <cstdint>

namespace sheave {

/// A signed integer of 128 bits in two's complement, for compilers without one (32 bit). Overflow
/// wraps around.
class TwoWordInteger {
 public:
  constexpr TwoWordInteger() = default;
  // Implicit, so that mixed arithmetic reads as with built-in types.
  // NOLINTNEXTLINE(google-explicit-constructor,hicpp-explicit-conversions)
  constexpr TwoWordInteger(std::int64_t value)
      : low_(static_cast<std::uint64_t>(value)), high_(value < 0 ? ~std::uint64_t{0} : 0) {}

  /// The nearest double; of two equally near ones the one with an even last bit.
  explicit operator double() const {
    if (negative()) return -static_cast<double>(-*this);
    if (high_ == 0) return static_cast<double>(low_);
    // The highest 64 bits. Their last bit is set if a lower bit is, so that one rounding gives the
    // right result.
    int lost = 64;
    std::uint64_t kept = high_;
    std::uint64_t rest = low_;
    while ((kept >> 63U) == 0) {
      kept = (kept << 1U) | (rest >> 63U);
      rest <<= 1U;
      --lost;
    }
    return std::ldexp(static_cast<double>(kept | (rest != 0 ? 1U : 0U)), lost);
  }

  friend constexpr TwoWordInteger operator+(TwoWordInteger a, TwoWordInteger b) {
    const std::uint64_t low = a.low_ + b.low_;
    return {low, a.high_ + b.high_ + (low < a.low_ ? 1U : 0U)};
  }
  friend constexpr TwoWordInteger operator-(TwoWordInteger a) {
    return TwoWordInteger(~a.low_, ~a.high_) + TwoWordInteger(1);
  }
  friend constexpr TwoWordInteger operator-(TwoWordInteger a, TwoWordInteger b) { return a + -b; }
  friend constexpr TwoWordInteger operator*(TwoWordInteger a, TwoWordInteger b) {
    constexpr std::uint64_t half = 0xffffffffU;
    const std::uint64_t bottom = (a.low_ & half) * (b.low_ & half);
    const std::uint64_t first = (a.low_ >> 32U) * (b.low_ & half) + (bottom >> 32U);
    const std::uint64_t second = (a.low_ & half) * (b.low_ >> 32U) + (first & half);
    const std::uint64_t top = (a.low_ >> 32U) * (b.low_ >> 32U) + (first >> 32U) + (second >> 32U);
    return {(second << 32U) | (bottom & half), top + a.low_ * b.high_ + a.high_ * b.low_};
  }
  constexpr TwoWordInteger& operator+=(TwoWordInteger other) { return *this = *this + other; }
  constexpr TwoWordInteger& operator-=(TwoWordInteger other) { return *this = *this - other; }

  friend constexpr bool operator==(TwoWordInteger a, TwoWordInteger b) = default;
  friend constexpr std::strong_ordering operator<=>(TwoWordInteger a, TwoWordInteger b) {
    const auto high = static_cast<std::int64_t>(a.high_) <=> static_cast<std::int64_t>(b.high_);
    return high != std::strong_ordering::equal ? high : a.low_ <=> b.low_;
  }

 private:
  constexpr TwoWordInteger(std::uint64_t low, std::uint64_t high) : low_(low), high_(high) {}
  [[nodiscard]] constexpr bool negative() const { return (high_ >> 63U) != 0; }

  std::uint64_t low_ = 0;
  std::uint64_t high_ = 0;
};

#ifdef __SIZEOF_INT128__
// Not part of ISO C++; only a typedef avoids -Wpedantic's warning.
// NOLINTNEXTLINE(modernize-use-using)
__extension__ typedef __int128 WideInteger;
#else
using WideInteger = TwoWordInteger;
#endif

}  // namespace sheave
