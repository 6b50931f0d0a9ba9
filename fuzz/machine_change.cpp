#include "fuzz/machine_change.h"

#include "fuzz/field_fill.h"
#include "scenes/format.h"

namespace sheave::fuzz {
namespace {

using test::Machine;
using test::Random;

template <class Element>
Element* any_of(Random& random, std::vector<Element>& list) {
  if (list.empty()) return nullptr;
  return &list[static_cast<std::size_t>(random.below(static_cast<int>(list.size())))];
}

/// Changes one entity of a machine.
class Change {
 public:
  Change(Random& random, Machine& machine) : random_(random), machine_(machine) {}

  void make() {
    Model& model = machine_.model;
    switch (random_.below(12)) {
      case 0:
        return fill(StepSettings::field_table(), &model.step);
      case 1:
        model.gravity = random_.vector(20.0);
        return;
      case 2:
      case 3:
        if (BodyDef* body = any_of(random_, model.bodies)) fill(BodyDef::field_table(), body);
        return;
      case 4:
        return change_shape();
      case 5:
      case 6:
        return change_joint();
      case 7:
        if (CableDef* cable = any_of(random_, machine_.cables)) {
          fill(CableDef::field_table(), cable);
        }
        return;
      case 8:
      case 9:
        return change_link();
      case 10:
        if (!model.ground) model.ground.emplace();
        return fill(GroundDef::field_table(), &*model.ground);
      default:
        return change_collider();
    }
  }

 private:
  void fill(std::span<const Field> fields, void* object) {
    if (fields.empty()) return;
    const Field& field =
        fields[static_cast<std::size_t>(random_.below(static_cast<int>(fields.size())))];
    const auto bodies = static_cast<int>(machine_.model.bodies.size());
    std::visit(FieldFill(random_, field, bodies), field.slot(object));
  }

  /// A copy of the entity with another value in one field of `common` or of its own type.
  template <class Base>
  std::shared_ptr<const Base> changed(const Base& old, std::span<const TypeEntry<Base>> types,
                                      std::span<const Field> common) {
    const TypeEntry<Base>* type = &types[0];
    for (const TypeEntry<Base>& entry : types) {
      if (entry.name == old.type()) type = &entry;
    }
    const bool other = random_.chance(0.1);
    if (other)
      type = &types[static_cast<std::size_t>(random_.below(static_cast<int>(types.size())))];
    std::shared_ptr<Base> result = type->make();
    for (const Field& field : common) copy_value(field, &old, result.get());
    void* settings = const_cast<void*>(result->settings());
    if (!other) {
      for (const Field& field : type->fields()) copy_value(field, old.settings(), settings);
    }
    if (!common.empty() && random_.chance(0.3)) {
      fill(common, result.get());
    } else {
      fill(type->fields(), settings);
    }
    return result;
  }
  void change_shape() {
    BodyDef* body = any_of(random_, machine_.model.bodies);
    if (body == nullptr) return;
    PlacedShape* placed = any_of(random_, body->shapes);
    if (placed == nullptr || random_.chance(0.1)) {
      PlacedShape& added = body->shapes.emplace_back();
      const auto types = shape_types();
      added.shape =
          types[static_cast<std::size_t>(random_.below(static_cast<int>(types.size())))].make();
      return;
    }
    if (random_.chance(0.3)) return fill(PlacedShape::field_table(), placed);
    placed->shape = changed<Shape>(*placed->shape, shape_types(), {});
  }
  void change_joint() {
    auto& joints = machine_.model.joints;
    std::shared_ptr<const JointDef>* joint = any_of(random_, joints);
    if (joint == nullptr || random_.chance(0.15)) {
      const auto types = joint_types();
      std::shared_ptr<JointDef> added =
          types[static_cast<std::size_t>(random_.below(static_cast<int>(types.size())))].make();
      added->name = "added" + std::to_string(joints.size());
      const auto bodies = static_cast<int>(machine_.model.bodies.size());
      added->body_a = {random_.below(bodies + 1) - 1};
      added->body_b = {random_.below(bodies + 1) - 1};
      joints.push_back(std::move(added));
      return;
    }
    *joint = changed<JointDef>(**joint, joint_types(), JointDef::common_field_table());
  }
  void change_link() {
    CableDef* cable = any_of(random_, machine_.cables);
    if (cable == nullptr) return;
    auto* link = any_of(random_, cable->links);
    if (link == nullptr) return;
    const auto kind = random_.below(12);
    if (kind == 0) {
      cable->links.erase(cable->links.begin() + (link - cable->links.data()));
    } else if (kind == 1) {
      cable->links.push_back(*link);
    } else {
      *link = changed<LinkDef>(**link, link_types(), LinkDef::common_field_table());
    }
  }
  void change_collider() {
    std::vector<ColliderDef>& colliders = machine_.model.colliders;
    ColliderDef* collider = any_of(random_, colliders);
    if (collider == nullptr || random_.chance(0.3)) collider = &colliders.emplace_back();
    fill(ColliderDef::field_table(), collider);
  }

  Random& random_;
  Machine& machine_;
};

}  // namespace

void change_field(Random& random, Machine& machine) { Change(random, machine).make(); }

}  // namespace sheave::fuzz
