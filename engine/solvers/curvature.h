#pragma once
// How forces turn while bodies move: the second derivatives of rows, times their multipliers.
//
// A row that acts with the force n at the arm r from a body's centre has the gradient (n, r x n).
// If the body turns by th, so does the arm, and if the row is a span of length L between points
// that move by v1 and v2, its direction u turns, too:
//
//   d(r x n) = (th x r) x n + r x dn,   dn = +- du,   du = (1 - u u^T) (v2 - v1) / L,   v = d + th x r.
//
// r follows from the gradient but for its part along n, r . n, which rows tell (RowTerm::reach), as
// they tell 1 / L (Row::turning); a row that tells nothing counts as straight. In one plane this is
// exact for wheels as well: the point where the span leaves a wheel slides over it, but only by
// what is along u. There u turns about the plane's normal alone: with the gradient G of what the
// ends move across u, and w = -G dx / L, all that J changes by is w G, and -(r . n) th in the turns.
//
// dx . dJ / 2 is the second-order term of the row's value.

#include <span>
#include <vector>

#include "engine/dynamics/coordinates.h"
#include "engine/row_list.h"

namespace sheave {

class Curvature {
 public:
  /// Takes up these rows but for those that are copies, which are straight, or have nothing that
  /// could turn them. Returns whether any is left.
  bool collect(const RowList& rows, const Coordinates& coordinates,
               std::span<const MovingBody> bodies);
  /// How the gradients of the rows turn with `motion`, which is along degrees of freedom: the
  /// motion that `multipliers` (per row) make of that into `bent`, which has to be 0, and the
  /// second-order term of each row's value into `second_order`. False where a span turns so far
  /// that its derivatives tell little.
  bool turn(const Coordinates& coordinates, std::span<const MovingBody> bodies,
            std::span<const double> multipliers, std::span<const double> motion,
            std::span<double> bent, std::span<double> second_order);
  /// Which rows have been taken up.
  [[nodiscard]] std::span<const int> rows() const { return numbers_; }
  /// The largest of these, which are per row.
  [[nodiscard]] double largest(std::span<const double> values) const;

 private:
  /// Force of a unit multiplier.
  struct Force {
    int body = 0;
    bool has_arm = false;  ///< and the body may turn
    double sign = 0.0;     ///< along the row's direction
    Vector3 arm = Vector3::Zero();
    Vector3 force = Vector3::Zero();
  };
  /// In a plane, along one degree of freedom.
  struct Part {
    int dof = 0;
    double across = 0.0;  ///< G
    double reach = 0.0;   ///< r . n, of a turn
    double yield = 0.0;   ///< inverse mass
  };
  struct CurvedRow {
    int first = 0;  ///< of its forces, or parts
    int last = 0;
    double turning = 0.0;
    bool planar = false;
    Vector3 direction = Vector3::Zero();
  };
  struct Motion {
    Vector3 linear = Vector3::Zero();
    Vector3 angular = Vector3::Zero();
  };
  /// Takes up what the row does to its bodies if they and it keep to one plane; false if not.
  bool add_parts(const Row& row, const Coordinates& coordinates, std::span<const MovingBody> bodies,
                 CurvedRow& curved);
  /// `sign`: of the force along the row's direction, as Force::sign.
  void add_part(const RowTerm& term, const BodyFreedom& freedom, const MovingBody& body,
                const Vector3& normal, const CurvedRow& row, double sign);
  /// Takes up what the row does to a body, unless that stays as it is however the body moves.
  void add_force(const RowTerm& term, const BodyFreedom& freedom, const MovingBody& body,
                 const CurvedRow& row);

  /// turn() of one row; false as there.
  bool turn_in_plane(const CurvedRow& row, double multiplier, std::span<const double> motion,
                     std::span<double> bent, double& second_order) const;
  bool turn_in_space(const CurvedRow& row, double multiplier, double& second_order);

  std::vector<int> numbers_;  ///< of the rows
  std::vector<CurvedRow> rows_;
  std::vector<Part> parts_;
  std::vector<Force> forces_;
  std::vector<Motion> motions_;   ///< per body
  std::vector<Motion> wrenches_;  ///< per body
};

}  // namespace sheave
