#pragma once
// Numbers from a seed that are the same with every library and compiler: std::mt19937_64 is
// specified bit by bit, the standard distributions are not.

#include <cstdint>
#include <random>
#include <span>

#include "engine/vector.h"

namespace sheave::test {

/// A stream of random numbers.
class Random {
 public:
  /// The first numbers are made of `bytes`, two for each, so that who changes a byte changes one
  /// choice; those that follow, of the seed. `bytes` must outlive the stream.
  explicit Random(std::uint64_t seed, std::span<const std::uint8_t> bytes = {})
      : source_(seed), bytes_(bytes) {}

  /// In [low, high).
  double between(double low, double high) {
    return low + (high - low) * (static_cast<double>(next() >> 11) * 0x1p-53);
  }
  /// 0 ... count - 1.
  int below(int count) { return static_cast<int>(next() % static_cast<std::uint64_t>(count)); }
  bool chance(double probability) { return between(0.0, 1.0) < probability; }
  /// Each coordinate in [-size, size).
  Vector3 vector(double size) {
    const double x = between(-size, size);
    const double y = between(-size, size);
    return {x, y, between(-size, size)};
  }
  Quaternion orientation() { return rotation_by(vector(3.0)); }

 private:
  std::uint64_t next() {
    if (bytes_.size() < 2) return source_();
    const auto value = static_cast<std::uint64_t>(bytes_[0] | bytes_[1] << 8);
    bytes_ = bytes_.subspan(2);
    // The high bits are the value for `between`; the factor has no small divisor, so `below` gets
    // every remainder.
    return value * 0x0001000100010001U;
  }

  std::mt19937_64 source_;
  std::span<const std::uint8_t> bytes_;
};

}  // namespace sheave::test
