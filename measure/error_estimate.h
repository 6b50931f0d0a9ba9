#pragma once
// Discretisation error of a run, estimated from two further runs with half and a quarter of its
// substep.
//
// No balance of forces or of energy can show that error: a step may obey its rule to the last digit
// while the rule describes a slightly different motion. Only a comparison with finer steps shows
// it. The comparison does not show errors of the model, nor errors that all three runs have in
// common. The three runs advance side by side, frame by frame, so a long run needs no more memory
// than a short one.
//
//   auto estimator = *ErrorEstimator::create(scene, simulation.world.state());
//   while (simulation.step().ok() && ...) estimator.observe(simulation);
//   const ErrorEstimate estimate = estimator.estimate();

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "measure/decisions.h"
#include "measure/event_watch.h"
#include "measure/step_difference.h"
#include "measure/trajectory.h"

namespace sheave::measure {

/// The cause of the differences of positions, or of tensions.
enum class StepErrorKind {
  /// Only rounding and the solver's tolerance: differences below 1e-9 of their scale
  rounding,
  regular,  ///< the step: the differences have an order
  /// No order, and events occurred at times that depend on the step: contacts, slack, links left,
  /// breaks; or sudden events may have moved bodies by more than the differences show
  /// (StepDifference::unseen)
  events,
  chaos,   ///< no order, no events, and differences that grow exponentially
  sweeps,  ///< no order, and Gauss-Seidel sweeps, of which half the step does twice as many
  coarse,  ///< no order for any of these reasons: the step is too long
};
inline constexpr std::array<std::string_view, 6> step_error_kind_names{
    "rounding", "regular", "events", "chaos", "sweeps", "coarse"};

/// "Size of the scene" below means the larger of BodySet::scale(), the diagonal of the box round
/// its bodies, and the diagonal of the box round the ends of its spans, both at the start.
struct BodyDifference {
  std::string name;
  StepDifference position;  ///< of the body frame's origin [m]; scale: the size of the scene
  /// [rad]; scale: the rotation that moves the surface by the size of the scene. For a body without
  /// a shape 1 rad.
  StepDifference turn;
};

struct SpanDifference {
  std::string name;  ///< "<cable>.<span>"
  /// [N]; scale: the largest root mean square over time of all spans of its cable and all three
  /// runs.
  StepDifference tension;
};

struct ErrorEstimate {
  std::array<int, 3> substeps{};  ///< of the run, and of the two finer runs
  /// Tolerance of the run [m]. The finer runs have a quarter and a sixteenth of it, which halves the
  /// lengths of substeps. 0: `substeps` are fixed
  double tolerance = 0.0;
  double end = 0.0;  ///< end of the compared time [s]
  /// Root mean square over all bodies of their displacements, including rotations at their
  /// surfaces, as in measure/run_error.h [m]; scale: the size of the scene.
  StepDifference position{};
  StepErrorKind position_kind = StepErrorKind::rounding;
  /// Root mean square over all spans [N]; scale: the root mean square of all spans and frames.
  StepDifference tension{};
  StepErrorKind tension_kind = StepErrorKind::rounding;
  /// largest displacement of the bodies from their start, in the same measure [m]
  double motion = 0.0;
  RunChanges changes;  ///< of the run with the shortest substep, observed after each substep
  std::optional<double>
      growth{};  ///< growth rate of differences of positions, if they grow exponentially [1/s]
  /// If the kinds are neither `rounding` nor `regular`: time until which differences of positions
  /// stay below 0.1 % of the size [s].
  double trusted_time = 0.0;
  std::vector<BodyDifference>
      bodies{};  ///< bodies whose motion is not a function of time, in the order of the model
  std::vector<SpanDifference> spans{};  ///< that the scene lists, cable by cable
  /// The closest first.
  std::vector<Decision> decisions{};
  /// Largest difference of the position of a body between two of the three runs [m], and that body.
  /// If one of them entered another branch, so much does the branch matter.
  double apart = 0.0;
  std::string apart_body{};
  /// Divergence of a run with a shorter substep, which ended the comparison.
  std::optional<Divergence> divergence{};
};

class ErrorEstimator {
 public:
  /// For a run of this scene that begins at `start`. Errors: the scene does not build, or four
  /// times its substeps exceed the limit ("/step/substeps"). With a tolerance the finer runs have a
  /// quarter and a sixteenth of it.
  static Result<ErrorEstimator> create(const Scene& scene, const State& start);

  /// To be called after every step of the run; advances the finer runs to the same time. When
  /// `stop` ends one of their steps, the comparison ends; the estimate covers the time before.
  void observe(const Simulation& run, const StopRequest& stop = {});
  /// To be called after each substep of the run, so that margins are known between steps.
  void look(const Simulation& run) { margins_[0].observe(run, reader_); }
  [[nodiscard]] ErrorEstimate estimate() const;

 private:
  /// Displacements that events may have caused, by the widths of their brackets, with a tolerance.
  struct HiddenEvents {
    std::size_t count = 0;
    double distance = 0.0;  // up to now [m]
    double speed = 0.0;     // from now on [m/s]
    /// Adds a step of this length [s].
    void add(const StepStatistics& statistics, double length);
  };
  ErrorEstimator(const Scene& scene, std::vector<Simulation> finer);
  void compare(const Frame& run, const Frame& finer, const Frame& finest, double time);
  void compare_tensions(const std::array<const Frame*, 3>& frames, double time);
  /// Advances a finer run to the time of the run; false if that has ended the comparison.
  bool follow(std::size_t index, const StopRequest& stop);
  /// Finds how far bodies have moved after sudden events, and before stops by friction, within the
  /// time by which all runs find the events late.
  void look_for_unseen();
  /// The same with a tolerance, where the engine tells how well it knows each event.
  void look_for_hidden_events();
  /// Takes these displacements into account, of the present frame.
  void add_unseen(const std::function<EventWatch::Hidden(std::size_t body)>& hidden);
  void estimate_tensions(ErrorEstimate& estimate) const;
  [[nodiscard]] StepErrorKind kind_of(const StepDifference& difference,
                                      const std::optional<double>& growth) const;

  void find_apart(ErrorEstimate& estimate) const;

  StepSettings step_;
  double scale_;
  std::vector<Simulation> finer_;  // with 2 and 4 times the substeps
  std::vector<TrackedBody> bodies_;
  std::vector<std::string> span_names_;
  std::vector<std::size_t> cable_of_span_;
  Frame start_;
  EventWatch watch_;  // of the finest run
  BranchReader reader_;
  std::array<MarginWatch, 3> margins_;  // of the run, and of the finer ones
  HiddenEvents hidden_;                 // the same
  double unseen_ = 0.0;                 // of all bodies, see StepDifference::unseen
  std::vector<double> unseen_positions_, unseen_turns_;  // of each body
  double end_ = 0.0;
  double motion_ = 0.0;
  std::int64_t frames_ = 0;
  StepDifferenceSum position_;
  StepDifferenceSum tension_;
  std::vector<StepDifferenceSum> positions_, turns_, tensions_;
  std::vector<std::array<double, 3>> square_tensions_;  // sums over frames, of each run
  // relative differences of positions, beginning with that of the start
  std::vector<double> course_{0.0};
  std::optional<Divergence> divergence_;
  bool stopped_ = false;
};

}  // namespace sheave::measure
