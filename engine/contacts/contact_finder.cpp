// The largest distance at which two bodies are examined at the start of a substep: the distance
// that their velocities, free fall and rotation can close within the substep, plus 1 % of the
// smaller form, so that resting bodies keep their points. A point with a gap has a row that acts
// once the gap closes; such rows stop a fast body at a thin wall. Two motions are not detected:
// displacements by forces within one substep that exceed the 1 %, and the sideways sweep of a body
// that turns fast.

#include "engine/contacts/contact_finder.h"

#include <algorithm>
#include <limits>
#include <set>

#include "engine/integrators/loads.h"
#include "engine/math/portable.h"
#include "engine/model.h"

namespace sheave {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double skin = 0.01;

bool can_move(const BodySet& bodies, int body) {
  if (!yields(bodies[body].mobility)) return false;
  if (bodies[body].mount >= 0) return true;
  return !bodies[body].prescribed();
}

bool share_a_name(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  return std::any_of(a.begin(), a.end(), [&](const std::string& name) {
    return std::find(b.begin(), b.end(), name) != b.end();
  });
}

/// The carrier of a mounted rotor, else the body itself.
int carrier_of(const BodySet& bodies, int body) {
  return bodies[body].mount >= 0 ? bodies[body].mount : body;
}

}  // namespace

ContactFinder::ContactFinder(const Model& model, const BodySet& bodies)
    : collider_count_(model.colliders.size()) {
  add_forms(model, bodies);
  exclude_pairs(model, bodies);
  combine_materials(model);
  placed_.resize(forms_.size());
  margins_.resize(forms_.size());
  bounds_.resize(forms_.size());
  accelerations_.resize(at(bodies.count()), Vector3::Zero());
}

void ContactFinder::add_forms(const Model& model, const BodySet& bodies) {
  for (std::size_t c = 0; c < model.colliders.size(); ++c) {
    const int body = model.colliders[c].body.index;
    for (const PlacedShape& placed : bodies.definition(body).shapes) {
      ContactForm form;
      form.body = body;
      form.collider = static_cast<int>(c);
      form.shape = placed.shape.get();
      form.solid = placed.shape->solid();
      form.position = placed.position - bodies[body].center_of_mass;
      form.orientation = placed.orientation.normalized();
      const bool bounded = placed.shape->bounded();
      const bool rim = form.solid.kind == ConvexSolid::Kind::cylinder;
      form.spread = 2.0 * placed.shape->half_extent().maxCoeff();
      for (const Vector3& vertex : form.solid.vertices) {
        const double reach = bounded ? vertex.norm() + form.solid.radius : infinite;
        form.radius = std::max(form.radius, reach);
        const double arm = (form.position + form.orientation * vertex).norm();
        form.turning_arm = std::max(form.turning_arm, arm + (rim ? form.solid.radius : 0.0));
      }
      forms_.push_back(std::move(form));
    }
  }
}

void ContactFinder::exclude_pairs(const Model& model, const BodySet& bodies) {
  std::set<std::pair<int, int>> joined;
  for (const auto& joint : model.joints) {
    const int a = bodies.index(joint->body_a);
    const int b = bodies.index(joint->body_b);
    joined.insert({std::min(a, b), std::max(a, b)});
  }
  apart_.resize(collider_count_ * collider_count_);
  for (std::size_t i = 0; i < collider_count_; ++i) {
    for (std::size_t j = 0; j < collider_count_; ++j) {
      const ColliderDef& first = model.colliders[i];
      const ColliderDef& second = model.colliders[j];
      const int a = first.body.index;
      const int b = second.body.index;
      const bool apart = a == b || carrier_of(bodies, a) == carrier_of(bodies, b) ||
                         (!can_move(bodies, a) && !can_move(bodies, b)) ||
                         joined.contains({std::min(a, b), std::max(a, b)}) ||
                         share_a_name(first.ignores, second.groups) ||
                         share_a_name(second.ignores, first.groups);
      apart_[i * collider_count_ + j] = apart ? 1 : 0;
    }
  }
}

double damping_ratio_of(double restitution) {
  if (!(restitution > 0.0)) return 1.0;
  if (!(restitution < 1.0)) return 0.0;
  double low = 0.0;
  double high = 1.0;
  while (true) {
    const double ratio = 0.5 * (low + high);
    if (!(ratio > low && ratio < high)) return ratio;
    const double sine = std::sqrt((1.0 - ratio) * (1.0 + ratio));
    const double phase = portable::atan2(2.0 * ratio * sine, (2.0 * ratio * ratio) - 1.0);
    const bool throws_less = portable::exp(-ratio / sine * phase) < restitution;
    (throws_less ? high : low) = ratio;
  }
}

void ContactFinder::combine_materials(const Model& model) {
  std::vector<double> ratios;  // per collider; only compliant contacts use it
  for (const ColliderDef& c : model.colliders) {
    ratios.push_back(c.compliance > 0.0 || c.restitution > 0.0 ? damping_ratio_of(c.restitution)
                                                               : 1.0);
  }
  const auto resting = [](const ColliderDef& c) { return c.static_friction.value_or(c.friction); };
  for (std::size_t i = 0; i < model.colliders.size(); ++i) {
    for (std::size_t k = 0; k < model.colliders.size(); ++k) {
      const ColliderDef& a = model.colliders[i];
      const ColliderDef& b = model.colliders[k];
      materials_.push_back({std::sqrt(a.friction * b.friction), std::sqrt(resting(a) * resting(b)),
                            std::max(a.restitution, b.restitution), a.compliance + b.compliance,
                            std::min(ratios[i], ratios[k])});
    }
  }
}

bool ContactFinder::may_touch(const FormPair& pair) const {
  return apart_[pair_of_colliders(pair.a, pair.b)] == 0;
}

const ContactMaterial& ContactFinder::material(const FormPair& pair) const {
  return materials_[pair_of_colliders(pair.a, pair.b)];
}

SolidMotion ContactFinder::motion(const Substep& substep, int form) const {
  const int body = forms_[at(form)].body;
  const BodyState& state = substep.start.bodies[at(body)];
  SolidMotion motion{substep.position(body), substep.h * state.velocity};
  if (!is_zero(state.angular_velocity)) {
    motion.turn = rotation_by(substep.h * state.angular_velocity).toRotationMatrix();
  }
  return motion;
}

void ContactFinder::place(const Substep& substep) {
  const double h = substep.h;
  for (std::size_t i = 0; i < forms_.size(); ++i) {
    const ContactForm& form = forms_[i];
    const BodyState& state = substep.start.bodies[at(form.body)];
    const int carrier = carrier_of(substep.bodies, form.body);
    const MovingBody& moving = substep.moving[at(carrier)];
    Vector3& acceleration = accelerations_[at(form.body)];
    if (moving.translates) {
      acceleration =
          times(moving.inverse_mass, substep.bodies[carrier].mass * substep.gravity +
                                         force_on(substep, carrier, substep.start.bodies));
    }
    const Quaternion own_to_world = substep.orientation(form.body);
    const Vector3 position = substep.position(form.body) + own_to_world * form.position;
    placed_[i].place(form.solid, position, own_to_world * form.orientation);
    const double speed = state.velocity.norm() + state.angular_velocity.norm() * form.turning_arm;
    margins_[i] = h * (speed + h * acceleration.norm()) + skin * form.spread;
    const double reach = form.radius + margins_[i];
    bounds_[i] = {Vector3(position.array() - reach), Vector3(position.array() + reach)};
    if (!std::isfinite(form.radius)) continue;
    for (int k = 0; k < 3; ++k) {
      // The exact extent of core and radius, which is smaller than the ball for long and flat
      // forms.
      double low = infinite;
      double high = -infinite;
      for (const Vector3& vertex : placed_[i].vertices) {
        low = std::min(low, vertex[k]);
        high = std::max(high, vertex[k]);
      }
      const double round = placed_[i].round_reach(Vector3::Unit(k)) + margins_[i];
      bounds_[i].low[k] = low - round;
      bounds_[i].high[k] = high + round;
    }
  }
}

}  // namespace sheave
