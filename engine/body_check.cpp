#include "engine/body_check.h"

#include <algorithm>
#include <string_view>
#include <unordered_set>

#include <Eigen/Eigenvalues>

#include "engine/body_mass.h"
#include "engine/field_check.h"
#include "engine/model.h"

namespace sheave {
namespace {

std::string vector_text(const Vector3& v) {
  // Projections may leave minus zero or a rounding error in place of 0.
  const double negligible = 1e-12 * v.norm();
  std::string text;
  for (const double value : {v.x(), v.y(), v.z()}) {
    text += (text.empty() ? "[" : ", ") + number_text(std::abs(value) > negligible ? value : 0.0);
  }
  return text + "]";
}

/// Six digits of each, since numbers of an eigenvalue problem have rounding in their last ones.
std::string rounded_text(const Vector3& v) {
  return "[" + number_text(v.x(), 6) + ", " + number_text(v.y(), 6) + ", " + number_text(v.z(), 6) +
         "]";
}

/// Checks one body and collects its faults.
class BodyCheck {
 public:
  BodyCheck(const Model& model, int index, Errors& errors)
      : model_(model),
        body_(model.bodies[static_cast<std::size_t>(index)]),
        path_("/bodies/" + std::to_string(index)),
        errors_(errors) {}

  void run() {
    const std::size_t before = errors_.size();
    check_fields(BodyDef::field_table(), &body_, path_, errors_);
    for (std::size_t i = 0; i < body_.shapes.size(); ++i) check_shape(i);
    if (errors_.size() > before) return;  // the following checks compute with these numbers
    check_reach();
    if (is(Mobility::knot)) return check_knot();
    check_axis();
    check_mount();
    check_motion();
    if (moves()) check_mass();
    if (moves() && errors_.size() == before) check_magnitudes();
    check_drive();
    check_wrappable();
    check_damping();
  }

 private:
  void fail(const std::string& field, const std::string& message) {
    errors_.push_back({path_ + field, "body \"" + body_.name + "\": " + message});
  }
  [[nodiscard]] bool is(Mobility mobility) const { return body_.mobility == mobility; }
  [[nodiscard]] bool moves() const { return yields(body_.mobility); }
  [[nodiscard]] std::string mobility_name() const {
    return std::string(mobility_names[static_cast<std::size_t>(body_.mobility)]);
  }

  /// Beyond this distance [m] the squares of distances overflow, and residuals cannot be computed.
  static constexpr double farthest = 1e150;

  void check_reach() {
    const auto reach = [](const Vector3& place) { return place.cwiseAbs().maxCoeff(); };
    double shape = 0.0;
    for (const PlacedShape& placed : body_.shapes) {
      shape = std::max(shape, reach(placed.position) + reach(placed.shape->half_extent()));
    }
    const bool by_shape = !(shape <= farthest);
    if (!by_shape && reach(body_.position) <= farthest) return;
    const std::string field = body_.shapes.size() == 1 ? "/shape" : "/shapes";
    fail(by_shape ? field : "/position",
         "at most 1e150 m from the origin is allowed, because squares of lengths must be finite");
  }

  void check_shape(std::size_t i) {
    const PlacedShape& placed = body_.shapes[i];
    const std::string path =
        path_ + (body_.shapes.size() == 1 ? "/shape" : "/shapes/" + std::to_string(i));
    if (!placed.shape) {
      errors_.push_back({path, "body \"" + body_.name + "\": shape is missing"});
      return;
    }
    check_fields(PlacedShape::field_table(), &placed, path, errors_);
    for (const auto& entry : shape_types()) {
      if (entry.name != placed.shape->type()) continue;
      check_fields(entry.fields(), placed.shape->settings(), path, errors_);
    }
    for (const Error& error : placed.shape->validate(path)) errors_.push_back(error);
    if (!placed.shape->bounded() && moves()) {
      errors_.push_back({path, "body \"" + body_.name + "\": a " +
                                   std::string(placed.shape->type()) +
                                   " has no mass; only static and kinematic bodies can have it, "
                                   "and mobility is " +
                                   mobility_name()});
    }
  }

  /// A knot is a point that has a name and a place, and nothing else.
  void check_knot() {
    const auto deny = [&](bool given, const char* field, const char* what) {
      if (!given) return;
      fail(field,
           std::string("a knot is a point without mass, which the forces of its cables place; "
                       "it has no ") +
               what + ": leave it out, or take another mobility");
    };
    deny(body_.mass.has_value(), "/mass", "mass");
    deny(body_.density.has_value(), "/density", "mass");
    deny(body_.center_of_mass.has_value(), "/center_of_mass", "centre of mass");
    deny(body_.inertia.has_value(), "/inertia", "inertia");
    deny(!is_zero(body_.products_of_inertia), "/products_of_inertia", "inertia");
    deny(body_.spin_inertia.has_value(), "/spin_inertia", "inertia");
    deny(body_.axis.has_value(), "/axis", "axis");
    deny(body_.mount.has_value(), "/mount", "axle");
    deny(!body_.shapes.empty(), body_.shapes.size() == 1 ? "/shape" : "/shapes", "shape");
    deny(!is_zero(body_.velocity), "/velocity", "velocity of its own");
    deny(!is_zero(body_.angular_velocity), "/angular_velocity", "orientation");
    deny(std::abs(body_.orientation.w()) != 1.0, "/orientation", "orientation");
    deny(!is_zero(body_.force), "/force", "load; load one of the bodies that its cables hold");
    deny(!is_zero(body_.torque), "/torque", "orientation");
    deny(body_.damping > 0.0, "/damping", "drag");
    deny(body_.angular_damping > 0.0, "/angular_damping", "orientation");
    deny(body_.drive != DriveKind::none || !body_.drive_values.empty(), "/drive", "drive");
    deny(!is_zero(body_.oscillation), "/oscillation", "motion of its own");
    deny(body_.wrappable, "/wrappable", "shape");
  }

  void check_axis() {
    const bool uses_axis = is(Mobility::planar) || is(Mobility::slider) || is(Mobility::rotor) ||
                           is(Mobility::kinematic);
    if (body_.axis && !uses_axis) {
      fail("/axis", "mobility " + mobility_name() +
                        " has no axis; only planar, slider, rotor and kinematic have one");
    }
    if (!body_.axis && is(Mobility::slider)) {
      fail("", "mobility slider needs \"axis\", the direction in which the body slides");
    }
    if (body_.axis && !(body_.axis->norm() > 1e-12)) {
      fail("/axis", "axis must have a direction; its length is " + number_text(body_.axis->norm()));
    }
  }

  void check_mount() {
    if (!body_.mount) return;
    if (!is(Mobility::rotor)) {
      fail("/mount", "only a rotor can be mounted; mobility is " + mobility_name());
      return;
    }
    const int mount = body_.mount->index;
    if (body_.mount->is_world()) {
      fail("/mount", "a rotor on an axle that does not move needs no mount; leave it out");
      return;
    }
    if (mount < 0 || mount >= static_cast<int>(model_.bodies.size())) {
      fail("/mount", "there is no body number " + std::to_string(mount));
      return;
    }
    const BodyDef& carrier = model_.bodies[static_cast<std::size_t>(mount)];
    if (carrier.mobility == Mobility::rotor || carrier.mobility == Mobility::knot) {
      const char* kind = carrier.mobility == Mobility::rotor ? "rotor itself" : "knot";
      fail("/mount", "the carrier \"" + carrier.name + "\" is a " + kind +
                         "; it may be static, free, planar, slider or kinematic");
    }
  }

  /// A velocity that the mobility allows: the rule as a text, and the allowed velocity nearest to
  /// the given one.
  struct Allowed {
    std::string rule;
    Vector3 nearest;
  };

  [[nodiscard]] Allowed allowed_velocities(const Vector3& axis) const {
    const Vector3 along = body_.velocity.dot(axis) * axis;
    if (is(Mobility::slider)) return {"it slides along its axis " + vector_text(axis), along};
    if (is(Mobility::planar)) {
      return {"it stays in the plane across its axis " + vector_text(axis), body_.velocity - along};
    }
    const bool carried = is(Mobility::rotor) && body_.mount;
    return {carried ? "its axle moves with its mount" : "it stays where it is", Vector3::Zero()};
  }

  [[nodiscard]] Allowed allowed_spins(const Vector3& axis) const {
    if (is(Mobility::planar) || is(Mobility::rotor)) {
      return {"it turns about its axis " + vector_text(axis),
              body_.angular_velocity.dot(axis) * axis};
    }
    return {"it does not turn", Vector3::Zero()};
  }

  void fail_motion(const std::string& field, const std::string& what, const Vector3& value,
                   const Allowed& allowed) {
    fail(field, "the " + what + " " + vector_text(value) + " is not one that mobility " +
                    mobility_name() + " allows: " + allowed.rule + ", so " +
                    vector_text(allowed.nearest) + " is allowed");
  }

  void check_motion() {
    const Vector3 axis = body_.axis ? body_.axis->normalized()
                         : is(Mobility::rotor)
                             ? Vector3(body_.orientation.normalized() * Vector3::UnitZ())
                             : Vector3(Vector3::UnitZ());
    const Vector3& v = body_.velocity;
    const Vector3& w = body_.angular_velocity;
    const double small_v = 1e-9 * v.norm();
    const double small_w = 1e-9 * w.norm();
    const bool across_v = v.cross(axis).norm() > small_v;
    const bool along_v = std::abs(v.dot(axis)) > small_v;
    const bool across_w = w.cross(axis).norm() > small_w;
    const bool bad_v = (is(Mobility::fixed) && v.norm() > 0.0) ||
                       (is(Mobility::rotor) && v.norm() > 0.0) ||
                       (is(Mobility::slider) && across_v) || (is(Mobility::planar) && along_v);
    const bool bad_w = ((is(Mobility::fixed) || is(Mobility::slider)) && w.norm() > 0.0) ||
                       ((is(Mobility::planar) || is(Mobility::rotor)) && across_w);
    if (is(Mobility::kinematic) && body_.axis) check_plane(axis);
    if (bad_v) fail_motion("/velocity", "velocity", v, allowed_velocities(axis));
    if (bad_w) fail_motion("/angular_velocity", "angular velocity", w, allowed_spins(axis));
    if (!is(Mobility::kinematic) &&
        (body_.oscillation.norm() > 0.0 || body_.oscillation_frequency > 0.0)) {
      fail("/oscillation",
           "only a kinematic body follows an oscillation; mobility is " + mobility_name());
    }
  }

  /// Checks the motion of a kinematic body with an axis.
  void check_plane(const Vector3& axis) {
    const auto leaves = [&](const Vector3& v) { return std::abs(v.dot(axis)) > 1e-9 * v.norm(); };
    const std::string plane = "it stays in the plane across its axis " + vector_text(axis);
    if (leaves(body_.velocity)) fail("/velocity", plane + ", so its velocity must, too");
    if (leaves(body_.oscillation)) fail("/oscillation", plane + ", so its oscillation must, too");
    const Vector3& w = body_.angular_velocity;
    if (w.cross(axis).norm() > 1e-9 * w.norm()) {
      fail("/angular_velocity", "it turns about its axis " + vector_text(axis) + " alone");
    }
  }

  void check_damping() {
    const bool translates = is(Mobility::free) || is(Mobility::planar) || is(Mobility::slider);
    if (body_.damping > 0.0 && !translates) {
      fail("/damping",
           "only free, planar and slider bodies can have drag; mobility is " + mobility_name());
    }
    if (!(body_.angular_damping > 0.0)) return;
    const bool bearing = is(Mobility::rotor) && !body_.mount && body_.spin_inertia != 0.0;
    if (!is(Mobility::free) && !is(Mobility::planar) && !bearing) {
      fail("/angular_damping",
           "only free and planar bodies and rotors with inertia on fixed axles can have angular "
           "damping; mobility is " +
               mobility_name());
    }
  }

  void check_wrappable() {
    if (!body_.wrappable) return;
    if (body_.shapes.empty()) {
      fail("/wrappable", "only a body with a shape can be wrapped; give it one");
    }
    for (const PlacedShape& placed : body_.shapes) {
      if (placed.shape->bounded()) continue;
      fail("/wrappable",
           "a cable cannot be laid round a " + std::string(placed.shape->type()) + "; use a box");
    }
    if (body_.spin_inertia == 0.0 && body_.drive == DriveKind::none) {
      fail("/wrappable",
           "a wheel without spin inertia cannot be wrapped unless its cable lists it");
    }
  }

  void check_drive() {
    if (body_.drive == DriveKind::none) {
      if (!body_.drive_values.empty() || !body_.drive_times.empty() ||
          body_.drive_interpolation != Interpolation::linear) {
        fail("/drive",
             "drive_times, drive_values and drive_interpolation need a drive: speed, angle or "
             "torque");
      }
      return;
    }
    if (!is(Mobility::rotor)) {
      fail("/drive", "only a rotor can be driven; mobility is " + mobility_name());
    }
    const std::size_t values = body_.drive_values.size();
    const std::size_t times = body_.drive_times.size();
    if (values == 0 || (times == 0 && values != 1) || (times > 0 && times != values)) {
      fail("/drive_values",
           "one value per time is needed, or a single value without times; there are " +
               std::to_string(values) + " values and " + std::to_string(times) + " times");
    }
    for (std::size_t i = 1; i < times; ++i) {
      if (body_.drive_times[i] > body_.drive_times[i - 1]) continue;
      fail("/drive_times/" + std::to_string(i), "times must increase");
      break;
    }
    if (body_.spin_inertia != 0.0) return;
    if (body_.drive == DriveKind::torque) {
      fail("/drive", "a massless wheel cannot take up a torque; its spin inertia is 0");
    } else if (body_.mount) {
      fail("/drive", "a massless wheel on a mount cannot be driven; give it a spin inertia");
    }
  }

  void check_mass() {
    if (body_.mass && body_.density) {
      fail("/density", "mass and density exclude each other; leave one out");
      return;
    }
    if (body_.density && body_.shapes.empty()) {
      fail("/density", "density needs a shape; give mass and inertia instead");
      return;
    }
    if (!check_densities() || !check_given_tensor()) return;
    if (body_.spin_inertia && !is(Mobility::rotor)) {
      fail("/spin_inertia", "only a rotor has a spin inertia; mobility is " + mobility_name());
    }
    if (body_.spin_inertia == 0.0 && body_.torque.norm() > 0.0) {
      fail("/torque", "a massless wheel cannot take up a torque; its spin inertia is 0");
    }
    const bool rotates = !is(Mobility::slider) && !body_.spin_inertia;
    if (body_.shapes.empty() && !body_.inertia && rotates) {
      fail("", "a body without a shape needs \"inertia\"");
      return;
    }
    if (body_.inertia) check_inertia();
    if (is(Mobility::rotor)) check_rotor_balance();
  }

  /// Beyond these masses [kg] and moments [kg m2], squares of forces and determinants of tensors
  /// overflow or vanish, and no result is a number.
  static constexpr double least_mass = 1e-100;
  static constexpr double greatest_mass = 1e100;

  void check_magnitudes() {
    const MassProperties own = defined_mass_properties(body_);
    if (!(own.mass >= least_mass && own.mass <= greatest_mass)) {
      const std::string shape = body_.shapes.size() == 1 ? "/shape" : "/shapes";
      fail(body_.mass ? "/mass" : (body_.density ? "/density" : shape),
           "the mass is " + number_text(own.mass) +
               " kg; from 1e-100 to 1e+100 kg is allowed, because squares of forces and "
               "determinants of moments of inertia must be finite");
    } else if (!own.inertia.allFinite() || own.inertia.cwiseAbs().maxCoeff() > greatest_mass) {
      fail(body_.inertia ? "/inertia" : (body_.shapes.size() == 1 ? "/shape" : "/shapes"),
           "the moments of inertia are not finite or above 1e+100 kg m2, so their determinant is "
           "no number; give a size that a body can have");
    }
  }

  /// Whether the mass is given once: by the body, or by the densities of its shapes.
  bool check_densities() {
    std::size_t dense = 0;
    for (std::size_t i = 0; i < body_.shapes.size(); ++i) {
      if (!body_.shapes[i].density) continue;
      ++dense;
      if (!body_.mass) continue;
      const bool one = body_.shapes.size() == 1;
      fail(one ? "/shape/density" : "/shapes/" + std::to_string(i) + "/density",
           "the body has a mass, which its shapes share by their volumes; leave out the mass of "
           "the body, or the densities of its shapes");
      return false;
    }
    if (body_.mass || body_.density || (dense > 0 && dense == body_.shapes.size())) return true;
    fail("", dense == 0 ? "a body that moves needs \"mass\" or \"density\""
                        : "only " + std::to_string(dense) + " of its " +
                              std::to_string(body_.shapes.size()) +
                              " shapes have a density; the body needs \"density\" for the others");
    return false;
  }

  /// Whether the centre of mass and the products of inertia have the settings that they need.
  bool check_given_tensor() {
    const bool turns = !is(Mobility::slider) && !body_.spin_inertia;
    if (body_.center_of_mass && !body_.mass) {
      fail("/center_of_mass",
           "the densities of the shapes place the centre of mass; give mass and inertia with "
           "center_of_mass, or leave it out");
      return false;
    }
    if (body_.center_of_mass && !body_.inertia && turns) {
      fail("/center_of_mass",
           "shapes tell no inertia about another centre of mass than their own; give "
           "\"inertia\", about center_of_mass");
      return false;
    }
    if (!is_zero(body_.products_of_inertia) && !body_.inertia) {
      fail("/products_of_inertia",
           "needs \"inertia\", the moments Ixx, Iyy, Izz of the same tensor");
      return false;
    }
    return true;
  }

  /// The principal moments of every body are positive, and none is greater than the sum of the
  /// other two, since each is the sum of two integrals of squares of coordinates.
  void check_inertia() {
    const bool has_products = !is_zero(body_.products_of_inertia);
    Vector3 moments = *body_.inertia;
    if (has_products) {
      moments =
          Eigen::SelfAdjointEigenSolver<Matrix3>(defined_inertia(body_), Eigen::EigenvaluesOnly)
              .eigenvalues();
    }
    std::sort(moments.begin(), moments.end());
    const double slack = 1e-9 * moments.cwiseAbs().sum();
    const bool positive = !has_products || moments[0] > 1e-12 * moments[2];
    if (positive && moments[2] <= moments[0] + moments[1] + slack) return;
    fail(has_products ? "/products_of_inertia" : "/inertia",
         "no body has the " + std::string(has_products ? "principal " : "") +
             "moments of inertia " + rounded_text(moments) + " kg m2: " +
             (positive ? "each must be at most the sum of the other two"
                       : "each must be greater than 0") +
             (has_products ? "; inertia and products_of_inertia are entries of one tensor about "
                             "the centre of mass, with Ixy = -(integral of x y dm)"
                           : ""));
  }

  /// A rotor's centre of mass lies on its axle, and a mounted rotor is symmetric about it;
  /// otherwise the spin would not be a separate degree of freedom.
  void check_rotor_balance() {
    const Vector3 axle =
        body_.axis ? Vector3(body_.orientation.normalized().conjugate() * body_.axis->normalized())
                   : Vector3(Vector3::UnitZ());
    const MassProperties own = defined_mass_properties(body_);
    double size = 0.0;
    for (const PlacedShape& placed : body_.shapes) {
      size = std::max(size, placed.shape->half_extent().norm());
    }
    if (size == 0.0) size = own.center_of_mass.norm();
    if (own.center_of_mass.cross(axle).norm() > 1e-9 * size) {
      fail(body_.center_of_mass ? "/center_of_mass" : "/shape",
           "the centre of mass of a rotor must lie on its axle; use mobility planar and a "
           "hinge joint for an unbalanced one");
    }
    if (!body_.mount) return;
    const Matrix3& inertia = own.inertia;
    const Vector3 across = any_perpendicular(axle);
    const Matrix3 symmetric =
        axle.dot(inertia * axle) * axle * axle.transpose() +
        across.dot(inertia * across) * (Matrix3::Identity() - axle * axle.transpose());
    if ((inertia - symmetric).norm() > 1e-6 * inertia.norm()) {
      fail("/inertia",
           "a mounted rotor must be symmetric about its axle; mount the body with a "
           "hinge joint instead");
    }
  }

  const Model& model_;
  const BodyDef& body_;
  std::string path_;
  Errors& errors_;
};

}  // namespace

bool is_good_gravity(const Vector3& gravity) {
  // The largest of NaN and a number may be the number.
  return gravity.allFinite() && gravity.cwiseAbs().maxCoeff() <= most_gravity;
}

Errors check_bodies(const Model& model) {
  Errors errors;
  std::unordered_set<std::string_view> names;
  for (int i = 0; i < static_cast<int>(model.bodies.size()); ++i) {
    const std::string& name = model.bodies[static_cast<std::size_t>(i)].name;
    const auto fail = [&](std::string message) {
      errors.push_back({"/bodies/" + std::to_string(i) + "/name", std::move(message)});
    };
    if (name.empty()) fail("a body needs a name that is not empty");
    if (name == "world") fail("the name \"world\" belongs to the fixed frame");
    if (!names.insert(name).second) {
      fail("two bodies are called \"" + name + "\"; names must differ");
    }
    BodyCheck(model, i, errors).run();
  }
  return errors;
}

}  // namespace sheave
