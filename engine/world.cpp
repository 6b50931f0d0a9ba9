#include "engine/world.h"

#include <algorithm>

#include "engine/body_check.h"
#include "engine/contacts/contact_batch.h"
#include "engine/contacts/ground_batch.h"
#include "engine/dynamics/mounted_drive.h"
#include "engine/field_check.h"
#include "engine/index.h"
#include "engine/joint_references.h"
#include "engine/number_text.h"
#include "engine/state_check.h"
#include "engine/world_content.h"

namespace sheave {
namespace {

void check_joints(const Model& model, const BodySet& bodies, Errors& errors) {
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    const std::string path = "/joints/" + std::to_string(i);
    if (model.joints[i] == nullptr) {
      errors.push_back({path, "there is no joint: the pointer is null"});
      continue;
    }
    const JointDef& joint = *model.joints[i];
    for (std::size_t k = 0; k < i; ++k) {
      if (model.joints[k] != nullptr && model.joints[k]->name == joint.name) {
        errors.push_back(
            {path + "/name", "two joints are called \"" + joint.name + "\"; names must differ"});
        break;
      }
    }
    const std::size_t before = errors.size();
    if (joint.name.empty()) {
      errors.push_back({path + "/name", "a joint needs a name that is not empty"});
    }
    for (const auto& [key, body] :
         {std::pair{"/body_a", joint.body_a}, {"/body_b", joint.body_b}}) {
      if (bodies.contains(body)) {
        const int index = bodies.index(body);
        if (bodies[index].massless()) {
          errors.push_back({path + key, "joint \"" + joint.name +
                                            "\": nothing can be joined to \"" + bodies.name(index) +
                                            "\", which has no spin inertia"});
        }
        if (bodies[index].mobility == Mobility::knot) {
          errors.push_back({path + key, "joint \"" + joint.name + "\": \"" + bodies.name(index) +
                                            "\" is a knot, a point at which ends of cables meet; "
                                            "a joint needs a body, so give it a mass and another "
                                            "mobility"});
        }
        continue;
      }
      errors.push_back({path + key, "joint \"" + joint.name + "\": there is no body number " +
                                        std::to_string(body.index)});
    }
    check_fields(JointDef::common_field_table(), &joint, path, errors);
    for (const auto& entry : joint_types()) {
      if (entry.name == joint.type()) check_fields(entry.fields(), joint.settings(), path, errors);
    }
    if (errors.size() > before) continue;
    for (const Error& error : joint.validate(bodies, path)) errors.push_back(error);
    const auto* const references = dynamic_cast<const JointReferences*>(&joint);
    if (references == nullptr || errors.size() > before) continue;
    for (const Error& error : references->check_references(model, bodies, path)) {
      errors.push_back(error);
    }
  }
}

/// Other solvers and integrators have errors that do not fall with the length of the substeps as the
/// choice of lengths assumes.
void check_tolerance(const StepSettings& step, const BodySet& bodies, Errors& errors) {
  if (!(step.tolerance > 0.0)) return;
  // Residuals of positions become velocities in short substeps.
  constexpr double least = 1e-6;
  if (step.tolerance < least * bodies.scale()) {
    errors.push_back({"/step/tolerance",
                      "a tolerance must be at least 1e-6 of the machine's size, which is " +
                          std::string(number_text(bodies.scale(), 3)) +
                          " m: rounding limits how short the "
                          "substeps at an event can be; take a larger tolerance, or 0 and a number "
                          "of substeps"});
  }
  if (step.solver != SolverKind::direct) {
    errors.push_back({"/step/solver",
                      "a tolerance needs the solver \"direct\": sweeps of Gauss-Seidel leave "
                      "errors that shorter substeps do not remove; take \"direct\", or substeps in "
                      "place of the tolerance"});
  }
  if (step.integrator != IntegratorKind::rattle) {
    errors.push_back({"/step/integrator",
                      "a tolerance needs the integrator \"rattle\", because xpbd is of first order "
                      "and would take too many substeps; take \"rattle\", or substeps in place of "
                      "the tolerance"});
  }
}

Errors check_model(const Model& model, const BodySet& bodies) {
  Errors errors;
  for (int i = 0; i < 3; ++i) {
    if (!(std::abs(model.gravity[i]) <= most_gravity)) {
      errors.push_back({"/gravity/" + std::to_string(i),
                        "gravity must be finite and at most 1e+100 m/s2 in each direction"});
    }
  }
  check_fields(StepSettings::field_table(), &model.step, "/step", errors);
  check_tolerance(model.step, bodies, errors);
  if (model.ground) {
    check_fields(GroundDef::field_table(), &*model.ground, "/ground", errors);
    if (!(model.ground->normal.norm() > 1e-12)) {
      errors.push_back({"/ground/normal", "the normal must have a direction; its length is 0"});
    }
  }
  check_joints(model, bodies, errors);
  for (const Error& error : check_colliders(model, bodies)) errors.push_back(error);
  return errors;
}

}  // namespace

std::vector<std::unique_ptr<ConstraintBatch>> model_features(const Model& model,
                                                             const BodySet& bodies) {
  std::vector<std::unique_ptr<ConstraintBatch>> features;
  for (const auto& entry : joint_types()) {
    std::vector<const JointDef*> joints;
    for (const auto& joint : model.joints) {
      if (joint->type() == entry.name) joints.push_back(joint.get());
    }
    if (!joints.empty()) features.push_back(joints.front()->make_batch(bodies, joints));
  }
  if (has_mounted_drives(bodies)) features.push_back(make_mounted_drives(bodies));
  if (model.ground) features.push_back(make_ground_batch(*model.ground, bodies));
  // The contacts come last, so that create() knows their index for World::contacts().
  if (!model.colliders.empty())
    features.push_back(make_contact_batch(model, bodies, features.size()));
  return features;
}

World::World(std::unique_ptr<Content> content) : content_(std::move(content)) {}
World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

Result<World> World::create(Model model) { return create(std::move(model), {}); }

Result<World> World::create(Model model, std::vector<std::unique_ptr<ConstraintBatch>> features) {
  Result<BodySet> bodies = BodySet::create(model);
  if (!bodies) return bodies.errors();
  auto shared = std::make_shared<const BodySet>(std::move(*bodies));
  return create(std::move(model), std::move(shared), std::move(features), 0);
}

Result<World> World::create(Model model, std::shared_ptr<const BodySet> bodies,
                            std::vector<std::unique_ptr<ConstraintBatch>> features,
                            std::uint64_t layout) {
  Errors errors = check_model(model, *bodies);
  if (!errors.empty()) return errors;
  std::vector<std::unique_ptr<ConstraintBatch>> all = model_features(model, *bodies);
  const std::size_t own_features = all.size();
  for (auto& feature : features) all.push_back(std::move(feature));
  State state = bodies->initial_state();
  state.layout = layout;
  for (const auto& feature : all) state.features.push_back(feature->initial_state());
  auto content = std::make_unique<Content>(std::move(model), std::move(bodies), std::move(all),
                                           std::move(state));
  if (!content->model.colliders.empty()) content->contacts = own_features - 1;
  return World(std::move(content));
}

Errors World::check(const Model& model) {
  if (model.joints.empty() && model.colliders.empty() && !(model.step.tolerance > 0.0)) {
    Errors errors = check_bodies(model);
    // A model without joints and colliders refers to no body here.
    return errors.empty() ? check_model(model, BodySet()) : errors;
  }
  const Result<BodySet> bodies = BodySet::create(model);
  return bodies ? check_model(model, *bodies) : bodies.errors();
}

void World::keep_in_place() {
  Content& c = *content_;
  if (c.stays_in_place) return;
  c.stays_in_place = true;
  c.bodies_place = c.state.bodies.data();
  if (!c.state.features.empty()) c.reals_place = c.state.features.back().reals.data();
}

const Model& World::model() const { return content_->model; }
const BodySet& World::bodies() const { return *content_->bodies; }
std::shared_ptr<const BodySet> World::shared_bodies() const { return content_->bodies; }
const State& World::state() const { return content_->state; }
const std::vector<Stage>& World::stages() const { return content_->stages; }
std::span<const std::unique_ptr<ConstraintBatch>> World::features() const {
  return content_->features;
}
const FeatureState& World::feature_state(std::size_t index) const {
  return content_->state.features[index];
}

std::vector<ContactReport> World::contacts() const {
  const Content& c = *content_;
  if (c.model.colliders.empty()) return {};
  return report_contacts(c.model, *c.bodies, c.state.features[c.contacts]);
}

std::optional<LastSubstep> World::last_substep() const {
  const Content& c = *content_;
  const State* before = c.driver.before();
  if (before == nullptr) return std::nullopt;
  const bool rattle =
      c.model.step.integrator == IntegratorKind::rattle && c.substep.load_share != 1.0;
  return LastSubstep{*before, c.substep.h, rattle ? IntegratorKind::rattle : IntegratorKind::xpbd,
                     rattle ? std::span<const std::vector<double>>(c.substep.late_forces)
                            : std::span<const std::vector<double>>()};
}

Errors World::restore(const State& state) {
  const State& own = content_->state;
  bool fits = (state.layout == own.layout || state.layout == 0 || own.layout == 0) &&
              state.bodies.size() == own.bodies.size() &&
              state.features.size() == own.features.size() &&
              state.memory.size() == own.memory.size() &&
              state.history.is_sound(at(content_->bodies->coordinates().count())) &&
              state.step_size.is_sound(content_->bodies->coordinates().movable().size());
  for (std::size_t i = 0; fits && i < own.features.size(); ++i) {
    const ConstraintBatch& feature = *content_->features[i];
    fits = (!feature.has_fixed_size() ||
            (state.features[i].reals.size() == own.features[i].reals.size() &&
             state.features[i].integers.size() == own.features[i].integers.size())) &&
           feature.accepts(state.features[i]);
  }
  if (!fits) {
    return {{"",
             "the state does not belong to this world: it must have the same bodies, joints, "
             "cables, links, colliders, controllers and triggers, in the same order"}};
  }
  const std::string fault = ControlCheck(content_->model, *content_->bodies, content_->joints)
                                .fault_of(state.controls, content_->features);
  if (!fault.empty()) return {{"", "the state does not belong to this world: " + fault}};
  const std::string unsound = state_fault(state, *content_->bodies, content_->features);
  if (!unsound.empty()) return {{"", "no world can go on from the state: " + unsound}};
  if (content_->memory_fault) {
    const std::string bad = content_->memory_fault(state);
    if (!bad.empty()) return {{"", "the state does not belong to this world: " + bad}};
  }
  const std::uint64_t layout = own.layout;
  content_->state = state;
  content_->state.layout = layout;
  if (content_->model.step.tolerance == 0.0) content_->state.step_size = {};
  fit_angles(*content_->bodies, content_->state);
  content_->driver.forget();
  content_->substep.next = content_->state;
  return {};
}

Energy World::energy_of(const State& state) const {
  const Content& c = *content_;
  Energy energy;
  const Controls& controls = state.controls;
  const Vector3& gravity = controls.has_gravity ? controls.gravity : c.model.gravity;
  for (int i = 0; i < c.bodies->count(); ++i) {
    const BodyProperties& body = (*c.bodies)[i];
    const BodyState& own = state.bodies[at(i)];
    if (!yields(body.mobility)) continue;
    const Vector3& w = own.angular_velocity;
    if (body.mobility == Mobility::rotor) {
      const Vector3 axis = body.mount >= 0
                               ? Vector3(state.bodies[at(body.mount)].orientation * body.axis)
                               : body.axis;
      const double spin = axis.dot(w);
      energy.kinetic += 0.5 * body.axis_inertia * spin * spin;
      continue;
    }
    const Vector3 own_w = own.orientation.conjugate() * w;
    energy.kinetic +=
        0.5 * body.mass * own.velocity.squaredNorm() + 0.5 * own_w.dot(body.inertia * own_w);
    energy.potential -= own.position.dot(body.mass * gravity + c.model.bodies[at(i)].force);
  }
  for (std::size_t i = 0; i < c.features.size(); ++i) {
    energy.elastic += c.features[i]->elastic_energy(*c.bodies, state, state.features[i]);
    energy.potential += c.features[i]->potential_energy(*c.bodies, state, state.features[i]);
    energy.kinetic += c.features[i]->kinetic_energy(*c.bodies, state);
  }
  return energy;
}

Vector3 World::point(BodyId body, const Vector3& local) const {
  const int i = content_->bodies->index(body);
  if (body.is_world()) return local;
  const BodyState& state = content_->state.bodies[at(i)];
  return state.position + state.orientation * (local - (*content_->bodies)[i].center_of_mass);
}

Vector3 World::position(BodyId body) const { return point(body, Vector3::Zero()); }

Quaternion World::orientation(BodyId body) const {
  if (body.is_world()) return Quaternion::Identity();
  return content_->state.bodies[at(body.index)].orientation;
}

Vector3 World::velocity(BodyId body) const {
  if (body.is_world()) return Vector3::Zero();
  const BodyState& state = content_->state.bodies[at(body.index)];
  return state.velocity + state.angular_velocity.cross(position(body) - state.position);
}

Vector3 World::angular_velocity(BodyId body) const {
  if (body.is_world()) return Vector3::Zero();
  return content_->state.bodies[at(body.index)].angular_velocity;
}

}  // namespace sheave
