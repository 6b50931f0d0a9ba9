// A hoist lets its hook down, hangs a crate on it, lifts it and leaves it on a shelf: edits of a
// world that runs.

#include <cstdio>

#include <sheave/sheave.h>

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
  drum.inertia = {0.2, 0.2, 0.4};
  auto spool = std::make_shared<SpoolLink>();
  spool->body = model.add(drum);
  spool->radius = 0.2;
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
  BodyDef crate = hook;
  crate.name = "crate";
  crate.position = world->pose(tackle)->position - Vector3(0.0, 0.4, 0.0);
  crate.mass = 30.0;
  const auto hung = world->edit([&](Edit& edit) {
    FixedJoint shackle;
    shackle.name = "shackle";
    shackle.body_a = edit.id(tackle);
    shackle.body_b = edit.id(edit.add(crate));
    shackle.anchor = crate.position;
    edit.add(std::make_shared<FixedJoint>(shackle));
  });
  if (!hung || !turn(5.0, 150) || !turn(0.0, 200)) return 1;
  const double tension = *world->tension(*world->cable("rope"), 0);
  const auto left = world->edit([&](Edit& edit) { edit.remove(*world->joint("shackle")); });
  return left && tension > 300.0 && tension < 330.0 ? 0 : 1;
}
