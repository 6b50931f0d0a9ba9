#include "bench/drives_bench.h"

#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include "cable/links/attachment.h"
#include "cable/links/rolling.h"
#include "cable/live_world.h"
#include "engine/index.h"
#include "engine/joints/hinge.h"
#include "engine/shapes/cylinder.h"
#include "measure/clock.h"
#include "measure/spread.h"

namespace sheave::bench {
namespace {

constexpr int driven_count = 1000;
constexpr int steps_in_turn = 5;
constexpr double usual_speed =
    0.02;                      // [rad/s]; slow, so that winches take long to wind up their cables
constexpr double shift = 3.0;  // [m] from one body to the next

struct Fleet {
  Model model;
  std::vector<CableDef> cables;
};

enum class Kind { rotors, mounted, hinges, forces, winches };
constexpr std::array<const char*, 5> kind_names{"rotors", "mounted", "hinges", "forces", "winches"};

BodyDef wheel(int number, Mobility mobility) {
  auto shape = std::make_shared<Cylinder>();
  shape->radius = 0.25;
  shape->length = 0.1;
  BodyDef body;
  body.name = "wheel " + std::to_string(number);
  body.mobility = mobility;
  body.mass = 1.0;
  body.position = {shift * number, 0.0, 0.0};
  body.shapes = {{shape}};
  return body;
}

BodyDef driven_wheel(int number) {
  BodyDef body = wheel(number, Mobility::rotor);
  body.drive = DriveKind::speed;
  body.drive_values = {usual_speed};
  return body;
}

void add_mounted(int number, Model& model) {
  BodyDef carrier = wheel(number, Mobility::free);
  carrier.name = "carrier " + std::to_string(number);
  BodyDef rotor = driven_wheel(number);
  rotor.mount = model.add(carrier);
  model.add(rotor);
}

void add_hinged(int number, Model& model) {
  auto hinge = std::make_shared<HingeJoint>();
  hinge->name = "hinge " + std::to_string(number);
  hinge->body_b = model.add(wheel(number, Mobility::free));
  hinge->anchor = {shift * number, 0.0, 0.0};
  hinge->axis = Vector3::UnitZ();
  hinge->angle.drive = CoordinateDrive::speed;
  hinge->angle.drive_values = {usual_speed};
  model.joints.push_back(hinge);
}

void add_winch(int number, Fleet& fleet) {
  BodyDef load = wheel(number, Mobility::slider);
  load.name = "load " + std::to_string(number);
  load.axis = Vector3::UnitY();
  load.position = {shift * number - 0.25, -5.0, 0.0};
  auto drum = std::make_shared<RollingLink>();
  drum->winding = Winding::counter_clockwise;
  drum->body = fleet.model.add(driven_wheel(number));
  drum->stored_length = 5.0;
  auto hook = std::make_shared<AttachmentLink>();
  hook->body = fleet.model.add(load);
  CableDef cable;
  cable.name = "cable " + std::to_string(number);
  cable.links = {drum, hook};
  fleet.cables.push_back(cable);
}

Fleet fleet_of(Kind kind) {
  Fleet fleet;
  fleet.model.gravity = kind == Kind::winches ? Vector3(0.0, -10.0, 0.0) : Vector3(Vector3::Zero());
  fleet.model.step.dt = 0.01;
  for (int i = 0; i < driven_count; ++i) {
    switch (kind) {
      case Kind::rotors:
        fleet.model.add(driven_wheel(i));
        break;
      case Kind::mounted:
        add_mounted(i, fleet.model);
        break;
      case Kind::hinges:
        add_hinged(i, fleet.model);
        break;
      case Kind::forces:
        fleet.model.add(wheel(i, Mobility::free));
        break;
      case Kind::winches:
        add_winch(i, fleet);
        break;
    }
  }
  return fleet;
}

/// What is set of a fleet, by handle.
struct Driven {
  Kind kind;
  std::vector<BodyHandle> bodies;
  std::vector<JointHandle> joints;
};

Driven driven_of(Kind kind, const LiveWorld& world) {
  Driven driven{kind, {}, world.joints()};
  const auto& bodies = world.simulation().world.model().bodies;
  for (const BodyHandle body : world.bodies()) {
    if (bodies[at(body.slot)].name.starts_with("wheel")) driven.bodies.push_back(body);
  }
  return driven;
}

Errors set(LiveWorld& world, const Driven& driven, std::size_t which, double value) {
  if (driven.kind == Kind::hinges) return world.set_drive(driven.joints[which], value);
  if (driven.kind == Kind::forces) {
    return world.set_force(driven.bodies[which], {.force = {value, 0.0, 0.0}});
  }
  return world.set_speed(driven.bodies[which], value);
}

/// Something that changes from step to step and differs from body to body, and costs next to
/// nothing.
double value_of(std::int64_t step, std::size_t which) {
  constexpr std::array<double, 8> changes{0.0, 0.1, 0.2, 0.1, 0.0, -0.1, -0.2, -0.1};
  const std::size_t place = (static_cast<std::size_t>(step) + which) % changes.size();
  return usual_speed * (1.0 + changes[place]);
}

// Not inlined, so that callgrind can count each by name.

[[gnu::noinline]] bool all_set(LiveWorld& world, const Driven& driven) {
  bool fine = true;
  const std::int64_t step = world.state().steps;
  for (std::size_t k = 0; k < at(driven_count); ++k) {
    fine = set(world, driven, k, value_of(step, k)).empty() && fine;
  }
  return fine;
}

/// The work of some steps; less than nothing if one failed.
[[gnu::noinline]] std::int64_t steps_left_alone(LiveWorld& world, int steps) {
  std::int64_t rounds = 0;
  for (int i = 0; i < steps; ++i) {
    const LiveReport report = world.step();
    if (!report.ok()) return -1;
    rounds += report.statistics.rounds;
  }
  return rounds;
}

[[gnu::noinline]] std::int64_t steps_with_all_set(LiveWorld& world, const Driven& driven,
                                                  int steps) {
  std::int64_t rounds = 0;
  for (int i = 0; i < steps; ++i) {
    if (!all_set(world, driven)) return -1;
    const LiveReport report = world.step();
    if (!report.ok()) return -1;
    rounds += report.statistics.rounds;
  }
  return rounds;
}

struct Sample {
  double seconds = 0.0;     ///< per step
  std::int64_t rounds = 0;  ///< of all steps
};

Sample sample(LiveWorld& world, const Driven* driven) {
  const double start = measure::thread_time();
  const std::int64_t rounds = driven != nullptr ? steps_with_all_set(world, *driven, steps_in_turn)
                                                : steps_left_alone(world, steps_in_turn);
  return {(measure::thread_time() - start) / steps_in_turn, rounds};
}

/// Each iteration takes one sample of either world, first and second in turns, so that a machine
/// that slows down slows both.
void compare(benchmark::State& state, Kind kind) {
  const Fleet fleet = fleet_of(kind);
  Result<LiveWorld> alone = LiveWorld::create(fleet.model, fleet.cables);
  Result<LiveWorld> steered = LiveWorld::create(fleet.model, fleet.cables);
  if (!alone || !steered) return state.SkipWithError(alone.errors().front().message.c_str());
  const Driven driven = driven_of(kind, *steered);
  sample(*alone, nullptr);
  sample(*steered, &driven);
  std::vector<double> alone_times;
  std::vector<double> steered_times;
  std::vector<double> ratios;
  double extra_rounds = 0.0;
  for ([[maybe_unused]] auto _ : state) {
    const bool alone_first = ratios.size() % 2 == 0;
    Sample left = alone_first ? sample(*alone, nullptr) : Sample{};
    const Sample set = sample(*steered, &driven);
    if (!alone_first) left = sample(*alone, nullptr);
    if (left.rounds < 0 || set.rounds < 0) return state.SkipWithError("a setter or step failed");
    alone_times.push_back(left.seconds);
    steered_times.push_back(set.seconds);
    ratios.push_back(set.seconds / left.seconds);
    extra_rounds += static_cast<double>(set.rounds - left.rounds);
    state.SetIterationTime((left.seconds + set.seconds) * steps_in_turn);
  }
  const measure::Spread ratio = measure::spread_of(ratios);
  const measure::Spread time = measure::spread_of(alone_times);
  state.counters["us_alone"] = 1e6 * time.median;
  state.counters["us_set"] = 1e6 * measure::spread_of(steered_times).median;
  state.counters["least_ratio"] = measure::spread_of(steered_times).minimum / time.minimum;
  state.counters["ratio"] = ratio.median;
  state.counters["ratio_lower"] = ratio.lower;
  state.counters["ratio_upper"] = ratio.upper;
  state.counters["extra_rounds"] = extra_rounds / static_cast<double>(ratios.size());
}

}  // namespace

void register_drive_benchmarks() {
  for (const Kind kind : {Kind::rotors, Kind::mounted, Kind::hinges, Kind::forces, Kind::winches}) {
    const std::string name = std::string("drives/") + kind_names[static_cast<std::size_t>(kind)];
    benchmark::RegisterBenchmark(name.c_str(),
                                 [kind](benchmark::State& state) { compare(state, kind); })
        ->UseManualTime()
        ->Unit(benchmark::kMicrosecond);
  }
}

}  // namespace sheave::bench
