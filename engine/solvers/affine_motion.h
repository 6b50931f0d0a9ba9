#pragma once
// Machines in which nothing turns a row's gradient: wheels on fixed axles, and what slides.
//
// There the matrix of the rows is a constant, Newton's first round is the last one, and as long as
// the same rows act its factor serves from substep to substep. What is left of a substep is a
// residual, two triangular sweeps, a check, and sums; all in flat arrays. With C0 the value at the
// start of the substep, dq* the motion without constraints, and the rules of
// engine/solvers/row_system.h, the unknowns l of the rows that act satisfy
//
//   r = C0 + s min(C0, 0) + J dq* + (J W J^T + d) l = 0
//
//   rigid:     s = 0,                 d = 0
//   backward:  s = -g / (1 + g),      d = a / (h^2 (1 + g)),   g = a b / h
//   midpoint:  s = (1 - g) / (1 + g), d = 4 a / (h^2 (1 + g)), g = 2 a b / h
//
// and then dq = dq* + W J^T l. `rattle` gives the velocities, after the second half of the loads,
// the other half of what springs do and the impulses m of the rigid rows, J W J^T m = -J v.
//
// Mostly the rows act that had a force at the start. If these have none now, or others have to
// (a cable falls slack, a weight lands), a search finds which ones do (engine/solvers/
// affine_problem.h). Such a substep is taken only if its solution is one: the rows that act pull, the
// others stay open, and what is left of the equations is rounding. Everything else (a wheel has
// wound off all its cable, drives contradict each other) the stages of engine/step.cpp do, which
// find the same motion. Which of the two it is follows from the state.

#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include "engine/dynamics/affine_bodies.h"
#include "engine/model.h"
#include "engine/solvers/affine_problem.h"
#include "engine/solvers/affine_rows.h"
#include "engine/solvers/affine_terms.h"
#include "engine/solvers/row_system.h"

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
  /// At most `count` whole steps, bit for bit those that advance() makes, as long as they are such,
  /// if settings and controls are simple: their number. Of `before`, only what no such step changes
  /// and what the next advance() needs is right afterwards; statistics mean nothing.
  std::int64_t leap(std::int64_t count, State& state, State& before, Substep& substep);
  /// To be called when a state has come about in another way.
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
  /// Whether nothing is set but loads.
  [[nodiscard]] static bool runs_free(const Controls& controls);
  /// One substep between these times [s] from `state` to `next`.
  /// `fresh` and `first`: see AffineSubstep.
  struct Place {
    bool fresh = false;
    bool first = false;
  };
  bool attempt(const Interval& time, Place place, const State& state, State& next,
               Substep& substep);
  bool begin(AffineSubstep& own, const State& state);
  bool finish(AffineSubstep& own, const State& state, State& next, StepStatistics& statistics);
  /// What is the same in all substeps of this length.
  void prepare(const Substep& substep);
  /// The multipliers and the motion, if the rows act that have acted before; false if these are
  /// no solution.
  bool keep_positions();
  /// The same with the rows that have to act.
  bool search_positions();
  /// Moves the bodies by the unknowns; false if these are no solution.
  bool act_and_check(std::span<const char> acts);
  /// The same if all rows act.
  bool act_and_check_all();
  /// Where the rows' values at the start count by the rules above: p C0 + s min(C0, 0).
  void find_free_values();
  /// Whether all rows act that had a force.
  [[nodiscard]] bool all_act() const {
    return active_.empty() || std::memchr(active_.data(), 0, active_.size()) == nullptr;
  }
  /// Changes the speeds at the end by the impulses of the rows that act, or that have to.
  bool solve_velocities();
  /// Rows that an impulse may stop.
  void find_closed();
  bool keep_velocities();
  bool search_velocities();
  /// What the last search did.
  void count_search(const AffineProblem& problem);
  [[nodiscard]] AffineProblem& velocities() { return elastic_ ? rigid_ : problem_; }
  void keep_forces(Substep& substep) const;
  void count(int substeps, StepStatistics& statistics) const;

  const StepSettings& settings_;
  Features features_;
  AffineBodies bodies_;
  AffineRows rows_;
  AffineTerms terms_;
  std::vector<std::size_t> feature_rows_;  ///< first row of each feature, of which the last comes
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
  AffineProblem rigid_;  ///< of the velocities; only where some rows are springs
  bool agree_ = false;   ///< all that affine substeps leave alone is the same in both states
  // Of one substep.
  std::vector<double> values_, free_, unknowns_, multipliers_, impulses_;
  std::vector<double> going_on_;  ///< displacements as they are at the speeds of the start
  std::vector<double> speeds_;    ///< at the end, before impulses
  std::vector<double> rates_;     ///< J v of these
  std::vector<char> active_;      ///< rows that act
  std::vector<char> found_;       ///< the same after a search
  std::vector<char> closed_;      ///< rows that an impulse may stop
  int redundant_ = 0;             ///< rows that the last search for positions left out
  int changes_ = 0;               ///< of searches
  int factorisations_ = 0;
  double left_ = 0.0;                       ///< the largest residual of the rows that act [m]
  std::vector<std::vector<double>> first_;  ///< per feature, of the state before all
};

}  // namespace sheave
