#pragma once
// Losses of a sheave: stiffness of the rope, and friction of the pin.
//
// A rope takes work to be bent onto a sheave and to be straightened again, and the pin of the sheave
// rubs. Between the tensions T1 of the incoming and T2 of the outgoing cable both brake a sheave of
// radius R with a torque of at most
//
//   M = R b (T1 + T2) + r mu P,   P = |T1 u1 + T2 u2 + m g|
//
//   b      half of `bending_loss`: each of both bends takes this share of the tension there
//   r mu   `journal_radius` x `bearing_friction`
//   P      load of the pin, by the directions u from the sheave along its spans and the weight of
//          the sheave
//
// An `efficiency` e is the case b = (1 - e) / (1 + e) without a pin: one number for all losses.
//
// Without weight P^2 = T1^2 + T2^2 - 2 T1 T2 cos w, with the wrap angle w. At a steady speed
// R (T2 - T1) = M, and with k = r mu / R the ratio e = T1 / T2 solves
//
//   (1 - b) - (1 + b) e = k sqrt(1 + e^2 - 2 e cos w),
//
// the smaller root of the square of this equation. The root is positive if b + k < 1; for half a turn
// it is (1 - b - k) / (1 + b + k).

#include <algorithm>
#include <cmath>

#include "engine/math/portable.h"

namespace sheave {

struct BearingLoss {
  double rope = 0.0;  ///< b
  double pin = 0.0;   ///< k

  /// -ln(e) at a wrap angle [rad]: the exponent of a capstan with the same ratio.
  [[nodiscard]] double exponent(double wrap) const {
    const double come = 1.0 - rope;
    const double go = 1.0 + rope;
    const double cosine = portable::cos(wrap);
    const double square = pin * pin;
    const double root = std::sqrt(std::max(
        come * come + go * go - 2.0 * come * go * cosine - square * (1.0 - cosine * cosine), 0.0));
    return portable::log((go * go - square) / (come * go - square * cosine - pin * root));
  }
};

}  // namespace sheave
