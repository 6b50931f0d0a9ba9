#pragma once
// Machines in which no row's gradient turns: wheels on fixed axles, and bodies on sliders.
//
// The matrix of the rows is constant, and Newton's first round is the last one. Its factors hold
// from substep to substep as long as the same rows act. A substep then consists of a residual, two
// triangular sweeps, a check and sums, all in flat arrays. With C0 the value at the start of the
// substep, dq* the motion without constraints, and the rules of engine/solvers/row_system.h, the
// unknowns l of the rows that act satisfy
//
//   r = C0 + s min(C0, 0) + J dq* + (J W J^T + d) l = 0
//
//   rigid:     s = 0,                 d = 0
//   backward:  s = -g / (1 + g),      d = a / (h^2 (1 + g)),   g = a b / h
//   midpoint:  s = (1 - g) / (1 + g), d = 4 a / (h^2 (1 + g)), g = 2 a b / h
//
// and then dq = dq* + W J^T l. In `rattle`, three effects then change the velocities: the second
// half of the loads, the other half of the impulses of springs, and the impulses m of the rigid
// rows, J W J^T m = -J v.
//
// Usually the rows that had a force at the start act. If one of them has no force now, or another
// row has to act (a cable becomes slack, a weight lands), a search finds the active set
// (engine/solvers/affine_problem.h). The substep is accepted only with a solution: the rows that
// act pull, the others stay open, and residuals are of the size of rounding. In all other cases (a
// wheel has wound off all its cable, drives contradict each other) the stages of engine/step.cpp do
// the substep, with the same motion. The choice between the two follows from the state.

#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include "engine/dynamics/affine_bodies.h"
#include "engine/feature_roles.h"
#include "engine/model.h"
#include "engine/solvers/affine_problem.h"
#include "engine/solvers/affine_rows.h"
#include "engine/solvers/affine_terms.h"
#include "engine/solvers/row_system.h"

namespace sheave {

class AffineMotion {
 public:
  /// Null if the model has other bodies or features, or another solver than the direct one.
  /// `bodies` and `features` must outlive the result.
  static std::unique_ptr<AffineMotion> create(const Model& model, const BodySet& bodies,
                                              Features features);

  /// Does substeps `first` to `last` - 1 of a step in order, as many as it can, and returns their
  /// number. `substep` keeps their statistics. If all substeps are done, `before` becomes the state
  /// before the last one. If only some are done and `start` is not null, `start` becomes the state
  /// before the first one.
  int advance(int first, int last, State& state, State& before, Substep& substep, State* start);
  /// Does at most `count` whole steps, with the bits of advance(), and returns their number; 0
  /// unless settings and controls are simple. Afterwards `before` holds only the members that such
  /// a step leaves unchanged and those that the next advance() needs. Statistics are meaningless.
  std::int64_t leap(std::int64_t count, State& state, State& before, Substep& substep);
  /// To be called when anything else has changed the state.
  void forget() { agree_ = false; }

 private:
  /// [s]
  struct Interval {
    double from = 0.0;
    double to = 0.0;
    [[nodiscard]] double middle() const { return 0.5 * (from + to); }
  };
  AffineMotion(const Model& model, const BodySet& bodies, Features features, AffineBodies moving);
  bool append(Features features);
  void find_matrix();
  /// Whether the controls set no cables, motions or joint drives; loads may be set.
  [[nodiscard]] static bool runs_free(const Controls& controls);
  /// Place of a substep in a call. `fresh` and `first`: see AffineSubstep.
  struct Place {
    bool fresh = false;
    bool first = false;
  };
  bool attempt(const Interval& time, Place place, const State& state, State& next,
               Substep& substep);
  bool begin(AffineSubstep& own, const State& state);
  bool finish(AffineSubstep& own, const State& state, State& next, StepStatistics& statistics);
  /// Computes the quantities that are the same in all substeps of this length.
  void prepare(const Substep& substep);
  /// Finds multipliers and motion if the same rows act as before; false if the result is no
  /// solution.
  bool keep_positions();
  /// Likewise after a search for the rows that act.
  bool search_positions();
  /// Moves the bodies by the unknowns; false if the result is no solution.
  bool act_and_check(std::span<const char> acts);
  /// Likewise if all rows act.
  bool act_and_check_all();
  /// The rows' values at the start, as the rules above count them: C0 + s min(C0, 0).
  void find_free_values();
  /// Whether all rows act.
  [[nodiscard]] bool all_act() const {
    return active_.empty() || std::memchr(active_.data(), 0, active_.size()) == nullptr;
  }
  /// Changes the speeds at the end by the impulses of the rows that act, or after a search for
  /// these rows.
  bool solve_velocities();
  /// Marks the rows that an impulse may stop.
  void find_closed();
  /// Whether a spring begins or ceases to press: a force that is not linear in its value.
  [[nodiscard]] bool crosses();
  bool keep_velocities();
  bool search_velocities();
  /// Adds the counts of the last search.
  void count_search(const AffineProblem& problem);
  [[nodiscard]] AffineProblem& velocities() { return elastic_ ? rigid_ : problem_; }
  void keep_forces(Substep& substep) const;
  void count(int substeps, StepStatistics& statistics) const;

  const StepSettings& settings_;
  Features features_;
  std::vector<AffineFeature*> affine_;  ///< per feature
  AffineBodies bodies_;
  AffineRows rows_;
  AffineTerms terms_;
  std::vector<std::size_t>
      feature_rows_;  ///< first row of each feature; rows of the last feature come
                      ///< first
  std::vector<std::size_t> feature_counts_;
  bool rattle_ = false;
  double scale_ = 1.0;
  double h_ = 0.0;
  bool elastic_ = false;                         ///< some rows are springs
  std::vector<char> springs_;                    ///< per row
  std::vector<double> start_shares_, softness_;  ///< s, d
  std::vector<std::pair<int, int>> entries_;     ///< rows that share a number
  std::vector<double> diagonal_;                 ///< of J W J^T
  AffineProblem problem_;
  AffineProblem rigid_;  ///< for the velocities; only if some rows are springs
  bool agree_ = false;   ///< members that affine substeps leave alone are equal in both states
  // Scratch of one substep.
  std::vector<double> values_, free_, unknowns_, multipliers_, impulses_;
  std::vector<double> going_on_;  ///< displacements at the speeds of the start
  std::vector<double> speeds_;    ///< at the end of the substep, before impulses
  std::vector<double> rates_;     ///< J v of speeds_
  std::vector<char> active_;      ///< rows that act
  std::vector<char> found_;       ///< rows that act after a search
  std::vector<char> closed_;      ///< rows that an impulse may stop
  int redundant_ = 0;             ///< rows that the last search for positions has dropped
  int changes_ = 0;               ///< changes of sides in searches
  int factorisations_ = 0;
  double left_ = 0.0;  ///< the largest residual of the rows that act [m]
  std::vector<std::vector<double>>
      first_;  ///< per feature: reals of the state before the first substep
};

}  // namespace sheave
