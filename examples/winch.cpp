// A winch keeps the tension of its rope while what pulls at the other end gets stronger.

#include <cmath>
#include <cstdio>
#include <memory>

#include <sheave/sheave.h>

int main() {
  using namespace sheave;
  Model model;
  model.step.dt = 1.0 / 1000.0;
  auto shape = std::make_shared<Cylinder>();
  shape->radius = 0.2;
  BodyDef drum;
  drum.name = "drum";
  drum.mobility = Mobility::rotor;
  drum.mass = 5.0;
  drum.shapes = {{shape}};
  drum.drive = DriveKind::speed;
  drum.drive_values = {0.0};
  BodyDef boat;
  boat.name = "boat";
  boat.mobility = Mobility::slider;
  boat.axis = Vector3::UnitX();
  boat.position = {10.0, 0.2, 0.0};
  boat.mass = 200.0;
  auto spool = std::make_shared<SpoolLink>();
  spool->body = model.add(drum);
  spool->winding = Winding::clockwise;
  spool->stored_length = 50.0;
  auto cleat = std::make_shared<AttachmentLink>();
  cleat->body = model.add(boat);
  CableDef rope;
  rope.name = "rope";
  rope.compliance = 5e-5;
  rope.damping = 10.0;
  rope.links = {spool, cleat};

  auto world = LiveWorld::create(model, {rope});
  if (!world) return std::puts(world.errors()[0].message.c_str()), 1;
  const auto winch = *world->body("drum"), load = *world->body("boat");
  const auto line = *world->cable("rope");
  double sum = 0.0;
  while (world->time() < 6.0) {
    const double wind = 100.0 + (world->time() > 3.0 ? 20.0 * (world->time() - 3.0) : 0.0);
    const double error = *world->tension(line, 0) - 100.0;
    sum += error * model.step.dt;
    Errors errors = world->set_force(load, {.force = {wind, 0.0, 0.0}});
    if (errors.empty()) errors = world->set_speed(winch, -(0.07 * error + 5.0 * sum));
    if (!errors.empty()) return std::puts(errors[0].message.c_str()), 1;
    if (!world->step().ok()) return 1;
  }
  const double tension = *world->tension(line, 0);
  std::printf("the boat is at %.2f m, the tension is %.2f N\n", world->pose(load)->position.x(),
              tension);
  return std::abs(tension - 100.0) < 1.0 ? 0 : 1;
}
