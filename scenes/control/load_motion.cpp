#include "scenes/control/load_motion.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "engine/body_set.h"
#include "engine/math/portable.h"
#include "engine/model.h"
#include "engine/world.h"

namespace sheave {
namespace {

/// A displacement or a rotation vector, and its rate.
struct Moved {
  Vector3 value = Vector3::Zero();
  Vector3 rate = Vector3::Zero();
};

/// The angular velocity of a body whose rotation vector is `turn.value`.
Vector3 angular_velocity(const Moved& turn) {
  const double angle = turn.value.norm();
  // Below this angle the next terms of the series are smaller than rounding.
  constexpr double small = 1e-4;
  const double square = angle * angle;
  const double first = angle < small ? 0.5 - square / 24.0 : (1.0 - portable::cos(angle)) / square;
  const double second = angle < small ? 1.0 / 6.0 - square / 120.0
                                      : (angle - portable::sin(angle)) / (square * angle);
  const Vector3 across = turn.value.cross(turn.rate);
  return turn.rate + first * across + second * turn.value.cross(across);
}

class ActingMotion final : public ActingLoad {
 public:
  ActingMotion(const MotionLoad& load, const BodyDef& body)
      : load_(load),
        positions_(load.times, load.positions, load.interpolation),
        turns_(load.times, load.turns, load.interpolation),
        position_(body.position),
        orientation_(body.orientation) {
    for (const double frequency : load.frequencies) fastest_ = std::max(fastest_, frequency);
  }

  [[nodiscard]] MotionTarget motion(const World& world, double h) const override {
    const double end = world.state().time + h;
    const Moved way = way_at(end);
    const Moved turn = turn_at(end);
    MotionTarget target;
    target.position = position_ + way.value;
    target.orientation = (rotation_by(turn.value) * orientation_).normalized();
    target.velocity = way.rate;
    target.angular_velocity = angular_velocity(turn);
    target.over = h;
    return target;
  }

  [[nodiscard]] LoadCourse course(const World& world, double h) const override {
    const double now = world.state().time;
    const double table_corner = std::min(positions_.next_corner(now), turns_.next_corner(now));
    LoadCourse course;
    course.corner = load_.interpolation == Interpolation::linear ? table_corner : no_instant;
    const Path path(*this, now, h);
    const double size = world.bodies()[load_.body.index].size;
    const auto look = [&](double time) {
      course.distance = std::max(course.distance, path.distance(*this, time, size));
    };
    // A cubic departs the most from a sine halfway between its ends, and from a table at a point.
    // More looks than these are not needed: the distance exceeds any tolerance long before.
    constexpr double looks_per_period = 4.0;
    constexpr double most_looks = 64.0;
    const double looks = std::ceil(std::min(looks_per_period * fastest_ * h, most_looks)) + 1.0;
    for (double i = 0.5; i < looks; ++i) look(now + i / looks * h);
    double point = table_corner;
    for (int i = 0; point < now + h && i < static_cast<int>(most_looks); ++i) {
      look(point);
      point = std::min(positions_.next_corner(point), turns_.next_corner(point));
    }
    return course;
  }

 private:
  /// The cubics between the ends of a substep, of the displacement and of the rotation vector.
  struct Path {
    Path(const ActingMotion& own, double now, double h)
        : way(between(own.way_at(now), own.way_at(now + h), now, h)),
          turn(between(own.turn_at(now), own.turn_at(now + h), now, h)) {}
    static RampOf<Vector3> between(const Moved& start, const Moved& end, double now, double h) {
      return {now, now + h, start.value, start.rate, end.value, end.rate, end.rate};
    }
    [[nodiscard]] double distance(const ActingMotion& own, double time, double size) const {
      return (own.way_at(time).value - way.at(time)).norm() +
             size * (own.turn_at(time).value - turn.at(time)).norm();
    }
    RampOf<Vector3> way, turn;
  };

  [[nodiscard]] Moved way_at(double time) const {
    return moved(load_.translations, positions_, time);
  }
  [[nodiscard]] Moved turn_at(double time) const { return moved(load_.rotations, turns_, time); }
  [[nodiscard]] Moved moved(const std::vector<Vector3>& amplitudes, const VectorTable& table,
                            double time) const {
    Moved sum{table.at(time) - table.at(0.0), table.rate(time)};
    for (std::size_t k = 0; k < amplitudes.size(); ++k) {
      const double rate = 2.0 * pi * load_.frequencies[k];
      const double phase = load_.phases.empty() ? 0.0 : load_.phases[k];
      sum.value += amplitudes[k] * (portable::sin(rate * time + phase) - portable::sin(phase));
      sum.rate += amplitudes[k] * (rate * portable::cos(rate * time + phase));
    }
    return sum;
  }

  MotionLoad load_;
  double fastest_ = 0.0;  // of the sines [Hz]
  VectorTable positions_;
  VectorTable turns_;
  Vector3 position_;
  Quaternion orientation_;
};

}  // namespace

std::span<const Field> MotionLoad::field_table() {
  static const std::array table{
      field<&MotionLoad::frequencies>("frequencies", "Hz", at_least(0.0), optional,
                                      "of sines, one per sine"),
      field<&MotionLoad::phases>("phases", "rad", any_number(), optional,
                                 "of the sines at time 0; none: 0"),
      field<&MotionLoad::translations>("translations", "m", any_number(), optional,
                                       "[x, y, z], the amplitude of each sine: surge, heave, sway"),
      field<&MotionLoad::rotations>(
          "rotations", "rad", any_number(), optional,
          "[x, y, z], the amplitude of each sine about these axes of the world: roll, yaw, pitch"),
      field<&MotionLoad::times>("times", "s", any_number(), optional,
                                "increasing times of a table, which is added to the sines"),
      field<&MotionLoad::positions>("positions", "m", any_number(), optional,
                                    "[x, y, z], one per time; only their changes count"),
      field<&MotionLoad::turns>("turns", "rad", any_number(), optional,
                                "rotation vectors, one per time; only their changes count"),
      choice_field<&MotionLoad::interpolation>("interpolation", interpolation_names, optional,
                                               interpolation_meaning),
  };
  return table;
}

Errors MotionLoad::validate(const LoadScope& scope, const std::string& path) const {
  Errors errors = LoadDef::validate(scope, path);
  const auto check_count = [&](std::size_t count, std::size_t needed, std::string_view key,
                               std::string_view per) {
    if (count == 0 || count == needed) return;
    errors.push_back(
        fault(fmt::format("{}/{}", path, key),
              fmt::format("one value per {} is needed, {}; there are {}", per, needed, count)));
  };
  check_count(phases.size(), frequencies.size(), "phases", "frequency");
  check_count(translations.size(), frequencies.size(), "translations", "frequency");
  check_count(rotations.size(), frequencies.size(), "rotations", "frequency");
  check_count(positions.size(), times.size(), "positions", "time");
  check_count(turns.size(), times.size(), "turns", "time");
  check_times(times, path, errors);
  if (translations.empty() && rotations.empty() && positions.empty() && turns.empty()) {
    errors.push_back(
        fault(path,
              "it needs translations or rotations with frequencies, or positions or turns "
              "with times"));
  }
  if (!errors.empty()) return errors;
  const BodyDef& own = scope.model.bodies[static_cast<std::size_t>(body.index)];
  const bool moves = own.oscillation.norm() > 0.0 || own.velocity.norm() > 0.0 ||
                     own.angular_velocity.norm() > 0.0;
  if (moves) {
    errors.push_back(fault(path + "/body", fmt::format("body \"{}\" has a motion of its own; leave "
                                                       "its velocities and its oscillation out",
                                                       own.name)));
  }
  return errors;
}

std::shared_ptr<const ActingLoad> MotionLoad::prepare(const LoadScope& scope) const {
  return std::make_shared<const ActingMotion>(
      *this, scope.model.bodies[static_cast<std::size_t>(body.index)]);
}

}  // namespace sheave
