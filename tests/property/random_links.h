#pragma once
// Links of a random machine and the bodies they are on.

#include <memory>
#include <string>

#include "tests/property/random_machine.h"
#include "tests/support/random.h"

namespace sheave::test {

/// Where a link stands.
struct Place {
  Vector3 center = Vector3::Zero();           ///< [m]
  Quaternion frame = Quaternion::Identity();  ///< its z axis is the normal of the cable's plane
  bool flat = true;                           ///< all links of the cable share the plane
  Winding winding = Winding::counter_clockwise;
  bool open = true;  ///< of a cable with ends, which passes from left to right
};

/// Draws links and adds their bodies to a machine.
class LinkMaker {
 public:
  LinkMaker(Random& random, const Traits& traits, Machine& machine)
      : random_(random), traits_(traits), machine_(machine) {}

  [[nodiscard]] std::shared_ptr<const LinkDef> end_link(const Place& place);
  [[nodiscard]] std::shared_ptr<const LinkDef> middle_link(const Place& place);

 private:
  // Bodies: each is added to the machine.
  BodyId add(BodyDef body);
  /// A body that can carry points and axles, at the place; the world at times.
  BodyId add_block(const Place& place, bool may_be_world);
  /// A wheel about the place's normal, with a radius of `radius`.
  BodyId add_wheel(const Place& place, double radius, bool may_be_massless);
  /// A body with corners.
  BodyId add_outline(const Place& place);
  /// Lets the body move as its mobility allows.
  void set_going(BodyDef& body, const Vector3& normal);
  /// A mobility other than rotor and slider that keeps the place's plane if the machine is flat.
  void choose_carrier(BodyDef& body, const Place& place);

  std::shared_ptr<LinkDef> point_link(const Place& place, bool pinhole);
  std::shared_ptr<LinkDef> wheel_link(const Place& place);
  /// Body-frame coordinates of a random point near the place.
  Vector3 point_near(BodyId body, const Place& place, double distance);

  Random& random_;
  const Traits& traits_;
  Machine& machine_;
};

/// The link in a few words.
[[nodiscard]] std::string describe(const LinkDef& link);

}  // namespace sheave::test
