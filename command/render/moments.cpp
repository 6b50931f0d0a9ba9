// Only in builds with the renderer.
#if SHEAVE_HAS_RENDER

#include "command/render/moments.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "command/failure.h"
#include "command/scene_options.h"
#include "engine/field_check.h"

namespace sheave::command {
namespace {

constexpr double most_frames = 1e7;

/// An interval of time, and the tolerance of moments [s].
struct Period {
  double begin = 0.0;
  double end = 0.0;
  double tolerance = 0.0;
};

Period period_of(const Scene& scene, double begin) {
  const double dt = scene.model.step.dt;
  return {begin, static_cast<double>(step_count(scene)) * dt, 1e-6 * dt};
}

void add_frames(const PictureOptions& options, const Period& period, std::vector<Moment>& moments) {
  const double interval = options.speed / options.fps;
  const double last = std::floor((period.end + period.tolerance) / interval);
  if (!(last < most_frames)) {
    throw Failure(
        ExitCode::usage,
        fmt::format(
            "{} s at this --speed and --fps make {:.3g} frames; at most {:.0f} are possible",
            number_text(period.end), last, most_frames));
  }
  const double first = std::ceil((period.begin - period.tolerance) / interval);
  for (double k = std::max(first, 0.0); k <= last; ++k) {
    moments.push_back({.time = k * interval, .frame = true});
  }
}

void add_still(const PictureOptions& options, const Period& period, std::vector<Moment>& moments) {
  const double at = options.at.value_or(period.end);
  if (at > period.end + period.tolerance) {
    throw Failure(ExitCode::usage, fmt::format("--at {}: the run ends at {} s; see --duration",
                                               number_text(at), number_text(period.end)));
  }
  if (at < period.begin - period.tolerance) {
    throw Failure(ExitCode::usage, fmt::format("--at {}: the loaded state is later, at {} s",
                                               number_text(at), number_text(period.begin)));
  }
  moments.push_back({.time = std::clamp(at, period.begin, period.end), .still = true});
}

/// Adds ends of steps up to a time, at most `interval` apart.
void add_steps(const Scene& scene, double begin, double end, double interval,
               std::vector<Moment>& moments) {
  const double dt = scene.model.step.dt;
  const double every = std::max(1.0, std::floor(interval / dt));
  for (double step = std::ceil(begin / dt); step * dt <= end; step += every) {
    moments.push_back({.time = step * dt});
  }
}

bool earlier(const Moment& a, const Moment& b) { return a.time < b.time; }

}  // namespace

std::vector<Moment> choose_moments(const Scene& scene, const PictureOptions& options, double begin,
                                   double interval) {
  const Period period = period_of(scene, begin);
  if (begin > period.end + period.tolerance) {
    throw Failure(
        ExitCode::usage,
        fmt::format("--load-state: the state is at {} s, and the run ends at {} s; see --duration",
                    number_text(begin), number_text(period.end)));
  }
  std::vector<Moment> moments;
  if (options.has_frames()) add_frames(options, period, moments);
  if (!options.still.empty()) add_still(options, period, moments);
  if (interval > 0.0 && !moments.empty()) {
    const auto last = std::max_element(moments.begin(), moments.end(), earlier);
    std::vector<Moment> between;
    add_steps(scene, begin, last->time, interval, between);
    moments.insert(moments.end(), between.begin(), between.end());
  }
  std::stable_sort(moments.begin(), moments.end(), earlier);
  return moments;
}

std::vector<Moment> scale_moments(const Scene& scene, double begin) {
  // This number determines the 98 % quantile of tensions well. Ends of steps need no interpolation.
  constexpr double count = 240.0;
  const Period period = period_of(scene, begin);
  std::vector<Moment> moments;
  add_steps(scene, begin, period.end + period.tolerance, (period.end - begin) / count, moments);
  for (Moment& moment : moments) moment.scale = true;
  return moments;
}

std::vector<Moment> peak_moments(const Scene& scene, double begin) {
  const Period period = period_of(scene, begin);
  std::vector<Moment> moments;
  add_steps(scene, begin, period.end + period.tolerance, 0.0, moments);
  for (Moment& moment : moments) moment.peak = true;
  return moments;
}

std::vector<Moment> chain_moments(const Scene& scene, std::span<const Moment> moments,
                                  double begin) {
  const bool can_part =
      std::any_of(scene.cables.begin(), scene.cables.end(),
                  [](const CableDef& cable) { return cable.cut_time || cable.breaking_tension; });
  std::vector<Moment> all;
  if (moments.empty() || scene.cables.empty() || !(can_part || !scene.triggers.empty())) return all;
  constexpr double interval = 1.0 / 60.0;  // [s]
  add_steps(scene, begin, moments.back().time, interval, all);
  return all;
}

std::vector<Moment> merged(std::span<const Moment> a, std::span<const Moment> b) {
  std::vector<Moment> all;
  std::merge(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(all), earlier);
  return all;
}

std::vector<double> times_of(std::span<const Moment> moments) {
  std::vector<double> times;
  for (const Moment& moment : moments) times.push_back(moment.time);
  return times;
}

}  // namespace sheave::command

#endif  // SHEAVE_HAS_RENDER
