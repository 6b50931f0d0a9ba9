#pragma once
// Runs substeps one after the other, and repeats a substep that does not converge in smaller parts.
//
// A solver gives up (Substep::failed) if its rounds do not approach a solution: the residual would
// become velocity, and so energy, in the next substep. In half the time bodies move half as far, so
// the same number of rounds converges quadratically better. The driver does both halves in turn,
// each first as a whole. No hidden data goes from one substep to the next, so a run depends on its
// state alone.
//
// If even the shortest part does not converge, its length is not the cause (drives that contradict
// each other). If the parts use up their rounds, cutting has no end. In both cases the substep
// starts again and is done as a whole: by the other integrator if that converges, else with the
// solvers' best result, which is counted in the statistics.

#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "engine/divergence.h"
#include "engine/feature_roles.h"
#include "engine/model.h"
#include "engine/solvers/affine_motion.h"
#include "engine/step.h"

namespace sheave {

class SubstepDriver {
 public:
  /// The largest number of equal parts of a substep. Only parts that do not converge are cut, so
  /// depth costs little. In so short a part, rounding changes velocities by at most 1e-9 of the
  /// scene's size per second.
  static constexpr std::int64_t most_parts = 262144;
  /// Most rounds of a part before it is cut. Newton's method needs far fewer where it converges.
  static constexpr int rounds_of_part = 16;
  /// Most rounds of a substep and its parts; beyond them the driver gives the parts up. The hardest
  /// case of tests/physics/light_cart_test.cpp takes less than 300.
  static constexpr std::int64_t most_rounds = 512;
  /// Most factorisations of a substep and its parts, besides one per iteration that the settings
  /// allow. A round takes one factorisation per active set that it tries. Each of the last two
  /// attempts at the whole substep may take `last_factorisations`.
  static constexpr std::int64_t most_factorisations = 4096;
  static constexpr std::int64_t last_factorisations = 2048;
  /// The limits hold for so many rows. For n times as many rows a factorisation takes n times
  /// longer, and the limits are n times smaller, down to 1/fewest_share. Most solutions are found
  /// within ten.
  static constexpr std::int64_t rows_of_factorisation = 64;
  static constexpr std::int64_t fewest_share = 16;
  /// Most smallest parts that are left to the other integrator. After these, larger parts are left
  /// to it, too: shorter parts do not help then.
  static constexpr int patience = 4;

  /// `features` and `stages` are those of the model of `substep`, and `state` is the state at its
  /// start. All arguments must outlive the driver.
  SubstepDriver(const Model& model, std::span<const std::unique_ptr<ConstraintBatch>> features,
                std::span<const Stage> stages, Substep& substep, State& state);

  /// Advances the state by the substeps of the step, from `index` to before `end`, that need no
  /// stages (engine/solvers/affine_motion.h), and returns their number. If other substeps follow
  /// and `start` is not null, `start` becomes the state before them. `start` must be the same
  /// object in all calls, and other code may only replace it as a whole.
  int run_affine(int index, int end, State* start);
  /// AffineMotion::leap(). before() is null until the next substep.
  std::int64_t leap(std::int64_t count);
  /// Advances the state by substep `index` of the step. After a divergence the state is the last
  /// good one.
  std::optional<Divergence> run(int index);
  /// The same for part `index` of `count` equal parts of the step; `count`: a power of two.
  std::optional<Divergence> run_part(std::int64_t index, std::int64_t count);
  /// The same up to the time `end` [s], wherever in a step that is.
  std::optional<Divergence> run_to(double end);
  /// Whether the last run() has done its substep in parts.
  [[nodiscard]] bool was_cut() const { return was_cut_; }
  /// When substep `index` of the step ends [s].
  [[nodiscard]] double end_of_substep(int index) const;
  /// The state in which the last run() or run_to() has begun, or that of the substep that
  /// run_affine() has done if it has done one.
  [[nodiscard]] const State& start_of_run() const { return was_cut_ ? start_ : before_; }
  /// The state and the statistics are again those of a run's start, but for controls and memory,
  /// and but for the work; features have returned to the mark.
  void go_back(const State& start, const StepStatistics& before, NoteMark mark);
  /// The state at the start of the last substep, or of its last part; null if there is none.
  [[nodiscard]] const State* before() const { return has_stepped_ ? &before_ : nullptr; }
  /// Must be called after other code has changed the state.
  void forget();
  /// Exchanges the memory of the state and of the state before, with their contents, so that bodies
  /// and the numbers of the last feature are at these addresses. Does nothing for an address that
  /// belongs to neither.
  void put_in_place(const BodyState* bodies, const double* reals);
  /// To be called when a feature's state has been changed between substeps.
  void note_features();
  /// To be called when the state's controls have been changed.
  void note_controls() { controls_changed_ = start_lacks_controls_ = true; }
  /// Calls `set`, and tells whether it has changed controls.
  template <class Set>
  bool sets_controls(const Set& set) {
    const bool before = std::exchange(controls_changed_, false);
    set();
    const bool changed = controls_changed_;
    controls_changed_ = changed || before;
    return changed;
  }

 private:
  /// One of `count` equal parts of the step, or of the stretch; counts are the number of substeps
  /// times a power of two, or a power of two, so that the ends of parts, which come from these counters and not
  /// from a running sum, agree to the last bit.
  struct Part {
    std::int64_t index = 0;
    std::int64_t count = 1;
    bool of_stretch = false;
    [[nodiscard]] Part first_half() const { return {2 * index, 2 * count, of_stretch}; }
    [[nodiscard]] Part second_half() const { return {2 * index + 1, 2 * count, of_stretch}; }
  };
  /// The interval of run_to() [s].
  struct Stretch {
    double from = 0.0;
    double to = 0.0;
  };
  std::optional<Divergence> run(Part whole);
  [[nodiscard]] double length_of(Part part) const;
  [[nodiscard]] double end_of(Part part) const;
  /// All stages; false if a solver gave up, the result is no state, or the caller wants no more of
  /// it, and then nothing has changed.
  bool attempt(Part part, Resort resort);
  /// Does a substep that does not converge as a whole, in parts.
  void cut(Part whole);
  /// Does the substep as a whole after its parts have not converged.
  void make_do(Part whole);
  void allow_work(std::int64_t factorisations);
  /// The approximate number of rows in the state at the start of a substep.
  [[nodiscard]] std::int64_t row_count() const;
  [[nodiscard]] bool out_of_work() const;
  /// Does a part in halves; false if they do not converge, and the motion done so far is then void.
  bool advance_in_halves(Part part);
  bool advance_half(Part part);
  void keep();
  void keep_start(State& start);
  /// Whether the step ends here.
  [[nodiscard]] bool over() const { return divergence_ || substep_.work.stopped(); }
  /// Whether another integrator can do the substep.
  [[nodiscard]] bool others() const;

  const StepSettings& settings_;
  std::span<const std::unique_ptr<ConstraintBatch>> features_;
  std::vector<NotedFeature*> noted_;
  std::span<const Stage> stages_;
  Substep& substep_;
  State& state_;
  State before_;
  std::unique_ptr<AffineMotion> affine_;  ///< null: there are no such substeps
  bool next_is_old_ = false;              ///< substep_.next is not one on which stages can build
  Stretch stretch_;
  State start_;           ///< of a substep that is cut
  bool was_cut_ = false;  ///< the last one is
  bool has_stepped_ = false;
  bool controls_changed_ = false;  ///< whether controls have changed since before_ was copied
  /// Whether they have changed since the `start` of run_affine() was
  bool start_lacks_controls_ = true;
  std::optional<Divergence> divergence_;
  int left_to_others_ = 0;          ///< parts of this substep that the other integrator has done
  std::int64_t parts_ = 0;          ///< parts of this substep that are done
  std::int64_t fewest_ = 1;         ///< Part::count of this substep as a whole
  std::int64_t rounds_before_ = 0;  ///< rounds of the step before this substep
};

}  // namespace sheave
