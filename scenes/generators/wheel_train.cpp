// One cable over N wheels on fixed axles, with weights m1 and m2 at its ends.
//
//     (o)   (o)   (o)      All axles on one level, 3 radii apart. The cable runs over the first
//    |   \ /   \ /   |     wheel, under the second, over the third, ... and over the last, so that
//   m1   (o)   (o)   m2    both weights hang; if N is even the last two are both passed above.
//                          (The drawing lowers the wheels that are passed below.)
//
// The cable neither stretches nor slips, so every rim moves with the speed v of the weights:
//   kinetic energy  1/2 (m1 + m2 + N I / r^2) v^2,   power of gravity  (m2 - m1) g v,
//   a = (m2 - m1) g / (m1 + m2 + N I / r^2),   with I / r^2 = m / 2 for a disc of mass m.
// The weights hang on T1 = m1 (g + a) and T2 = m2 (g - a).

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "engine/field_check.h"
#include "scenes/generators.h"
#include "scenes/generators/parts.h"

namespace sheave {
namespace {

/// Number of Gauss-Seidel sweeps that brings every check within its tolerance, with a margin. A
/// sweep carries a correction one span further, and an error as long as the train decays in about
/// N^2 sweeps. Wheels that are light compared with the weights absorb corrections, in proportion to
/// N times the ratio. Measured needs (1 s at 60 Hz): 11 at N = 16, 93 at 64, 1734 at 256; with
/// wheels of 1/100 of that mass 453 at 16 and 1734 at 64.
int sufficient_iterations(const WheelTrainOptions& options) {
  const double n = options.wheels;
  const double ratio = (options.first_mass + options.last_mass) / options.wheel_mass;
  return static_cast<int>(std::min(1e6, std::ceil(10.0 + n * n / 20.0 + 0.2 * n * ratio)));
}

}  // namespace

std::span<const Field> WheelTrainOptions::field_table() {
  using Options = WheelTrainOptions;
  static const std::array table{
      field<&Options::wheels>("wheels", "", between(1, 100000), optional, "number of wheels"),
      field<&Options::radius>("radius", "m", above(0.0), optional, "of each wheel"),
      field<&Options::wheel_mass>("wheel_mass", "kg", above(0.0), optional,
                                  "of each wheel, a solid disc"),
      field<&Options::first_mass>("first_mass", "kg", above(0.0), optional,
                                  "weight before the first wheel"),
      field<&Options::last_mass>("last_mass", "kg", above(0.0), optional,
                                 "weight behind the last wheel"),
      field<&Options::gravity>("gravity", "m/s2", above(0.0), optional, "downwards"),
      field<&Options::duration>("duration", "s", above(0.0), optional, "time to simulate"),
      field<&Options::dt>("dt", "s", above(0.0), optional, "time per step"),
      field<&Options::substeps>("substeps", "", between(1, 100000), optional, "per step"),
      field<&Options::iterations>("iterations", "", between(0, 1000000), optional,
                                  "0: as many as bring the acceleration within 0.1 %"),
  };
  return table;
}

double WheelTrainOptions::acceleration() const {
  const double inertia_over_r2 = 0.5 * wheel_mass;
  return (last_mass - first_mass) * gravity / (first_mass + last_mass + wheels * inertia_over_r2);
}

Result<Scene> generate_wheel_train(const WheelTrainOptions& options) {
  Errors errors;
  check_fields(WheelTrainOptions::field_table(), &options, "", errors);
  if (!errors.empty()) return errors;

  const double r = options.radius;
  const double a = options.acceleration();
  Scene scene;
  scene.name = fmt::format("Wheel train, {} wheels", options.wheels);
  scene.description = "One cable over wheels on fixed axles, with a weight at each end.";
  scene.duration = options.duration;
  scene.model.gravity = {0.0, -options.gravity, 0.0};
  generators::step_as_the_paper(
      scene, options.dt, options.substeps,
      options.iterations > 0 ? options.iterations : sufficient_iterations(options));

  // Space for the motion of the weights, a margin, and their own size.
  const double travel = 1.1 * 0.5 * std::abs(a) * options.duration * options.duration;
  const double edge = 0.8 * r;
  const double high = -3.0 * r;
  const double low = high - travel;
  const double last_x = 3.0 * r * (options.wheels - 1);
  Model& model = scene.model;
  const BodyId first = model.add(generators::weight("first weight", {-r, a > 0.0 ? low : high, 0.0},
                                                    Vector3::Constant(edge), options.first_mass));
  CableDef& cable = scene.cables.emplace_back();
  cable.name = "cable";
  cable.links.push_back(generators::attach(first, {0.0, 0.5 * edge, 0.0}));
  for (int k = 0; k < options.wheels; ++k) {
    const BodyId wheel = model.add(generators::wheel(
        fmt::format("wheel {}", k), {3.0 * r * k, 0.0, 0.0}, r, 0.3 * r, options.wheel_mass));
    const bool over = k % 2 == 0 || k == options.wheels - 1;
    cable.links.push_back(
        generators::roll(wheel, over ? Winding::clockwise : Winding::counter_clockwise));
  }
  const BodyId last =
      model.add(generators::weight("last weight", {last_x + r, a > 0.0 ? high : low, 0.0},
                                   Vector3::Constant(edge), options.last_mass));
  cable.links.push_back(generators::attach(last, {0.0, 0.5 * edge, 0.0}));

  const double g = options.gravity;
  scene.checks = {
      generators::check("first weight.vy", Statistic::rate, a, 1e-6 * g,
                        "a = (m2 - m1) g / (m1 + m2 + N I / r^2)"),
      generators::check("last weight.vy", Statistic::rate, -a, 1e-6 * g,
                        "the cable does not stretch"),
      generators::check("cable.0.tension", Statistic::mean, options.first_mass * (g + a), 0.0,
                        "m1 (g + a)"),
      generators::check(fmt::format("cable.{}.tension", options.wheels), Statistic::mean,
                        options.last_mass * (g - a), 0.0, "m2 (g - a)"),
  };
  scene.camera = generators::side_view();
  return scene;
}

}  // namespace sheave
