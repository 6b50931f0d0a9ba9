// Machines with all that there is (wide_machine.h): pushed a little from rest along the shape of a
// mode, they move as the linear motion that `modes` predicts.
//
// With x = (z, z') and the state matrix A, the linear motion is x(t) = exp(A t) x(0). Runs go from
// the rest with the velocities of a mode times +a and -a. Half of their difference is the motion
// that is linear in a, with an error of a^2. Half of their sum is the rest, unless a stop
// or a slack rope changes the motion on one side only; such machines say nothing.

#include "statics/modes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <unsupported/Eigen/MatrixFunctions>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "engine/body_set.h"
#include "scenes/control/scene_supervisor.h"
#include "scenes/scene.h"
#include "statics/acting.h"
#include "statics/configuration.h"
#include "statics/equilibrium.h"
#include "tests/property/campaign.h"
#include "tests/property/machine_at_rest.h"
#include "tests/property/shrink.h"
#include "tests/property/wide_machine.h"
#include "tests/support/effort.h"

namespace sheave::test {
namespace {

using Json = nlohmann::json;

constexpr int samples = 8;  // of a period
/// Motion at the largest, as a share of the machine's size.
constexpr double push = 1e-6;

std::optional<Simulation> simulation_with(Json scene, double dt) {
  scene["step"] = {{"dt", dt},
                   {"substeps", 1},
                   {"iterations", 100},
                   {"solver", "direct"},
                   {"integrator", "rattle"}};
  const SceneResult loaded = load_scene_text(scene.dump(), "modes");
  if (!loaded.errors.empty()) return {};
  Result<Simulation> simulation = create_simulation(*loaded);
  if (!simulation) return {};
  return std::move(*simulation);
}

/// The bodies after each eighth of a period; empty if the run ends before.
using Course = std::vector<std::vector<BodyState>>;
Course run(const Json& scene, const State& start, double period, int steps) {
  std::optional<Simulation> simulation = simulation_with(scene, period / steps);
  if (!simulation || !simulation->world.restore(start).empty()) return {};
  Course course;
  for (int i = 1; i <= steps; ++i) {
    if (!simulation->world.step().ok()) return {};
    if (i % (steps / samples) == 0) course.push_back(simulation->world.state().bodies);
  }
  return course;
}

/// Half of the way from one pose to another, along the degrees of freedom.
VectorX half_way(const Configuration& rest, const std::vector<BodyState>& from,
                 const std::vector<BodyState>& to) {
  VectorX way = VectorX::Zero(rest.freedoms());
  for (std::size_t i = 0; i < from.size(); ++i) {
    Quaternion turn = to[i].orientation * from[i].orientation.conjugate();
    if (turn.w() < 0.0) turn.coeffs() *= -1.0;
    way += rest.along(static_cast<int>(i), 0.5 * (to[i].position - from[i].position), turn.vec());
  }
  return way;
}

/// exp(A t) of a mechanical system, in coordinates in which stiffness is a rate.
Eigen::MatrixXd propagator(const Modes& modes, double t) {
  const auto k = static_cast<Eigen::Index>(modes.modes.size());
  Eigen::VectorXd scale = Eigen::VectorXd::Ones(modes.state_matrix.rows());
  for (Eigen::Index i = 0; i < k; ++i) {
    const double square = std::abs(modes.modes[static_cast<std::size_t>(i)].eigenvalue);
    scale[i] = square > 0.0 ? std::sqrt(square) : 1.0;
  }
  const Eigen::MatrixXd scaled =
      scale.asDiagonal() * modes.state_matrix * scale.cwiseInverse().asDiagonal();
  return scale.cwiseInverse().asDiagonal() * (t * scaled).exp() * scale.asDiagonal();
}

double norm(const Configuration& rest, const VectorX& way) {
  return std::sqrt(way.dot(rest.mass() * way));
}

struct Comparison {
  double off = 0.0;       ///< of the prediction / largest motion
  double lopsided = 0.0;  ///< part of the motion that has no sign / largest motion
};

/// A push along one mode, over its period in steps.
std::optional<Comparison> compare(const Json& scene, Simulation& at_rest, const Modes& modes,
                                  std::size_t mode, int steps) {
  const State rest = at_rest.world.state();
  const Configuration configuration(at_rest, rest, 1.0);
  const auto k = static_cast<Eigen::Index>(modes.modes.size());
  const double period = 1.0 / modes.modes[mode].frequency;
  // A velocity v moves by v / w at most.
  const Configuration::Reach reach = configuration.reach(modes.modes[mode].shape);
  const double size = at_rest.world.bodies().scale();
  const double most = std::max({reach.translation / size, reach.turn, reach.spin});
  const double speed = push / most * 2.0 * pi / period;
  std::array<Course, 3> courses;
  for (const int sign : {-1, 0, 1}) {
    ModalVector x = ModalVector::Zero(modes.state_matrix.rows());
    x[k + static_cast<Eigen::Index>(mode)] = sign * speed;
    courses[static_cast<std::size_t>(sign + 1)] =
        run(scene, perturbed_state(at_rest, modes, x), period, steps);
    if (courses[static_cast<std::size_t>(sign + 1)].size() != samples) return {};
  }
  const Eigen::MatrixXd step = propagator(modes, period / samples);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(modes.state_matrix.rows());
  x[k + static_cast<Eigen::Index>(mode)] = speed;
  Comparison worst;
  double largest = 0.0;
  for (std::size_t i = 0; i < samples; ++i) {
    x = step * x;
    const VectorX predicted = modes.motions * x.head(k);
    largest = std::max(largest, norm(configuration, predicted));
    const VectorX found = half_way(configuration, courses[0][i], courses[2][i]);
    const VectorX mean = half_way(configuration, courses[1][i], courses[0][i]) +
                         half_way(configuration, courses[1][i], courses[2][i]);
    worst.off = std::max(worst.off, norm(configuration, found - predicted));
    worst.lopsided = std::max(worst.lopsided, norm(configuration, mean));
  }
  worst.off /= largest;
  worst.lopsided /= largest;
  return worst;
}

/// Whether a rope, a contact or a stop holds nothing, so that the least motion may let it go.
bool idles(Simulation& at_rest) {
  constexpr double nothing = 1e-6;  // of the largest force
  const State rest = at_rest.world.state();
  Configuration configuration(at_rest, rest, 1.0);
  const Acting acting = find_acting(configuration, at_rest.world.bodies().scale());
  double largest = acting.rows.loads.size() > 0 ? acting.rows.loads.cwiseAbs().maxCoeff() : 0.0;
  if (acting.unknowns.size() > 0) {
    largest = std::max(largest, acting.unknowns.cwiseAbs().maxCoeff());
  }
  for (std::size_t g = 0; g < acting.acts.size(); ++g) {
    const ForceUnknown& unknown = acting.rows.unknowns[g];
    if (unknown.lower != 0.0 && unknown.upper != 0.0) continue;
    const double force = std::abs(acting.unknowns[static_cast<Eigen::Index>(g)]);
    if (acting.acts[g] != 0 && force <= nothing * largest) return true;
  }
  return false;
}

/// Whether a span leaves its wheel so steeply that no groove holds the rope.
bool lacks_a_tangent(const Simulation& simulation) {
  for (const CableReport& cable : simulation.cable_reports()) {
    for (const SpanReport& span : cable.spans) {
      if (!span.has_tangent) return true;
    }
  }
  return false;
}

/// A machine at its rest, and the modes about it.
struct Swinging {
  Json scene;
  Simulation simulation;
  Modes modes;
  std::vector<std::size_t> modes_that_swing;
};

/// Nothing if the machine has no rest that small motions keep to.
std::optional<Swinging> swinging(const Machine& machine) {
  Json scene = Json::parse(scene_of(machine));
  take_out_sources(scene);
  // Frozen tangents with dampers do not converge to the motion of a rope (tests/property/known).
  for (Json& cable : scene["cables"]) cable.erase("tangent_update");
  std::optional<Simulation> simulation = simulation_with(scene, 1e-3);
  if (!simulation) return {};
  const Equilibrium rest = find_equilibrium(*simulation);
  if (!rest.converged || rest.stability == Stability::unstable) return {};
  Modes modes = find_modes(*simulation);
  if (modes.friction_slides || idles(*simulation) || lacks_a_tangent(*simulation)) return {};
  std::vector<std::size_t> swing;
  for (std::size_t i = 0; i < modes.modes.size(); ++i) {
    if (modes.modes[i].frequency > 0.0) swing.push_back(i);
  }
  if (swing.empty()) return {};
  return Swinging{std::move(scene), std::move(*simulation), std::move(modes), std::move(swing)};
}

/// The first machine of a few that swings.
Machine swinging_machine(std::uint64_t seed) {
  constexpr std::uint64_t most_draws = 8;
  for (std::uint64_t i = 0; i < most_draws; ++i) {
    Machine machine = wide_machine(most_draws * seed + i);
    if (swinging(machine)) return machine;
  }
  return wide_machine(seed);
}

Finding moves_as_predicted(const Machine& machine, std::uint64_t seed) {
  Finding finding{false, 0.0, 1e-3, "the motion of a mode"};
  std::optional<Swinging> at_rest = swinging(machine);
  if (!at_rest) return finding;
  Random random(seed);
  const std::size_t mode = at_rest->modes_that_swing[static_cast<std::size_t>(
      random.below(static_cast<int>(at_rest->modes_that_swing.size())))];
  // Runs converge with the step, at first order where dampers act. Contradictions do not. Rounding
  // ends the convergence of fast modes, whose steps are short.
  constexpr double converges = 0.45;
  constexpr double near = 1e-2;
  double before = INFINITY;
  for (const int steps : {64, 256, 1024}) {
    const std::optional<Comparison> found =
        compare(at_rest->scene, at_rest->simulation, at_rest->modes, mode, steps);
    if (!found || found->lopsided > 0.5 * finding.limit) return {false, 0.0, finding.limit, {}};
    finding.checked = true;
    finding.value = found->off;
    finding.what = "mode " + std::to_string(mode + 1) + " of " + at_rest->scene.dump();
    if (found->off <= finding.limit) return finding;
    const bool closes_in = found->off <= converges * before;
    if (closes_in && (steps == 1024 || found->off <= near))
      return {true, finding.limit, finding.limit, finding.what};
    before = found->off;
  }
  return finding;
}

TEST(Property, WideMachinesVibrateAsTheirModes) {
  run_campaign_on(
      "modes", instrumented || !optimised ? 4 : 12,
      [](std::uint64_t seed) {
        return RandomMachine{swinging_machine(seed), 0, {}};
      },
      moves_as_predicted);
}

}  // namespace
}  // namespace sheave::test
