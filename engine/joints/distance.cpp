// Lock: C = |p_a - p_b| - L, gradient n at p_a and -n at p_b with n = (p_a - p_b) / |p_a - p_b|. A
// force l / h^2 along the gradient pushes the points apart. A string (C <= 0) therefore has l in
// (-inf, 0], and a bumper (C >= 0) has l in [0, inf). Coordinate: the extension, |p_a - p_b| minus
// its value at time 0.

#include "engine/joints/distance.h"

#include "engine/joints/joint_batch.h"
#include "engine/joints/lock_rows.h"

namespace sheave {
namespace {

struct DistanceKernel : AnchorPair {
  static constexpr int lock_count = 1;
  static constexpr std::array<JointCoordinateInfo, 1> coordinates{{{"extension", false}}};
  double length = 0.0;
  double start_length = 0.0;
  double compliance = 0.0;
  double damping = 0.0;
  double lower = -Row::unbounded;
  double upper = Row::unbounded;

  [[nodiscard]] bool elastic() const { return compliance > 0.0; }
  void lock(int /*index*/, JointTerms& terms) const {
    measure(length, terms);
    terms.set_compliance(compliance);
    terms.set_damping(damping);
    terms.set_bounds(lower, upper);
  }
  void coordinate(int /*index*/, JointTerms& terms) const { measure(start_length, terms); }
  void apply(const JointHold& hold) { length += hold.offset; }
  [[nodiscard]] JointHold hold_here(const DistanceKernel& defined, const Substep& now) const {
    const double growth = (a.position(now) - b.position(now)).norm() - defined.length;
    const bool pulls = lower < 0.0;
    const bool pushes = upper > 0.0;
    JointHold hold;
    if ((growth > 0.0 && pulls) || (growth < 0.0 && pushes)) hold.offset = growth;
    return hold;
  }
  void measure(double less, JointTerms& terms) const {
    const Vector3 at_a = a.position(terms.substep());
    const Vector3 at_b = b.position(terms.substep());
    const Vector3 apart = at_a - at_b;
    const double distance = apart.norm();
    terms.set_value(distance - less);
    // Coincident points have no direction; any unit vector separates them again.
    const Vector3 direction =
        distance > 0.0 ? Vector3(apart / distance) : Vector3(Vector3::UnitX());
    terms.add_force(a.body, at_a, direction);
    terms.add_force(b.body, at_b, -direction);
  }
};

/// The fields of the extension without those that the joint itself has.
std::vector<Field> extension_fields() {
  std::vector<Field> fields = coordinate_fields<DistanceJoint, &DistanceJoint::extension>(
      CoordinateKind::translation, "", "the growth of the distance since time 0");
  std::erase_if(fields, [](const Field& field) {
    return field.name == "stiffness" || field.name == "rest" || field.name == "damping";
  });
  return fields;
}

}  // namespace

std::span<const Field> DistanceJoint::field_table() {
  static const std::vector<Field> table = joined(
      {{field<&DistanceJoint::anchor_a>("anchor_a", "m", any_number(), required,
                                        "point of body_a, world frame at time 0"),
        field<&DistanceJoint::anchor_b>("anchor_b", "m", any_number(), required,
                                        "point of body_b, world frame at time 0"),
        field<&DistanceJoint::length>("length", "m", above(0.0), optional,
                                      "default: the distance at time 0"),
        choice_field<&DistanceJoint::limit>("limit", distance_limit_names, optional,
                                            "which distances are permitted: a rod, a string, a "
                                            "bumper, or any"),
        field<&DistanceJoint::compliance>("compliance", "m/N", at_least(0.0), optional,
                                          "0 (default) is rigid"),
        field<&DistanceJoint::damping>("damping", "N s/m", at_least(0.0), optional,
                                       "of an elastic joint, or, with the limit none, a dashpot")},
       extension_fields()});
  return table;
}

std::span<const JointCoordinateInfo> DistanceJoint::coordinates() const {
  return DistanceKernel::coordinates;
}

Errors DistanceJoint::validate(const BodySet& bodies, const std::string& path) const {
  Errors errors = JointDef::validate(bodies, path);
  const auto fail = [&](const char* key, const char* message) {
    errors.push_back({path + key, "joint \"" + name + "\": " + message});
  };
  if (!length && !((anchor_a - anchor_b).norm() > 0.0)) {
    fail("", "the anchors coincide; give them a distance, or \"length\", or use a ball joint");
  }
  if (damping > 0.0 && compliance == 0.0 && limit != DistanceLimit::none) {
    fail("/damping", "damping acts on an elastic joint only; give \"compliance\" too");
  }
  if (limit == DistanceLimit::none) {
    if (length) fail("/length", "any distance is permitted; leave the length out");
    if (compliance > 0.0) fail("/compliance", "any distance is permitted; leave it out");
  }
  check_coordinate(extension, name, path, "", errors);
  return errors;
}

std::unique_ptr<ConstraintBatch> DistanceJoint::make_batch(
    const BodySet& bodies, std::span<const JointDef* const> joints) const {
  std::vector<JointParts<DistanceKernel>> parts;
  for (const JointDef* def : joints) {
    const auto& joint = static_cast<const DistanceJoint&>(*def);
    DistanceKernel kernel;
    kernel.a = Anchor::at_start(bodies, joint, joint.body_a, joint.anchor_a);
    kernel.b = Anchor::at_start(bodies, joint, joint.body_b, joint.anchor_b);
    kernel.start_length = (joint.anchor_a - joint.anchor_b).norm();
    kernel.length = joint.length.value_or(kernel.start_length);
    kernel.compliance = joint.compliance;
    JointCoordinate along = joint.extension;
    switch (joint.limit) {
      case DistanceLimit::exactly:
        break;
      case DistanceLimit::at_most:
        kernel.upper = 0.0;
        break;
      case DistanceLimit::at_least:
        kernel.lower = 0.0;
        break;
      case DistanceLimit::none:
        kernel.lower = kernel.upper = 0.0;
        along.damping = joint.damping;
        break;
    }
    if (joint.limit != DistanceLimit::none) kernel.damping = joint.damping;
    JointParts<DistanceKernel> part{kernel, {}};
    append_effects(along, 0, part.effects);
    part.counts_coordinates = !part.effects.empty();
    parts.push_back(std::move(part));
  }
  return std::make_unique<JointBatch<DistanceKernel>>("distance joints", bodies, joints,
                                                      std::move(parts));
}

}  // namespace sheave
