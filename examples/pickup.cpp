// A hoist lets its hook down, hangs a crate on it, lifts it and leaves it on a shelf: edits of a world that runs.

#include <cmath>
#include <cstdio>

#include "sheave/sheave.h"

using namespace sheave;

int main() {
  Model model;
  model.gravity = {0.0, -9.81, 0.0};
  model.step.dt = 0.01;
  BodyDef drum;
  drum.name = "drum";
  drum.mobility = Mobility::rotor;
  drum.mass = 20.0;
  drum.drive = DriveKind::speed;
  drum.drive_values = {0.0};
  auto barrel = std::make_shared<Cylinder>();
  barrel->radius = 0.2;
  drum.shapes = {{barrel}};
  auto spool = std::make_shared<SpoolLink>();
  spool->body = model.add(drum);
  spool->winding = Winding::clockwise;
  spool->stored_length = 5.0;
  BodyDef hook;
  hook.name = "hook";
  hook.position = {0.2, -1.0, 0.0};
  hook.mass = 2.0;
  hook.inertia = {0.01, 0.01, 0.01};
  auto eye = std::make_shared<AttachmentLink>();
  eye->body = model.add(hook);
  CableDef rope;
  rope.name = "rope";
  rope.links = {spool, eye};
  auto world = LiveWorld::create(model, {rope});
  if (!world) return std::puts(world.errors()[0].message.c_str()), 1;
  const auto winch = *world->body("drum"), tackle = *world->body("hook");
  const auto turn = [&](double speed, int steps) {
    bool ok = world->set_speed(winch, speed).empty();
    for (int i = 0; i < steps; ++i) ok = world->step().ok() && ok;
    return ok && world->set_speed(winch, 0.0).empty() && world->step().ok();
  };
  if (!turn(-5.0, 200)) return 1;
  const Vector3 below = world->pose(tackle)->position - Vector3(0.0, 0.4, 0.0);
  const auto hung = world->edit([&](Edit& edit) {
    BodyDef crate{.name = "crate", .position = below, .mass = 30.0, .inertia = Vector3(1, 1, 1)};
    FixedJoint shackle;
    shackle.name = "shackle";
    shackle.body_a = Edit::id(tackle);
    shackle.body_b = Edit::id(edit.add(crate));
    shackle.anchor = below;
    edit.add(std::make_shared<FixedJoint>(shackle));
  });
  if (!hung) return std::puts(hung.errors()[0].message.c_str()), 1;
  if (!turn(5.0, 150)) return 1;
  const double tension = *world->tension(*world->cable("rope"), 0);
  const auto left = world->edit([&](Edit& edit) { edit.remove(*world->joint("shackle")); });
  std::printf("%.1f N at the hook; %.1f J\n", tension, left ? left->energy.total() : NAN);
  return left && std::abs(tension - 32.0 * 9.81) < 5.0 ? 0 : 1;
}
