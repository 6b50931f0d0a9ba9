// Constraints: welds, points, and coordinates that follow others.

#include <fmt/format.h>

#include "engine/index.h"
#include "engine/number_text.h"
#include "scenes/import/opensim/reader.h"

namespace sheave::import::opensim {
namespace {

constexpr double wanted_misfit = 1e-9;
constexpr double most_misfit = 0.02;  // [rad or m]

/// The frame of one side of a constraint, by a body's name before version 4.
FixedFrame side(const xml::Element& element, int number, Reader& reader) {
  const std::string old = reader.properties.text(element, fmt::format("body_{}", number));
  const std::string* const name = element.value("name");
  const std::string inside = "/constraintset/" + (name == nullptr ? "" : *name);
  FixedFrame frame;
  if (!old.empty()) {
    const auto found = reader.body_names.find(old);
    if (found == reader.body_names.end()) {
      reader.log.error(element, fmt::format("<body_{}> must be the name of a body", number), old,
                       FaultCode::meaning);
      return {};
    }
    frame.body = found->second;
  } else {
    const bool weld = element.tag == "WeldConstraint";
    frame =
        frame_of(element, fmt::format("{}{}", weld ? "frame" : "body_", number), inside, reader);
  }
  if (frame.body < 0) return {};
  const char* const point =
      element.tag == "PointConstraint" ? "location_body_{}" : "location_in_body_{}";
  const std::string tag = fmt::format(fmt::runtime(point), number);
  if (const auto own = reader.properties.vector(element, tag)) {
    frame.frame.position = frame.frame.point(*own);
  }
  return frame;
}

void join(const xml::Element& element, mjcf::EqualityType type, Reader& reader) {
  const FixedFrame first = side(element, 1, reader);
  const FixedFrame second = side(element, 2, reader);
  if (first.body < 0 || second.body < 0) return;
  mjcf::Equality equality;
  equality.element = &element;
  equality.name = element.value("name") == nullptr ? "" : *element.value("name");
  equality.type = type;
  equality.body1 = reader.bodies[at(first.body)].number;
  equality.body2 = reader.bodies[at(second.body)].number;
  equality.anchor = first.frame.position;
  const mjcf::Pose& pose = start_pose(reader);
  const double apart = (pose.bodies[at(equality.body1)].frame.point(first.frame.position) -
                        pose.bodies[at(equality.body2)].frame.point(second.frame.position))
                           .norm();
  if (apart > 1e-6) {
    reader.log.changed(element,
                       fmt::format("the bodies are joined as they stand at the start, where "
                                   "the points are {} m apart",
                                   number_text(apart, 3)));
  }
  reader.model.equalities.push_back(std::move(equality));
}

/// Reads a constraint of two coordinates.
void enter_coupler(const xml::Element& element, Reader& reader) {
  Properties& properties = reader.properties;
  const int follower = reader.coordinate(properties.text(element, "dependent_coordinate_name"));
  Coupler coupler;
  coupler.element = &element;
  coupler.leader = reader.coordinate(properties.text(element, "independent_coordinate_names"));
  const auto function =
      read_function(element, "coupled_coordinates_function", properties, reader.log);
  if (follower < 0 || coupler.leader < 0 || follower == coupler.leader || !function) {
    reader.log.error(element,
                     "needed are the names of two coordinates, the dependent and one independent, "
                     "and a function",
                     {}, FaultCode::meaning);
    return;
  }
  coupler.function = function->scaled(properties.number(element, "scale_factor").value_or(1.0));
  reader.coordinates[at(follower)].is_named = true;
  reader.coordinates[at(coupler.leader)].is_named = true;
  if (reader.couplers.emplace(follower, coupler).second) return;
  reader.log.error(element, "another constraint has the same dependent coordinate", {},
                   FaultCode::meaning);
}

void couple(const xml::Element& element, int follower, const Coupler& coupler, Reader& reader) {
  const int leader = coupler.leader;
  const Coordinate& from = reader.coordinates[at(leader)];
  const Coordinate& to = reader.coordinates[at(follower)];
  if (coupler.is_replaced) {
    reader.log.same(element, fmt::format("what the coordinate \"{}\" moves follows \"{}\" itself",
                                         to.name, from.name));
    return;
  }
  if (from.joint < 0 || to.joint < 0) {
    reader.log.skipped(
        element, "one of its coordinates is locked, or a part of a ball joint or a free body");
    return;
  }
  const Function& scaled = coupler.function;
  const Fit fit = fit_polynomial(scaled, from.range[0],
                                 std::max(from.range[1], from.range[0] + 1e-6), wanted_misfit);
  if (fit.deviation > most_misfit) {
    reader.log.error(element,
                     fmt::format("a coupling has a polynomial of degree 9, which differs from this "
                                 "function by up to {} in the range of the coordinate",
                                 number_text(fit.deviation, 3)),
                     {}, FaultCode::meaning);
    return;
  }
  if (!scaled.is_polynomial()) {
    reader.log.changed(element, fmt::format("a polynomial of degree 9 in place of the function, "
                                            "which differs by up to {} in the range of the "
                                            "coordinate",
                                            number_text(fit.deviation, 3)));
  }
  mjcf::Equality equality;
  equality.element = &element;
  equality.name = element.value("name") == nullptr ? "" : *element.value("name");
  equality.type = mjcf::EqualityType::joint;
  equality.joint1 = to.joint;
  equality.joint2 = from.joint;
  equality.polynomial = of_line(fit.factors, 1.0 / from.factor, -from.offset / from.factor);
  for (double& factor : equality.polynomial) factor *= to.factor;
  equality.polynomial[0] += to.offset;
  reader.model.equalities.push_back(equality);
  // The scene starts where the coordinates agree.
  Driven& driven = reader.driven[at(to.joint)];
  if (reader.driven[at(from.joint)].coordinate != leader) return;
  driven.coordinate = leader;
  driven.factors = fit.factors;
  for (double& factor : driven.factors) factor *= to.factor;
  driven.factors[0] += to.offset;
}

bool is_on(const xml::Element& element, Reader& reader) {
  return reader.properties.flag(element, "isEnforced", true) &&
         !reader.properties.flag(element, "isDisabled", false);
}

}  // namespace

void read_couplers(Reader& reader) {
  for (const xml::Element* const force : reader.properties.objects(reader.root, "ForceSet")) {
    for (const xml::Element& property : force->children) {
      if (property.tag != "coordinate" && property.tag != "socket_coordinate") continue;
      const std::size_t slash = property.text.rfind('/');
      const int number = reader.coordinate(
          slash == std::string::npos ? property.text : property.text.substr(slash + 1));
      if (number >= 0) reader.coordinates[at(number)].is_named = true;
    }
  }
  for (const xml::Element* const element :
       reader.properties.objects(reader.root, "ConstraintSet")) {
    if (element->tag == "CoordinateCouplerConstraint" && is_on(*element, reader)) {
      enter_coupler(*element, reader);
    }
  }
}

void read_constraints(Reader& reader) {
  // Coordinates that depend move the start, where the others join bodies.
  for (const auto& [follower, coupler] : reader.couplers) {
    couple(*coupler.element, follower, coupler, reader);
  }
  for (const xml::Element* const element :
       reader.properties.objects(reader.root, "ConstraintSet")) {
    if (!is_on(*element, reader)) {
      reader.log.skipped(*element, "it is switched off");
    } else if (element->tag == "WeldConstraint") {
      join(*element, mjcf::EqualityType::weld, reader);
    } else if (element->tag == "PointConstraint") {
      join(*element, mjcf::EqualityType::connect, reader);
    } else if (element->tag != "CoordinateCouplerConstraint") {
      reader.log.skipped(*element, "no constraint that is known here");
    }
  }
}

}  // namespace sheave::import::opensim
