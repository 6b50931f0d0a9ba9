#pragma once
// Fixed-point iteration for the pressure that bounds friction. Each round takes the pressure of the
// round before as given.
//
// With the given pressure p, a round finds the pressure n(p), and the iteration seeks n(p) = p.
// Friction may unload the surface that it acts on (a tall body that is dragged tips), so that n
// falls with p. Once n'(p) < -1, taking n(p) as the next p oscillates for ever. The root of n(p) -
// p then lies between the last two p, and a secant finds it.

#include <cmath>

namespace sheave {

class FollowedPressure {
 public:
  /// The pressure to give to the next round, if the last round was given `taken` and found `found`,
  /// in any unit.
  double next(double taken, double found) {
    constexpr double slow = 0.5;
    const double off = found - taken;
    const bool to_and_fro = off * off_ < 0.0 && std::abs(off) > slow * std::abs(off_);
    const double best = to_and_fro ? taken - off * (taken - taken_) / (off - off_) : found;
    taken_ = taken;
    off_ = off;
    return best;
  }

 private:
  double taken_ = 0.0;
  double off_ = 0.0;  ///< found - taken of the round before; 0: no round yet
};

}  // namespace sheave
