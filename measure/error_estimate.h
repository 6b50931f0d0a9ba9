#pragma once
// What the step alone makes a run wrong by: the run beside itself with half and with a quarter of
// its substep.
//
// No balance of forces or of energy can see that: a step may obey its own rule to the last digit,
// and the rule be that of a motion a little different. Comparing with finer steps shows it, and
// nothing else: what the model leaves out, and what all three runs do alike, it does not. The three
// go side by side, frame by frame, so that a long run needs no more memory than a short one.
//
//   auto estimator = *ErrorEstimator::create(scene, simulation.world.state());
//   while (simulation.step().ok() && ...) estimator.observe(simulation);
//   const ErrorEstimate estimate = estimator.estimate();

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "measure/event_watch.h"
#include "measure/step_difference.h"
#include "measure/trajectory.h"

namespace sheave::measure {

/// What the differences of positions, or of tensions, are ruled by.
enum class StepErrorKind {
  /// There are none but for rounding and the solver's tolerance: below 1e-9 of their scale
  rounding,
  regular,  ///< the step: they have an order
  /// No order, and things happened at moments that depend on the step: contacts, slack, links left,
  /// breaks; or sudden ones may have moved more than the differences show (StepDifference::unseen)
  events,
  chaos,   ///< no order, no events, and differences that grow exponentially
  sweeps,  ///< no order, and Gauss-Seidel sweeps, of which half the step has twice as many
  coarse,  ///< no order for none of these reasons: the step is too long for one to show
};
inline constexpr std::array<std::string_view, 6> step_error_kind_names{
    "rounding", "regular", "events", "chaos", "sweeps", "coarse"};

/// The scene's size, below: the larger of BodySet::scale(), the diagonal of the box round its
/// bodies, and of the box round the ends of its spans, both at the start.
struct BodyDifference {
  std::string name;
  StepDifference position;  ///< of the body frame's origin [m]; scale: the size of the scene
  /// [rad]; scale: the turn that moves the surface by the size of the scene. A body without a
  /// shape: 1 rad.
  StepDifference turn;
};

struct SpanDifference {
  std::string name;  ///< "<cable>.<span>"
  /// [N]; scale: the largest root of the mean square over time of all spans of its cable and all
  /// three runs.
  StepDifference tension;
};

struct ErrorEstimate {
  std::array<int, 3> substeps{};  ///< of the run, and of those beside it
  double end = 0.0;               ///< of what was compared [s]
  /// Root of the mean square over all bodies of their displacements, turns at their surface
  /// included, as in measure/run_error.h [m]; scale: the size of the scene.
  StepDifference position{};
  StepErrorKind position_kind = StepErrorKind::rounding;
  /// Root of the mean square over all spans [N]; scale: the root of the mean square of all spans
  /// and frames.
  StepDifference tension{};
  StepErrorKind tension_kind = StepErrorKind::rounding;
  double motion =
      0.0;  ///< how far the bodies of the run get from where they started, the same measure [m]
  RunChanges changes;  ///< of the run with the shortest substep, looked at after each of them
  std::optional<double>
      growth{};  ///< of differences of positions, if they grow exponentially [1/s]
  /// If kinds are neither `rounding` nor `regular`: until when differences of positions stay below
  /// 0.1 % of the size [s].
  double trusted_time = 0.0;
  std::vector<BodyDifference>
      bodies{};  ///< that move otherwise than as a function of time, in the order of the model
  std::vector<SpanDifference> spans{};  ///< that the scene lists, cable by cable
  /// Of a run with a shorter substep, which ended the comparison.
  std::optional<Divergence> divergence{};
};

class ErrorEstimator {
 public:
  /// For a run of this scene that begins at `start`. Errors: the scene does not build, or four
  /// times its substeps are more than a step can have ("/step/substeps").
  static Result<ErrorEstimator> create(const Scene& scene, const State& start);

  /// To be called after every step of the run; takes the finer runs as far. Once `stop` has ended
  /// one of their steps the comparison is over: the estimate is of what came before.
  void observe(const Simulation& run, const StopRequest& stop = {});
  [[nodiscard]] ErrorEstimate estimate() const;

 private:
  ErrorEstimator(const Scene& scene, std::vector<Simulation> finer);
  void compare(const Frame& run, const Frame& finer, const Frame& finest, double time);
  void compare_tensions(const std::array<const Frame*, 3>& frames, double time);
  /// Takes a finer run as far as the run; false if that has ended the comparison.
  bool follow(Simulation& finer, bool is_finest, const StopRequest& stop);
  /// How far what came after sudden events has moved within the moment that no run can tell them to.
  void look_for_unseen();
  void estimate_tensions(ErrorEstimate& estimate) const;
  [[nodiscard]] StepErrorKind kind_of(const StepDifference& difference,
                                      const std::optional<double>& growth) const;

  StepSettings step_;
  double scale_;
  std::vector<Simulation> finer_;  // with 2 and 4 times the substeps
  std::vector<TrackedBody> bodies_;
  std::vector<std::string> span_names_;
  std::vector<std::size_t> cable_of_span_;
  Frame start_;
  EventWatch watch_;                                     // of the finest run
  double unseen_ = 0.0;                                  // of all bodies, as StepDifference::unseen
  std::vector<double> unseen_positions_, unseen_turns_;  // of each body
  double end_ = 0.0;
  double motion_ = 0.0;
  std::int64_t frames_ = 0;
  StepDifferenceSum position_;
  StepDifferenceSum tension_;
  std::vector<StepDifferenceSum> positions_, turns_, tensions_;
  std::vector<std::array<double, 3>> square_tensions_;  // sums over frames, of each run
  std::vector<double> course_{0.0};  // relative differences of positions, that of the start first
  std::optional<Divergence> divergence_;
  bool stopped_ = false;
};

}  // namespace sheave::measure
