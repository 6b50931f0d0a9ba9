// Somebody else's program: an Atwood machine built in C++, stepped, and its tension read.

#include <cmath>
#include <cstdio>
#include <memory>

#include <sheave/sheave.h>

namespace {

sheave::BodyDef weight(const char* name, double mass, double x) {
  sheave::BodyDef body;
  body.name = name;
  body.mobility = sheave::Mobility::slider;
  body.axis = sheave::Vector3::UnitY();
  body.position = {x, 0.0, 0.0};
  body.mass = mass;
  return body;
}

sheave::BodyDef wheel(double radius) {
  auto shape = std::make_shared<sheave::Cylinder>();
  shape->radius = radius;
  sheave::BodyDef body;
  body.name = "wheel";
  body.mobility = sheave::Mobility::rotor;
  body.position = {0.0, 2.0, 0.0};
  body.mass = 1.0;
  body.shapes = {{shape}};
  return body;
}

std::shared_ptr<sheave::LinkDef> attached_to(sheave::BodyId body) {
  auto link = std::make_shared<sheave::AttachmentLink>();
  link->body = body;
  return link;
}

}  // namespace

int main() {
  sheave::Model model;
  model.gravity = {0.0, -10.0, 0.0};
  const auto light = model.add(weight("light", 1.0, -0.5));
  const auto heavy = model.add(weight("heavy", 2.0, 0.5));
  const auto over = std::make_shared<sheave::RollingLink>();
  over->body = model.add(wheel(0.5));
  over->winding = sheave::Winding::clockwise;
  sheave::CableDef cable;
  cable.name = "cable";
  cable.links = {attached_to(light), over, attached_to(heavy)};

  auto world = sheave::LiveWorld::create(model, {cable});
  if (!world) {
    for (const auto& error : world.errors()) std::puts(error.message.c_str());
    return 1;
  }
  for (int i = 0; i < 60; ++i) {
    if (!world->step().ok()) return 1;
  }
  sheave::Errors faults;
  const auto held = world->cable("cable").value(faults);
  const double tension = world->tension(held, 0).value(faults);
  if (!faults.empty()) return std::puts(faults[0].message.c_str()), 1;
  // a = (m2 - m1) g / (m1 + m2 + I / r^2) = 10 / 3.5 and T = m1 (g + a).
  const double expected = 1.0 * (10.0 + 10.0 / 3.5);
  std::printf("tension %.6f N, closed form %.6f N\n", tension, expected);
  return std::abs(tension - expected) < 1e-3 * expected ? 0 : 1;
}
