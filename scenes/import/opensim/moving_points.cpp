// <MovingPathPoint>: the point p(q) = (x(q_x), y(q_y), z(q_z)) in a frame of a body, by functions of
// coordinates. A chain of small bodies, one per function that is not constant, slides along the axes
// of the frame, and a held coupling keeps each slide at the polynomial of its coordinate.
//
// The virtual work of the couplings makes the point's motion part of moment arms,
//   d length / d q = (by the bodies at a fixed point) + (unit vectors of both spans) . dp/dq,
// which is the force along the coordinate that OpenSim adds for such points.

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "engine/index.h"
#include "engine/number_text.h"
#include "scenes/import/opensim/reader.h"

namespace sheave::import::opensim {
namespace {

constexpr double slide_part = 1e-6;        // of the mass and inertia of the body that has the point
constexpr double least_slide_mass = 1e-6;  // where that body has no mass [kg]
constexpr double wanted_way_fit = 1e-9;    // [m]
constexpr double most_way_misfit = 2e-3;   // [m]

/// One component of a point's position.
struct Component {
  int coordinate = -1;  ///< -1: it is constant
  Function function;
  mjcf::Polynomial factors{};
};

class MovingPointReader {
 public:
  MovingPointReader(const xml::Element& element, const std::string& owner, Reader& reader)
      : element_(element), reader_(reader) {
    const std::string* const name = element.value("name");
    name_ = (name == nullptr ? "moving point" : *name) + " of " + owner;
  }

  void read() {
    for (int i = 0; i < 3; ++i) {
      if (!read_component(i)) return;
    }
    if (moving_ == 0) return;
    const FixedFrame frame = frame_of_point(element_, reader_);
    if (frame.body < 0) return;
    add_chain(frame);
  }

 private:
  /// False if the point must stay where it is at the start.
  bool read_component(int i) {
    const std::string axis(1, static_cast<char>('x' + i));
    const auto function =
        read_function(element_, axis + "_location", reader_.properties, reader_.log);
    const int number = coordinate_of_point(element_, axis, reader_);
    if (!function || (number < 0 && !function->is_constant())) return false;  // told with the path
    Component& own = components_[at(i)];
    own.function = *function;
    if (number < 0 || function->is_constant()) return true;
    const Coordinate& coordinate = reader_.coordinates[at(number)];
    if (coordinate.locked) {
      own.function = Function({(*function)(coordinate.start)});
      return true;
    }
    if (coordinate.joint < 0) return false;
    const auto [least, most] = coordinate.range;
    const Fit fit = fit_polynomial(*function, least, std::max(most, least + 1e-6), wanted_way_fit);
    if (fit.deviation > most_way_misfit) return false;
    if (!function->is_polynomial()) deviation_ = std::max(deviation_, fit.deviation);
    own.factors = fit.factors;
    own.coordinate = number;
    ++moving_;
    return true;
  }

  void add_chain(const FixedFrame& frame) {
    const RawBody& raw = reader_.bodies[at(frame.body)];
    mjcf::Inertial small;
    small.mass = std::max(slide_part * raw.inertial.mass, least_slide_mass * 1e-3);
    if (raw.inertial.mass <= 0.0) small.mass = least_slide_mass;
    const double moment = slide_part * raw.inertial.inertia.trace() / 3.0;
    small.inertia = std::max(moment, 1e-6 * small.mass) * Matrix3::Identity();
    mjcf::Frame place = frame.frame;
    Vector3 constant = Vector3::Zero();
    for (int i = 0; i < 3; ++i) {
      const Component& own = components_[at(i)];
      if (own.coordinate < 0) constant[i] = own.function(0.0);
    }
    place.position = place.point(constant);
    int parent = raw.number;
    for (int i = 0; i < 3; ++i) {
      const Component& own = components_[at(i)];
      if (own.coordinate < 0) continue;
      parent = add_slide(i, own, parent, place, small);
      place = {};
    }
    reader_.moving_points.emplace(&element_, parent);
    reader_.log.changed(element_,
                        fmt::format("{} small {} of {} kg move it by couplings", moving_,
                                    moving_ == 1 ? "body" : "bodies", number_text(small.mass, 3)));
    if (deviation_ == 0.0) return;
    reader_.log.changed(element_,
                        fmt::format("polynomials of degree 9 in place of the functions, which "
                                    "differ by up to {} m in the range of the coordinate",
                                    number_text(deviation_, 3)));
  }

  int add_slide(int axis, const Component& own, int parent, const mjcf::Frame& frame,
                const mjcf::Inertial& small) {
    mjcf::Model& model = reader_.model;
    const std::string name = fmt::format("{} {}", name_, static_cast<char>('x' + axis));
    const int number = static_cast<int>(model.bodies.size());
    mjcf::Body body;
    body.element = &element_;
    body.name = name;
    body.parent = parent;
    body.frame = frame;
    body.given = body.inertial = small;
    model.bodies.push_back(std::move(body));
    reader_.start_frames.emplace_back();
    const int joint = add_joint(mjcf::JointType::slide, Vector3::Unit(axis), Vector3::Zero(),
                                element_, number, reader_);
    model.joints[at(joint)].name = name + " way";
    reader_.driven[at(joint)] = {own.coordinate, own.factors};
    reader_.followers.push_back({&element_, joint, own.coordinate, own.factors});
    Coordinate& coordinate = reader_.coordinates[at(own.coordinate)];
    if (!own.function.is_polynomial() && !coordinate.clamped) {
      reader_.log.changed(*coordinate.element,
                          "stops at the ends of the range, in which the polynomial holds");
      coordinate.clamped = true;
    }
    return number;
  }

  const xml::Element& element_;
  Reader& reader_;
  std::string name_;
  std::array<Component, 3> components_;
  int moving_ = 0;
  double deviation_ = 0.0;
};

/// Reads the moving points in the path of a force.
void look_for_points(const xml::Element& element, const std::string& owner, Reader& reader) {
  for (const xml::Element& child : element.children) {
    if (child.tag == "MovingPathPoint") {
      MovingPointReader(child, owner, reader).read();
    } else {
      look_for_points(child, owner, reader);
    }
  }
}

}  // namespace

void read_moving_points(Reader& reader) {
  for (const xml::Element* const force : reader.properties.objects(reader.root, "ForceSet")) {
    if (!reader.properties.flag(*force, "appliesForce", true) ||
        reader.properties.flag(*force, "isDisabled", false)) {
      continue;
    }
    const std::string* const name = force->value("name");
    look_for_points(*force, name == nullptr ? force->tag : *name, reader);
  }
}

}  // namespace sheave::import::opensim
