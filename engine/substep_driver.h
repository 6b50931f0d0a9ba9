#pragma once
// Substeps one after the other; one that does not converge is done again in smaller parts.
//
// A solver gives up (Substep::failed) where its rounds do not come near a solution: what they leave
// would become velocity, and energy, in the next substep. In half the time bodies swing half as
// far, so the same rounds converge quadratically better. The halves are done in turn, each of them
// as a whole first. Nothing carries over from one substep to the next, so a run depends on its
// state alone.
//
// Where a part does not converge, however short it is, time is not what is wrong (drives that
// contradict each other), and where parts have taken so many rounds there is no end to them: the
// substep starts again and is done as a whole, by the other integrator if that converges, or else
// with what the solvers make of it, and is counted.

#include <cstdint>
#include <optional>
#include <span>

#include "engine/divergence.h"
#include "engine/model.h"
#include "engine/solvers/affine_motion.h"
#include "engine/step.h"

namespace sheave {

class SubstepDriver {
 public:
  /// The most equal parts that a substep is done in. Depth costs little, for only what does not
  /// converge is cut, and velocities of so short a part are still rounded by no more than 1e-9 of a
  /// scene size per second.
  static constexpr std::int64_t most_parts = 262144;
  /// Rounds in which a part converges, or else is cut: Newton's method needs far fewer where it
  /// works.
  static constexpr int rounds_of_part = 16;
  /// When so many rounds have been spent on a substep and its parts it is given up. The hardest of
  /// tests/physics/light_cart_test.cpp takes less than 300.
  static constexpr std::int64_t most_rounds = 512;
  /// Likewise factorisations, of which a round takes one for each set of rows that it tries,
  /// besides one per iteration that the settings allow, and those for each of the two last attempts
  /// at the whole.
  static constexpr std::int64_t most_factorisations = 4096;
  static constexpr std::int64_t last_factorisations = 2048;
  /// Of so many rows; of more rows, of which each factorisation takes as much longer, so many times
  /// fewer, down to a share. What can be found mostly is within ten.
  static constexpr std::int64_t rows_of_factorisation = 64;
  static constexpr std::int64_t fewest_share = 16;
  /// So many of the smallest parts may be left to another integrator before larger ones are, too:
  /// it is no matter of time then.
  static constexpr int patience = 4;

  /// `features` and `stages` are those of the model that `substep` is of, and `state` is what it
  /// starts from. All must outlive the driver.
  SubstepDriver(const Model& model, std::span<const std::unique_ptr<ConstraintBatch>> features,
                std::span<const Stage> stages, Substep& substep, State& state);

  /// Advances the state by the substeps of the step from `index` to before `end` that need none of
  /// the stages (engine/solvers/affine_motion.h), and returns their number. If these are not all,
  /// `start`, unless it is null, becomes the state before them; it must be the same one each time,
  /// and nobody else may change it unless by the whole state.
  int run_affine(int index, int end, State* start);
  /// AffineMotion::leap(); there is no before() then until the next substep.
  std::int64_t leap(std::int64_t count);
  /// Advances the state by substep `index` of the step. If it diverges the state is the last good
  /// one.
  std::optional<Divergence> run(int index);
  /// The state at the start of the last substep, or of its last part; null if there is none.
  [[nodiscard]] const State* before() const { return has_stepped_ ? &before_ : nullptr; }
  /// To be called when the state has been changed by somebody else.
  void forget();
  /// Exchanges what the state and the one before it are kept in, numbers and all, so that bodies
  /// and the numbers of the last feature are at these addresses, if they are among the two.
  void put_in_place(const BodyState* bodies, const double* reals);
  /// To be called when the state's controls have been changed.
  void note_controls() { controls_changed_ = start_lacks_controls_ = true; }

 private:
  /// One of `count` equal parts of the step; counts are the number of substeps times a power of
  /// two, so that the ends of parts, which come from these counters and not from a running sum,
  /// agree to the last bit.
  struct Part {
    std::int64_t index = 0;
    std::int64_t count = 1;
    [[nodiscard]] Part first_half() const { return {2 * index, 2 * count}; }
    [[nodiscard]] Part second_half() const { return {2 * index + 1, 2 * count}; }
  };
  /// All stages; false if a solver gave up, the result is no state, or the caller wants no more of
  /// it, and then nothing has changed.
  bool attempt(Part part, Resort resort);
  /// A substep that does not converge as a whole.
  void cut(Part whole);
  /// What is left where parts do not converge, either.
  void make_do(Part whole);
  void go_back(const StepStatistics& before);
  void allow_work(std::int64_t factorisations);
  /// About how many rows the state that a substep begins with has.
  [[nodiscard]] std::int64_t row_count() const;
  [[nodiscard]] bool out_of_work() const;
  /// A part half by half; false where it does not converge, and then what has been done of it is
  /// void.
  bool advance_in_halves(Part part);
  bool advance_half(Part part);
  void keep();
  void keep_start(State& start);
  /// Whether there is nothing more to be tried.
  [[nodiscard]] bool over() const { return divergence_ || substep_.work.stopped(); }
  /// Whether another integrator can stand in.
  [[nodiscard]] bool others() const;

  const StepSettings& settings_;
  std::span<const std::unique_ptr<ConstraintBatch>> features_;
  std::span<const Stage> stages_;
  Substep& substep_;
  State& state_;
  State before_;
  std::unique_ptr<AffineMotion> affine_;  ///< null: there are no such substeps
  bool next_is_old_ = false;              ///< substep_.next is not what a stage builds on
  State start_;                           ///< of a substep that is cut
  bool has_stepped_ = false;
  bool controls_changed_ = false;     ///< since before_ has had them
  bool start_lacks_controls_ = true;  ///< nor has the `start` of run_affine()
  std::optional<Divergence> divergence_;
  int left_to_others_ = 0;          ///< parts of this substep that another integrator has done
  std::int64_t parts_ = 0;          ///< of this substep that are done
  std::int64_t rounds_before_ = 0;  ///< of the step before this substep
};

}  // namespace sheave
