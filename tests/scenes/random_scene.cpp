#include "tests/scenes/random_scene.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "cable/links/attachment.h"
#include "cable/links/rolling.h"
#include "cable/links/wheel_link.h"
#include "cable/simulation.h"
#include "engine/joints/coupling.h"
#include "engine/joints/gear.h"
#include "engine/joints/hinge.h"
#include "engine/joints/rack.h"
#include "engine/joints/slider.h"
#include "engine/joints/universal.h"

namespace sheave::test {
namespace {

/// Fills the fields of any type with random values inside their ranges.
class RandomFields {
 public:
  explicit RandomFields(unsigned seed) : random_(seed) {}

  int pick(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }
  double number(double low, double high) {
    return low + (high - low) * static_cast<double>(random_()) / 4294967296.0;
  }
  double number(const Range& range) {
    // Mostly ordinary magnitudes, sometimes numbers with all their digits far from 1.
    double value = pick(4) == 0 ? std::ldexp(number(-1.0, 1.0), pick(30) - 15) : number(-2.0, 2.0);
    if (pick(8) == 0) value = std::round(value);
    if (range.contains(value)) return value;
    const double low = std::isfinite(range.minimum) ? range.minimum : range.maximum - 1.0;
    const double high = std::isfinite(range.maximum) ? range.maximum : low + 1.0;
    return number(low + 1e-3 * (high - low), low + 0.5 * (high - low));
  }
  Vector3 vector(const Range& range) { return {number(range), number(range), number(range)}; }
  Quaternion orientation() {
    Quaternion q(number(-1, 1), number(-1, 1), number(-1, 1), number(-1, 1) + 1.5);
    return q.normalized();
  }

  /// Fills one of `rarity` of the optional fields and all required ones.
  void fill(std::span<const Field> fields, void* object, int bodies, int rarity = 2) {
    for (const Field& field : fields) {
      if (field.name == "name") continue;
      if (field.presence == Presence::optional && pick(rarity) != 0) continue;
      std::visit(Fill{*this, field, bodies}, field.slot(object));
    }
  }

 private:
  struct Fill {
    RandomFields& random;
    const Field& field;
    int bodies;

    void operator()(double* x) const { *x = random.number(field.range); }
    void operator()(std::optional<double>* x) const { *x = random.number(field.range); }
    void operator()(int* x) const { *x = static_cast<int>(field.range.minimum) + random.pick(10); }
    void operator()(bool* x) const { *x = random.pick(2) == 0; }
    void operator()(std::string* x) const {
      *x = "text \"\\\n\xC3\xA4" + std::to_string(random.pick(99));
    }
    void operator()(Vector3* x) const { *x = random.vector(field.range); }
    void operator()(std::optional<Vector3>* x) const { *x = random.vector(field.range); }
    void operator()(Quaternion* x) const { *x = random.orientation(); }
    void operator()(BodyId* x) const { *x = {random.pick(bodies + 1) - 1}; }
    void operator()(std::optional<BodyId>* x) const { *x = BodyId{random.pick(bodies + 1) - 1}; }
    void operator()(std::vector<double>* x) const { x->assign(1, random.number(field.range)); }
    void operator()(std::vector<Vector3>* x) const {
      for (int i = 0; i < 12; ++i) x->push_back(random.vector(field.range));
      if (field.name != "outline") return;
      for (Vector3& point : *x) point.z() = 0.0;  // outlines lie in this plane
    }
    void operator()(std::vector<std::string>* x) const { x->assign(1, "a group"); }
    void operator()(const ChoiceSlot& x) const {
      x.set(x.object, random.pick(static_cast<int>(field.choices.size())));
    }
  };

  std::mt19937 random_;
};

/// Adds entities one by one and keeps those with which the scene is still valid.
class RandomScene {
 public:
  explicit RandomScene(unsigned seed) : random_(seed) {}

  Scene make() {
    random_.fill(Scene::field_table(), &scene_, 0);
    random_.fill(StepPresetDef::field_table(), &scene_.step_preset, 0);
    scene_.model.step = StepSettings::of(scene_.step_preset.preset);
    random_.fill(StepSettings::field_table(), &scene_.model.step, 0);
    if (scene_.model.step.tolerance > 0.0) {
      scene_.model.step.integrator = IntegratorKind::rattle;
      scene_.model.step.solver = SolverKind::direct;
      scene_.model.step.substeps = StepSettings::of(scene_.step_preset.preset).substeps;
    }
    for (int i = 0; i < 16; ++i) attempt([&] { add_body(); });
    for (int i = 0; i < 40; ++i) attempt([&] { add_joint(); });
    for (int i = 0; i < 12; ++i) attempt([&] { add_cable(); });
    for (int i = 0; i < 12; ++i) {
      attempt([&] { fill(ColliderDef::field_table(), &scene_.model.colliders.emplace_back()); });
    }
    attempt([&] { fill(GroundDef::field_table(), &scene_.model.ground.emplace()); });
    for (int i = 0; i < 4 && !scene_.camera; ++i) {
      attempt([&] { fill(CameraDef::field_table(), &scene_.camera.emplace()); });
    }
    for (int i = 0; i < 4; ++i) {
      attempt([&] { fill(CameraKeyDef::field_table(), &scene_.camera_path.emplace_back()); });
      attempt([&] { add_annotation(); });
    }
    for (int i = 0; i < 4; ++i) {
      attempt([&] { fill(PaintDef::field_table(), &scene_.paint.emplace_back()); });
    }
    for (int i = 0; i < 12; ++i) attempt([&] { add_check(); });
    for (int i = 0; i < 6; ++i) attempt([&] { add_controller(); });
    for (int i = 0; i < 6; ++i) attempt([&] { add_trigger(); });
    for (int i = 0; i < 4; ++i) attempt([&] { add_parameter(); });
    return std::move(scene_);
  }

 private:
  template <class Change>
  void attempt(const Change& change) {
    Scene before = scene_;
    change();
    if (!validate_scene(scene_).empty()) scene_ = std::move(before);
  }
  [[nodiscard]] int bodies() const { return static_cast<int>(scene_.model.bodies.size()); }
  void fill(std::span<const Field> fields, void* object) { random_.fill(fields, object, bodies()); }
  std::string name(const char* kind) { return kind + std::to_string(next_name_++); }

  /// A new object of a random type of a registry.
  template <class Base>
  std::shared_ptr<Base> make(std::span<const TypeEntry<Base>> types, int rarity = 2) {
    const auto& type =
        types[static_cast<std::size_t>(random_.pick(static_cast<int>(types.size())))];
    std::shared_ptr<Base> object = type.make();
    random_.fill(type.fields(), const_cast<void*>(object->settings()), bodies(), rarity);
    return object;
  }

  void add_body() {
    BodyDef body;
    fill(BodyDef::field_table(), &body);
    body.name = name("body");
    // A random scene hardly ever ties two to four suitable cables to a knot.
    if (body.mobility == Mobility::knot) body.mobility = Mobility::free;
    // Most random combinations of these make no sense; drop what excludes the rest.
    if (body.mass) body.density.reset();
    if (random_.pick(2) == 0) body.inertia.reset();
    if (!body.mass || !body.inertia || body.mobility == Mobility::rotor) {
      body.center_of_mass.reset();
    }
    if (!body.inertia || body.mobility == Mobility::rotor) {
      body.products_of_inertia.setZero();
    } else {
      // So small beside the moments that nearly all such tensors are those of bodies.
      body.products_of_inertia *=
          0.1 * body.inertia->minCoeff() / (1.0 + body.products_of_inertia.norm());
    }
    if (body.mobility != Mobility::kinematic) {
      body.oscillation.setZero();
      body.oscillation_frequency = 0.0;
    }
    if (body.mobility != Mobility::free && body.mobility != Mobility::kinematic) {
      body.velocity.setZero();
      body.angular_velocity.setZero();
    }
    if (body.mobility != Mobility::rotor) body.mount.reset();
    if (body.drive == DriveKind::none) body.drive_interpolation = Interpolation::linear;
    if (body.mobility == Mobility::free || body.mobility == Mobility::fixed) body.axis.reset();
    const int shapes = random_.pick(3) + 1;
    for (int i = 0; i < shapes; ++i) {
      PlacedShape placed;
      // Forms without end are only for bodies that need no mass.
      const bool moves = body.mobility != Mobility::fixed && body.mobility != Mobility::kinematic;
      do {
        placed.shape = make(shape_types());
      } while (moves && !placed.shape->bounded());
      if (body.mobility != Mobility::rotor) fill(PlacedShape::field_table(), &placed);
      if (body.mass) placed.density.reset();
      body.shapes.push_back(std::move(placed));
    }
    scene_.model.bodies.push_back(std::move(body));
  }
  void add_annotation() {
    AnnotationDef& text = scene_.annotations.emplace_back();
    fill(AnnotationDef::field_table(), &text);
    text.text = name("text");
    if (text.kind == AnnotationDef::Kind::arrow) return;
    text.body = BodyId::world();
    text.point.setZero();
  }
  void add_parameter() {
    ParameterDef& own = scene_.model.parameters.emplace_back();
    fill(ParameterDef::field_table(), &own);
    own.name = fmt::format("parameter_{}", scene_.model.parameters.size());
    own.unit = scene_.model.parameters.size() % 2 == 0 ? "N m" : "";
  }
  void add_joint() {
    // Few at a time: most settings of a joint's coordinates need or exclude others.
    auto joint = make(joint_types(), 8);
    if (auto* cross = dynamic_cast<UniversalJoint*>(joint.get())) {
      cross->axis_b = cross->axis_a.cross(cross->axis_b);
    }
    fill(JointDef::common_field_table(), joint.get());
    const bool couples =
        joint->type() == GearJoint::type_name || joint->type() == RackJoint::type_name;
    if (couples && bodies() > 1) {
      // Most pairs of random bodies are one body or the world.
      joint->body_a = BodyId{random_.pick(bodies() - 1)};
      joint->body_b = BodyId{joint->body_a.index + 1};
    }
    if (auto* coupling = dynamic_cast<CouplingJoint*>(joint.get())) {
      if (!couple_last(*coupling)) return;
    }
    joint->name = name("joint");
    scene_.model.joints.push_back(std::move(joint));
  }
  /// Gives a coupling the last hinge or slider; false if there is none.
  bool couple_last(CouplingJoint& coupling) const {
    const auto& joints = scene_.model.joints;
    const auto found = std::find_if(joints.rbegin(), joints.rend(), [](const auto& joint) {
      return joint->type() == HingeJoint::type_name || joint->type() == SliderJoint::type_name;
    });
    if (found == joints.rend()) return false;
    coupling.body_a = (*found)->body_a;
    coupling.body_b = (*found)->body_b;
    coupling.joints = {(*found)->name};
    coupling.joint_coordinates.clear();
    coupling.factors = {2.5};
    coupling.held = true;
    coupling.travel = {};
    return true;
  }
  void add_cable() {
    CableDef cable;
    fill(CableDef::field_table(), &cable);
    cable.name = name("cable");
    choose_elasticity(cable);
    cable.pretensions.clear();
    if (cable.pretension) cable.rest_lengths.clear();
    cable.closed = false;
    const int links = 2 + random_.pick(2);
    for (int i = 0; i < links; ++i) {
      // All but the last three types: a random rope hardly ever lies on a random body ("surface"), or
      // suits a sheath or an opening.
      auto link = make(link_types().first(link_types().size() - 3));
      fill(LinkDef::common_field_table(), link.get());
      tell_one_side(*link);
      if (link->type() != AttachmentLink::type_name) cable.linear_density = 0.0;
      cable.links.push_back(std::move(link));
    }
    if (!cable.axial_stiffness) cable.linear_density = 0.0;
    scene_.cables.push_back(std::move(cable));
  }
  /// A constant stiffness or compliance, or a table; random tables would not rise.
  void choose_elasticity(CableDef& cable) {
    if (cable.compliance) cable.axial_stiffness.reset();
    cable.strain_table.clear();
    cable.tension_table.clear();
    cable.unloading_table.clear();
    cable.unloading_stiffness.reset();
    cable.transition_strain.reset();
    if (random_.pick(4) == 0) {
      cable.strain_table = {0.0, 0.1, 0.25};
      cable.tension_table = {0.0, 40.5, 200.25};
      cable.compliance.reset();
      cable.axial_stiffness.reset();
      cable.tangent_update = TangentUpdate::iteration;
      cable.wrap_friction = 0.0;
    }
    if (!cable.has_material() || cable.damping > 0.0) cable.axial_damping = 0.0;
    if (cable.is_elastic()) return;
    cable.damping = 0.0;
    cable.pretension.reset();
  }
  /// A link on a wheel has a winding or a side, and passes one way only with friction.
  static void tell_one_side(LinkDef& link) {
    if (auto* wheel = dynamic_cast<WheelLink*>(&link)) {
      if (wheel->side) wheel->winding.reset();
      if (!wheel->side && !wheel->winding) wheel->winding = Winding::clockwise;
    }
    auto* rolling = dynamic_cast<RollingLink*>(&link);
    if (rolling == nullptr) return;
    if (!rolling->friction) rolling->passes = Passage::both;
    // One number stands for all losses, and the pin has a radius and a friction, or none.
    if (rolling->efficiency) rolling->bending_loss = rolling->bearing_friction = 0.0;
    if (rolling->bearing_friction == 0.0) rolling->journal_radius.reset();
    if (!rolling->journal_radius) rolling->bearing_friction = 0.0;
  }
  void add_check() {
    CheckDef check;
    fill(CheckDef::field_table(), &check);
    check.quantity = "energy.total";
    if (check.statistic == Statistic::at) {
      check.from.reset();
      check.to.reset();
    } else {
      check.at.reset();
    }
    scene_.checks.push_back(std::move(check));
  }

  void add_controller() {
    auto controller = make(controller_types());
    fill(ControllerDef::common_field_table(), controller.get());
    controller->name = name("controller");
    controller->measures = "energy.kinetic";
    controller->control = random_.pick(2) == 0 ? "gravity.x" : "gravity.y";
    // One kind of setpoint.
    const int kind = random_.pick(3);
    if (kind != 0) controller->setpoint.reset();
    if (kind == 0) controller->setpoint = 7.0;
    controller->setpoint_quantity = kind == 1 ? "t" : "";
    controller->setpoint_times.clear();
    controller->setpoint_values.clear();
    if (kind == 2) {
      controller->setpoint_times = {0.0, 1.5};
      controller->setpoint_values = {-1.0, 0.25};
    } else {
      controller->setpoint_interpolation = Interpolation::linear;
    }
    scene_.controllers.push_back(std::move(controller));
  }
  void add_trigger() {
    TriggerDef trigger;
    fill(TriggerDef::field_table(), &trigger);
    trigger.name = name("trigger");
    trigger.quantity = trigger.at ? "" : "energy.total";
    if (trigger.at) trigger.above = trigger.below = std::nullopt;
    trigger.action = random_.pick(2) == 0 ? TriggerAction::set : TriggerAction::stop;
    const bool sets = trigger.action == TriggerAction::set;
    trigger.target = sets ? "gravity.z" : "";
    if (!sets) trigger.value.reset();
    scene_.triggers.push_back(std::move(trigger));
  }

  RandomFields random_;
  Scene scene_;
  int next_name_ = 0;
};

}  // namespace

Scene random_scene(unsigned seed) { return RandomScene(seed).make(); }

}  // namespace sheave::test
