// Only in builds with the renderer.
#if SHEAVE_HAS_RENDER

#include "command/render/trails.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "command/failure.h"
#include "scenes/suggestion.h"

namespace sheave::command {
namespace {

constexpr render::Color fresh = render::rgb(0x2f6f8f);
constexpr render::Color faded = render::rgb(0xdfe6ec);
constexpr double pieces = 120.0;  // smallest number of pieces of a trail

[[noreturn]] void refuse(const std::string& trail, const std::string& what) {
  throw Failure(
      ExitCode::usage,
      fmt::format("--trail {}: {}; give NAME:SECONDS or NAME:SECONDS:X,Y,Z", trail, what));
}

double number(const std::string& trail, std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !(std::abs(value) < 1e30)) {
    refuse(trail, fmt::format("\"{}\" is not a number", text));
  }
  return value;
}

/// The text before and behind the last separator; nullopt if there is none.
std::optional<std::pair<std::string, std::string>> split_last(const std::string& text, char at) {
  const std::size_t place = text.rfind(at);
  if (place == std::string::npos) return std::nullopt;
  return std::pair(text.substr(0, place), text.substr(place + 1));
}

}  // namespace

Trails::Trails(const Scene& scene, const std::vector<std::string>& trails) {
  for (const std::string& text : trails) {
    Trail trail;
    auto parts = split_last(text, ':');
    if (parts && parts->second.find(',') != std::string::npos) {
      std::string rest = parts->second;
      for (int axis = 2; axis >= 0; --axis) {
        const auto numbers = split_last(rest, ',');
        if (!numbers && axis > 0) refuse(text, "a point has three coordinates");
        trail.point[axis] = number(text, numbers && axis > 0 ? numbers->second : rest);
        if (numbers && axis > 0) rest = numbers->first;
      }
      parts = split_last(parts->first, ':');
    }
    if (!parts) refuse(text, "the time is missing");
    trail.seconds = number(text, parts->second);
    if (!(trail.seconds > 0.0)) refuse(text, "the time must be positive");
    const auto& bodies = scene.model.bodies;
    const auto found = std::find_if(bodies.begin(), bodies.end(),
                                    [&](const BodyDef& body) { return body.name == parts->first; });
    if (found == bodies.end()) {
      Suggestion near(parts->first);
      for (const BodyDef& body : bodies) near.consider(body.name);
      refuse(text, fmt::format("there is no body \"{}\"{}", parts->first, near.question()));
    }
    trail.body = BodyId{static_cast<int>(found - bodies.begin())};
    trails_.push_back(std::move(trail));
  }
}

double Trails::longest_interval() const {
  double interval = 0.0;
  for (const Trail& trail : trails_) {
    const double own = trail.seconds / pieces;
    interval = interval > 0.0 ? std::min(interval, own) : own;
  }
  return interval;
}

void Trails::observe(const World& world) {
  const double now = world.state().time;
  for (Trail& trail : trails_) {
    if (!trail.places.empty() && !(now > trail.places.back().time)) continue;
    trail.places.push_back({now, world.point(trail.body, trail.point)});
    while (trail.places.front().time < now - trail.seconds) trail.places.pop_front();
  }
}

void Trails::add_to(render::DrawList& list, double cable_radius) const {
  for (const Trail& trail : trails_) {
    if (trail.places.size() < 2) continue;
    render::Tube tube;
    tube.radius = 0.5 * cable_radius;
    const double now = trail.places.back().time;
    for (const Place& place : trail.places) {
      const auto age = static_cast<float>((now - place.time) / trail.seconds);
      tube.points.push_back({place.position, mix(fresh, faded, std::min(age, 1.0F))});
    }
    list.tubes.push_back(std::move(tube));
  }
}

}  // namespace sheave::command

#endif  // SHEAVE_HAS_RENDER
