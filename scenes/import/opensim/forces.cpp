// Forces: muscles and springs along paths, actuators and limits of coordinates.
//
// A muscle here has a rigid tendon and one law of force (scenes/control/muscle_curves.h). With the
// pennation angle a at the optimal length O, the fibres have the width O sin a. About that length,
// a fibre's length changes by cos a per length of the path. So to first order the muscle has the
// force F cos a, the optimal length O / cos a, and the tendon's length S + O cos a - O / cos a.

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "engine/index.h"
#include "engine/math/portable.h"
#include "engine/number_text.h"
#include "scenes/import/opensim/reader.h"

namespace sheave::import::opensim {
namespace {

bool is_muscle(std::string_view tag) {
  return tag.ends_with("Muscle") || tag == "Millard2012AccelerationMuscle" ||
         tag == "Schutte1993Muscle_Deprecated" || tag == "Thelen2003Muscle_Deprecated";
}

class ForceReader {
 public:
  ForceReader(const xml::Element& element, Reader& reader)
      : element_(element), reader_(reader), properties_(reader.properties) {}

  void read() {
    if (!properties_.flag(element_, "appliesForce", true) ||
        properties_.flag(element_, "isDisabled", false)) {
      reader_.log.skipped(element_, "it is switched off");
      return;
    }
    const std::string& tag = element_.tag;
    if (is_muscle(tag)) {
      muscle();
    } else if (tag == "PathSpring") {
      spring();
    } else if (tag == "PathActuator" || tag == "Ligament" || tag == "Blankevoort1991Ligament") {
      bare_path();
    } else if (tag == "CoordinateActuator") {
      actuator();
    } else if (tag == "CoordinateLimitForce") {
      limit();
    } else if (tag == "SpringGeneralizedForce") {
      joint_spring();
    } else {
      reader_.log.skipped(element_, "no force that is known here");
    }
  }

 private:
  double number(std::string_view tag, double otherwise) {
    return properties_.number(element_, tag).value_or(otherwise);
  }

  /// Adds the path as a tendon; -1 if there is none.
  int add_path() {
    mjcf::Tendon tendon;
    if (!read_path(element_, tendon, reader_)) return -1;
    reader_.model.tendons.push_back(std::move(tendon));
    return static_cast<int>(reader_.model.tendons.size()) - 1;
  }

  void muscle() {
    const int tendon = add_path();
    if (tendon < 0) return;
    const double force = properties_.positive(element_, "max_isometric_force").value_or(1000.0);
    const double optimal = properties_.positive(element_, "optimal_fiber_length").value_or(0.1);
    const double slack = number("tendon_slack_length", 0.2);
    const double angle = number("pennation_angle_at_optimal", number("pennation_angle", 0.0));
    const double cosine = portable::cos(angle);
    if (!(cosine > 0.0)) {
      reader_.log.error(element_, "the pennation angle must be below a right angle", {},
                        FaultCode::out_of_range);
      return;
    }
    mjcf::MuscleLaw law;
    law.force = force * cosine;
    law.range = {0.0, 1.0};
    const double tendon_length = slack + optimal * cosine - optimal / cosine;
    law.length_range = std::array<double, 2>{tendon_length, tendon_length + optimal / cosine};
    law.max_speed = properties_.positive(element_, "max_contraction_velocity").value_or(10.0);
    set_curves(law);
    for (const char* const curve : {"ActiveForceLengthCurve", "ForceVelocityCurve",
                                    "FiberForceLengthCurve", "TendonForceLengthCurve"}) {
      static_cast<void>(properties_.child(element_, curve));
    }
    law.activation = std::clamp(number("default_activation", 0.05), 0.0, 1.0);
    mjcf::Actuator actuator;
    actuator.element = &element_;
    actuator.name = reader_.model.tendons[at(tendon)].name;
    actuator.tendon = tendon;
    actuator.muscle = law;
    reader_.model.actuators.push_back(std::move(actuator));
    reader_.log.changed(
        element_,
        fmt::format("a rigid tendon; fibres as at the optimal length, cos of the pennation "
                    "angle {}; curves of force over length and speed of another form",
                    number_text(cosine, 6)));
  }

  /// The ends of the curves and the times of activation, with the defaults of each type.
  void set_curves(mjcf::MuscleLaw& law) {
    const bool millard = element_.tag.starts_with("Millard");
    law.lengthening_force = std::max(number("Flen", 1.4), 1.0);
    law.time_constants = {
        properties_.positive(element_, "activation_time_constant")
            .value_or(properties_.positive(element_, "activation_time_constant_1").value_or(0.01)),
        properties_.positive(element_, "deactivation_time_constant").value_or(0.04)};
    law.passive_force = 1.0;  // at the longest length
    // Millard's curve of active force ends at these lengths.
    law.shortest = millard ? 0.4441 : 0.5;
    law.longest = 1.0 + std::max(number("FmaxMuscleStrain", millard ? 0.7 : 0.6), 1e-3);
  }

  void spring() {
    const int number_of_tendon = add_path();
    if (number_of_tendon < 0) return;
    mjcf::Tendon& tendon = reader_.model.tendons[at(number_of_tendon)];
    const bool over_ellipsoid =
        std::any_of(tendon.path.begin(), tendon.path.end(), [&](const mjcf::PathPoint& point) {
          return point.geom >= 0 &&
                 reader_.model.geoms[at(point.geom)].type == mjcf::GeomType::ellipsoid;
        });
    if (over_ellipsoid) {
      reader_.log.changed(element_,
                          "its path alone; the rest lengths of an elastic cable over an "
                          "ellipsoid are not known here");
      return;
    }
    tendon.stiffness = number("stiffness", 1.0);
    tendon.spring_length = number("resting_length", 0.0);
    if (!(tendon.stiffness > 0.0) || !(*tendon.spring_length > 0.0)) {
      reader_.log.error(element_, "stiffness and resting_length must be > 0", {},
                        FaultCode::out_of_range);
    }
    if (number("dissipation", 0.0) != 0.0) {
      reader_.log.changed(element_, "not taken: dissipation, which grows with the stretch");
    }
  }

  void bare_path() {
    if (add_path() < 0) return;
    for (const char* const tag : {"optimal_force", "resting_length", "pcsa_force", "slack_length",
                                  "linear_stiffness", "transition_strain"}) {
      static_cast<void>(properties_.child(element_, tag));
    }
    reader_.log.changed(element_, element_.tag == "PathActuator"
                                      ? "its path alone; a force that a control sets along a cable "
                                        "has no counterpart"
                                      : "its path alone; its curve of force has no counterpart");
  }

  /// The joint of the coordinate that the force names; -1 if there is none, which the log tells.
  int joint_of(std::initializer_list<const char*> tags) {
    std::string path;
    for (const char* const tag : tags) {
      if (path.empty()) path = properties_.text(element_, tag);
    }
    const std::size_t slash = path.rfind('/');
    coordinate_ = reader_.coordinate(slash == std::string::npos ? path : path.substr(slash + 1));
    if (coordinate_ < 0) {
      reader_.log.error(element_, "<coordinate> must be the name of a coordinate", path,
                        FaultCode::meaning);
      return -1;
    }
    const int joint = own().joint;
    if (joint < 0) {
      reader_.log.skipped(element_,
                          "its coordinate is locked, or a part of a ball joint or a free body");
    }
    return joint;
  }
  [[nodiscard]] const Coordinate& own() const { return reader_.coordinates[at(coordinate_)]; }

  void actuator() {
    const int joint = joint_of({"coordinate", "socket_coordinate"});
    if (joint < 0) return;
    const std::string* const name = element_.value("name");
    mjcf::Actuator actuator;
    actuator.element = &element_;
    actuator.name = name == nullptr ? "" : *name;
    actuator.joint = joint;
    actuator.gain = number("optimal_force", 1.0) / own().factor;
    reader_.model.actuators.push_back(std::move(actuator));
  }

  void joint_spring() {
    const int number_of_joint = joint_of({"coordinate", "socket_coordinate"});
    if (number_of_joint < 0) return;
    mjcf::Joint& joint = reader_.model.joints[at(number_of_joint)];
    const double square = own().factor * own().factor;
    const double stiffness = number("stiffness", 0.0) / square;
    const double viscosity = number("viscosity", 0.0) / square;
    if (stiffness < 0.0 || viscosity < 0.0) {
      reader_.log.error(element_, "stiffness and viscosity must be >= 0", {},
                        FaultCode::out_of_range);
      return;
    }
    if (joint.stiffness > 0.0 && stiffness > 0.0) {
      reader_.log.skipped(element_, "its coordinate has another spring");
      return;
    }
    if (stiffness > 0.0) {
      joint.stiffness = stiffness;
      joint.spring_reference = own().factor * number("rest_length", 0.0) + own().offset;
    } else {
      static_cast<void>(number("rest_length", 0.0));
    }
    joint.damping += viscosity;
    reader_.log.same(element_, fmt::format("spring and damper of the joint \"{}\"", joint.name));
  }

  void limit() {
    const int number_of_joint = joint_of({"coordinate", "socket_coordinate"});
    if (number_of_joint < 0) return;
    mjcf::Joint& joint = reader_.model.joints[at(number_of_joint)];
    // Its limits and stiffnesses of a rotation are in degrees.
    const double unit = joint.type == mjcf::JointType::hinge ? pi / 180.0 : 1.0;
    const auto position = [&](double value) { return own().factor * unit * value + own().offset; };
    const double stiffness =
        0.5 * (number("upper_stiffness", 1.0) + number("lower_stiffness", 1.0)) / unit;
    const std::array<double, 2> range{position(number("lower_limit", 0.0)),
                                      position(number("upper_limit", 0.0))};
    if (!(stiffness > 0.0) || !(range[0] < range[1])) {
      reader_.log.error(element_,
                        "the upper limit must be above the lower one, and stiffnesses > 0", {},
                        FaultCode::out_of_range);
      return;
    }
    if (joint.range) {
      reader_.log.skipped(element_, "its coordinate has stops already");
      return;
    }
    joint.range = range;
    joint.limit_compliance = own().factor * own().factor / stiffness;
    reader_.log.changed(element_, fmt::format("elastic stops of {} per rad or m, the mean of both, "
                                              "from the limits on; no transition, no damping",
                                              number_text(stiffness, 6)));
    for (const char* const tag : {"damping", "transition"}) {
      static_cast<void>(properties_.child(element_, tag));
    }
  }

  const xml::Element& element_;
  Reader& reader_;
  Properties& properties_;
  int coordinate_ = -1;
};

}  // namespace

void read_forces(Reader& reader) {
  for (const xml::Element* const element : reader.properties.objects(reader.root, "ForceSet")) {
    ForceReader(*element, reader).read();
  }
}

}  // namespace sheave::import::opensim
