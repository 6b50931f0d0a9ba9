// One coordinate, the travel s, whose gradient is the sum of those of the coupled coordinates times
// ds/dq. The other joints measure their coordinates themselves, with whole turns.

#include "engine/joints/coupling.h"

#include <algorithm>

#include "engine/control_check.h"
#include "engine/joints/joint_batch.h"

namespace sheave {
namespace {

/// One of the coupled coordinates.
struct CoupledTerm {
  const JointFeature* feature = nullptr;
  std::size_t state = 0;  // of the feature among those of the world
  int joint = 0;          // index within the feature
  int coordinate = 0;
  double factor = 0.0;  // ds/dq of the linear part
  bool angle = false;
};

struct CouplingKernel {
  static constexpr int lock_count = 0;
  // The second coordinate is 0. A held travel is an effect of both, like that of a gear: a lock
  // shifts the value of such an effect.
  static constexpr std::array<JointCoordinateInfo, 2> coordinates{{{"travel"}, {"none"}}};
  const CouplingJoint* definition = nullptr;
  int body = 0;
  std::array<CoupledTerm, CouplingJoint::most_joints> terms;
  std::size_t count = 0;
  double mesh = 0.0;  // shift of the held travel relative to the definition [m]

  [[nodiscard]] bool elastic() const { return false; }
  [[nodiscard]] int anchor_body() const { return body; }
  [[nodiscard]] Vector3 anchor(const Substep& substep) const { return substep.position(body); }
  void lock(int /*index*/, JointTerms& /*terms*/) const {}
  void apply(const JointHold& hold) { mesh = hold.offset; }
  [[nodiscard]] JointHold hold_here(const CouplingKernel& /*defined*/,
                                    const Substep& /*now*/) const {
    return {};  // the only constraint is the travel
  }

  void connect(const Model& model, std::span<const JointPlace> places,
               std::span<const std::unique_ptr<ConstraintBatch>> features) {
    count = definition->joints.size();
    for (std::size_t i = 0; i < count; ++i) {
      const CoupledCoordinate found = coupled_coordinate(*definition, i, model.joints);
      const JointPlace& place = places[at(found.joint)];
      CoupledTerm& term = terms[i];
      term.feature = place.feature;
      term.state = 0;
      while (features[term.state].get() != place.feature) ++term.state;
      term.joint = place.index;
      term.coordinate = found.coordinate;
      term.angle = model.joints[at(found.joint)]->coordinates()[at(found.coordinate)].angle;
      term.factor = definition->factors[i] * (term.angle ? definition->radius : 1.0);
    }
  }

  void coordinate(int index, JointTerms& travel) const {
    double sum = 0.0;
    for (std::size_t i = 0; index == 0 && i < count; ++i) {
      const CoupledTerm& term = terms[i];
      const Substep& now = travel.substep();
      Row row;
      const double value = term.feature->measure(term.joint, term.coordinate, now,
                                                 now.start.features[term.state], row);
      sum += term.factor * value;
      double slope = term.factor;
      if (i + 1 == count && !definition->curve.empty()) {
        const double scale = term.angle ? 1.0 : 1.0 / definition->radius;
        const auto [bend, rate] = bent(scale * value);
        sum += definition->radius * bend;
        slope += definition->radius * rate * scale;
      }
      travel.add_row(row, slope);
    }
    travel.set_value(sum);
  }

 private:
  /// The part of the curve at y, and its derivative.
  [[nodiscard]] std::pair<double, double> bent(double y) const {
    double value = 0.0;
    double rate = 0.0;
    double power = y;
    for (std::size_t k = 0; k < definition->curve.size(); ++k) {
      rate += definition->curve[k] * static_cast<double>(k + 2) * power;
      power *= y;
      value += definition->curve[k] * power;
    }
    return {value, rate};
  }
};

bool can_be_coupled(std::string_view type) {
  constexpr std::array<std::string_view, 5> types{"hinge", "slider", "cylindrical", "plane",
                                                  "universal"};
  return std::find(types.begin(), types.end(), type) != types.end();
}

int joint_named(const std::string& name, std::span<const std::shared_ptr<const JointDef>> joints) {
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (joints[j] != nullptr && joints[j]->name == name) return static_cast<int>(j);
  }
  return -1;
}

/// The names of a joint's coordinates, for messages.
std::string coordinate_list(const JointDef& joint) {
  std::string list;
  for (const JointCoordinateInfo& own : joint.coordinates()) {
    list += (list.empty() ? "" : ", ") + std::string(own.name);
  }
  return list;
}

/// Checks the names of a coupling among the joints of its model.
class CouplingCheck {
 public:
  CouplingCheck(const CouplingJoint& coupling, const Model& model, const BodySet& bodies,
                const std::string& path)
      : own_(coupling), model_(model), bodies_(bodies), path_(path) {}

  Errors check() {
    std::vector<int> touched;
    for (std::size_t i = 0; i < own_.joints.size(); ++i) {
      const int number = joint_named(own_.joints[i], model_.joints);
      const std::string place = "/joints/" + std::to_string(i);
      if (number < 0) {
        fail(place, "there is no joint \"" + own_.joints[i] + "\"");
        continue;
      }
      const JointDef& joint = *model_.joints[at(number)];
      if (!can_be_coupled(joint.type())) {
        fail(place, "\"" + joint.name + "\" is of the type " + std::string(joint.type()) +
                        "; hinge, slider, cylindrical, plane and universal can be coupled");
        continue;
      }
      check_coordinate_name(i, joint);
      if (!bodies_.contains(joint.body_a) || !bodies_.contains(joint.body_b)) continue;
      for (const BodyId body : {joint.body_a, joint.body_b}) touch(body, place, touched);
      if (i + 1 == own_.joints.size()) check_bodies(joint);
    }
    std::sort(touched.begin(), touched.end());
    const auto count = std::unique(touched.begin(), touched.end()) - touched.begin();
    if (count > Row::max_terms) {
      fail("/joints",
           "the joints have " + std::to_string(count) + " bodies; a coupling can have four");
    }
    return std::move(errors_);
  }

 private:
  void fail(const std::string& place, const std::string& message) {
    errors_.push_back({path_ + place, "joint \"" + own_.name + "\": " + message});
  }
  void touch(BodyId body, const std::string& place, std::vector<int>& touched) {
    if (body.is_world()) return;
    const int index = bodies_.index(body);
    if (bodies_[index].mount >= 0) {
      fail(place, "body \"" + bodies_.name(index) +
                      "\" is mounted on another one; couple a body with a hinge instead");
    }
    touched.push_back(index);
  }
  void check_coordinate_name(std::size_t i, const JointDef& joint) {
    const bool named = !own_.joint_coordinates.empty();
    const CoupledCoordinate found = coupled_coordinate(own_, i, model_.joints);
    if (found.coordinate < 0) {
      fail(named ? "/joint_coordinates/" + std::to_string(i) : "/joint_coordinates",
           "\"" + joint.name + "\" has the coordinates " + coordinate_list(joint) +
               "; name one of them");
    }
    for (std::size_t k = 0; k < i; ++k) {
      const CoupledCoordinate other = coupled_coordinate(own_, k, model_.joints);
      if (other.joint == found.joint && other.coordinate == found.coordinate) {
        fail("/joints/" + std::to_string(i), "the coordinate is coupled twice; add the factors");
      }
    }
  }
  void check_bodies(const JointDef& last) {
    if (own_.body_a == last.body_a && own_.body_b == last.body_b) return;
    fail("/body_b", "body_a and body_b must be those of the last joint, \"" + last.name +
                        "\"; reports tell the force on its body_b");
  }

  const CouplingJoint& own_;
  const Model& model_;
  const BodySet& bodies_;
  const std::string& path_;
  Errors errors_;
};

}  // namespace

CoupledCoordinate coupled_coordinate(const CouplingJoint& coupling, std::size_t index,
                                     std::span<const std::shared_ptr<const JointDef>> joints) {
  const int joint = joint_named(coupling.joints[index], joints);
  if (joint < 0) return {};
  const auto all = joints[at(joint)]->coordinates();
  if (coupling.joint_coordinates.empty()) return {joint, all.size() == 1 ? 0 : -1};
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (all[k].name == coupling.joint_coordinates[index]) return {joint, static_cast<int>(k)};
  }
  return {joint, -1};
}

std::span<const Field> CouplingJoint::field_table() {
  using Joint = CouplingJoint;
  static const std::vector<Field> table = joined(
      {{field<&Joint::joints>(
            "joints", "", {}, required,
            "names of the coupled joints, 1 to 4: hinges, sliders, cylindrical, "
            "plane and universal joints; body_a and body_b are those of the last"),
        field<&Joint::joint_coordinates>("joint_coordinates", "", {}, optional,
                                         "names of their coordinates, one per joint (default: each "
                                         "joint has only one)"),
        field<&Joint::factors>(
            "factors", "", any_number(), required,
            "one per joint: travel per radius and rad, or per travel; not 0, but the last "
            "one beside a curve"),
        field<&Joint::curve>("curve", "", any_number(), optional,
                             "factors of the powers 2, 3, ... of the last coordinate, an angle or "
                             "travel / radius; at most 8"),
        field<&Joint::radius>("radius", "m", above(0.0), optional, "travel per rad (default: 1)"),
        field<&Joint::held>("held", "", {}, optional, "keeps the travel at 0 (default: true)"),
        field<&Joint::compliance>("compliance", "m/N", at_least(0.0), optional,
                                  "of a travel that is held; 0 (default) is rigid")},
       coordinate_fields<Joint, &Joint::travel>(CoordinateKind::translation, "", "the travel")});
  return table;
}

std::span<const JointCoordinateInfo> CouplingJoint::coordinates() const {
  return std::span(CouplingKernel::coordinates).first(1);
}

Errors CouplingJoint::validate(const BodySet& bodies, const std::string& path) const {
  Errors errors = JointDef::validate(bodies, path);
  const auto fail = [&](const std::string& place, const std::string& message) {
    errors.push_back({path + place, "joint \"" + name + "\": " + message});
  };
  if (joints.empty() || joints.size() > most_joints) {
    fail("/joints", "a coupling has 1 to 4 joints, not " + std::to_string(joints.size()));
  }
  if (factors.size() != joints.size()) {
    fail("/factors", "as many factors as joints are needed, there are " +
                         std::to_string(factors.size()) + " and " + std::to_string(joints.size()));
  }
  for (std::size_t i = 0; i < factors.size(); ++i) {
    const bool curved = i + 1 == factors.size() && !curve.empty();
    if (factors[i] == 0.0 && !curved) {
      fail("/factors/" + std::to_string(i),
           "a factor must not be 0, but the last one beside a curve; leave the joint out");
    }
  }
  if (!joint_coordinates.empty() && joint_coordinates.size() != joints.size()) {
    fail("/joint_coordinates", "as many names as joints are needed, or none, not " +
                                   std::to_string(joint_coordinates.size()));
  }
  if (curve.size() > most_powers) {
    fail("/curve", "at most 8 factors are allowed, not " + std::to_string(curve.size()));
  }
  if (!held && compliance > 0.0) {
    fail("/compliance", "only a travel that is held has a compliance; give a stiffness");
  }
  if (held && travel.acts()) {
    fail("/held",
         "a travel that is held cannot change; set held to false, or leave its stops, "
         "spring, damping, friction and drive out");
  }
  if (defined_in != nullptr) {
    fail("",
         "a coupling cannot be added to a running world, because its travel is 0 at time 0; "
         "start with it");
  }
  check_coordinate(travel, name, path, "", errors);
  return errors;
}

Errors CouplingJoint::check_references(const Model& model, const BodySet& bodies,
                                       const std::string& path) const {
  return CouplingCheck(*this, model, bodies, path).check();
}

std::unique_ptr<ConstraintBatch> CouplingJoint::make_batch(
    const BodySet& bodies, std::span<const JointDef* const> definitions) const {
  std::vector<JointParts<CouplingKernel>> parts;
  for (const JointDef* def : definitions) {
    const auto& joint = static_cast<const CouplingJoint&>(*def);
    JointParts<CouplingKernel> part;
    part.kernel.definition = &joint;
    part.kernel.body = bodies.index(joint.body_b);
    if (joint.held) {
      JointEffect hold;
      hold.kind = JointEffect::Kind::coupling;
      hold.second = 1;
      hold.compliance = joint.compliance;
      part.effects.push_back(std::move(hold));
    } else {
      // A damper of its own sees the change of the travel, also where its gradient turns.
      JointCoordinate others = joint.travel;
      JointCoordinate damper;
      std::swap(others.damping, damper.damping);
      append_effects(others, 0, part.effects);
      append_effects(damper, 0, part.effects);
    }
    parts.push_back(std::move(part));
  }
  return std::make_unique<JointBatch<CouplingKernel>>("couplings", bodies, definitions,
                                                      std::move(parts));
}

}  // namespace sheave
