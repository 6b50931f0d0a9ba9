#include "tests/property/machine_values.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "engine/joint.h"
#include "engine/joints/ball.h"
#include "engine/joints/cylindrical.h"
#include "engine/joints/distance.h"
#include "engine/joints/fixed.h"
#include "engine/joints/gear.h"
#include "engine/joints/hinge.h"
#include "engine/joints/plane.h"
#include "engine/joints/rack.h"
#include "engine/joints/slider.h"
#include "engine/joints/universal.h"
#include "scenes/format.h"
#include "tests/property/link_change.h"
#include "tests/support/random.h"

namespace sheave::test {
namespace {

/// A new object of the registry's type with the name `type`.
template <class Base>
std::pair<std::shared_ptr<Base>, std::span<const Field>> new_object(
    std::span<const TypeEntry<Base>> types, std::string_view type) {
  for (const TypeEntry<Base>& entry : types) {
    if (entry.name == type) return {entry.make(), entry.fields()};
  }
  throw std::logic_error("no such type");
}

template <class Base>
std::shared_ptr<Base> copy_of_typed(const Base& original, std::span<const TypeEntry<Base>> types) {
  auto [copy, fields] = new_object(types, original.type());
  for (const Field& field : fields) {
    copy_value(field, original.settings(), const_cast<void*>(copy->settings()));
  }
  return copy;
}

/// One overload per type of slot that holds numbers.
struct ChangeSlot {
  const std::function<double(double)>& change;

  void of(double& x) const { x = change(x); }
  void of(Vector3& v) const {
    for (int k = 0; k < 3; ++k) v[k] = change(v[k]);
  }
  void operator()(double* x) const { of(*x); }
  void operator()(Vector3* v) const { of(*v); }
  void operator()(std::optional<double>* x) const {
    if (*x) of(**x);
  }
  void operator()(std::optional<Vector3>* v) const {
    if (*v) of(**v);
  }
  void operator()(std::vector<double>* list) const {
    for (double& x : *list) of(x);
  }
  void operator()(std::vector<Vector3>* list) const {
    for (Vector3& v : *list) of(v);
  }
  template <class Other>
  void operator()(const Other&) const {}
};

/// The unit of a drive's values is one of three, by the kind of the drive beside it.
std::string_view unit_of_field(const Field& field, std::span<const Field> fields, void* object) {
  const std::size_t comma = field.unit.find(", ");
  const std::size_t either = field.unit.find(" or ");
  if (comma == std::string_view::npos || either == std::string_view::npos) return field.unit;
  const std::string_view drive = field.name.substr(0, field.name.find("drive") + 5);
  for (const Field& other : fields) {
    if (other.name != drive) continue;
    const auto slot = std::get<ChoiceSlot>(other.slot(object));
    switch (slot.get(slot.object)) {
      case 1:
        return field.unit.substr(0, comma);
      case 2:
        return field.unit.substr(comma + 2, either - comma - 2);
      case 3:
        return field.unit.substr(either + 4);
      default:
        return "";
    }
  }
  return "";
}

using ValueChange = std::function<double(double, const UnitPowers&, const Field&)>;

void change_table(std::span<const Field> fields, void* object, const ValueChange& change) {
  for (const Field& field : fields) {
    const auto powers = unit_powers(unit_of_field(field, fields, object));
    if (!powers || field.unit.empty()) continue;
    const std::function<double(double)> of_value = [&](double x) {
      return change(x, *powers, field);
    };
    std::visit(ChangeSlot{of_value}, field.slot(object));
  }
}

template <class Base>
void change_typed(Base& object, std::span<const TypeEntry<Base>> types, const ValueChange& change) {
  const auto [unused, fields] = new_object(types, object.type());
  change_table(fields, const_cast<void*>(object.settings()), change);
}

}  // namespace

std::shared_ptr<JointDef> copy_of(const JointDef& joint) {
  auto copy = copy_of_typed(joint, joint_types());
  for (const Field& field : JointDef::common_field_table()) copy_value(field, &joint, copy.get());
  return copy;
}

std::shared_ptr<LinkDef> copy_of(const LinkDef& link) {
  auto copy = copy_of_typed(link, link_types());
  copy->body = link.body;
  return copy;
}

std::shared_ptr<Shape> copy_of(const Shape& shape) { return copy_of_typed(shape, shape_types()); }

Machine with_values(const Machine& machine, const ValueChange& change) {
  Machine result = machine;
  const Field gravity = field<&Model::gravity>("gravity", "m/s2", any_number(), required, "");
  change_table(std::span(&gravity, 1), &result.model, change);
  change_table(StepSettings::field_table(), &result.model.step, change);
  for (BodyDef& body : result.model.bodies) {
    change_table(BodyDef::field_table(), &body, change);
    for (PlacedShape& placed : body.shapes) {
      change_table(PlacedShape::field_table(), &placed, change);
      auto shape = copy_of(*placed.shape);
      change_typed(*shape, shape_types(), change);
      placed.shape = shape;
    }
  }
  for (auto& joint : result.model.joints) {
    auto copy = copy_of(*joint);
    change_table(JointDef::common_field_table(), copy.get(), change);
    change_typed(*copy, joint_types(), change);
    joint = copy;
  }
  for (ColliderDef& collider : result.model.colliders) {
    change_table(ColliderDef::field_table(), &collider, change);
  }
  if (result.model.ground) change_table(GroundDef::field_table(), &*result.model.ground, change);
  for (CableDef& cable : result.cables) {
    change_table(CableDef::field_table(), &cable, change);
    for (auto& link : cable.links) {
      auto copy = copy_of(*link);
      change_typed(*copy, link_types(), change);
      link = copy;
    }
  }
  return result;
}

double Units::of(const UnitPowers& powers) const {
  return std::pow(length, powers.length) * std::pow(mass, powers.mass) *
         std::pow(time, powers.time);
}

Machine in_units(const Machine& machine, const Units& units) {
  return with_values(machine, [&](double x, const UnitPowers& powers, const Field&) {
    return x * units.of(powers);
  });
}

Machine perturbed(const Machine& machine, double size, std::uint64_t seed) {
  Random random(seed);
  const StepSettings step = machine.model.step;
  Machine result = with_values(machine, [&](double x, const UnitPowers&, const Field&) {
    return x * (1.0 + random.between(-size, size));
  });
  result.model.step = step;
  return result;
}

namespace {

/// Turns and moves what is given in the world's frame.
struct Placement {
  Quaternion turn;
  Vector3 way;

  void point(Vector3& p) const { p = turn * p + way; }
  void direction(Vector3& d) const { d = turn * d; }

  void body(BodyDef& body) const {
    // By default a planar body has the world's z axis, which does not turn with the machine.
    if (body.mobility == Mobility::planar && !body.axis) body.axis = Vector3::UnitZ();
    if (body.axis) direction(*body.axis);
    point(body.position);
    body.orientation = turn * body.orientation;
    for (Vector3* v :
         {&body.velocity, &body.angular_velocity, &body.force, &body.torque, &body.oscillation}) {
      direction(*v);
    }
  }
  void joint(JointDef& any) const {
    if (auto* j = dynamic_cast<HingeJoint*>(&any)) point(j->anchor), direction(j->axis);
    if (auto* j = dynamic_cast<SliderJoint*>(&any)) point(j->anchor), direction(j->axis);
    if (auto* j = dynamic_cast<CylindricalJoint*>(&any)) point(j->anchor), direction(j->axis);
    if (auto* j = dynamic_cast<PlaneJoint*>(&any)) point(j->anchor), direction(j->normal);
    if (auto* j = dynamic_cast<FixedJoint*>(&any)) point(j->anchor);
    if (auto* j = dynamic_cast<DistanceJoint*>(&any)) point(j->anchor_a), point(j->anchor_b);
    if (auto* j = dynamic_cast<GearJoint*>(&any)) direction(j->axis_a), direction(j->axis_b);
    if (auto* j = dynamic_cast<BallJoint*>(&any)) {
      point(j->anchor);
      if (j->axis) direction(*j->axis);
    }
    if (auto* j = dynamic_cast<UniversalJoint*>(&any)) {
      point(j->anchor), direction(j->axis_a), direction(j->axis_b);
    }
    if (auto* j = dynamic_cast<RackJoint*>(&any)) {
      direction(j->axis), direction(j->direction), point(j->anchor);
    }
  }
};

}  // namespace

Machine moved(const Machine& machine, const Quaternion& turn, const Vector3& way) {
  const Placement place{turn, way};
  Machine result = machine;
  place.direction(result.model.gravity);
  for (BodyDef& body : result.model.bodies) place.body(body);
  for (auto& joint : result.model.joints) {
    auto copy = copy_of(*joint);
    place.joint(*copy);
    joint = copy;
  }
  if (result.model.ground) {
    place.point(result.model.ground->point);
    place.direction(result.model.ground->normal);
  }
  for (CableDef& cable : result.cables) {
    for (auto& link : cable.links) {
      if (!link->body.is_world()) continue;
      link = changed(
          *link, [&](auto& at) { place.point(at.point); },
          [&](auto& wheel) {
            if (wheel.center) place.point(*wheel.center);
            wheel.normal = turn * wheel.normal.value_or(Vector3::UnitZ());
          });
    }
  }
  return result;
}

}  // namespace sheave::test
