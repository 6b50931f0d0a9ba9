// The list of joints, the stops and followers of their coordinates, and bodies without a joint.

#include <fmt/format.h>

#include "engine/index.h"
#include "scenes/import/opensim/reader.h"

namespace sheave::import::opensim {

using mjcf::Frame;
using mjcf::JointType;

int add_joint(JointType type, const Vector3& axis, const Vector3& position,
              const xml::Element& element, int body, Reader& reader) {
  mjcf::Model& model = reader.model;
  mjcf::Joint joint;
  joint.element = &element;
  joint.type = type;
  joint.body = body;
  joint.axis = axis.normalized();
  joint.position = position;
  joint.qpos = model.position_count;
  joint.qvel = model.velocity_count;
  model.position_count += joint.position_count();
  model.velocity_count += joint.velocity_count();
  if (type == JointType::ball || type == JointType::free) {
    if (const std::string* name = element.value("name")) joint.name = *name;
  }
  const int number = static_cast<int>(model.joints.size());
  model.bodies[at(body)].joints.push_back(number);
  model.joints.push_back(std::move(joint));
  reader.driven.emplace_back();
  return number;
}

void add_body(int body, const RawJoint* joint, Reader& reader) {
  RawBody& raw = reader.bodies[at(body)];
  if (joint != nullptr) {
    build_joint(body, *joint, reader);
    return;
  }
  mjcf::Body free;
  free.element = raw.element;
  free.name = raw.name;
  free.given = free.inertial = raw.inertial;
  raw.number = static_cast<int>(reader.model.bodies.size());
  reader.model.bodies.push_back(std::move(free));
  reader.start_frames.emplace_back();
  static_cast<void>(add_joint(JointType::free, Vector3::UnitZ(), Vector3::Zero(), *raw.element,
                              raw.number, reader));
  reader.log.same(*raw.element, "has no joint: it is free");
}

void finish_joints(Reader& reader) {
  for (const Follower& follower : reader.followers) {
    const Coordinate& coordinate = reader.coordinates[at(follower.coordinate)];
    if (coordinate.joint < 0) {
      reader.log.error(
          *follower.element,
          fmt::format("the coordinate \"{}\" has no joint that moves by it alone", coordinate.name),
          {}, FaultCode::meaning);
      continue;
    }
    mjcf::Equality equality;
    equality.element = follower.element;
    equality.name = reader.model.joints[at(follower.joint)].name + " follows";
    equality.type = mjcf::EqualityType::joint;
    equality.joint1 = follower.joint;
    equality.joint2 = coordinate.joint;
    // The coordinate is (position - offset) / factor.
    equality.polynomial =
        of_line(follower.factors, 1.0 / coordinate.factor, -coordinate.offset / coordinate.factor);
    reader.model.equalities.push_back(std::move(equality));
  }
  for (const Coordinate& coordinate : reader.coordinates) {
    if (!coordinate.clamped || coordinate.joint < 0) continue;
    if (!coordinate.has_stops) {
      reader.log.changed(*coordinate.element, "not taken: its range");
      continue;
    }
    const auto position = [&](double value) {
      return coordinate.factor * value + coordinate.offset;
    };
    reader.model.joints[at(coordinate.joint)].range =
        std::array<double, 2>{position(coordinate.range[0]), position(coordinate.range[1])};
    reader.log.changed(*coordinate.element,
                       "stops of its joint, in OpenSim a range for values that are set");
  }
}

void read_joints(Reader& reader) {
  const auto enter = [&](const xml::Element& element, int child) {
    RawJoint joint;
    joint.element = &element;
    if (child < 0) {
      const std::string* const name = element.value("name");
      const std::string inside = "/jointset/" + (name == nullptr ? "" : *name);
      joint.parent = frame_of(element, "parent_frame", inside, reader);
      joint.child = frame_of(element, "child_frame", inside, reader);
    } else {
      Properties& properties = reader.properties;
      const auto frame = [&](const char* position, const char* orientation) {
        return Frame{properties.vector(element, position).value_or(Vector3::Zero()),
                     from_xyz(properties.vector(element, orientation).value_or(Vector3::Zero()))};
      };
      const std::string parent = properties.text(element, "parent_body");
      const auto found = reader.body_names.find(parent);
      if (found == reader.body_names.end()) {
        reader.log.error(element, "<parent_body> must be the name of a body", parent,
                         FaultCode::meaning);
        return;
      }
      joint.parent = {found->second, frame("location_in_parent", "orientation_in_parent")};
      joint.child = {child, frame("location", "orientation")};
    }
    if (reader.properties.flag(element, "reverse", false)) {
      reader.log.error(element, "<reverse> is not known here; swap parent and child", {},
                       FaultCode::meaning);
    }
    joint.coordinates = read_coordinates(element, reader);
    if (joint.parent.body >= 0 && joint.child.body >= 0) reader.joints.push_back(joint);
  };
  for (const xml::Element* const element : reader.properties.objects(reader.root, "JointSet")) {
    enter(*element, -1);
  }
  // Before version 4 a body holds the joint to its parent.
  for (std::size_t i = 1; i < reader.bodies.size(); ++i) {
    const xml::Element* const joint = reader.properties.child(*reader.bodies[i].element, "Joint");
    if (joint == nullptr) continue;
    for (const xml::Element& element : joint->children) {
      reader.properties.mark(element);
      enter(element, static_cast<int>(i));
    }
  }
}

}  // namespace sheave::import::opensim
