#pragma once
// Numbers from a seed that are the same with every library and compiler: std::mt19937_64 is specified bit by bit, the
// standard distributions are not.

#include <cstdint>
#include <random>

#include "engine/vector.h"

namespace sheave::test {

/// A stream of random numbers.
class Random {
 public:
  explicit Random(std::uint64_t seed) : source_(seed) {}

  /// In [low, high).
  double between(double low, double high) {
    return low + (high - low) * (static_cast<double>(source_() >> 11) * 0x1p-53);
  }
  /// 0 ... count - 1.
  int below(int count) { return static_cast<int>(source_() % static_cast<std::uint64_t>(count)); }
  bool chance(double probability) { return between(0.0, 1.0) < probability; }
  /// Each coordinate in [-size, size).
  Vector3 vector(double size) {
    const double x = between(-size, size);
    const double y = between(-size, size);
    return {x, y, between(-size, size)};
  }
  Quaternion orientation() { return rotation_by(vector(3.0)); }

 private:
  std::mt19937_64 source_;
};

}  // namespace sheave::test
