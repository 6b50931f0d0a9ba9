#include "tests/support/builders.h"

#include <cmath>
#include <stdexcept>

#include "engine/joints/hinge.h"
#include "engine/shapes/box.h"
#include "engine/shapes/cylinder.h"

namespace sheave::test {

std::string text(const Errors& errors) {
  std::string all;
  for (const Error& error : errors) all += error.path + ": " + error.message + "\n";
  return all;
}

Simulation start(const Machine& machine) {
  Result<Simulation> simulation = Simulation::create(machine.model, machine.cables);
  if (!simulation) throw std::runtime_error(text(simulation.errors()));
  return std::move(*simulation);
}

World start(const Model& model) {
  Result<World> world = World::create(model);
  if (!world) throw std::runtime_error(text(world.errors()));
  return std::move(*world);
}

void run(World& world, double time) {
  const double dt = world.model().step.dt;
  while (world.state().time < time - 0.5 * dt) {
    const StepReport report = world.step();
    if (!report.ok()) throw std::runtime_error(report.divergence->message);
  }
}

StepSettings settings(double dt, int substeps, int iterations) {
  StepSettings step = StepSettings::paper();
  step.dt = dt;
  step.substeps = substeps;
  step.iterations = iterations;
  return step;
}

StepSettings direct_settings(IntegratorKind integrator, double dt, int substeps) {
  StepSettings step;
  step.dt = dt;
  step.substeps = substeps;
  step.solver = SolverKind::direct;
  step.integrator = integrator;
  return step;
}

BodyDef wheel(std::string name, const Vector3& center, double radius, double inertia) {
  BodyDef body;
  body.name = std::move(name);
  body.mobility = Mobility::rotor;
  body.position = center;
  body.mass = 1.0;
  body.inertia = Vector3(0.6 * inertia, 0.6 * inertia, inertia);
  auto shape = std::make_shared<Cylinder>();
  shape->radius = radius;
  shape->length = 0.2 * radius;
  body.shapes.push_back({shape});
  return body;
}

BodyDef sheave(std::string name, BodyId mount, const Vector3& center, double radius, double mass,
               double inertia) {
  BodyDef body = wheel(std::move(name), center, radius, inertia);
  body.mount = mount;
  body.mass = mass;
  return body;
}

BodyDef weight(std::string name, const Vector3& position, double mass) {
  BodyDef body;
  body.name = std::move(name);
  body.mobility = Mobility::slider;
  body.axis = Vector3::UnitY();
  body.position = position;
  body.mass = mass;
  return body;
}

BodyDef lump(std::string name, const Vector3& position, double mass) {
  BodyDef body;
  body.name = std::move(name);
  body.position = position;
  body.mass = mass;
  body.inertia = mass * Vector3(0.06, 0.09, 0.12);
  auto shape = std::make_shared<Box>();
  shape->size = Vector3(0.3, 0.3, 0.3);
  body.shapes.push_back({shape});
  return body;
}

std::shared_ptr<AttachmentLink> attach(BodyId body, const Vector3& point) {
  auto link = std::make_shared<AttachmentLink>();
  link->body = body;
  link->point = point;
  return link;
}

std::shared_ptr<RollingLink> roll(BodyId body, Winding winding) {
  auto link = std::make_shared<RollingLink>();
  link->body = body;
  link->winding = winding;
  return link;
}

CableDef cable(std::string name, std::initializer_list<std::shared_ptr<const LinkDef>> links) {
  CableDef def;
  def.name = std::move(name);
  def.links = links;
  return def;
}

Machine Atwood::machine() const {
  Machine m;
  m.model.gravity = down;
  m.model.step = settings(0.01, 10, 10);
  const BodyId pulley = m.model.add(wheel("wheel", Vector3::Zero(), radius, inertia));
  const BodyId a = m.model.add(weight("left", {-radius, -hang, 0.0}, m1));
  const BodyId b = m.model.add(weight("right", {radius, -hang, 0.0}, m2));
  m.cables.push_back(cable("rope", {attach(a), roll(pulley, right), attach(b)}));
  return m;
}

Machine wheel_train(int count, double m1, double m2, double radius, double inertia) {
  Machine m;
  m.model.gravity = down;
  m.model.step = settings(1.0 / 60.0, 1, 10);
  CableDef rope;
  rope.name = "rope";
  rope.links.push_back(nullptr);
  for (int i = 0; i < count; ++i) {
    const bool under = i % 2 == 1;
    const Vector3 center(3.0 * radius * i, under ? -1.5 * radius : 0.0, 0.0);
    const BodyId id = m.model.add(wheel("wheel" + std::to_string(i), center, radius, inertia));
    rope.links.push_back(roll(id, under ? left : right));
  }
  const BodyId a = m.model.add(weight("left", {-radius, -10.0, 0.0}, m1));
  const double end = 3.0 * radius * (count - 1) + radius;
  const BodyId b = m.model.add(weight("right", {end, -10.0, 0.0}, m2));
  rope.links.front() = attach(a);
  rope.links.push_back(attach(b));
  m.cables.push_back(rope);
  return m;
}

Machine Tackle::machine() const {
  Machine m;
  m.model.gravity = down;
  m.model.step = settings(0.01, 10, 10);
  const int pairs = strands / 2;
  const double top = 2.0;
  const auto strand_x = [&](int j) { return 2.0 * radius * j; };
  BodyDef body = sheave::test::weight("block", Vector3::Zero(), load - pairs * sheave_mass);
  body.mobility = block_mobility;
  body.position.x() = 0.5 * strand_x(strands - 1);
  if (block_mobility != Mobility::slider) {
    body.axis.reset();
    body.inertia = *body.mass * Vector3(0.02, 0.02, 0.02);
  }
  m.model.add(body);
  m.model.add(sheave::test::weight("effort", {strand_x(strands), 0.0, 0.0}, effort));
  CableDef rope;
  rope.name = "rope";
  rope.links.push_back(attach(BodyId::world(), {strand_x(0), top, 0.0}));
  for (int i = 0; i < pairs; ++i) {
    const std::string number = std::to_string(i);
    const BodyId lower = m.model.add(sheave::test::sheave("lower" + number, block,
                                                          {strand_x(2 * i) + radius, 0.0, 0.0},
                                                          radius, sheave_mass, inertia));
    const BodyId upper = m.model.add(
        wheel("upper" + number, {strand_x(2 * i + 1) + radius, top, 0.0}, radius, inertia));
    rope.links.push_back(roll(lower, left));
    rope.links.push_back(roll(upper, right));
  }
  rope.links.push_back(attach(weight));
  m.cables.push_back(rope);
  return m;
}

Machine cable_pendulum(double mass, double length, double angle) {
  Machine m;
  m.model.gravity = down;
  m.model.step = settings(0.01, 10, 10);
  BodyDef bob = lump("bob", length * Vector3(std::sin(angle), -std::cos(angle), 0.0), mass);
  m.model.add(bob);
  m.cables.push_back(cable("rope", {attach(BodyId::world()), attach({0})}));
  return m;
}

Machine involute() {
  Machine m;
  m.model.gravity = Vector3::Zero();
  BodyDef post = wheel("post", Vector3::Zero(), 0.2, 1.0);
  post.mobility = Mobility::fixed;
  post.axis.reset();
  const BodyId fixed = m.model.add(post);
  BodyDef ball = lump("ball", {0.2, -1.0, 0.0}, 1.0);
  ball.mobility = Mobility::planar;
  ball.velocity = {1.0, 0.0, 0.0};
  const BodyId weight = m.model.add(ball);
  auto end = roll(fixed, right);
  end->stored_length = 3.0;
  m.cables.push_back(cable("rope", {end, attach(weight)}));
  return m;
}

Machine hinged_chain() {
  Machine m;
  m.model.gravity = down;
  BodyId last = BodyId::world();
  for (int i = 0; i < 3; ++i) {
    const BodyId next =
        m.model.add(lump("part" + std::to_string(i), {0.3 + 0.6 * i, 0.0, 0.0}, 1.0));
    auto hinge = std::make_shared<HingeJoint>();
    hinge->name = "hinge" + std::to_string(i);
    hinge->body_a = last;
    hinge->body_b = next;
    hinge->anchor = {0.6 * i, 0.0, 0.0};
    hinge->axis = Vector3(0.1, i == 1 ? 1.0 : 0.2, i == 1 ? 0.1 : 1.0);
    m.model.joints.push_back(hinge);
    last = next;
  }
  return m;
}

Machine belt(double r1, double r2, double distance, double inertia1, double inertia2) {
  Machine m;
  m.model.step = settings(0.01, 10, 10);
  m.model.add(wheel("driver", Vector3::Zero(), r1, inertia1));
  m.model.add(wheel("follower", {distance, 0.0, 0.0}, r2, inertia2));
  CableDef loop = cable("belt", {roll({0}, left), roll({1}, left)});
  loop.closed = true;
  m.cables.push_back(loop);
  return m;
}

}  // namespace sheave::test
