#pragma once
// Machines in which nothing turns a row's gradient: wheels on fixed axles, and what slides.
//
// There the matrix of the rows is a constant, Newton's first round is the last one, and as long as
// the same rows act its factor serves from substep to substep. What is left of a substep is a
// residual, two triangular sweeps, a check, and sums; all in flat arrays. With C0 the value at the
// start of the substep, dq* the motion without constraints, and the rules of
// engine/solvers/row_system.h, the unknowns l of the rows that act satisfy
//
//   r = p C0 + s min(C0, 0) + J dq* + (J W J^T + d) l = 0
//
//   rigid:     p = 1,           s = 0,                 d = 0
//   backward:  p = 1 / (1 + g), s = 0,                 d = p a / h^2,           g = a b / h
//   midpoint:  p = 1,           s = (1 - g) / (1 + g), d = 4 a / (h^2 (1 + g)), g = 2 a b / h
//
// and then dq = dq* + W J^T l. `rattle` gives the velocities, after the second half of the loads,
// the other half of what springs do and the impulses m of the rigid rows, J W J^T m = -J v.
//
// Such a substep is taken only if its solution is one: the rows that had a force at its start have
// one, the others stay open, none is redundant, and what is left of the equations is rounding.
// Everything else (a cable falls slack, a wheel has wound off all its cable) the stages of
// engine/step.cpp do, which find the same motion. Which of the two it is follows from the state.

#include <memory>
#include <span>
#include <vector>

#include "engine/dynamics/affine_bodies.h"
#include "engine/model.h"
#include "engine/solvers/affine_rows.h"
#include "engine/solvers/row_system.h"
#include "engine/solvers/sparse_factor.h"

namespace sheave {

class AffineMotion {
 public:
  /// Null if bodies or features of the model are not such, or it wants another solver. `bodies` and
  /// `features` must outlive it.
  static std::unique_ptr<AffineMotion> create(const Model& model, const BodySet& bodies,
                                              Features features);

  /// Substeps `first` to before `last` of a step, one after the other, as many as are such: their
  /// number. `substep` keeps their statistics. If these are all, `before` becomes the state before
  /// the last of them; if some are left, `start`, unless it is null or there is none of them,
  /// becomes the state before all of them.
  int advance(int first, int last, State& state, State& before, Substep& substep, State* start);
  /// To be called when a state has come about in another way.
  void forget() { agree_ = false; }

 private:
  AffineMotion(const Model& model, const BodySet& bodies, Features features, AffineBodies moving);
  bool append(Features features);
  void find_matrix();
  /// One substep between these times [s] from `state` to `next`.
  bool attempt(double from, double to, const State& state, State& next, Substep& substep);
  bool begin(const State& state);
  /// What is the same in all substeps of this length.
  void prepare(const Substep& substep);
  /// The factors for the rows that act; false if some are redundant.
  bool factor();
  /// Finds the multipliers and the motion; false if they are no solution.
  bool solve_positions();
  /// Changes the speeds at the end; false if the impulses are no solution.
  bool solve_velocities();
  /// The gradients of all rows, for loops over them.
  struct Terms {
    const int* starts;
    const int* numbers;
    const double* gradients;
    const double* yields;

    /// J x of a row.
    [[nodiscard]] double along(std::size_t row, const double* x) const {
      double sum = 0.0;
      for (int p = starts[row]; p < starts[row + 1]; ++p) sum += gradients[p] * x[numbers[p]];
      return sum;
    }
    /// x += W J^T multiplier.
    void act(std::size_t row, double multiplier, double* x) const {
      for (int p = starts[row]; p < starts[row + 1]; ++p) {
        x[numbers[p]] += yields[numbers[p]] * gradients[p] * multiplier;
      }
    }
  };
  [[nodiscard]] Terms terms() const {
    return {rows_.starts().data(), rows_.numbers().data(), rows_.gradients().data(),
            bodies_.yields().data()};
  }
  void keep_forces(Substep& substep) const;
  void count(int substeps, StepStatistics& statistics) const;

  const StepSettings& settings_;
  Features features_;
  AffineBodies bodies_;
  AffineRows rows_;
  std::vector<std::size_t> feature_rows_;  ///< first row of each feature, and their number
  bool rattle_ = false;
  double scale_ = 1.0;
  double h_ = 0.0;
  bool elastic_ = false;                                  ///< some rows are springs
  std::vector<char> springs_;                             ///< per row
  std::vector<double> shares_, start_shares_, softness_;  ///< p, s, d
  std::vector<std::pair<int, int>> entries_;              ///< rows that share a number
  std::vector<double> couplings_;                         ///< J W J^T there
  std::vector<double> diagonal_;
  SparseFactor factor_;
  SparseFactor rigid_factor_;       ///< of the velocities; only where some rows are springs
  std::vector<char> factored_for_;  ///< rows that act
  bool regular_ = false;
  bool agree_ = false;  ///< all that affine substeps leave alone is the same in both states
  // Of one substep.
  std::vector<double> values_, free_, unknowns_, multipliers_, impulses_;
  std::vector<char> active_;
  double left_ = 0.0;                       ///< the largest residual of the rows that act [m]
  std::vector<std::vector<double>> first_;  ///< per feature, of the state before all
};

}  // namespace sheave
