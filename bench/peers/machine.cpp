#include "bench/peers/machine.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "cable/simulation.h"

namespace sheave::peers {
namespace {

class SheaveMachine final : public Machine {
 public:
  SheaveMachine(Simulation simulation, std::vector<Coordinate> coordinates)
      : simulation_(std::move(simulation)),
        start_(simulation_.world.state()),
        coordinates_(std::move(coordinates)) {}

  void restart() override { static_cast<void>(simulation_.world.restore(start_)); }
  bool step() override { return simulation_.step().ok(); }
  void read(std::vector<double>& positions, std::vector<double>& rates) const override {
    read_coordinates(simulation_.world.state(), start_, coordinates_, positions, rates);
  }

 private:
  Simulation simulation_;
  State start_;
  std::vector<Coordinate> coordinates_;
};

double root_mean_square(const std::vector<double>& values, double right) {
  double sum = 0.0;
  for (const double value : values) sum += (value - right) * (value - right);
  return std::sqrt(sum / static_cast<double>(values.size()));
}

}  // namespace

MachineError error_of(const Problem& problem, Machine& machine) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  MachineError error;
  std::vector<double> positions;
  std::vector<double> rates;
  machine.restart();
  const double a = problem.acceleration();
  // What is in balance but for rounding has no speed to compare with.
  const bool balanced = std::abs(a) < 1e-9 * problem.gravity;
  const double last_speed = (balanced ? problem.gravity : std::abs(a)) * problem.duration();
  for (int i = 1; i <= problem.frames; ++i) {
    if (!machine.step()) return {infinity, infinity, infinity};
    machine.read(positions, rates);
    const double t = problem.dt * i;
    const double off = root_mean_square(positions, 0.5 * a * t * t) / problem.scale;
    const double fast = root_mean_square(rates, a * t) / last_speed;
    if (!std::isfinite(off) || !std::isfinite(fast)) return {infinity, infinity, infinity};
    error.position = std::max(error.position, off);
    if (2 * i >= problem.frames) error.speed = std::max(error.speed, fast);
    for (std::size_t k = 1; k < positions.size(); ++k) {
      error.stretch = std::max(error.stretch, (positions[k] - positions[k - 1]) / problem.scale);
    }
  }
  return error;
}

void read_coordinates(const State& now, const State& start,
                      const std::vector<Coordinate>& coordinates, std::vector<double>& positions,
                      std::vector<double>& rates) {
  positions.clear();
  rates.clear();
  for (const Coordinate& own : coordinates) {
    const BodyState& body = now.bodies[static_cast<std::size_t>(own.body)];
    const BodyState& then = start.bodies[static_cast<std::size_t>(own.body)];
    const bool wheel = own.radius > 0.0;
    positions.push_back(own.sense * (wheel ? own.radius * (body.angle - then.angle)
                                           : body.position.y() - then.position.y()));
    rates.push_back(own.sense *
                    (wheel ? own.radius * body.angular_velocity.z() : body.velocity.y()));
  }
}

measure::Contender contender_of(std::string name, const Problem& problem,
                                std::shared_ptr<Machine> machine) {
  return {std::move(name), [machine] { machine->restart(); }, [machine] { return machine->step(); },
          problem.frames};
}

Result<std::shared_ptr<Machine>> sheave_machine(const Problem& problem,
                                                const StepSettings& settings) {
  Model model = problem.scene.model;
  model.step = settings;
  model.step.dt = problem.dt;
  Result<Simulation> simulation = Simulation::create(model, problem.scene.cables);
  if (!simulation) return simulation.errors();
  return std::shared_ptr<Machine>(
      std::make_shared<SheaveMachine>(std::move(simulation).value(), problem.coordinates));
}

}  // namespace sheave::peers
