// Joints as slides and hinges of the body behind them.
//
// A joint has the frames P on the parent and M on the child, and
//
//   M in P = T(sum of t_i f_i) R(r_1, f_1) R(r_2, f_2) R(r_3, f_3).
//
// A displacement that is constant, or of a locked coordinate, goes to the front: with C, the product
// of the constant turns,
//
//   M in P = T(constant) C  T(sum of C^-1 t_i f_i)  product of R(r'_i, f_i),
//
// where r'_i is r_i turned back by the constant turns behind it. The first factor belongs to the
// body's frame; the others are slides and hinges in its order.

#include <algorithm>

#include <Eigen/LU>
#include <fmt/format.h>

#include "engine/index.h"
#include "engine/number_text.h"
#include "scenes/import/opensim/reader.h"

namespace sheave::import::opensim {
namespace {

using mjcf::Frame;
using mjcf::JointType;

// Of a body between two axes, over the mass and inertia of the body that moves by both.
constexpr double small_part = 1e-4;
// Largest differences of a polynomial from the function that it replaces [m], [rad].
constexpr double wanted_fit = 1e-9;
constexpr double most_misfit_along = 2e-3;
constexpr double most_misfit_about = 0.02;

class JointBuilder {
 public:
  JointBuilder(int body, const RawJoint& joint, Reader& reader)
      : reader_(reader), raw_(reader.bodies[at(body)]), joint_(joint) {}

  void build() {
    std::vector<Axis> axes = axes_of(joint_, reader_);
    if (reader_.log.failed()) return;
    replace_followers(axes);
    for (Axis& axis : axes) take(axis);
    if (reader_.log.failed()) return;
    find_leaders();
    if (reader_.log.failed()) return;
    if (followers_ > 0 || !has_one_joint()) {
      chain();
    } else if (turning_ == 3) {
      whole(moving_.size() == 6);
    } else {
      const int number = add(parent_number(), placed());
      for (const Axis& axis : moving_) {
        const int joint = one(axis, joint_.child.frame, number);
        lead(axis, joint);
        if (moving_.size() == 3 && !axis.turns) own(axis).has_stops = false;
      }
      start(number, joint_.parent.frame * fixed_ * moved() * child_inverse());
    }
    finish();
  }

 private:
  [[nodiscard]] int parent_number() const { return reader_.bodies[at(joint_.parent.body)].number; }
  [[nodiscard]] Frame child_inverse() const {
    const Frame& child = joint_.child.frame;
    const Quaternion back = child.orientation.conjugate();
    return {back * -child.position, back};
  }
  /// The child in the parent where all positions are 0.
  [[nodiscard]] Frame placed() const { return joint_.parent.frame * fixed_ * child_inverse(); }

  [[nodiscard]] Coordinate& own(const Axis& axis) const {
    return reader_.coordinates[at(axis.coordinate)];
  }

  /// Whether one joint of a scene has all displacements, and all coordinates that are named.
  [[nodiscard]] bool has_one_joint() const {
    const std::size_t count = moving_.size();
    if (count < 2) return true;
    const auto apart = [&](std::size_t a, std::size_t b) {
      return std::abs(moving_[a].direction.dot(moving_[b].direction)) < 1e-9;
    };
    if (count == 2 && turning_ == 2) return apart(0, 1);
    if (count == 2 && turning_ == 1) {
      return moving_[0].direction.cross(moving_[1].direction).norm() < 1e-9;
    }
    // A plane joint, a ball or a free body have fewer coordinates, or none.
    const bool named = std::any_of(moving_.begin(), moving_.end(), [&](const Axis& axis) {
      return own(axis).is_named && (turning_ == 3 || !axis.turns);
    });
    if (named) return false;
    if (count == 3 && turning_ == 1) return apart(0, 1) && apart(0, 2) && apart(1, 2);
    return turning_ == 3 && (count == 3 || count == 6);
  }

  /// Makes a displacement of a coordinate that follows another one a function of that one.
  void replace(Axis& axis) const {
    const auto found = reader_.couplers.find(axis.coordinate);
    if (axis.coordinate < 0 || found == reader_.couplers.end()) return;
    Coupler& coupler = found->second;
    if (!coupler.is_replaced || coupler.leader == axis.coordinate) return;
    const std::vector<double>& line = coupler.function.factors();
    axis.function = axis.function.of_line(line[1], line[0]);
    axis.coordinate = coupler.leader;
  }

  /// Replaces coordinates that move nothing in a linear way.
  void replace_followers(std::vector<Axis>& axes) const {
    for (const int number : joint_.coordinates) {
      const auto found = reader_.couplers.find(number);
      const bool leads = std::any_of(axes.begin(), axes.end(), [&](const Axis& axis) {
        return axis.coordinate == number && axis.function.is_linear();
      });
      if (found == reader_.couplers.end() || leads) continue;
      found->second.is_replaced = found->second.function.is_linear();
    }
    for (Axis& axis : axes) replace(axis);
  }

  /// Adds a displacement to the constant ones or to those that move.
  void take(Axis& axis) {
    Coordinate* const coordinate =
        axis.coordinate < 0 ? nullptr : &reader_.coordinates[at(axis.coordinate)];
    if (coordinate != nullptr && !coordinate->locked) {
      if (axis.turns) ++turning_;
      moving_.push_back(axis);
      return;
    }
    const double value = axis.function(coordinate == nullptr ? 0.0 : coordinate->start);
    if (coordinate != nullptr) {
      reader_.log.changed(*coordinate->element, fmt::format("locked: it keeps its default_value {}",
                                                            number_text(coordinate->start, 6)));
    }
    if (!axis.turns) {
      fixed_.position += value * axis.direction;
      return;
    }
    if (value == 0.0) return;
    const Quaternion turn = mjcf::turn_about(axis.direction, value);
    // Directions of the displacements before this one are seen from behind it.
    for (Axis& before : moving_) before.direction = turn.conjugate() * before.direction;
    fixed_.orientation = fixed_.orientation * turn;
  }

  /// Finds the displacement of each coordinate that is its joint, and counts the others.
  void find_leaders() {
    leads_.assign(moving_.size(), false);
    for (std::size_t i = 0; i < moving_.size(); ++i) {
      const int coordinate = moving_[i].coordinate;
      const auto& own = joint_.coordinates;
      if (std::find(own.begin(), own.end(), coordinate) == own.end()) {
        ++followers_;  // of a coordinate of another joint
        continue;
      }
      int best = -1;
      for (std::size_t k = 0; k < moving_.size(); ++k) {
        if (moving_[k].coordinate != coordinate || !moving_[k].function.is_linear()) continue;
        if (best < 0 || (moving_[k].turns && !moving_[at(best)].turns)) best = static_cast<int>(k);
      }
      if (best < 0) {
        reader_.log.error(*moving_[i].element,
                          "its coordinate needs one displacement that is linear in it, or a "
                          "CoordinateCouplerConstraint that makes it linear in another one",
                          {}, FaultCode::meaning);
        return;
      }
      leads_[i] = best == static_cast<int>(i);
      if (!leads_[i]) ++followers_;
    }
  }

  /// The polynomial of a displacement that follows a coordinate.
  mjcf::Polynomial follow(const Axis& axis) {
    Coordinate& coordinate = reader_.coordinates[at(axis.coordinate)];
    const auto [least, most] = coordinate.range;
    const Fit fit = fit_polynomial(axis.function, least, std::max(most, least + 1e-6), wanted_fit);
    if (axis.function.is_polynomial()) return fit.factors;
    const bool close = fit.deviation <= (axis.turns ? most_misfit_about : most_misfit_along);
    const std::string deviation =
        fmt::format("{} {}", number_text(fit.deviation, 3), axis.turns ? "rad" : "m");
    if (!close) {
      reader_.log.error(*axis.element,
                        fmt::format("a coupling has a polynomial of degree 9, which differs from "
                                    "this function by up to {} in the range of the coordinate; "
                                    "narrow the range, or give a smoother function",
                                    deviation),
                        {}, FaultCode::meaning);
    }
    reader_.log.changed(*axis.element,
                        fmt::format("a polynomial of degree 9 in place of the function, which "
                                    "differs by up to {} in the range of the coordinate",
                                    deviation));
    if (!coordinate.clamped) {
      reader_.log.changed(*coordinate.element,
                          "stops at the ends of the range, in which the polynomial holds");
    }
    coordinate.clamped = true;
    return fit.factors;
  }

  /// The displacement by the moving axes at the start, with polynomials in place of functions.
  [[nodiscard]] Frame moved() const {
    Frame frame;
    for (std::size_t i = 0; i < moving_.size(); ++i) {
      const Axis& axis = moving_[i];
      const double q = reader_.coordinates[at(axis.coordinate)].start;
      const double value = polynomials_.empty()
                               ? axis.function(q)
                               : Function({polynomials_[i].begin(), polynomials_[i].end()})(q);
      if (axis.turns) {
        frame.orientation = frame.orientation * mjcf::turn_about(axis.direction, value);
      } else {
        frame.position += value * axis.direction;
      }
    }
    return frame;
  }

  /// Adds a body to the model.
  int add(int parent, const Frame& frame) {
    mjcf::Body body;
    body.element = raw_.element;
    body.name = raw_.name;
    body.parent = parent;
    body.frame = frame;
    body.given = body.inertial = raw_.inertial;
    raw_.number = static_cast<int>(reader_.model.bodies.size());
    reader_.model.bodies.push_back(std::move(body));
    reader_.start_frames.emplace_back();
    return raw_.number;
  }

  void start(int number, const Frame& in_parent) {
    reader_.start_frames[at(number)] = reader_.start_frames[at(parent_number())] * in_parent;
  }

  /// Adds the slide or hinge of an axis.
  int one(const Axis& axis, const Frame& child, int number) {
    const Vector3 direction = child.orientation * axis.direction;
    const int joint = add_joint(axis.turns ? JointType::hinge : JointType::slide, direction,
                                child.position, *joint_.element, number, reader_);
    Driven& driven = reader_.driven[at(joint)];
    driven.coordinate = axis.coordinate;
    driven.factors = fit_polynomial(axis.function, -1.0, 1.0, wanted_fit).factors;
    return joint;
  }

  /// Makes the joint that of the axis' coordinate.
  void lead(const Axis& axis, int number) {
    Coordinate& coordinate = reader_.coordinates[at(axis.coordinate)];
    mjcf::Joint& joint = reader_.model.joints[at(number)];
    Driven& driven = reader_.driven[at(number)];
    if (driven.factors[1] < 0.0) {
      joint.axis = -joint.axis;
      for (double& factor : driven.factors) factor = -factor;
    }
    joint.name = coordinate.name;
    coordinate.joint = number;
    coordinate.offset = driven.factors[0];
    coordinate.factor = driven.factors[1];
    if (coordinate.factor != 1.0 || coordinate.offset != 0.0) {
      reader_.log.changed(
          *coordinate.element,
          fmt::format("the joint turns or moves by {} times the coordinate, plus {}",
                      number_text(coordinate.factor, 6), number_text(coordinate.offset, 6)));
    }
  }

  /// Three turns are a ball, and with three directions the body is free.
  void whole(bool free) {
    Matrix3 turns, ways;
    int t = 0;
    int w = 0;
    for (const Axis& axis : moving_) (axis.turns ? turns.col(t++) : ways.col(w++)) = axis.direction;
    constexpr double independent = 1e-3;
    if (std::abs(turns.determinant()) < independent ||
        (free && std::abs(ways.determinant()) < independent)) {
      reader_.log.error(*joint_.element, "its axes must not lie in one plane", {},
                        FaultCode::meaning);
      return;
    }
    const Frame frame = joint_.parent.frame * fixed_ * moved() * child_inverse();
    const int number = add(free ? 0 : parent_number(), placed());
    start(number, frame);
    if (free) reader_.model.bodies[at(number)].frame = reader_.start_frames[at(number)];
    const int joint = add_joint(free ? JointType::free : JointType::ball, Vector3::UnitZ(),
                                joint_.child.frame.position, *joint_.element, number, reader_);
    if (!free) {
      const Quaternion& own = joint_.child.frame.orientation;
      reader_.model.bodies[at(number)].frame = placed();
      ball_starts().emplace_back(joint, own * moved().orientation * own.conjugate());
    }
    for (const Axis& axis : moving_) {
      const Coordinate& coordinate = reader_.coordinates[at(axis.coordinate)];
      reader_.log.changed(*coordinate.element,
                          free ? "the body is free: its position and orientation take the place of "
                                 "the coordinate"
                               : "a ball joint, whose orientation takes the place of the "
                                 "coordinate and has no range");
    }
  }
  [[nodiscard]] std::vector<std::pair<int, Quaternion>>& ball_starts() const {
    return reader_.ball_starts;
  }

  /// One body per axis: those before the last are small ones.
  void chain() {
    for (const Axis& axis : moving_) {
      polynomials_.push_back(follow(axis));
    }
    mjcf::Inertial small;
    small.mass = small_part * raw_.inertial.mass;
    small.inertia = small_part * raw_.inertial.inertia.trace() / 3.0 * Matrix3::Identity();
    const Frame whole_frame = joint_.parent.frame * fixed_ * moved() * child_inverse();
    int parent = parent_number();
    Frame before = joint_.parent.frame * fixed_;
    std::vector<int> joints;
    for (std::size_t i = 0; i < moving_.size(); ++i) {
      const bool last = i + 1 == moving_.size();
      const int number = add(parent, last ? before * child_inverse() : before);
      if (!last) {
        mjcf::Body& body = reader_.model.bodies.back();
        body.name = fmt::format("{} axis {}", raw_.name, i + 1);
        body.given = body.inertial = small;
      }
      start(number, whole_frame);
      joints.push_back(one(moving_[i], last ? joint_.child.frame : Frame{}, number));
      reader_.driven[at(joints.back())].factors = polynomials_[i];
      parent = number;
      before = {};
    }
    reader_.log.changed(*joint_.element,
                        fmt::format("{} small bodies between the axes, each of {} kg",
                                    moving_.size() - 1, number_text(small.mass, 6)));
    for (std::size_t i = 0; i < moving_.size(); ++i) {
      if (leads_[i]) {
        lead(moving_[i], joints[i]);
        continue;
      }
      mjcf::Joint& joint = reader_.model.joints[at(joints[i])];
      joint.name = fmt::format("{} {} of {}", raw_.name, moving_[i].turns ? "turn" : "way",
                               own(moving_[i]).name);
      reader_.followers.push_back(
          {moving_[i].element, joints[i], moving_[i].coordinate, polynomials_[i]});
    }
  }

  void finish() {
    if (reader_.log.failed()) return;
    for (const Axis& axis : moving_) {
      reader_.log.same(*reader_.coordinates[at(axis.coordinate)].element, "a coordinate");
    }
    reader_.log.same(*joint_.element,
                     moving_.empty() ? "the body is a part of its parent" : "a joint");
  }

  Reader& reader_;
  RawBody& raw_;
  const RawJoint& joint_;
  Frame fixed_;  ///< of the constant displacements
  std::vector<Axis> moving_;
  std::vector<bool> leads_;
  std::vector<mjcf::Polynomial> polynomials_;  ///< of a chain, one per axis
  int followers_ = 0;
  int turning_ = 0;  ///< number of moving axes that turn
};

}  // namespace

void build_joint(int body, const RawJoint& joint, Reader& reader) {
  JointBuilder(body, joint, reader).build();
}

}  // namespace sheave::import::opensim
