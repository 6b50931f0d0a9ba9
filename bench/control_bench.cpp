#include "bench/control_bench.h"

#include <memory>
#include <vector>

#include <benchmark/benchmark.h>

#include "cable/links/attachment.h"
#include "cable/links/rolling.h"
#include "cable/live_world.h"
#include "engine/joints/hinge.h"
#include "engine/shapes/cylinder.h"

namespace sheave::bench {
namespace {

/// One of each thing that can be set, in a world that stands still.
LiveWorld workshop() {
  Model model;
  BodyDef hand;
  hand.name = "hand";
  hand.mobility = Mobility::kinematic;
  const BodyId held = model.add(hand);
  auto shape = std::make_shared<Cylinder>();
  shape->radius = 0.25;
  BodyDef drum;
  drum.name = "drum";
  drum.mobility = Mobility::rotor;
  drum.mass = 1.0;
  drum.position = {2.0, 2.0, 0.0};
  drum.shapes = {{shape}};
  drum.drive = DriveKind::speed;
  drum.drive_values = {0.0};
  model.add(drum);
  drum.name = "bar";
  drum.mobility = Mobility::free;
  drum.position = {4.0, 0.0, 0.0};
  drum.drive = DriveKind::none;
  drum.drive_values.clear();
  auto hinge = std::make_shared<HingeJoint>();
  hinge->name = "hinge";
  hinge->body_b = model.add(drum);
  hinge->angle.drive = CoordinateDrive::speed;
  hinge->angle.drive_values = {0.0};
  hinge->angle.drive_limit = 10.0;
  model.joints.push_back(hinge);
  auto from = std::make_shared<AttachmentLink>();
  from->body = held;
  auto to = std::make_shared<AttachmentLink>();
  to->body = BodyId::world();
  to->point = {0.0, 1.0, 0.0};
  to->feed_speed = 0.0;
  CableDef rope;
  rope.name = "rope";
  rope.compliance = 1e-6;
  rope.links = {from, to};
  Result<LiveWorld> world = LiveWorld::create(model, {rope});
  return std::move(*world);
}

/// `call` sets something to a value below 1.
template <class Call>
void time_setter(const char* name, const Call& call) {
  benchmark::RegisterBenchmark(name, [call](benchmark::State& state) {
    LiveWorld world = workshop();
    double value = 0.0;
    for (auto _ : state) {
      value = value < 0.5 ? value + 1e-3 : 0.0;
      const Errors errors = call(world, value);
      if (!errors.empty()) return state.SkipWithError(errors.front().message.c_str());
      benchmark::DoNotOptimize(errors);
    }
  });
}

}  // namespace

void register_control_benchmarks() {
  const LiveWorld world = workshop();
  const BodyHandle hand = *world.body("hand");
  const BodyHandle drum = *world.body("drum");
  const BodyHandle bar = *world.body("bar");
  const JointHandle hinge = *world.joint("hinge");
  const CableHandle rope = *world.cable("rope");
  time_setter("set_motion/position", [=](LiveWorld& w, double value) {
    return w.set_motion(hand, {.position = {value, 0.0, 0.0}});
  });
  time_setter("set_motion/velocity", [=](LiveWorld& w, double value) {
    return w.set_motion(hand,
                        {.position = {value, 0.0, 0.0}, .velocity = Vector3(0.0, value, 0.0)});
  });
  // Who makes orientations of angles pays for that, not the setter.
  constexpr int turns = 64;
  std::vector<Quaternion> orientations;
  for (int i = 0; i < turns; ++i) {
    orientations.push_back(rotation_by(Vector3(0.0, 0.0, static_cast<double>(i) / turns)));
  }
  time_setter("set_motion/orientation", [=](LiveWorld& w, double value) {
    return w.set_motion(hand, {.position = {value, 0.0, 0.0},
                               .orientation = orientations[static_cast<std::size_t>(turns * value)],
                               .velocity = Vector3(0.0, value, 0.0),
                               .angular_velocity = Vector3(0.0, 0.0, value)});
  });
  time_setter("set_speed", [=](LiveWorld& w, double value) { return w.set_speed(drum, value); });
  time_setter("set_force", [=](LiveWorld& w, double value) {
    return w.set_force(bar, {.force = {value, 0.0, 0.0}});
  });
  time_setter("set_drive", [=](LiveWorld& w, double value) { return w.set_drive(hinge, value); });
  time_setter("set_drive_limit",
              [=](LiveWorld& w, double value) { return w.set_drive_limit(hinge, 1.0 + value); });
  time_setter("set_gravity", [=](LiveWorld& w, double value) {
    return w.set_gravity({0.0, value, 0.0});
  });
  time_setter("set_compliance", [=](LiveWorld& w, double value) {
    return w.set_compliance(rope, 1e-6 * (1.0 + value));
  });
  time_setter("set_feed_speed",
              [=](LiveWorld& w, double value) { return w.set_feed_speed(rope, 1, value); });
}

}  // namespace sheave::bench
