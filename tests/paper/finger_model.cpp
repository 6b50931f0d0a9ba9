#include "tests/paper/finger_model.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "cable/links/attachment.h"
#include "cable/links/pinhole.h"
#include "cable/links/rolling.h"
#include "engine/joints/hinge.h"

namespace sheave::test {
namespace {

const BodyDef& body_of(const Scene& scene, BodyId id) {
  return scene.model.bodies[static_cast<std::size_t>(id.index)];
}

const CableDef& tendon(const Scene& scene, const std::string& name) {
  for (const CableDef& cable : scene.cables) {
    if (cable.name == name) return cable;
  }
  throw std::runtime_error("no tendon " + name);
}

Vector3 point_of_link(const LinkDef& link) {
  if (const auto* hole = dynamic_cast<const PinholeLink*>(&link)) return hole->point;
  return dynamic_cast<const AttachmentLink&>(link).point;
}

double radius_of(const BodyDef& wheel) { return wheel.shapes.front().shape->wheel_radius(); }

}  // namespace

FingerModel::FingerModel(const Scene& scene, const std::string& digit)
    : gravity_(scene.model.gravity) {
  const CableDef& flexor = tendon(scene, digit + " flexor");
  const CableDef& extensor = tendon(scene, digit + " extensor");
  for (const auto& joint : scene.model.joints) {
    if (!joint->name.starts_with(digit + " ")) continue;
    const auto& hinge = dynamic_cast<const HingeJoint&>(*joint);
    const BodyDef& bone = body_of(scene, hinge.body_b);
    const MassProperties mass = combine(bone.shapes, *bone.density);
    const std::size_t i = phalanges_.size();
    Phalanx phalanx;
    phalanx.anchor = hinge.anchor;
    phalanx.axis = hinge.axis.normalized();
    phalanx.center = bone.position + bone.orientation * mass.center_of_mass;
    phalanx.hole = bone.position + bone.orientation * point_of_link(*flexor.links[i + 1]);
    phalanx.mass = mass.mass;
    phalanx.stiffness = hinge.angle.stiffness;
    const auto& roll = dynamic_cast<const RollingLink&>(*extensor.links[i + 1]);
    phalanx.wheel_radius = roll.radius ? *roll.radius : radius_of(body_of(scene, roll.body));
    // Wheels on the bone before weigh on it.
    const BodyDef& wheel = body_of(scene, roll.body);
    if (wheel.mount && i > 0) {
      Phalanx& carrier = phalanges_.back();
      const double sum = carrier.mass + *wheel.mass;
      carrier.center = (carrier.mass * carrier.center + *wheel.mass * wheel.position) / sum;
      carrier.mass = sum;
    }
    joints_.push_back(hinge.name);
    phalanges_.push_back(phalanx);
  }
  const BodyDef& drum = body_of(scene, flexor.links.front()->body);
  drum_ = drum.position;
  drum_frame_ = drum.orientation;
  drum_radius_ = radius_of(drum);
  double compliance = 0.0;
  for (std::size_t k = 0; k < extensor.rest_lengths.size(); ++k) compliance += *extensor.compliance;
  stiffness_ = 1.0 / compliance;
  // The first span runs at a tangent of the first wheel.
  const Vector3 start = point_of_link(*extensor.links.front());
  const double d = (start - phalanges_.front().anchor).norm();
  const double r = phalanges_.front().wheel_radius;
  first_tension_ =
      (std::sqrt(d * d - r * r) - extensor.rest_lengths.front()) / *extensor.compliance;
}

double FingerModel::flexor_way(const std::vector<Vector3>& holes) const {
  const Vector3 d = drum_frame_.conjugate() * (holes.front() - drum_);
  const double distance = std::hypot(d.x(), d.y());
  // It leaves the drum clockwise, over its top; what turns the tangent point back along the cable
  // is unwound from the drum.
  double way = std::sqrt(distance * distance - drum_radius_ * drum_radius_) -
               drum_radius_ * (std::atan2(d.y(), d.x()) - std::asin(drum_radius_ / distance));
  for (std::size_t i = 1; i < holes.size(); ++i) way += (holes[i] - holes[i - 1]).norm();
  return way;
}

double FingerModel::potential(const Eigen::VectorXd& angles, double flexor_tension) const {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();  // x -> turn x + shift
  std::vector<Vector3> holes;
  double v = 0.0;
  double lengthening = 0.0;
  for (std::size_t i = 0; i < phalanges_.size(); ++i) {
    const Phalanx& p = phalanges_[i];
    const double t = angles[static_cast<Eigen::Index>(i)];
    // Turns about an axis that the bones before have carried along.
    const Eigen::Matrix3d own = Eigen::AngleAxisd(t, Eigen::Vector3d(p.axis)).toRotationMatrix();
    shift += turn * (Eigen::Vector3d(p.anchor) - own * Eigen::Vector3d(p.anchor));
    turn = turn * own;
    holes.emplace_back(turn * Eigen::Vector3d(p.hole) + shift);
    v -= p.mass * Eigen::Vector3d(gravity_).dot(turn * Eigen::Vector3d(p.center) + shift);
    v += 0.5 * p.stiffness * t * t;
    lengthening += p.wheel_radius * t;
  }
  return v + flexor_tension * flexor_way(holes) + first_tension_ * lengthening +
         0.5 * stiffness_ * lengthening * lengthening;
}

Eigen::VectorXd FingerModel::posture(double flexor_tension) const {
  const auto n = static_cast<Eigen::Index>(phalanges_.size());
  Eigen::VectorXd angles = Eigen::VectorXd::Zero(n);
  // Newton's method with central differences: errors of V'' e^2 = 1e-8 of the gradient, 1e-4 of the
  // slope.
  constexpr double e = 1e-4;
  const auto v = [&](Eigen::Index i, double si, Eigen::Index j, double sj) {
    Eigen::VectorXd moved = angles;
    moved[i] += si * e;
    moved[j] += sj * e;
    return potential(moved, flexor_tension);
  };
  for (int round = 0; round < 30; ++round) {
    Eigen::VectorXd gradient(n);
    Eigen::MatrixXd slope(n, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      gradient[i] = (v(i, 1.0, i, 0.0) - v(i, -1.0, i, 0.0)) / (2.0 * e);
      for (Eigen::Index j = 0; j < n; ++j) {
        slope(i, j) =
            (v(i, 1.0, j, 1.0) - v(i, 1.0, j, -1.0) - v(i, -1.0, j, 1.0) + v(i, -1.0, j, -1.0)) /
            (4.0 * e * e);
      }
    }
    const Eigen::VectorXd change = slope.fullPivLu().solve(gradient);
    angles -= std::min(1.0, 0.2 / std::max(change.norm(), 1e-30)) * change;
    if (change.norm() < 1e-8) break;
  }
  return angles;
}

double FingerModel::extensor_tension(const Eigen::VectorXd& angles) const {
  double lengthening = 0.0;
  for (std::size_t i = 0; i < phalanges_.size(); ++i) {
    lengthening += phalanges_[i].wheel_radius * angles[static_cast<Eigen::Index>(i)];
  }
  return first_tension_ + stiffness_ * lengthening;
}

}  // namespace sheave::test
