#include "fuzz/heap.h"

#include "cable/links/attachment.h"
#include "cable/links/pinhole.h"
#include "engine/shapes/capsule.h"
#include "engine/shapes/cylinder.h"
#include "engine/shapes/half_space.h"
#include "engine/shapes/sphere.h"
#include "tests/property/wide_joints.h"
#include "tests/support/shapes.h"

namespace sheave::fuzz {
namespace {

using test::Machine;
using test::Random;

/// Bodies of about 0.3 m.
class HeapMaker {
 public:
  explicit HeapMaker(Random& random) : random_(random), flat_(random.chance(0.3)) {}

  Machine make() {
    machine_.model.gravity = test::down;
    if (random_.chance(0.1)) machine_.model.gravity.setZero();
    if (random_.chance(0.8)) add_floor();
    const int count = 1 + random_.below(6);
    for (int i = 0; i < count; ++i) add_body(i);
    if (machine_.model.bodies.empty()) machine_.model.add(test::lump("lump", test::down, 1.0));
    if (random_.chance(0.2)) {
      attempt([&](Machine& m) { m.model.ground.emplace().point.y() = -random_.between(0.0, 0.3); });
    }
    for (int joints = random_.below(3); joints > 0; --joints) {
      attempt([&](Machine& m) {
        auto joint = test::random_joint(random_, m.model, flat_);
        if (!joint) return;
        joint->name = "joint" + std::to_string(m.model.joints.size());
        m.model.joints.push_back(std::move(joint));
      });
    }
    if (random_.chance(0.3)) attempt([&](Machine& m) { add_cable(m); });
    return std::move(machine_);
  }

 private:
  /// Keeps a change if the resulting machine is valid.
  template <class Make>
  void attempt(const Make& change) {
    Machine larger = machine_;
    change(larger);
    if (Simulation::check(larger.model, larger.cables).empty()) machine_ = std::move(larger);
  }

  void add_floor() {
    BodyDef floor;
    floor.name = "floor";
    floor.mobility = random_.chance(0.8) ? Mobility::fixed : Mobility::kinematic;
    if (floor.mobility == Mobility::kinematic) {
      floor.oscillation = random_.vector(0.1);
      floor.oscillation_frequency = random_.between(0.0, 3.0);
    }
    const double slope = random_.chance(0.5) ? 0.0 : random_.between(-0.5, 0.5);
    if (random_.chance(0.7)) {
      const Vector3 normal(std::sin(slope), std::cos(slope), 0.0);
      floor.shapes.push_back({test::make<HalfSpace>([&](HalfSpace& s) { s.normal = normal; })});
    } else {
      floor.shapes.push_back({test::box(Vector3(5.0, 1.0, 5.0))});
      floor.position = rotation_by(slope * Vector3::UnitZ()) * Vector3(0.0, -0.5, 0.0);
      floor.orientation = rotation_by(slope * Vector3::UnitZ());
    }
    attempt([&](Machine& m) { collide(m, m.model.add(floor)); });
  }
  void collide(Machine& m, BodyId body) {
    ColliderDef& collider = m.model.colliders.emplace_back();
    collider.body = body;
    collider.friction = random_.chance(0.7) ? random_.between(0.0, 1.0) : 0.0;
    if (random_.chance(0.2))
      collider.static_friction = collider.friction + random_.between(0.0, 0.3);
    if (random_.chance(0.3)) collider.restitution = random_.between(0.0, 1.0);
    if (random_.chance(0.2)) collider.compliance = std::pow(10.0, random_.between(-7.0, -3.0));
    if (random_.chance(0.2)) collider.groups = {random_.chance(0.5) ? "a" : "b"};
    if (random_.chance(0.2)) collider.ignores = {random_.chance(0.5) ? "a" : "b"};
  }
  std::shared_ptr<const Shape> shape() {
    const double size = random_.between(0.05, 0.3);
    switch (random_.below(6)) {
      case 0:
        return test::box(Vector3::Constant(size) + random_.vector(0.8 * size));
      case 1:
        return test::make<Sphere>([&](Sphere& s) { s.radius = 0.5 * size; });
      case 2:
        return test::make<Cylinder>([&](Cylinder& c) {
          c.radius = 0.5 * size;
          c.length = random_.between(0.02, 0.5);
        });
      case 3:
        return test::make<Capsule>([&](Capsule& c) {
          c.radius = 0.3 * size;
          c.length = random_.between(0.02, 0.5);
        });
      case 4:
        return test::polygon(points(true), size);
      default:
        return test::polyhedron(points(false));
    }
  }
  std::vector<Vector3> points(bool flat) {
    std::vector<Vector3> corners;
    for (int count = 4 + random_.below(8); count > 0; --count) {
      corners.push_back(random_.vector(0.2));
      if (flat) corners.back().z() = 0.0;
    }
    return corners;
  }
  Mobility mobility() {
    if (random_.chance(0.7)) return flat_ ? Mobility::planar : Mobility::free;
    return static_cast<Mobility>(random_.below(static_cast<int>(Mobility::knot)));
  }
  void add_body(int index) {
    BodyDef body;
    body.name = "body" + std::to_string(index);
    body.mobility = mobility();
    body.position = Vector3(0.15 * random_.below(4), random_.between(0.05, 0.2) + 0.2 * index,
                            flat_ ? 0.0 : random_.between(-0.1, 0.1));
    if (random_.chance(0.5)) {
      const Vector3 turn = random_.vector(3.0);
      body.orientation = rotation_by(flat_ ? Vector3(turn.z() * Vector3::UnitZ()) : turn);
    }
    const int shapes = 1 + (random_.chance(0.2) ? 1 : 0);
    for (int i = 0; i < shapes; ++i) {
      PlacedShape placed;
      placed.shape = shape();
      if (i > 0) placed.position = 0.5 * random_.vector(0.2);
      if (random_.chance(0.2)) placed.orientation = random_.orientation();
      body.shapes.push_back(std::move(placed));
    }
    if (random_.chance(0.5)) {
      body.mass = std::pow(10.0, random_.between(-1.0, 2.0));
    } else {
      body.density = std::pow(10.0, random_.between(1.0, 4.0));
    }
    if (body.mobility == Mobility::slider) body.axis = Vector3::UnitY();
    if (body.mobility == Mobility::free || body.mobility == Mobility::kinematic) {
      body.velocity = random_.vector(2.0);
      body.angular_velocity = random_.vector(5.0);
    }
    if (body.mobility == Mobility::planar) {
      body.velocity = Vector3(random_.between(-2.0, 2.0), random_.between(-2.0, 0.0), 0.0);
      body.angular_velocity.z() = random_.between(-5.0, 5.0);
    }
    if (body.mobility == Mobility::fixed || body.mobility == Mobility::kinematic) {
      body.mass.reset();
      body.density.reset();
    }
    const bool collides = random_.chance(0.9);
    attempt([&](Machine& m) {
      const BodyId id = m.model.add(body);
      if (collides) collide(m, id);
    });
  }
  void add_cable(Machine& m) {
    CableDef cable;
    cable.name = "rope";
    const auto bodies = static_cast<int>(m.model.bodies.size());
    const int links = 2 + random_.below(2);
    for (int i = 0; i < links; ++i) {
      const BodyId body{random_.below(bodies + 1) - 1};
      const Vector3 point = random_.vector(0.2) + (body.is_world() ? 2.0 : 0.0) * Vector3::UnitY();
      if (i == 0 || i + 1 == links) {
        cable.links.push_back(test::attach(body, point));
      } else {
        auto hole = std::make_shared<PinholeLink>();
        hole->body = body;
        hole->point = point;
        cable.links.push_back(std::move(hole));
      }
    }
    m.cables.push_back(std::move(cable));
  }

  Random& random_;
  Machine machine_;
  bool flat_;
};

}  // namespace

Machine heap(Random& random) { return HeapMaker(random).make(); }

}  // namespace sheave::fuzz
