#pragma once
// The tension along a rope that lies on a level floor with friction; internal to the cable library.
//
// The rope lies straight from an anchor, which does not move, to the touch-down. A place s is the
// unstretched length from the anchor to it, so it moves with the rope. Coulomb friction holds the rope
// at a place as long as
//
//   |dT / ds| <= k,   k = mu w,
//
// with the weight w per unstretched length. Rope that slides away from the anchor has the slope k, rope
// that slides towards it -k.
//
// A new tension H at the touch-down s1 lets rope slide from there inwards, as far as the old tension
// contradicts the law:
//
//   T(s) = T_old(s), limited to H +- k (s1 - s).
//
// Between the anchor and this front the rope sticks and keeps its strain: an operator of play, as in a
// sheath (cable/sheath_profile.h), with one end. Rope that has been lifted off forgets its tension. Rope
// that has come down beyond the old touch-down s0 was laid with tensions between the old one at the
// touch-down and H. T_old is the straight line between them there, and the limit holds for it too.
//
// The rope on the floor is stretched by J / EA, with J the integral of T over s. The derivatives of J
// are the length that slides (by H), and the tension at the front (by s1).
//
// A rope that has been lifted off whole has no length on the floor. Its s1 is below 0: minus the length whose
// weight the anchor bears. The line from there to the new touch-down has the tension with which the rope
// lands at the anchor.
//
// A place moves by the integral of (T - T_old) / EA from the anchor on. Friction takes k times this way,
// integrated over the rope that slides. Rope that is lifted or laid on the way slides for half of it in
// the mean.

#include <array>
#include <cstddef>
#include <span>

namespace sheave {

/// The tension along the rope, from the anchor at s = 0 to the touch-down.
class FloorProfile {
 public:
  /// Largest number of pieces. Beyond it one node replaces the two that are nearest to a straight line.
  static constexpr std::size_t most_pieces = 48;
  /// Number of saved numbers: the number of nodes, and s and T of each.
  static constexpr std::size_t real_count = 1 + 2 * (most_pieces + 1);

  /// Rope of this length [m], >= 0, with the same tension everywhere [N], >= 0.
  explicit FloorProfile(double length = 0.0, double tension = 0.0);
  /// Reads `real_count` numbers that is_sound() accepts.
  explicit FloorProfile(std::span<const double> reals);
  void save(std::span<double> reals) const;
  /// Whether `reals` are the numbers of a profile.
  [[nodiscard]] static bool is_sound(std::span<const double> reals);

  /// s0 [m]; below 0: no rope lies.
  [[nodiscard]] double length() const { return nodes_[count_ - 1].s; }
  [[nodiscard]] double touch_tension() const { return nodes_[count_ - 1].t; }  ///< [N]
  [[nodiscard]] double anchor_tension() const { return nodes_[0].t; }          ///< [N]
  [[nodiscard]] std::size_t piece_count() const { return count_ - 1; }
  /// s [m] and T [N] at the anchor (i = 0) and at the far end of each piece.
  [[nodiscard]] std::array<double, 2> node(std::size_t i) const {
    return {nodes_[i].s, nodes_[i].t};
  }
  [[nodiscard]] double at(double s) const;  ///< T at a place in [0, s0] [N]
  [[nodiscard]] double sum() const;         ///< J [N m]
  [[nodiscard]] double square() const;      ///< integral of T^2 over s [N2 m]

  /// J of the profile after limit(), with its derivatives.
  struct Sum {
    double sum = 0.0;         ///< J [N m]
    double by_tension = 0.0;  ///< of J by H, >= 0 [m]
    double by_length = 0.0;   ///< of J by s1, >= 0 [N]
  };
  [[nodiscard]] Sum limited_sum(double length, double tension, double slope) const;

  /// Makes this the profile with the tension `tension` [N], >= 0, at the touch-down `length` [m],
  /// under the slope k [N/m]. Returns the energy that friction takes, times EA [N2 m].
  double limit(double length, double tension, double slope);

 private:
  struct Node {
    double s = 0.0;
    double t = 0.0;
  };
  /// The place from which on rope slides.
  struct Front {
    std::size_t kept = 0;  ///< number of old nodes before it
    Node at;
    bool laid = false;  ///< no rope slides, and the place is the new touch-down
    double rise = 0.0;  ///< slope of T from the place to the touch-down [N/m]
  };
  [[nodiscard]] Front front(double length, double tension, double slope) const;
  /// Of a rope that lands: the profile at the instant at which it touches the floor.
  [[nodiscard]] FloorProfile at_landing(double length, double tension) const;
  [[nodiscard]] FloorProfile without_limit(double length, double tension) const;
  void put(Node node) { nodes_[count_++] = node; }
  void shorten(double slope);

  // Two more than the most: the front and the touch-down.
  std::array<Node, most_pieces + 4> nodes_{};
  std::size_t count_ = 0;
};

/// The friction of a floor under a span.
struct FloorGrip {
  const FloorProfile* profile = nullptr;  ///< nullptr: there is no friction
  double slope = 0.0;                     ///< k [N/m]
  bool at_end = false;                    ///< the anchor is the end of the span, else its start
};

}  // namespace sheave
