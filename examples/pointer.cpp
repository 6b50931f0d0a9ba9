// A pointer drags the end of a rope, which runs over a wheel to a weight, 60 times a second.

#include <cmath>
#include <cstdio>

#include <sheave/sheave.h>

int main() {
  using namespace sheave;
  Model model;
  model.gravity = {0.0, -9.81, 0.0};
  model.step.dt = 1.0 / 60.0;
  auto shape = std::make_shared<Cylinder>();
  shape->radius = 0.3;
  BodyDef wheel;
  wheel.name = "wheel";
  wheel.mobility = Mobility::rotor;
  wheel.mass = 2.0;
  wheel.shapes = {{shape}};
  BodyDef weight;
  weight.name = "weight";
  weight.mobility = Mobility::slider;
  weight.axis = Vector3::UnitY();
  weight.position = {-0.3, -5.0, 0.0};
  weight.mass = 3.0;
  BodyDef hand;
  hand.name = "hand";
  hand.mobility = Mobility::kinematic;
  hand.position = {0.3, -2.0, 0.0};
  auto hook = std::make_shared<AttachmentLink>();
  hook->body = model.add(weight);
  auto over = std::make_shared<RollingLink>();
  over->body = model.add(wheel);
  over->winding = Winding::clockwise;
  auto grip = std::make_shared<AttachmentLink>();
  grip->body = model.add(hand);
  CableDef rope;
  rope.name = "rope";
  rope.links = {hook, over, grip};

  auto world = LiveWorld::create(model, {rope});
  if (!world) return std::puts(world.errors()[0].message.c_str()), 1;
  const auto pointer = *world->body("hand"), load = *world->body("weight");
  Vector3 before = hand.position;
  for (int frame = 1; frame <= 300; ++frame) {
    const double phase = 0.02 * frame;
    const Vector3 at{0.3 + std::sin(phase), -2.0 - 0.5 * (1.0 - std::cos(phase)),
                     0.5 * std::sin(2.0 * phase)};
    // The velocity that the pointer has makes its way smooth.
    const Vector3 velocity = (at - before) / model.step.dt;
    const Errors errors = world->set_motion(pointer, {.position = at, .velocity = velocity});
    if (!errors.empty()) return std::puts(errors[0].message.c_str()), 1;
    if (!world->step().ok()) return 1;
    before = at;
  }
  const double height = world->pose(load)->position.y();
  std::printf("the weight is at %.3f m\n", height);
  return std::abs(height + 5.0) < 2.0 ? 0 : 1;
}
