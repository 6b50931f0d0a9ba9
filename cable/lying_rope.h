#pragma once
// A rope with weight that lies in part on a level floor.
//
// The part on the floor carries no vertical load. Without friction its tension is the horizontal
// component H, which is constant along the whole rope. The parts from the floor to both ends leave it level. With the
// height b of an end above the floor, the unstretched length s that hangs below this end, the tension
// T there and e = 1 / EA,
//
//   T + e T^2 / 2 = H + e H^2 / 2 + w b,   w s = sqrt(T^2 - H^2),   u = asinh(w s / H),
//
// and the hanging part is H u / w + e H s wide. The width of the whole is x, so the unstretched length is
//
//   L = (x + g_0 + g_1) / (1 + e H),   g = s - H u / w = (H / w)(sinh u - u),
//
// with the surplus g of each hanging part over its width. L falls with H:
//
//   w dg/dH = 2 tanh(u/2) - u - (T - H)^2 e / (w s (1 + e T)).
//
// With friction, one end is an anchor on the floor, H is the horizontal component from the touch-down to
// the other end, and the tension of the rope on the floor is that of cable/floor_profile.h. The rope that
// lies has the unstretched length l and is stretched by e J, so
//
//   L = x + g - e (J + s H),   l = L - s.
//
// Without friction J = l H, which gives the L above.
//
// A rope that is longer than L at H = 0, x + s_0 + s_1, is slack: its ends hang plumb, and the rest lies
// loose on the floor. There dg/dH has a logarithmic pole, so the tension of a rope that becomes taut
// rises from 0 without a jump.
//
// At the instant of touch-down the part on the floor has no length, so H, the forces at the ends and L
// are those of the free catenary. Their derivatives jump, because the lowest point of the free rope moves
// up and down, and the rope on the floor does not. The force of the span on its ends is therefore a
// continuous function of their places with a kink, and the energy has a continuous derivative.
//
// The chord tension (cable/catenary.h) is T_c = (H x + w (s_1 - s_0) z / 2) / c with the rise z. The least
// chord tension is that of H = 0. T_c rises with H, because ds/dH = tanh(u/2) / w (1 + e T) is larger at
// the higher end but for the stretch. So ends above the floor must be farther apart than about
// e w z^2 / 2 horizontally, which is a millimetre for steel and z = 10 m.
//
// A slack rope has this least chord tension. A smaller one tells how much rope is to spare: L grows by
// 1 / w per tension, and the forces stay. So the law of a span needs no bounds.

#include <optional>

#include "cable/catenary.h"

namespace sheave {

/// The part of a rope between the floor and an end.
struct HungPart {
  double length = 0.0;         ///< s: unstretched [m]
  double tension = 0.0;        ///< T: at the end [N]
  double surplus = 0.0;        ///< g: unstretched length less the part of the width [m]
  double length_slope = 0.0;   ///< ds / dH [m/N]
  double surplus_slope = 0.0;  ///< dg / dH [m/N], <= 0
  double height = 0.0;         ///< integral of the height above the floor over the length [m2]
};

/// The part below an end at this height above the floor [m] for the horizontal component H [N], >= 0. A
/// height below 0 counts as 0.
[[nodiscard]] HungPart hung_part(const HangingRope& rope, double height, double horizontal);

/// The rope of this unstretched length [m]; none if there is no floor or the rope does not touch it.
[[nodiscard]] std::optional<Catenary> lying_of_length(const HangingRope& rope, double length);

/// The same for this chord tension [N]; below the least one a rope that is slack.
[[nodiscard]] std::optional<Catenary> lying_of_tension(const HangingRope& rope, double tension);

/// The chord tension of a rope that lies slack on its floor [N].
[[nodiscard]] double least_tension(const HangingRope& rope);

/// Where a rope comes onto its floor.
struct TouchDown {
  /// Of the rope that lies taut on the floor [m, unstretched]. At most 0: none lies, and the link at the
  /// anchor bears the weight of so much rope.
  double length = 0.0;
  double tension = 0.0;  ///< H [N]
};
[[nodiscard]] TouchDown touch_down(const HangingRope& rope, const Catenary& catenary);

/// The tension along the rope that lies on a floor with friction.
[[nodiscard]] FloorProfile lying_tensions(const HangingRope& rope, const Catenary& catenary);

/// Derivatives of a rope on its floor by the chord tension.
/// 0 but for the length if it is slack.
struct LyingSlopes {
  double horizontal = 0.0;  ///< of H
  double start = 0.0;       ///< of the vertical component of the tension at the start, upwards
  double end = 0.0;         ///< the same at the end
  double length = 0.0;      ///< of the unstretched length [m/N]
};
[[nodiscard]] LyingSlopes lying_slopes(const HangingRope& rope, const Catenary& catenary);

[[nodiscard]] Excess lying_excess(const HangingRope& rope, const Catenary& catenary);
[[nodiscard]] double lying_height_integral(const HangingRope& rope, const Catenary& catenary);
[[nodiscard]] double lying_energy(const HangingRope& rope, const Catenary& catenary);

}  // namespace sheave
