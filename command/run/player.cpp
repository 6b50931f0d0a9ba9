#include "command/run/player.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "command/failure.h"
#include "command/interrupt.h"
#include "command/scene_options.h"
#include "scenes/control/scene_supervisor.h"

namespace sheave::command {
namespace {

/// The interpolation at the fraction `f` between `a` and `b`, two states of one world. For pictures
/// only: the interpolated state satisfies no equations.
State between(const State& a, const State& b, double f) {
  State state = a;
  const auto mix = [f](const auto& from, const auto& to) { return from + f * (to - from); };
  state.time = mix(a.time, b.time);
  for (std::size_t i = 0; i < a.bodies.size(); ++i) {
    const BodyState& from = a.bodies[i];
    const BodyState& to = b.bodies[i];
    BodyState& body = state.bodies[i];
    body.position = mix(from.position, to.position);
    body.orientation = from.orientation.slerp(f, to.orientation);
    body.velocity = mix(from.velocity, to.velocity);
    body.angular_velocity = mix(from.angular_velocity, to.angular_velocity);
    body.angle = mix(from.angle, to.angle);
  }
  for (std::size_t i = 0; i < a.features.size(); ++i) {
    for (std::size_t k = 0; k < a.features[i].reals.size(); ++k) {
      state.features[i].reals[k] = mix(a.features[i].reals[k], b.features[i].reals[k]);
    }
  }
  return state;
}

/// Shows the requested times as the simulation passes them.
class Shutter {
 public:
  Shutter(const Scene& scene, std::span<const double> times,
          const std::function<bool(std::size_t, const Simulation&)>& show)
      : scene_(scene), times_(times), show_(show), tolerance_(1e-6 * scene.model.step.dt) {}

  /// To be called at the start and after every step. False once all times have been shown or `show`
  /// has ended the play.
  bool observe(const Simulation& simulation) {
    const State& now = simulation.world.state();
    for (; next_ < times_.size() && times_[next_] <= now.time + tolerance_; ++next_) {
      const bool exact = times_[next_] >= now.time - tolerance_ || !before_;
      if (!(exact ? show_(next_, simulation) : show_between(now))) return false;
    }
    if (next_ == times_.size()) return false;
    // The state is needed later only if a requested time lies within the next step.
    const double step_end = now.time + scene_.model.step.dt - tolerance_;
    if (times_[next_] < step_end) {
      before_ = now;
    } else {
      before_.reset();
    }
    return true;
  }

 private:
  bool show_between(const State& now) {
    // A separate simulation shows the interpolated state, so that the running one is not disturbed.
    if (!shown_) shown_.emplace(make_in_pose(scene_));
    const double f = (times_[next_] - before_->time) / (now.time - before_->time);
    const Errors errors = shown_->world.restore(between(*before_, now, f));
    if (!errors.empty()) throw Failure(ExitCode::internal, to_text(errors));
    return show_(next_, *shown_);
  }

  const Scene& scene_;
  std::span<const double> times_;
  const std::function<bool(std::size_t, const Simulation&)>& show_;
  double tolerance_;
  std::size_t next_ = 0;
  std::optional<State> before_;      // at the start of the step, if a requested time lies within it
  std::optional<Simulation> shown_;  // created at first use
};

}  // namespace

Simulation make_simulation(const Scene& scene) {
  Result<Simulation> simulation = create_simulation(scene);
  if (simulation) return std::move(simulation).value();
  const bool rests = scene.start == Start::rest && scene.start_state == nullptr;
  throw Failure(rests ? ExitCode::diverged : ExitCode::internal, to_text(simulation.errors()));
}

Simulation make_in_pose(const Scene& scene) {
  Result<Simulation> simulation = create_in_pose(scene);
  if (!simulation) throw Failure(ExitCode::internal, to_text(simulation.errors()));
  return std::move(simulation).value();
}

RunOutcome play(const Scene& scene, std::span<const double> times, Progress& progress,
                const std::function<bool(std::size_t, const Simulation&)>& show) {
  Simulation simulation = make_simulation(scene);
  Shutter shutter(scene, times, show);
  return simulate(simulation, step_count(scene), progress,
                  [&](const RunStatistics&) { return shutter.observe(simulation); });
}

std::vector<CableReport> reports_to_show(const Scene& scene, const Simulation& simulation) {
  std::vector<CableReport> reports = simulation.cable_reports();
  const auto pulls = [](const CableReport& report) {
    return std::any_of(report.spans.begin(), report.spans.end(),
                       [](const SpanReport& span) { return span.tension > 0.0; }) ||
           std::any_of(report.wraps.begin(), report.wraps.end(),
                       [](const WrapReport& wrap) { return wrap.span.tension > 0.0; });
  };
  // A state computed by steps or by statics has tensions.
  const bool known =
      simulation.world.state().time > 0.0 || std::any_of(reports.begin(), reports.end(), pulls);
  if (reports.empty() || known) return reports;
  Simulation ahead = make_in_pose(scene);
  if (!ahead.world.restore(simulation.world.state()).empty()) return reports;
  if (!ahead.step(interrupted).ok()) return reports;
  const std::vector<CableReport> later = ahead.cable_reports();
  for (std::size_t c = 0; c < reports.size(); ++c) {
    for (std::size_t k = 0; k < reports[c].spans.size(); ++k) {
      reports[c].spans[k].tension = later[c].spans[k].tension;
    }
  }
  return reports;
}

}  // namespace sheave::command
