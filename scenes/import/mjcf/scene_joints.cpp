// Joints. A body with several joints is joined by the one joint of a scene that leaves the same
// motions (joint_kind.h). Other bodies have been split before.
//
// Joints count their coordinates from time 0, MJCF from the reference pose.

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "engine/index.h"
#include "scenes/import/mjcf/joint_kind.h"
#include "scenes/import/mjcf/scene.h"

namespace sheave::import::mjcf {
namespace {

const char* body_of(const Writer& writer, int number) {
  // A part of the world is a static body only where it has a name of its own.
  const Carrier& carrier = writer.carriers[at(number)];
  return carrier.body == 0 ? "world" : writer.body_names[at(carrier.body)].c_str();
}

/// Writes stops, spring, friction and drive of a coordinate that runs along the joint's own
/// (sense 1) or against it.
void write_coordinate(Writer& writer, int number, const std::string& prefix, double sense,
                      bool turns, Json& json) {
  const Joint& joint = writer.model.joints[at(number)];
  const std::string plain = turns ? "angle" : "travel";
  const bool numbered = prefix.starts_with("angle_a") || prefix.starts_with("angle_b");
  writer.coordinates[at(number)] = {
      {}, numbered ? prefix.substr(0, prefix.size() - 1) : plain, sense};
  const double start = writer.start.positions[at(joint.qpos)];
  const auto own = [&](double coordinate) { return sense * (coordinate - start); };
  if (joint.range) {
    std::array<double, 2> range{own((*joint.range)[0]), own((*joint.range)[1])};
    if (sense < 0.0) std::swap(range[0], range[1]);
    if (range[0] > 0.0 || range[1] < 0.0) {
      writer.log.changed(*joint.element,
                         "the body starts outside the range; the stop is moved to the start");
    }
    json[prefix + "lower"] = std::min(range[0], 0.0);
    json[prefix + "upper"] = std::max(range[1], 0.0);
    if (joint.limit_compliance > 0.0) {
      json[prefix + "limit_compliance"] = joint.limit_compliance;
    } else if (writer.model.is_soft) {
      writer.log.changed(*joint.element, "the limits of its range are rigid, not soft");
    }
  }
  if (joint.stiffness > 0.0) {
    json[prefix + "stiffness"] = joint.stiffness;
    json[prefix + "rest"] = own(joint.spring_reference);
  }
  const std::optional<Drive>& drive = writer.drives[at(number)];
  const double damping = joint.damping + (drive ? drive->damping : 0.0);
  if (damping > 0.0) json[prefix + "damping"] = damping;
  if (joint.friction > 0.0) {
    json[prefix + "friction"] = joint.friction;
    writer.log.changed(*joint.element, "frictionloss is rigid dry friction");
  }
  if (!drive) return;
  json[prefix + "drive"] =
      drive->to_position ? (turns ? "angle" : "position") : (turns ? "torque" : "force");
  json[prefix + "drive_values"] = {drive->to_position ? own(drive->value) : sense * drive->value};
  if (!drive->to_position) return;
  json[prefix + "drive_compliance"] = drive->compliance;
  if (drive->limit) json[prefix + "drive_limit"] = *drive->limit;
}

/// A name that no body has: quantities such as NAME.angle would be those of either.
std::string take_name(const Writer& writer, Names& names, const std::string& wanted,
                      const std::string& otherwise) {
  const std::string given = Names().take(wanted, otherwise);
  const auto& bodies = writer.body_names;
  const bool is_body = std::find(bodies.begin(), bodies.end(), given) != bodies.end();
  return names.take(is_body ? given + " joint" : wanted, otherwise);
}

/// The joints of one body of the model.
class BodyJoints {
 public:
  BodyJoints(Writer& writer, int body)
      : writer_(writer), numbers_(writer.model.bodies[at(body)].joints), body_(body) {}

  /// The joint of the scene, of a kind that is neither `none` nor `free`.
  Json write(JointKind kind) {
    switch (kind) {
      case JointKind::ball:
        return ball();
      case JointKind::slider:
        return one("slider", false);
      case JointKind::universal:
        return universal();
      case JointKind::cylindrical:
        return cylindrical();
      case JointKind::plane:
        return plane();
      case JointKind::three_hinges:
        return begin("ball", world(*meeting_point(joint(numbers_[0]), joint(numbers_[1]))));
      default:
        return one("hinge", true);
    }
  }

 private:
  [[nodiscard]] const Joint& joint(int number) const { return writer_.model.joints[at(number)]; }
  [[nodiscard]] const JointPose& pose(int number) const { return writer_.start.joints[at(number)]; }
  [[nodiscard]] int of_type(JointType type) const {
    return *std::find_if(numbers_.begin(), numbers_.end(),
                         [&](int j) { return joint(j).type == type; });
  }
  [[nodiscard]] Json begin(const char* type, const Vector3& anchor) const {
    return {{"type", type},
            {"body_a", body_of(writer_, writer_.model.bodies[at(body_)].parent)},
            {"body_b", body_of(writer_, body_)},
            {"anchor", json_of(anchor)}};
  }
  [[nodiscard]] Vector3 world(const Vector3& own) const {
    return writer_.at_start(body_).point(own);
  }

  Json one(const char* type, bool turns) {
    const int number = numbers_.front();
    Json json = begin(type, pose(number).anchor);
    json["axis"] = json_of(pose(number).axis);
    write_coordinate(writer_, number, "", 1.0, turns, json);
    return json;
  }

  Json ball() {
    const Joint& own = joint(numbers_.front());
    Json json = begin("ball", pose(numbers_.front()).anchor);
    if (own.damping > 0.0) json["damping"] = own.damping;
    if (own.friction > 0.0) {
      json["friction"] = own.friction;
      writer_.log.changed(*own.element, "frictionloss acts against the rotation as a whole");
    }
    if (own.range) {
      writer_.log.changed(*own.element, "not taken: range; a ball has swing_limit and twist stops");
    }
    if (own.stiffness > 0.0) {
      writer_.log.changed(*own.element, "not taken: stiffness; a ball has twist_stiffness alone");
    }
    return json;
  }

  Json universal() {
    const int first = numbers_[0];
    const int second = numbers_[1];
    Json json = begin("universal", world(*meeting_point(joint(first), joint(second))));
    json["axis_a"] = json_of(pose(first).axis);
    json["axis_b"] = json_of(pose(second).axis);
    write_coordinate(writer_, first, "angle_a_", 1.0, true, json);
    write_coordinate(writer_, second, "angle_b_", 1.0, true, json);
    return json;
  }

  Json cylindrical() {
    const int hinge = of_type(JointType::hinge);
    const int slide = of_type(JointType::slide);
    const double along = joint(hinge).axis.dot(joint(slide).axis);
    Json json = begin("cylindrical", pose(hinge).anchor);
    json["axis"] = json_of(pose(slide).axis);
    write_coordinate(writer_, slide, "travel_", 1.0, false, json);
    write_coordinate(writer_, hinge, "angle_", along > 0.0 ? 1.0 : -1.0, true, json);
    return json;
  }

  Json plane() {
    const int hinge = of_type(JointType::hinge);
    const double damping = joint(of_type(JointType::slide)).damping;
    Json json = begin("plane", pose(hinge).anchor);
    json["normal"] = json_of(pose(hinge).axis);
    if (damping > 0.0) json["damping"] = damping;
    write_coordinate(writer_, hinge, "angle_", 1.0, true, json);
    return json;
  }

  Writer& writer_;
  const std::vector<int>& numbers_;
  int body_;
};

}  // namespace

void write_joints(Writer& writer) {
  writer.coordinates.resize(writer.model.joints.size());
  Json list = Json::array();
  Names names;
  for (std::size_t i = 1; i < writer.model.bodies.size(); ++i) {
    const Body& body = writer.model.bodies[i];
    if (body.joints.empty()) continue;
    const Joint& first = writer.model.joints[at(body.joints.front())];
    if (first.type == JointType::free) {
      writer.log.same(*first.element, "the body is free");
      continue;
    }
    const JointKind kind = joint_kind(writer.model, static_cast<int>(i));
    if (kind == JointKind::none) continue;  // a body without mass, which is an error already
    Json json = BodyJoints(writer, static_cast<int>(i)).write(kind);
    std::string wanted;
    for (const int number : body.joints) {
      const std::string& name = writer.model.joints[at(number)].name;
      wanted += (wanted.empty() || name.empty() ? "" : " ") + name;
    }
    const std::string name =
        take_name(writer, names, wanted, fmt::format("joint of {}", writer.body_names[i]));
    for (const int number : body.joints) {
      if (writer.coordinates[at(number)]) writer.coordinates[at(number)]->joint = name;
    }
    Json named = {{"type", json["type"]}, {"name", name}};
    named.update(json);
    for (const int number : body.joints) {
      writer.log.same(
          *writer.model.joints[at(number)].element,
          fmt::format("the joint \"{}\", {}", name, named["type"].get_ref<const std::string&>()));
    }
    writer.log.origin(*first.element, fmt::format("/joints/{}", list.size()));
    list.push_back(std::move(named));
  }
  writer.scene["joints"] = std::move(list);
}

void write_equalities(Writer& writer) {
  Json& list = writer.scene["joints"];
  Names names;
  for (const Json& joint : list) {
    static_cast<void>(names.take(joint["name"].get_ref<const std::string&>(), ""));
  }
  for (const Equality& equality : writer.model.equalities) {
    if (equality.type == EqualityType::joint) continue;
    const bool weld = equality.type == EqualityType::weld;
    const Carrier& a = writer.carriers[at(equality.body1)];
    const Carrier& b = writer.carriers[at(equality.body2)];
    if (a.body == b.body || (!a.moves && !b.moves)) {
      writer.log.skipped(*equality.element, "both bodies are parts of one, or stand still");
      continue;
    }
    const Frame& first = writer.start.bodies[at(equality.body1)].frame;
    const Frame& second = writer.start.bodies[at(equality.body2)].frame;
    const Frame& first_reference = writer.reference.bodies[at(equality.body1)].frame;
    const Frame& second_reference = writer.reference.bodies[at(equality.body2)].frame;
    const Vector3 anchor = first.point(equality.anchor);
    const Vector3 other =
        second.point(second_reference.orientation.conjugate() *
                     (first_reference.point(equality.anchor) - second_reference.position));
    const double turned = (second_reference.orientation.conjugate() * first_reference.orientation)
                              .angularDistance(second.orientation.conjugate() * first.orientation);
    if ((anchor - other).norm() > 1e-9 || (weld && turned > 1e-7)) {
      writer.log.changed(*equality.element, "the bodies are joined as they stand at the start");
    }
    const char* const type = weld ? "fixed" : "ball";
    const std::string name = names.take(equality.name, weld ? "weld" : "connect");
    writer.log.origin(*equality.element, fmt::format("/joints/{}", list.size()));
    const std::string text = fmt::format("the joint \"{}\", {}", name, type);
    if (writer.model.is_soft) {
      writer.log.changed(*equality.element, text + ", rigid, not soft");
    } else {
      writer.log.same(*equality.element, text);
    }
    list.push_back({{"type", type},
                    {"name", name},
                    {"body_a", body_of(writer, equality.body1)},
                    {"body_b", body_of(writer, equality.body2)},
                    {"anchor", json_of(anchor)}});
  }
}

}  // namespace sheave::import::mjcf
