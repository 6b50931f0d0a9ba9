#pragma once
// Geometric stiffness: how forces turn with the bodies, from the second derivatives of rows times
// their multipliers.
//
// A row with the force n at the arm r from a body's centre has the gradient (n, r x n). If the body
// turns by th, the arm turns, too. If the row is a span of length L between points that move by v1
// and v2, its direction u also turns:
//
//   d(r x n) = (th x r) x n + r x dn,   dn = +- du,   du = (1 - u u^T) (v2 - v1) / L,   v = d + th x r.
//
// The gradient determines r except for its component along n. Rows supply this component as r . n
// (RowTerm::reach), and 1 / L (Row::turning); a row without these values counts as straight. In one
// plane the formulas are exact for wheels as well: the point where the span leaves a wheel slides
// over the wheel, but only along u. In a plane u turns about the plane's normal alone. With the
// gradient G of the motion of the ends across u, and w = -G dx / L, the change of J is w G, and -(r
// . n) th in the rotations.
//
// dx . dJ / 2 is the second-order term of the row's value.

#include <span>
#include <vector>

#include "engine/dynamics/coordinates.h"
#include "engine/row_list.h"

namespace sheave {

class Curvature {
 public:
  /// Collects the rows that can turn. Copies (which are straight) and rows that no motion turns are
  /// left out. Returns whether any row is left.
  bool collect(const RowList& rows, const Coordinates& coordinates,
               std::span<const MovingBody> bodies);
  /// Turns the gradients of the rows with `motion`, which is along degrees of freedom. Adds the
  /// motion that `multipliers` (per row) cause along the changes of the gradients to `bent`, which
  /// must be 0, and writes the second-order term of each row's value to `second_order`. False if a
  /// span turns too far for its derivatives to hold.
  bool turn(const Coordinates& coordinates, std::span<const MovingBody> bodies,
            std::span<const double> multipliers, std::span<const double> motion,
            std::span<double> bent, std::span<double> second_order);
  /// After turn(): the largest turn of a row or a body [rad], and the largest second-order term of
  /// a row with all its parts positive. The terms that turn() leaves out are smaller than the turned
  /// ones by the factor of the turn.
  [[nodiscard]] double largest_turn() const { return largest_turn_; }
  [[nodiscard]] double largest_part() const { return largest_part_; }
  /// Indices of the collected rows.
  [[nodiscard]] std::span<const int> rows() const { return numbers_; }
  /// Largest magnitude among the collected rows; `values` are per row.
  [[nodiscard]] double largest(std::span<const double> values) const;

 private:
  /// Force of a unit multiplier.
  struct Force {
    int body = 0;
    bool has_arm = false;  ///< the force has an arm, and the body may turn
    double sign = 0.0;     ///< along the row's direction
    Vector3 arm = Vector3::Zero();
    Vector3 force = Vector3::Zero();
  };
  /// A rotation of a row in a plane whose direction is constant.
  struct Arm {
    int row = 0;  ///< index of the row
    int dof = 0;
    double reach = 0.0;  ///< r . n
    double yield = 0.0;  ///< inverse moment of inertia
  };
  /// A degree of freedom of a row in a plane whose direction turns.
  struct Part {
    int dof = 0;
    double across = 0.0;  ///< G
    double reach = 0.0;   ///< r . n, if the degree of freedom is a rotation
    double yield = 0.0;   ///< inverse mass
  };
  struct CurvedRow {
    int row = 0;    ///< index of the row
    int first = 0;  ///< first of the row's forces_, or of its parts_
    int last = 0;
    double turning = 0.0;
    Vector3 direction = Vector3::Zero();
  };
  struct Motion {
    Vector3 linear = Vector3::Zero();
    Vector3 angular = Vector3::Zero();
  };
  /// Adds the arms or the parts of a row whose bodies all keep to one plane that contains it; false
  /// if they do not.
  bool add_in_plane(const Row& row, const Coordinates& coordinates,
                    std::span<const MovingBody> bodies, CurvedRow& curved);
  /// `sign`: sign of the force along the row's direction, as Force::sign. `across`: the direction
  /// turned by a right angle about `normal`.
  void add_parts(const RowTerm& term, const BodyFreedom& freedom, const MovingBody& body,
                 const Vector3& normal, const Vector3& across, double sign);
  /// Adds the force of the row on a body, unless no motion of the body changes the force.
  void add_force(const RowTerm& term, const BodyFreedom& freedom, const MovingBody& body,
                 const CurvedRow& row);
  /// turn() of the arms, and of one row; false in the same case.
  void turn_arms(std::span<const double> multipliers, std::span<const double> motion,
                 std::span<double> bent, std::span<double> second_order);
  bool turn_in_plane(const CurvedRow& row, double multiplier, std::span<const double> motion,
                     std::span<double> bent, double& second_order);
  bool turn_in_space(const CurvedRow& row, double multiplier, double& second_order);

  double largest_turn_ = 0.0;
  double largest_part_ = 0.0;
  std::vector<int> numbers_;  ///< indices of the collected rows
  std::vector<Arm> arms_;
  std::vector<CurvedRow> planar_;
  std::vector<Part> parts_;
  std::vector<CurvedRow> spatial_;
  std::vector<Force> forces_;
  std::vector<Motion> motions_;   ///< per body
  std::vector<Motion> wrenches_;  ///< per body
};

}  // namespace sheave
