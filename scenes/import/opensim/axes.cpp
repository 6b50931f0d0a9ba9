// The displacements of a joint: those of its type, or those of the <SpatialTransform> of a
// CustomJoint. All joints of OpenSim have the form of a CustomJoint.

#include <fmt/format.h>

#include "engine/index.h"
#include "scenes/import/opensim/reader.h"

namespace sheave::import::opensim {
namespace {

/// Displacements of a type along (t) or about (r) x, y and z, in the order of its coordinates, of
/// which displacements along directions come first in a chain.
struct TypeAxes {
  std::string_view type;
  std::string_view motions;
};
constexpr std::array<TypeAxes, 9> types{{{"WeldJoint", ""},
                                         {"PinJoint", "rz"},
                                         {"SliderJoint", "tx"},
                                         {"UniversalJoint", "rx ry"},
                                         {"PlanarJoint", "rz tx ty"},
                                         {"BallJoint", "rx ry rz"},
                                         {"GimbalJoint", "rx ry rz"},
                                         {"FreeJoint", "rx ry rz tx ty tz"},
                                         {"CustomJoint", "?"}}};

/// The axes of a type whose displacements are its coordinates.
std::vector<Axis> simple_axes(const xml::Element& joint, std::string_view motions,
                              const std::vector<int>& coordinates, Reader& reader) {
  std::vector<Axis> along, about;
  for (std::size_t i = 0; 3 * i < motions.size(); ++i) {
    Axis axis;
    axis.element = &joint;
    axis.turns = motions[3 * i] == 'r';
    axis.direction = Vector3::Unit(motions[3 * i + 1] - 'x');
    if (i < coordinates.size()) axis.coordinate = coordinates[i];
    axis.function = Function({0.0, 1.0});
    (axis.turns ? about : along).push_back(axis);
  }
  const std::size_t needed = (motions.size() + 1) / 3;
  if (coordinates.size() != needed) {
    reader.log.error(joint,
                     fmt::format("a {} has {} coordinates, each with a name; there are {}",
                                 joint.tag, needed, coordinates.size()),
                     {}, FaultCode::meaning);
  }
  along.insert(along.end(), about.begin(), about.end());
  return along;
}

/// Reads one <TransformAxis>.
Axis transform_axis(const xml::Element& element, bool turns, Reader& reader) {
  Axis axis;
  axis.element = &element;
  axis.turns = turns;
  const Vector3 given = reader.properties.vector(element, "axis").value_or(Vector3::UnitX());
  const double length = given.norm();
  if (length > 1e-10 && length < 1e100) {
    axis.direction = given / length;
  } else {
    reader.log.error(element, "axis must be a direction of a length that is not 0",
                     reader.properties.text(element, "axis"), FaultCode::out_of_range);
  }
  std::string name = reader.properties.text(element, "coordinates");
  if (name.empty()) name = reader.properties.text(element, "coordinate");
  if (!name.empty()) {
    axis.coordinate = reader.coordinate(name);
    if (axis.coordinate < 0) {
      reader.log.error(element, "coordinates must be the name of one coordinate", name,
                       FaultCode::meaning);
    }
  }
  const auto function = read_function(element, "function", reader.properties, reader.log);
  if (function) axis.function = *function;
  if (!function && axis.coordinate >= 0) axis.function = Function({0.0, 1.0});
  if (axis.function.is_constant()) axis.coordinate = -1;
  if (!axis.function.is_constant() && axis.coordinate < 0) {
    reader.log.error(element, "its function needs a coordinate; name one in <coordinates>", {},
                     FaultCode::missing_key);
  }
  return axis;
}

std::vector<Axis> custom_axes(const xml::Element& joint, Reader& reader) {
  const xml::Element* const transform = reader.properties.child(joint, "SpatialTransform");
  if (transform == nullptr) {
    reader.log.error(joint, "<SpatialTransform> is missing", {}, FaultCode::missing_key);
    return {};
  }
  std::vector<Axis> along, about;
  for (const xml::Element& child : transform->children) {
    // Before version 4 these are named objects.
    const std::string* const name = child.value("name");
    const bool known = child.tag == "TransformAxis" && name != nullptr;
    const bool turns = known && name->starts_with("rotation");
    if (!turns && !(known && name->starts_with("translation"))) continue;
    reader.properties.mark(child);
    (turns ? about : along).push_back(transform_axis(child, turns, reader));
  }
  constexpr std::size_t most = 3;
  if (along.size() > most || about.size() > most) {
    reader.log.error(*transform, "there are at most three rotations and three translations", {},
                     FaultCode::meaning);
    return {};
  }
  along.insert(along.end(), about.begin(), about.end());
  return along;
}

}  // namespace

int Reader::coordinate(std::string_view name) const {
  const auto found = coordinate_names.find(name);
  return found == coordinate_names.end() ? -1 : found->second;
}

std::vector<int> read_coordinates(const xml::Element& joint, Reader& reader) {
  std::vector<int> list;
  Properties& properties = reader.properties;
  std::vector<const xml::Element*> elements = properties.objects(joint, "coordinates");
  for (const xml::Element* const one : properties.objects(joint, "CoordinateSet")) {
    elements.push_back(one);
  }
  for (const xml::Element* const element : elements) {
    const std::string* const name = element->value("name");
    Coordinate coordinate;
    coordinate.element = element;
    coordinate.name = name == nullptr ? "" : *name;
    coordinate.start = properties.number(*element, "default_value").value_or(0.0);
    coordinate.clamped = properties.flag(*element, "clamped", false);
    coordinate.locked = properties.flag(*element, "locked", false);
    const std::string range = properties.text(*element, "range");
    if (!range.empty() && range.find("nf") == std::string::npos) {
      const auto ends = properties.numbers(*element, "range", 2, 2);
      if (!ends.empty()) coordinate.range = {ends[0], ends[1]};
      if (!(coordinate.range[0] <= coordinate.range[1])) {
        reader.log.error(*element, "range must be two numbers, the lower one first", range,
                         FaultCode::out_of_range);
      }
    } else {
      coordinate.clamped = false;
    }
    if (properties.number(*element, "default_speed_value").value_or(0.0) != 0.0) {
      reader.log.changed(*element, "not taken: default_speed_value; the scene starts at rest");
    }
    if (properties.flag(*element, "prescribed", false)) {
      reader.log.changed(*element, "not taken: prescribed; the coordinate is free");
    }
    const int number = static_cast<int>(reader.coordinates.size());
    if (coordinate.name.empty() ||
        !reader.coordinate_names.emplace(coordinate.name, number).second) {
      reader.log.error(*element, "a coordinate needs a name of its own", coordinate.name,
                       FaultCode::duplicate_name);
      continue;
    }
    reader.coordinates.push_back(std::move(coordinate));
    list.push_back(number);
  }
  return list;
}

std::vector<Axis> axes_of(const RawJoint& joint, Reader& reader) {
  const xml::Element& element = *joint.element;
  for (const TypeAxes& one : types) {
    if (one.type != element.tag) continue;
    return one.motions == "?" ? custom_axes(element, reader)
                              : simple_axes(element, one.motions, joint.coordinates, reader);
  }
  reader.log.error(element,
                   "no joint that is known here; allowed are WeldJoint, PinJoint, SliderJoint, "
                   "UniversalJoint, PlanarJoint, BallJoint, GimbalJoint, FreeJoint and CustomJoint",
                   {}, FaultCode::unknown_choice);
  return {};
}

}  // namespace sheave::import::opensim
