#include "tests/property/random_links.h"

#include <sstream>

#include "cable/links/hybrid.h"
#include "cable/links/pinhole.h"
#include "cable/links/spool.h"
#include "engine/shapes/cylinder.h"
#include "tests/support/shapes.h"

namespace sheave::test {
namespace {

constexpr double largest_radius = 0.3;  // [m]

std::string spelled(const Vector3& v) {
  std::ostringstream out;
  out << '[' << v.x() << ' ' << v.y() << ' ' << v.z() << ']';
  return out.str();
}

}  // namespace

BodyId LinkMaker::add(BodyDef body) {
  body.name = std::to_string(machine_.model.bodies.size());
  return machine_.model.add(std::move(body));
}

void LinkMaker::set_going(BodyDef& body, const Vector3& normal) {
  const Vector3 velocity = random_.vector(1.0);
  const Vector3 spin = random_.vector(3.0);
  const bool moves = !traits_.at_rest && random_.chance(0.8);
  const Vector3 axis = body.axis.value_or(normal).normalized();
  if (body.mobility == Mobility::kinematic) {
    // In the plane, so that flat machines stay flat.
    body.oscillation = 0.1 * (velocity - normal * normal.dot(velocity));
    body.oscillation_frequency = random_.between(0.5, 3.0);
    body.oscillation_phase = random_.between(0.0, 6.0);
    body.angular_velocity = spin.dot(normal) * normal;
    return;
  }
  if (!moves) return;
  switch (body.mobility) {
    case Mobility::free:
      body.velocity = velocity;
      body.angular_velocity = spin;
      break;
    case Mobility::planar:
      body.velocity = velocity - axis * axis.dot(velocity);
      body.angular_velocity = axis * axis.dot(spin);
      break;
    case Mobility::slider:
      body.velocity = axis * axis.dot(velocity);
      break;
    case Mobility::rotor:
      if (!body.mount && body.spin_inertia.value_or(1.0) > 0.0)
        body.angular_velocity = axis * axis.dot(spin);
      break;
    case Mobility::fixed:
    case Mobility::kinematic:
    case Mobility::knot:
      break;
  }
}

void LinkMaker::choose_carrier(BodyDef& body, const Place& place) {
  const Vector3 normal = place.frame * Vector3::UnitZ();
  const int kind = random_.below(traits_.kinematic ? 6 : 5);
  if (kind == 5) {
    body.mobility = Mobility::kinematic;
  } else if (kind >= 3 && traits_.free_bodies && traits_.skew) {
    body.mobility = Mobility::free;
  } else {
    body.mobility = Mobility::planar;
    body.axis = normal;
  }
  set_going(body, normal);
}

BodyId LinkMaker::add_block(const Place& place, bool may_be_world) {
  if (may_be_world && random_.chance(0.3)) return BodyId::world();
  BodyDef body = lump("", place.center, random_.between(0.5, 3.0));
  body.orientation = place.frame * rotation_by(random_.between(-3.0, 3.0) * Vector3::UnitZ());
  if (random_.chance(0.25)) {
    body.mobility = Mobility::slider;
    const double angle = random_.between(0.0, 2.0 * pi);
    body.axis = place.frame * Vector3(std::cos(angle), std::sin(angle), 0.0);
    set_going(body, place.frame * Vector3::UnitZ());
  } else {
    choose_carrier(body, place);
  }
  return add(body);
}

BodyId LinkMaker::add_wheel(const Place& place, double radius, bool may_be_massless) {
  BodyDef body;
  body.position = place.center;
  body.orientation = place.frame * rotation_by(random_.between(-3.0, 3.0) * Vector3::UnitZ());
  body.mass = random_.between(0.2, 2.0);
  body.shapes.push_back({make<Cylinder>([&](Cylinder& c) { c.radius = radius, c.length = 0.1; })});
  const double kind = random_.between(0.0, 1.0);
  if (kind < 0.45) {
    body.mobility = Mobility::rotor;
  } else if (kind < 0.7 && traits_.mounted) {
    body.mobility = Mobility::rotor;
    Place block = place;
    // One draw per statement: compilers may evaluate arguments in any order.
    const double across = random_.between(-0.2, 0.2);
    const double along = random_.between(-0.2, 0.2);
    block.center += place.frame * Vector3(along, across, 0);
    body.mount = add_block(block, false);
  } else {
    choose_carrier(body, place);
  }
  if (body.mobility == Mobility::rotor) {
    body.axis = place.frame * Vector3::UnitZ();
    if (may_be_massless && traits_.massless && random_.chance(0.2)) body.spin_inertia = 0.0;
    set_going(body, *body.axis);
  }
  return add(body);
}

BodyId LinkMaker::add_outline(const Place& place) {
  BodyDef body;
  body.position = place.center;
  body.orientation = place.frame * rotation_by(random_.between(-3.0, 3.0) * Vector3::UnitZ());
  body.mass = random_.between(0.5, 3.0);
  const int kind = random_.below(3);
  std::vector<Vector3> points;
  for (int count = 4 + random_.below(9); count > 0; --count) {
    points.push_back(0.17 * random_.vector(1.0));
  }
  if (kind == 0) {
    body.shapes.push_back({box(Vector3::Constant(0.22) + random_.vector(0.15))});
  } else if (kind == 1) {
    for (Vector3& point : points) point.z() = 0.0;
    body.shapes.push_back({polygon(points, 0.2)});
  } else {
    for (Vector3& point : points) point.z() *= 2.0;
    points.emplace_back(0.0, 0.0, 0.2), points.emplace_back(0.0, 0.0, -0.2);
    body.shapes.push_back({polyhedron(points)});
  }
  if (kind == 0 && random_.chance(0.5)) {
    body.mobility =
        Mobility::rotor;  // the others' centres of mass are not on an axle through the origin
    body.axis = place.frame * Vector3::UnitZ();
    set_going(body, *body.axis);
  } else {
    choose_carrier(body, place);
  }
  return add(body);
}

Vector3 LinkMaker::point_near(BodyId body, const Place& place, double distance) {
  Vector3 offset = random_.vector(distance);
  if (place.flat) offset.z() = 0.0;
  const Vector3 point = place.center + place.frame * offset;
  if (body.is_world()) return point;
  const BodyDef& def = machine_.model.bodies[static_cast<std::size_t>(body.index)];
  return def.orientation.conjugate() * (point - def.position);
}

std::shared_ptr<LinkDef> LinkMaker::point_link(const Place& place, bool pinhole) {
  const BodyId body = add_block(place, true);
  const Vector3 point = point_near(body, place, 0.15);
  if (!pinhole) return attach(body, point);
  auto link = std::make_shared<PinholeLink>();
  link->body = body;
  link->point = point;
  if (traits_.friction && random_.chance(0.4)) link->friction = random_.between(0.0, 0.6);
  return link;
}

std::shared_ptr<LinkDef> LinkMaker::wheel_link(const Place& place) {
  if (traits_.outlines && random_.chance(0.25)) return roll(add_outline(place), place.winding);
  const double radius = random_.between(0.05, largest_radius);
  if (random_.chance(0.15)) {
    // A circle that the body does not show, off its centre.
    const BodyId body = add_block(place, false);
    auto link = roll(body, place.winding);
    link->center = point_near(body, place, 0.1);
    link->radius = 0.7 * radius;
    return link;
  }
  return roll(add_wheel(place, radius, true), place.winding);
}

std::shared_ptr<const LinkDef> LinkMaker::middle_link(const Place& place) {
  const double kind = random_.between(0.0, 1.0);
  if (kind < 0.2) return point_link(place, true);
  if (kind < 0.27) return point_link(place, false);
  const bool lifted = traits_.lifted && place.open && random_.chance(0.08);
  Place here = place;
  // Well off the cable: a wheel that it cuts at time 0 would be wound on at once, all in one
  // substep.
  const double side = place.winding == Winding::clockwise ? -1.0 : 1.0;
  if (lifted) here.center += place.frame * Vector3(0.0, side * random_.between(1.2, 1.6), 0.0);
  auto link = std::static_pointer_cast<RollingLink>(wheel_link(here));
  if (traits_.friction && random_.chance(0.2)) link->friction = random_.between(0.0, 0.4);
  if (lifted) {
    link->lifted = true;
  } else if (random_.chance(0.15)) {
    link->turns = 1 + random_.below(3);
  }
  return link;
}

std::shared_ptr<const LinkDef> LinkMaker::end_link(const Place& place) {
  const double kind = random_.between(0.0, 1.0);
  if (kind < 0.55) return point_link(place, false);
  const double radius = random_.between(0.05, largest_radius);
  // Little, so that it may be used up, or plenty.
  const double stored = random_.between(0.0, 1.0) * (random_.chance(0.5) ? 0.05 : 3.0);
  if (kind < 0.7 || !traits_.changing_ends) {
    auto link = roll(add_wheel(place, radius, false), place.winding);
    // It has no other end to come to: used up, it would go on with a negative stored length, which
    // hybrid ends are for.
    link->stored_length = 50.0 + stored;
    return link;
  }
  if (kind < 0.85) {
    auto link = std::make_shared<HybridLink>();
    link->body = add_wheel(place, radius, false);
    link->winding = place.winding;
    link->stored_length = stored;
    return link;
  }
  auto link = std::make_shared<SpoolLink>();
  link->body = add_wheel(place, 0.7 * radius, false);
  link->winding = place.winding;
  link->stored_length = stored;
  const double pitch = random_.chance(0.6) ? random_.between(0.0, 0.02) : 0.0;
  link->layer_pitch = traits_.layers ? pitch : 0.0;
  return link;
}

std::string describe(const LinkDef& link) {
  std::ostringstream out;
  out << link.type() << '(';
  out << (link.body.is_world() ? "world" : std::to_string(link.body.index));
  const auto wound = [&](Winding w) { out << (w == Winding::clockwise ? " cw" : " ccw"); };
  if (const auto* a = dynamic_cast<const AttachmentLink*>(&link)) {
    out << ' ' << spelled(a->point);
  } else if (const auto* p = dynamic_cast<const PinholeLink*>(&link)) {
    out << ' ' << spelled(p->point) << " mu " << p->friction;
  } else if (const auto* r = dynamic_cast<const RollingLink*>(&link)) {
    wound(r->winding.value_or(Winding::counter_clockwise));
    if (r->center) out << " center " << spelled(*r->center);
    if (r->radius) out << " radius " << *r->radius;
    if (r->friction) out << " mu " << *r->friction;
    if (r->lifted) out << " lifted";
    if (r->turns > 0) out << " turns " << r->turns;
  } else if (const auto* h = dynamic_cast<const HybridLink*>(&link)) {
    wound(h->winding.value_or(Winding::counter_clockwise));
    out << " stored " << h->stored_length;
  } else if (const auto* s = dynamic_cast<const SpoolLink*>(&link)) {
    wound(s->winding.value_or(Winding::counter_clockwise));
    out << " stored " << s->stored_length << " pitch " << s->layer_pitch;
  }
  out << ')';
  return out.str();
}

}  // namespace sheave::test
