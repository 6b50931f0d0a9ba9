#pragma once
// The tension along a rope in a sheath; internal to the cable library.
//
// A sheath bends the rope evenly by the angle Phi over the length S. Coulomb friction holds the rope
// at a place as long as the tension T obeys |dT / dphi| <= m T there. With t = phi / Phi, the
// exponent X = m Phi and y = ln T this is |dy / dt| <= X. Rope that slides has y' = X towards the
// exit, or -X.
//
// New tensions Ta at the entry and Tb at the exit let rope slide from both ends inwards, as far as
// the old tension contradicts the law:
//
//   y(t) = y_old(t), limited to ln Ta +- X t and to ln Tb +- X (1 - t).
//
// Between these fronts the rope is stuck and keeps its strain. If |ln Tb / Ta| exceeds X, no profile
// exists and the whole rope slides. A front wipes out the pieces that it passes, so the profile is a
// list of few pieces, each linear in y (an operator of play, with wiping-out).
//
// Unstretched length: a part [t0, t1] of the sheath holds the length S (t1 - t0) less the stretch
//   S integral of x / (1 + x) dt,   x = T / EA,
// with the closed form ln((1 + x1) / (1 + x0)) / y' for each piece.

#include <array>
#include <cstddef>
#include <limits>
#include <span>

namespace sheave {

/// Constants of a rope in a sheath.
struct SheathLaw {
  double length = 0.0;    ///< S [m], > 0
  double exponent = 0.0;  ///< X, >= 0
  double yield = 0.0;     ///< 1 / EA [1/N], > 0
};

/// The tension along a sheath, from the entry at t = 0 to the exit at t = 1.
class SheathProfile {
 public:
  /// Largest number of pieces. Beyond it the node whose removal changes the stretched length least is
  /// removed. Motions that keep the largest swings from being wiped out are rare: 31 nested swings.
  static constexpr std::size_t most_pieces = 32;
  /// Number of saved numbers: the number of nodes, and t and y of each.
  static constexpr std::size_t real_count = 1 + 2 * (most_pieces + 1);
  /// ln T of a rope without tension.
  static constexpr double slack = -std::numeric_limits<double>::infinity();

  /// Without tension.
  SheathProfile() = default;
  /// One piece from the tension `entry` to the tension `exit` [N]; slack unless both are above 0.
  SheathProfile(double entry, double exit);
  /// Reads `real_count` numbers that has_sound() accepts.
  explicit SheathProfile(std::span<const double> reals);
  void save(std::span<double> reals) const;
  /// Whether `reals` are the numbers of a profile that obeys the law with this exponent.
  [[nodiscard]] static bool is_sound(std::span<const double> reals, double exponent);

  /// ln T at the entry and at the exit; `slack` without tension.
  [[nodiscard]] double entry() const { return count_ > 0 ? nodes_[0].y : slack; }
  [[nodiscard]] double exit() const { return count_ > 0 ? nodes_[count_ - 1].y : slack; }
  [[nodiscard]] std::size_t piece_count() const { return count_ > 0 ? count_ - 1 : 0; }
  [[nodiscard]] double most_tension() const;  ///< [N]
  /// ln T at a place t in [0, 1].
  [[nodiscard]] double at(double t) const;

  /// Limits the profile by a tension at the entry, ln T = `y`, and returns how far rope has slid
  /// there: the front, in [0, 1].
  double limit_from_entry(double y, double exponent);
  /// The same from the exit; the place where rope begins to slide.
  double limit_from_exit(double y, double exponent);
  /// Removes nodes until at most most_pieces pieces are left. Limits add at most two nodes.
  void shorten(const SheathLaw& law);

  /// Stretch of the rope between two places [m].
  [[nodiscard]] double stretch(const SheathLaw& law, double from = 0.0, double to = 1.0) const;
  /// Elastic energy of the rope between two places [J].
  [[nodiscard]] double energy(const SheathLaw& law, double from = 0.0, double to = 1.0) const;
  /// Energy that goes out at the entry while its ln T goes to `y` and the exit keeps its tension [J]:
  /// the integral of (T + T^2 / 2 EA) dM over the unstretched length M that comes in. A span that
  /// gives dM is stretched by (1 + x) dM against T, and loses the elastic energy of dM. The profile
  /// must have a tension.
  [[nodiscard]] double work_at_entry(const SheathLaw& law, double y) const;
  [[nodiscard]] double work_at_exit(const SheathLaw& law, double y) const;

 private:
  struct Node {
    double t = 0.0;
    double y = 0.0;
  };
  [[nodiscard]] double work(const SheathLaw& law, double y, bool at_exit) const;
  template <class Visit>
  void visit_pieces(double from, double to, Visit visit) const;

  std::array<Node, most_pieces + 5> nodes_{};
  std::size_t count_ = 0;
};

/// The part of a rope's stretch in a sheath by which rope slides along one end: the integral of
/// x / (1 + x) over a front of the length `front` from an end with x = `strain`, along which y
/// changes by `rise` per t.
struct FrontStretch {
  double stretch = 0.0;  ///< [m]
  /// Its derivative by the tension at that end, for a front that stays [m/N].
  double slope = 0.0;
};
[[nodiscard]] FrontStretch front_stretch(const SheathLaw& law, double tension, double rise,
                                         double front);

}  // namespace sheave
