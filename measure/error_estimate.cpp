#include "measure/error_estimate.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "engine/body_set.h"
#include "measure/error_growth.h"
#include "measure/run_error.h"
#include "scenes/control/scene_supervisor.h"

namespace sheave::measure {
namespace {

constexpr double trusted_level = 1e-3;
constexpr int most_substeps = 100'000;

/// The larger of the sizes of the boxes round the bodies and round the spans' ends [m].
double size_of(const Simulation& simulation) {
  Eigen::AlignedBox3d box;
  for (const CableReport& cable : simulation.cable_reports()) {
    for (const SpanReport& span : cable.spans) box.extend(span.start).extend(span.end);
  }
  const double bodies = simulation.world.bodies().scale();
  return box.isEmpty() ? bodies : std::max(bodies, box.diagonal().norm());
}

/// An order is meaningless if unseen motion may exceed the differences.
StepDifference with_unseen(StepDifference difference, double unseen) {
  difference.unseen = unseen;
  if (difference.order && unseen > difference.error()) difference.order.reset();
  return difference;
}

double scale_of_turn(const TrackedBody& body, double scale) {
  return body.reach > 0.0 ? scale / body.reach : 1.0;
}

}  // namespace

Result<ErrorEstimator> ErrorEstimator::create(const Scene& scene, const State& start) {
  const int substeps = scene.model.step.substeps;
  const double tolerance = scene.model.step.tolerance;
  if (tolerance == 0.0 && substeps > most_substeps / 4) {
    return Error{"/step/substeps",
                 fmt::format("{} substeps leave no room for runs with two and four times as many, "
                             "to compare with: at most {} are allowed then",
                             substeps, most_substeps / 4)};
  }
  std::vector<Simulation> finer;
  for (const int factor : {2, 4}) {
    Scene finer_scene = scene;
    if (tolerance == 0.0) finer_scene.model.step.substeps = factor * substeps;
    // The error is proportional to the tolerance and to the square of the length of substeps.
    finer_scene.model.step.tolerance = tolerance / (factor * factor);
    // Where the step limits their length, a finer tolerance alone would leave them as they are.
    finer_scene.model.step.coarsest_level = tolerance > 0.0 ? factor / 2 : 0;
    Result<Simulation> simulation = create_in_pose(finer_scene);
    if (!simulation) return simulation.errors();
    const Errors errors = simulation->world.restore(start);
    if (!errors.empty()) return errors;
    finer.push_back(std::move(simulation).value());
  }
  return ErrorEstimator(scene, std::move(finer));
}

ErrorEstimator::ErrorEstimator(const Scene& scene, std::vector<Simulation> finer)
    : step_(scene.model.step),
      scale_(size_of(finer.front())),
      finer_(std::move(finer)),
      bodies_(tracked_bodies(finer_.front().world.bodies())),
      start_(frame_of(finer_.front(), bodies_)),
      watch_(finer_.back(), bodies_),
      reader_(scene, finer_.front()),
      end_(finer_.front().world.state().time) {
  const std::vector<CableReport> reports = finer_.front().cable_reports();
  for (std::size_t i = 0; i < reports.size(); ++i) {
    for (std::size_t k = 0; k < reports[i].spans.size(); ++k) {
      span_names_.push_back(fmt::format("{}.{}", reports[i].name, k));
      cable_of_span_.push_back(i);
    }
  }
  positions_.resize(bodies_.size());
  turns_.resize(bodies_.size());
  tensions_.resize(span_names_.size());
  square_tensions_.resize(span_names_.size());
  unseen_positions_.resize(bodies_.size());
  unseen_turns_.resize(bodies_.size());
}

bool ErrorEstimator::follow(std::size_t index, const StopRequest& stop) {
  Simulation& finer = finer_[index];
  MarginWatch& margins = margins_[index + 1];
  const bool is_finest = index + 1 == finer_.size();
  const std::function<void()> watch = [&] {
    if (is_finest) watch_.observe(finer);
    margins.observe(finer, reader_);
  };
  StepReport report = finer.step(stop, watch, {});
  if (report.ok()) {
    watch();
    margins.end_step();
    if (!is_finest) return true;
    watch_.end_step(report.statistics);
    hidden_.add(report.statistics, step_.dt);
    return true;
  }
  stopped_ = report.stopped;
  divergence_ = std::move(report.divergence);
  return false;
}

void ErrorEstimator::observe(const Simulation& run, const StopRequest& stop) {
  if (divergence_ || stopped_) return;
  for (std::size_t i = 0; i < finer_.size(); ++i) {
    if (!follow(i, stop)) return;
  }
  look(run);
  margins_[0].end_step();
  const Frame frame = frame_of(run, bodies_);
  end_ = run.world.state().time;
  ++frames_;
  compare(frame, frame_of(finer_[0], bodies_), frame_of(finer_[1], bodies_), end_);
  if (step_.tolerance > 0.0) {
    look_for_hidden_events();
  } else if (watch_.changes().sudden + watch_.changes().stops > 0) {
    look_for_unseen();
  }
}

void ErrorEstimator::HiddenEvents::add(const StepStatistics& statistics, double length) {
  count += static_cast<std::size_t>(statistics.bracketed_events);
  distance += speed * length + statistics.event_distance;
  speed += statistics.event_speed;
}

void ErrorEstimator::look_for_hidden_events() {
  const std::vector<BodyState>& states = finer_.back().world.state().bodies;
  const auto state_of = [&](std::size_t i) -> const BodyState& {
    return states[static_cast<std::size_t>(bodies_[i].id.index)];
  };
  double fastest = 0.0;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    fastest = std::max({fastest, state_of(i).velocity.norm(),
                        bodies_[i].reach * state_of(i).angular_velocity.norm()});
  }
  if (hidden_.distance == 0.0 || fastest == 0.0) return;
  // A delay displaces bodies in proportion to their speeds. An event lies anywhere in its bracket.
  const double delay = 0.5 * hidden_.distance / fastest;
  add_unseen([&](std::size_t i) {
    return EventWatch::Hidden{delay * state_of(i).velocity.norm(),
                              delay * state_of(i).angular_velocity.norm()};
  });
}

void ErrorEstimator::look_for_unseen() {
  // A delay dt moves everything after the event by dt times its speed. The finest run cannot show a
  // delay below its substep.
  const bool late = watch_.changes().sudden > 0;
  const double delay = late ? 0.25 * step_.dt / step_.substeps : 0.0;
  add_unseen([&](std::size_t i) {
    const BodyState& state =
        finer_.back().world.state().bodies[static_cast<std::size_t>(bodies_[i].id.index)];
    const EventWatch::Hidden& stop = watch_.hidden_by_stops()[i];
    return EventWatch::Hidden{delay * state.velocity.norm() + stop.moved,
                              delay * state.angular_velocity.norm() + stop.turned};
  });
}

void ErrorEstimator::add_unseen(const std::function<EventWatch::Hidden(std::size_t body)>& hidden) {
  double sum = 0.0;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const auto [moved, turned] = hidden(i);
    const double reach = bodies_[i].reach;
    unseen_positions_[i] = std::max(unseen_positions_[i], moved);
    unseen_turns_[i] = std::max(unseen_turns_[i], turned);
    sum += moved * moved + reach * reach * turned * turned;
  }
  const auto count = static_cast<double>(std::max<std::size_t>(bodies_.size(), 1));
  unseen_ = std::max(unseen_, std::sqrt(sum / count));
}

void ErrorEstimator::compare(const Frame& run, const Frame& finer, const Frame& finest,
                             double time) {
  double moved = 0.0;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const TrackedBody& body = bodies_[i];
    const auto difference = [&](const BodyPose& pose, const BodyPose& from) {
      return pose_difference(pose, from, body.turns_by_angle);
    };
    const PoseDifference coarse = difference(run.poses[i], finer.poses[i]);
    const PoseDifference fine = difference(finer.poses[i], finest.poses[i]);
    positions_[i].add(coarse.position, fine.position);
    positions_[i].end_frame(time);
    turns_[i].add(coarse.turn, fine.turn);
    turns_[i].end_frame(time);
    position_.add(coarse.position, fine.position);
    position_.add(body.reach * coarse.turn, body.reach * fine.turn);
    const PoseDifference way = difference(run.poses[i], start_.poses[i]);
    moved += way.position.squaredNorm() + body.reach * body.reach * way.turn.squaredNorm();
  }
  position_.end_frame(time);
  const double root = std::sqrt(static_cast<double>(std::max<std::size_t>(bodies_.size(), 1)));
  motion_ = std::max(motion_, std::sqrt(moved) / root);
  course_.push_back(position_.last() / root / scale_);
  compare_tensions({&run, &finer, &finest}, time);
}

void ErrorEstimator::compare_tensions(const std::array<const Frame*, 3>& frames, double time) {
  for (std::size_t k = 0; k < span_names_.size(); ++k) {
    std::array<double, 3> of{};
    for (std::size_t run = 0; run < 3; ++run) {
      of[run] = frames[run]->tensions[k];
      square_tensions_[k][run] += of[run] * of[run];
    }
    const Vector3 coarse(of[0] - of[1], 0.0, 0.0);
    const Vector3 fine(of[1] - of[2], 0.0, 0.0);
    tensions_[k].add(coarse, fine);
    tensions_[k].end_frame(time);
    tension_.add(coarse, fine);
  }
  tension_.end_frame(time);
}

StepErrorKind ErrorEstimator::kind_of(const StepDifference& difference,
                                      const std::optional<double>& growth) const {
  const bool hidden = difference.unseen > negligible_difference * difference.scale;
  if (difference.negligible() && !hidden) return StepErrorKind::rounding;
  if (difference.order) return StepErrorKind::regular;
  if (hidden || watch_.changes().count() + watch_.changes().sudden + hidden_.count > 0) {
    return StepErrorKind::events;
  }
  if (growth) return StepErrorKind::chaos;
  if (step_.solver == SolverKind::gauss_seidel) return StepErrorKind::sweeps;
  return StepErrorKind::coarse;
}

void ErrorEstimator::estimate_tensions(ErrorEstimate& estimate) const {
  const auto frames = static_cast<double>(std::max<std::int64_t>(frames_, 1));
  std::vector<double> cable_scales(cable_of_span_.empty() ? 0 : cable_of_span_.back() + 1);
  std::array<double, 3> sums{};
  for (std::size_t k = 0; k < span_names_.size(); ++k) {
    double& scale = cable_scales[cable_of_span_[k]];
    for (std::size_t run = 0; run < 3; ++run) {
      scale = std::max(scale, std::sqrt(square_tensions_[k][run] / frames));
      sums[run] += square_tensions_[k][run];
    }
  }
  for (std::size_t k = 0; k < span_names_.size(); ++k) {
    estimate.spans.push_back(
        {span_names_[k], tensions_[k].result(cable_scales[cable_of_span_[k]])});
  }
  const auto spans = std::max<std::size_t>(span_names_.size(), 1);
  const double square = *std::max_element(sums.begin(), sums.end()) / frames;
  estimate.tension = tension_.result(std::sqrt(square / static_cast<double>(spans)), spans);
}

ErrorEstimate ErrorEstimator::estimate() const {
  ErrorEstimate estimate{
      .substeps = {step_.substeps, 2 * step_.substeps, 4 * step_.substeps},
      .tolerance = step_.tolerance,
      .end = end_,
      .motion = motion_,
      .changes = watch_.changes(),
      .divergence = divergence_,
  };
  if (step_.tolerance > 0.0) estimate.changes.sudden = hidden_.count;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const double turn_scale = scale_of_turn(bodies_[i], scale_);
    estimate.bodies.push_back({bodies_[i].name,
                               with_unseen(positions_[i].result(scale_), unseen_positions_[i]),
                               with_unseen(turns_[i].result(turn_scale), unseen_turns_[i])});
  }
  estimate.position =
      with_unseen(position_.result(scale_, std::max<std::size_t>(bodies_.size(), 1)), unseen_);
  estimate_tensions(estimate);
  const ErrorGrowth growth = error_growth(course_, step_.dt, trusted_level);
  estimate.growth = growth.rate;
  const double start = end_ - step_.dt * static_cast<double>(frames_);
  estimate.trusted_time = start + step_.dt * static_cast<double>(growth.trusted_frames - 1);
  estimate.position_kind = kind_of(estimate.position, estimate.growth);
  estimate.tension_kind = kind_of(estimate.tension, estimate.growth);
  estimate.decisions = find_decisions(
      reader_, {margins_[0].records(), margins_[1].records(), margins_[2].records()});
  find_apart(estimate);
  return estimate;
}

void ErrorEstimator::find_apart(ErrorEstimate& estimate) const {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const double largest = estimate.bodies[i].position.largest;
    if (largest <= estimate.apart) continue;
    estimate.apart = largest;
    estimate.apart_body = bodies_[i].name;
  }
}

}  // namespace sheave::measure
