#include "tests/paper/bow_model.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <fmt/format.h>

#include "engine/joints/hinge.h"

namespace sheave::test {
namespace {

const BodyDef& body_named(const Scene& scene, const std::string& name) {
  for (const BodyDef& body : scene.model.bodies) {
    if (body.name == name) return body;
  }
  throw std::runtime_error("no body " + name);
}

const HingeJoint& hinge_named(const Scene& scene, const std::string& name) {
  for (const auto& joint : scene.model.joints) {
    const auto* hinge = dynamic_cast<const HingeJoint*>(joint.get());
    if (hinge != nullptr && hinge->name == name) return *hinge;
  }
  throw std::runtime_error("no hinge " + name);
}

const CableDef& cable_named(const Scene& scene, const std::string& name) {
  for (const CableDef& cable : scene.cables) {
    if (cable.name == name) return cable;
  }
  throw std::runtime_error("no cable " + name);
}

}  // namespace

BowModel::BowModel(const Scene& scene) {
  while (std::any_of(
      scene.model.bodies.begin(), scene.model.bodies.end(),
      [&](const BodyDef& body) { return body.name == fmt::format("upper {}", rods_ + 1); })) {
    ++rods_;
  }
  q_ = Vector::Zero(2 * rods_ + 3);
  for (int i = 0; i < rods_; ++i) {
    const BodyDef& rod = body_named(scene, fmt::format("upper {}", i + 1));
    const HingeJoint& hinge = hinge_named(scene, fmt::format("upper hinge {}", i + 1));
    mass_.push_back(*rod.mass);
    inertia_.push_back(rod.inertia->z());
    stiffness_.push_back(hinge.angle.stiffness);
    damping_.push_back(hinge.angle.damping);
    for (const int limb : {0, 1}) {
      const std::string name = fmt::format("{} {}", limb == 0 ? "upper" : "lower", i + 1);
      const Quaternion turn = body_named(scene, name).orientation;
      q_[limb * rods_ + i] = (limb == 0 ? 2.0 : -2.0) * std::atan2(turn.z(), turn.w());
    }
  }
  const HingeJoint& first = hinge_named(scene, "upper hinge 1");
  rod_ = (hinge_named(scene, "upper hinge 2").anchor - first.anchor).norm();
  root_ = first.anchor.y();
  gravity_ = -scene.model.gravity.y();
  const CableDef& bowstring = cable_named(scene, "string");
  string_length_ = bowstring.rest_lengths.front();
  string_stiffness_ = *bowstring.axial_stiffness / string_length_;
  string_damping_ = bowstring.damping;
  serving_ = *body_named(scene, "serving").mass;
  arrow_ = *body_named(scene, "arrow").mass;
  const CableDef& grip = cable_named(scene, "nock grip");
  grip_compliance_ = *grip.compliance;
  grip_strength_ = *grip.breaking_tension;
  const Vector3 serving = body_named(scene, "serving").position;
  braced_x_ = serving.x();
  const Vector3 fingers = body_named(scene, "fingers").position;
  fingers_y_ = fingers.y();
  cord_ = (fingers - serving).norm();
  rest_x_ = body_named(scene, "rest").position.x();
  arrow_middle_ = body_named(scene, "arrow").position.x() - serving.x();
  q_.tail<3>() << serving.x(), serving.y(), serving.x();
}

Eigen::Vector2d BowModel::tip(const Vector& q, int limb) const {
  const double side = limb == 0 ? 1.0 : -1.0;
  Eigen::Vector2d p(0.0, side * root_);
  for (int i = 0; i < rods_; ++i) {
    const double a = q[limb * rods_ + i];
    p += rod_ * Eigen::Vector2d(-std::sin(a), side * std::cos(a));
  }
  return p;
}

Eigen::Vector2d BowModel::tip_velocity(const Vector& q, const Vector& v, int limb) const {
  const double side = limb == 0 ? 1.0 : -1.0;
  Eigen::Vector2d rate = Eigen::Vector2d::Zero();
  for (int i = 0; i < rods_; ++i) {
    const int k = limb * rods_ + i;
    rate += rod_ * v[k] * Eigen::Vector2d(-std::cos(q[k]), -side * std::sin(q[k]));
  }
  return rate;
}

BowModel::String BowModel::string(const Vector& q, const Vector& v, int limb) const {
  const Eigen::Vector2d serving(q[2 * rods_], q[2 * rods_ + 1]);
  const Eigen::Vector2d d = tip(q, limb) - serving;
  String s;
  s.length = d.norm();
  s.pull = d / s.length;
  const double rate =
      s.pull.dot(tip_velocity(q, v, limb) - Eigen::Vector2d(v[2 * rods_], v[2 * rods_ + 1]));
  const double spring = string_stiffness_ * (s.length - string_length_);
  // Only a stretched string resists, and it never pushes.
  s.tension = spring > 0.0 ? std::max(0.0, spring + string_damping_ * rate) : 0.0;
  s.damping_tension = s.tension - std::max(0.0, spring);
  return s;
}

double BowModel::grip(const Vector& q) const {
  return std::max(0.0, (q[2 * rods_] - q[2 * rods_ + 2]) * -1.0) / grip_compliance_;
}

BowModel::Vector BowModel::force(const Vector& q, const Vector& v, double arrow_weight) const {
  Vector f = Vector::Zero(2 * rods_ + 3);
  for (const int limb : {0, 1}) {
    const double side = limb == 0 ? 1.0 : -1.0;
    const String s = string(q, v, limb);
    const Eigen::Vector2d at_tip = -s.tension * s.pull;
    f.segment<2>(2 * rods_) -= at_tip;
    double beyond = 0.0;
    for (int i = rods_ - 1; i >= 0; --i) {
      const int k = limb * rods_ + i;
      const Eigen::Vector2d lever = rod_ * Eigen::Vector2d(-std::cos(q[k]), -side * std::sin(q[k]));
      const double weight = gravity_ * (beyond + 0.5 * mass_[static_cast<std::size_t>(i)]);
      f[k] += lever.dot(at_tip - Eigen::Vector2d(0.0, weight));
      beyond += mass_[static_cast<std::size_t>(i)];
      // The hinge at this rod's root turns it against the rod before.
      const double bend = q[k] - (i > 0 ? q[k - 1] : 0.0);
      const double rate = v[k] - (i > 0 ? v[k - 1] : 0.0);
      const double torque = stiffness_[static_cast<std::size_t>(i)] * bend +
                            damping_[static_cast<std::size_t>(i)] * rate;
      f[k] -= torque;
      if (i > 0) f[k - 1] += torque;
    }
  }
  f[2 * rods_ + 1] -= gravity_ * serving_ + arrow_weight;
  return f;
}

Eigen::MatrixXd BowModel::mass_matrix(const Vector& q, int limb) const {
  Eigen::MatrixXd m(rods_, rods_);
  double beyond = 0.0;
  for (int j = rods_ - 1; j >= 0; --j) {
    const auto at = static_cast<std::size_t>(j);
    m(j, j) = rod_ * rod_ * (0.25 * mass_[at] + beyond) + inertia_[at];
    for (int i = 0; i < j; ++i) {
      const double c = rod_ * rod_ * (0.5 * mass_[at] + beyond);
      m(i, j) = m(j, i) = c * std::cos(q[limb * rods_ + i] - q[limb * rods_ + j]);
    }
    beyond += mass_[at];
  }
  return m;
}

BowModel::Vector BowModel::acceleration(const Vector& q, const Vector& v, Nock nock) const {
  Vector f = force(q, v, flying_weight());
  Vector a = Vector::Zero(f.size());
  for (const int limb : {0, 1}) {
    const Eigen::MatrixXd m = mass_matrix(q, limb);
    Vector load = f.segment(limb * rods_, rods_);
    for (int j = 0; j < rods_; ++j) {
      for (int k = 0; k < rods_; ++k) {
        if (k == j) continue;
        const double turn = q[limb * rods_ + j] - q[limb * rods_ + k];
        const double rate = v[limb * rods_ + k];
        load[j] -= m(j, k) / std::cos(turn) * std::sin(turn) * rate * rate;
      }
    }
    a.segment(limb * rods_, rods_) = m.ldlt().solve(load);
  }
  const int x = 2 * rods_;
  a[x + 1] = f[x + 1] / (serving_ + 0.25 * arrow_);  // see flying_weight()
  if (nock == Nock::pushed) {
    a[x] = a[x + 2] = f[x] / (serving_ + arrow_);
    return a;
  }
  const double pull = nock == Nock::held ? grip(q) : 0.0;
  a[x] = (f[x] + pull) / serving_;
  a[x + 2] = -pull / arrow_;
  return a;
}

double BowModel::energy(const Vector& q, const Vector& v) const {
  double e = 0.0;
  for (const int limb : {0, 1}) {
    const double side = limb == 0 ? 1.0 : -1.0;
    const Vector rates = v.segment(limb * rods_, rods_);
    e += 0.5 * rates.dot(mass_matrix(q, limb) * rates);
    double height = side * root_;
    for (int i = 0; i < rods_; ++i) {
      const int k = limb * rods_ + i;
      const auto at = static_cast<std::size_t>(i);
      const double bend = q[k] - (i > 0 ? q[k - 1] : 0.0);
      const double rise = side * rod_ * std::cos(q[k]);
      e += 0.5 * stiffness_[at] * bend * bend + mass_[at] * gravity_ * (height + 0.5 * rise);
      height += rise;
    }
    const double stretch = std::max(0.0, string(q, v, limb).length - string_length_);
    e += 0.5 * string_stiffness_ * stretch * stretch;
  }
  const int x = 2 * rods_;
  e += 0.5 * (serving_ * v[x] * v[x] + arrow_ * v[x + 2] * v[x + 2]);
  e += 0.5 * (serving_ + 0.25 * arrow_) * v[x + 1] * v[x + 1];
  return e + (gravity_ * serving_ + flying_weight()) * q[x + 1];
}

double BowModel::loss_rate(const Vector& q, const Vector& v) const {
  double rate = 0.0;
  for (const int limb : {0, 1}) {
    for (int i = 0; i < rods_; ++i) {
      const int k = limb * rods_ + i;
      const double bending = v[k] - (i > 0 ? v[k - 1] : 0.0);
      rate += damping_[static_cast<std::size_t>(i)] * bending * bending;
    }
    const String s = string(q, v, limb);
    const Eigen::Vector2d serving(v[2 * rods_], v[2 * rods_ + 1]);
    rate += s.damping_tension * s.pull.dot(tip_velocity(q, v, limb) - serving);
  }
  return rate;
}

void BowModel::runge_kutta(Vector& q, Vector& v, Nock nock, double h) const {
  const Vector a1 = acceleration(q, v, nock);
  const Vector v2 = v + 0.5 * h * a1;
  const Vector a2 = acceleration(q + 0.5 * h * v, v2, nock);
  const Vector v3 = v + 0.5 * h * a2;
  const Vector a3 = acceleration(q + 0.5 * h * v2, v3, nock);
  const Vector v4 = v + h * a3;
  const Vector a4 = acceleration(q + h * v3, v4, nock);
  q += h / 6.0 * (v + 2.0 * v2 + 2.0 * v3 + v4);
  v += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
}

BowModel::Vector BowModel::held_force(const Vector& q) const {
  const int x = 2 * rods_;
  // Arrow: a beam on the rest and the serving. Fingers: their cord is straight back only if they
  // are level with the serving.
  const double share = (rest_x_ - q[x] - arrow_middle_) / (rest_x_ - q[x]);
  Vector f = force(q, Vector::Zero(q.size()), share * gravity_ * arrow_);
  f[x + 1] -= f[x] * (q[x + 1] - fingers_y_) / cord_;
  return f;
}

BowModel::Draw BowModel::hold(double x) {
  const int at_x = 2 * rods_;
  const Vector still = Vector::Zero(q_.size());
  q_[at_x] = q_[at_x + 2] = x;
  // Newton's method for the limbs and the serving's height; the stiffness matrix by central
  // differences.
  const int n = at_x + 1;
  const auto index = [&](int i) { return i < at_x ? i : at_x + 1; };
  for (int round = 0; round < 50; ++round) {
    const Vector f = held_force(q_);
    Vector rest(n);
    Eigen::MatrixXd k(n, n);
    for (int j = 0; j < n; ++j) {
      rest[j] = f[index(j)];
      Vector plus = q_;
      Vector minus = q_;
      plus[index(j)] += 1e-6;
      minus[index(j)] -= 1e-6;
      const Vector slope = (held_force(minus) - held_force(plus)) / 2e-6;
      for (int i = 0; i < n; ++i) k(i, j) = slope[index(i)];
    }
    const Vector change = k.fullPivLu().solve(rest);
    const double scale = std::min(1.0, 0.1 / std::max(change.cwiseAbs().maxCoeff(), 1e-30));
    for (int i = 0; i < n; ++i) q_[index(i)] += scale * change[i];
    if (change.cwiseAbs().maxCoeff() < 1e-12) break;
  }
  return {held_force(q_)[at_x], energy(q_, still), string(q_, still, 0).tension,
          string(q_, still, 1).tension};
}

BowModel::Shot BowModel::loose(double duration, double step) const {
  Shot shot;
  Vector q = q_;
  Vector v = Vector::Zero(q.size());
  const int x = 2 * rods_;
  Nock nock = Nock::pushed;
  const double before = energy(q, v);
  double broken = 0.0;  // energy that went with the grip
  for (double t = 0.0; t < duration; t += step) {
    const double rate = loss_rate(q, v);
    runge_kutta(q, v, nock, step);
    shot.losses += 0.5 * step * (rate + loss_rate(q, v));
    shot.largest_tension = std::max(shot.largest_tension, string(q, v, 0).tension);
    if (nock == Nock::pushed && acceleration(q, v, nock)[x + 2] < 0.0) nock = Nock::held;
    if (nock == Nock::held && grip(q) > grip_strength_) {
      nock = Nock::free;
      broken = 0.5 * grip_compliance_ * grip(q) * grip(q);
      shot.exit_speed = v[x + 2];
      shot.time = t + step;
    }
  }
  shot.energy_error = energy(q, v) + shot.losses + broken - before;
  return shot;
}

}  // namespace sheave::test
