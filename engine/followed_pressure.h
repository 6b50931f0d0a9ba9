#pragma once
// The pressure that bounds friction, found in rounds that each take it as given.
//
// With the pressure p of the last round a round finds the pressure n(p). Where friction unloads what
// presses (a tall body that is dragged tips), n falls with p, and taking n(p) for the next p goes to
// and fro for ever once it falls by more than p rises. Then the root of n(p) - p lies between the
// last two p, where a secant finds it.

#include <cmath>

namespace sheave {

class FollowedPressure {
 public:
  /// What to take for the next round, after one that was given `taken` and has found `found`, in
  /// any unit.
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
  double off_ = 0.0;  ///< 0: no round yet
};

}  // namespace sheave
