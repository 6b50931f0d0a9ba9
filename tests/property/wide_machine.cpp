#include "tests/property/wide_machine.h"

#include <algorithm>
#include <cmath>

#include "engine/shapes/cylinder.h"
#include "engine/shapes/half_space.h"
#include "engine/shapes/sphere.h"
#include "tests/property/link_change.h"
#include "tests/property/wide_joints.h"
#include "tests/support/shapes.h"

namespace sheave::test {
namespace {

bool accepted(const Machine& machine) {
  return Simulation::create(machine.model, machine.cables).operator bool();
}

/// Adds features to a machine.
class Widener {
 public:
  Widener(Random& random, Machine machine, bool flat)
      : random_(random), machine_(std::move(machine)), flat_(flat) {}

  Machine widen() {
    if (random_.chance(0.5)) attempt([&](Machine& m) { add_posts(m); });
    if (random_.chance(0.6)) attempt([&](Machine& m) { add_friction(m); });
    if (random_.chance(0.4)) attempt([&](Machine& m) { add_body_drive(m); });
    if (random_.chance(0.4)) attempt([&](Machine& m) { add_loads(m); });
    for (int i = random_.below(5); i > 0; --i) attempt([&](Machine& m) { add_joint(m); });
    if (random_.chance(0.4)) attempt([&](Machine& m) { add_second_cable(m); });
    if (random_.chance(0.25)) attempt([&](Machine& m) { add_feed(m); });
    if (random_.chance(0.3)) attempt([&](Machine& m) { add_obstacle(m); });
    if (random_.chance(0.3)) attempt([&](Machine& m) { add_contacts(m); });
    if (random_.chance(0.15)) attempt([&](Machine& m) { add_ground(m); });
    if (random_.chance(0.1)) machine_.cables[0].breaking_tension = random_.between(20.0, 300.0);
    return std::move(machine_);
  }

 private:
  template <class Change>
  void attempt(const Change& change) {
    Machine wider = machine_;
    change(wider);
    if (accepted(wider)) machine_ = std::move(wider);
  }

  /// Wheels on fixed axles become posts over which the cable slides, some beside each other.
  void add_posts(Machine& m) {
    const double share = random_.between(0.2, 1.0);
    for (auto& link : m.cables[0].links) {
      const auto* rolling = dynamic_cast<const RollingLink*>(link.get());
      if (rolling == nullptr || link->body.is_world() || rolling->stored_length) continue;
      BodyDef& body = m.model.bodies[static_cast<std::size_t>(link->body.index)];
      if (body.mobility != Mobility::rotor || body.mount || !random_.chance(share)) continue;
      body.mobility = Mobility::fixed;
      body.axis.reset();
      body.spin_inertia.reset();
      body.angular_velocity.setZero();
      auto sliding = std::make_shared<RollingLink>(*rolling);
      sliding->friction = random_.between(0.0, 0.5);
      link = sliding;
    }
  }
  void add_friction(Machine& m) {
    for (auto& link : m.cables[0].links) {
      if (!random_.chance(0.5)) continue;
      const double friction = random_.between(0.0, 0.5);
      if (const auto* hole = dynamic_cast<const PinholeLink*>(link.get())) {
        auto rough = std::make_shared<PinholeLink>(*hole);
        rough->friction = friction;
        link = rough;
      } else if (const auto* wheel = dynamic_cast<const RollingLink*>(link.get())) {
        auto rough = std::make_shared<RollingLink>(*wheel);
        if (!wheel->stored_length) rough->friction = friction;
        link = rough;
      }
    }
  }
  void add_body_drive(Machine& m) {
    for (BodyDef& body : m.model.bodies) {
      if (body.mobility != Mobility::rotor || body.mount || !random_.chance(0.4)) continue;
      body.angular_velocity.setZero();
      const int kind = random_.below(3);
      body.drive = kind == 0 ? DriveKind::speed : kind == 1 ? DriveKind::angle : DriveKind::torque;
      const double size = kind == 2 ? 5.0 : 2.0;
      if (kind == 1 || random_.chance(0.5)) {
        body.drive_times = {0.0, 0.1, 0.3};
        body.drive_values = {0.0, random_.between(-0.1, 0.1) * size,
                             random_.between(-0.3, 0.3) * size};
      } else {
        body.drive_values = {random_.between(-size, size)};
      }
    }
  }
  void add_loads(Machine& m) {
    for (BodyDef& body : m.model.bodies) {
      if (!random_.chance(0.4)) continue;
      Vector3 force = random_.vector(10.0);
      if (flat_) force.z() = 0.0;
      body.force = force;
      if (body.mobility == Mobility::rotor) body.torque.z() = random_.between(-1.0, 1.0);
      if (random_.chance(0.5)) body.damping = random_.between(0.0, 5.0);
      if (random_.chance(0.5)) body.angular_damping = random_.between(0.0, 0.5);
      if (body.mobility == Mobility::rotor) body.damping = 0.0, body.force.setZero();
      if (body.mobility == Mobility::slider) body.angular_damping = 0.0;
      if (body.mobility == Mobility::fixed || body.mobility == Mobility::kinematic) {
        body.damping = body.angular_damping = 0.0;
        body.force.setZero();
      }
    }
  }
  void add_joint(Machine& m) {
    auto joint = random_joint(random_, m.model, flat_);
    if (!joint) return;
    joint->name = "joint" + std::to_string(m.model.joints.size());
    m.model.joints.push_back(joint);
  }
  /// From the world or a body to a body, through holes at times.
  void add_second_cable(Machine& m) {
    CableDef cable;
    cable.name = "second";
    const int bodies = static_cast<int>(m.model.bodies.size());
    const auto point_of = [&](BodyId body) -> Vector3 {
      if (!body.is_world()) return {0.1 * random_.between(-1.0, 1.0), 0.05, 0.0};
      const double y = random_.between(1.0, 3.0);
      const double x = random_.between(0.0, 5.0);
      return {x, y, 0.0};
    };
    const int count = 2 + random_.below(3);
    for (int i = 0; i < count; ++i) {
      const bool world = random_.chance(0.4);
      const BodyId body = world || bodies == 0 ? BodyId::world() : BodyId{random_.below(bodies)};
      if (i == 0 || i + 1 == count) {
        cable.links.push_back(attach(body, point_of(body)));
        continue;
      }
      auto hole = std::make_shared<PinholeLink>();
      hole->body = body;
      hole->point = point_of(body);
      if (random_.chance(0.5)) hole->friction = random_.between(0.0, 0.4);
      cable.links.push_back(hole);
    }
    if (random_.chance(0.5)) {
      cable.axial_stiffness = std::pow(10.0, random_.between(2.0, 5.0));
      if (random_.chance(0.5)) cable.damping = random_.between(0.0, 20.0);
    }
    m.cables.push_back(cable);
  }
  void add_feed(Machine& m) {
    for (CableDef& cable : m.cables) {
      if (cable.closed || !random_.chance(0.6)) continue;
      for (auto* end : {&cable.links.front(), &cable.links.back()}) {
        const auto* point = dynamic_cast<const AttachmentLink*>(end->get());
        if (point == nullptr || !random_.chance(0.6)) continue;
        auto feeding = std::make_shared<AttachmentLink>(*point);
        feeding->feed_speed = random_.between(-0.3, 0.3);
        *end = feeding;
      }
    }
  }
  /// A body beside a span, which the cable may come to lie on.
  void add_obstacle(Machine& m) {
    const Result<Simulation> simulation = Simulation::create(m.model, m.cables);
    const auto spans = simulation->cable_reports()[0].spans;
    const SpanReport& span =
        spans[static_cast<std::size_t>(random_.below(static_cast<int>(spans.size())))];
    if (!(span.length > 0.0)) return;  // of a link that is lifted
    BodyDef body = lump("obstacle", 0.5 * (span.start + span.end), random_.between(0.5, 2.0));
    const Vector3 along = span.end - span.start;
    const Vector3 side = along.cross(Vector3::UnitZ()).normalized();
    body.position += (random_.chance(0.5) ? 1.0 : -1.0) * random_.between(0.3, 0.5) * side;
    body.shapes.clear();
    if (random_.chance(0.5)) {
      body.shapes.push_back(
          {make<Cylinder>([&](Cylinder& c) { c.radius = 0.15, c.length = 0.3; })});
    } else {
      body.shapes.push_back({box(Vector3(0.2, 0.25, 0.3))});
    }
    const int kind = random_.below(3);
    body.mobility = kind == 0   ? Mobility::fixed
                    : kind == 1 ? Mobility::planar
                                : Mobility::kinematic;
    if (kind == 0) body.inertia.reset();
    if (kind == 2) body.velocity = -0.5 * (body.position - 0.5 * (span.start + span.end));
    body.wrappable = true;
    m.model.add(body);
    m.cables[0].wrap_friction = random_.chance(0.5) ? random_.between(0.0, 0.4) : 0.0;
  }
  /// A floor or a slope, and things that fall onto it or already lie on it.
  void add_contacts(Machine& m) {
    BodyDef floor;
    floor.name = "floor";
    floor.mobility = Mobility::fixed;
    floor.position = Vector3(0.0, -2.0, 0.0);
    const double slope = random_.chance(0.5) ? 0.0 : random_.between(-0.4, 0.4);
    const Vector3 normal(-std::sin(slope), std::cos(slope), 0.0);
    floor.shapes.push_back({make<HalfSpace>([&](HalfSpace& s) { s.normal = normal; })});
    const auto collide = [&](BodyId body) {
      ColliderDef& collider = m.model.colliders.emplace_back();
      collider.body = body;
      if (random_.chance(0.7)) collider.friction = random_.between(0.0, 0.8);
      if (random_.chance(0.3)) collider.restitution = random_.between(0.0, 1.0);
      if (random_.chance(0.2)) collider.compliance = std::pow(10.0, random_.between(-7, -4));
    };
    collide(m.model.add(floor));
    const int count = 1 + random_.below(3);
    for (int i = 0; i < count; ++i) {
      BodyDef body = lump("thing" + std::to_string(i), Vector3::Zero(), random_.between(0.5, 3.0));
      if (random_.chance(0.4)) {
        body.shapes = {{make<Sphere>([](Sphere& s) { s.radius = 0.15; })}};
        body.inertia.reset();
      }
      if (flat_) body.mobility = Mobility::planar;
      const double above = random_.chance(0.5) ? 0.0 : random_.between(0.0, 0.03);
      const double at = -2.0 + 0.5 * i;
      body.position = floor.position + rotation_by(slope * Vector3::UnitZ()) *
                                           Vector3(at, 0.15 + above, flat_ ? 0.0 : 0.1 * i);
      body.orientation = rotation_by(slope * Vector3::UnitZ());
      const double falling = random_.between(0.0, 1.0);
      const double sideways = random_.between(-1.0, 1.0);
      body.velocity = {sideways, -falling, 0.0};
      collide(m.model.add(body));
    }
  }
  void add_ground(Machine& m) {
    m.model.ground.emplace();
    // No body begins in it: their parts are within 0.6 m of their places.
    double lowest = 0.0;
    for (const BodyDef& body : m.model.bodies) lowest = std::min(lowest, body.position.y());
    m.model.ground->point.y() = lowest - 0.6 - random_.between(0.0, 0.1);
  }

  Random& random_;
  Machine machine_;
  bool flat_;
};

Traits wide_traits(Random& random) {
  Traits traits;
  traits.skew = random.chance(0.4);
  traits.kinematic = random.chance(0.3);
  traits.at_rest = random.chance(0.5);
  traits.slack = 0.2;
  return traits;
}

}  // namespace

Machine wide_machine(std::uint64_t seed) {
  Random random(seed ^ 0x51f0a3c2d4e59b77U);
  const Traits traits = wide_traits(random);
  Machine base = random_machine(seed, traits).machine;
  base.cables[0].name = "rope";
  return Widener(random, std::move(base), !traits.skew).widen();
}

Machine wide_machine(Random& random) {
  const Traits traits = wide_traits(random);
  Machine base = random_machine(random, traits).machine;
  base.cables[0].name = "rope";
  return Widener(random, std::move(base), !traits.skew).widen();
}

}  // namespace sheave::test
