// One row per point that can touch the floor: C = n . (p - p0) >= 0 with l in [0, inf), gradient n
// at p. The shapes of a body give its points for the floor's direction at the start of the substep.
// Corners are fixed to the body for the substep, so the gradient is exact. The lowest point of a
// round form does not turn with the body: for a ball or a capsule it stays below the centre or the
// end of the core. The rim points of a cylinder turn with its axis, not about it, so that no force
// turns the cylinder about its axis. (Points fixed to the body would be off the middle by r w h
// when the floor stops a fall at the speed v, and a cylinder would gain the spin 2 v w h / r.) A
// rotor on a fixed axle cannot fall and has no points. The shape of a mounted rotor belongs to its
// carrier.

#include "engine/contacts/ground_batch.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/dynamics/affine_bodies.h"
#include "engine/feature_roles.h"
#include "engine/index.h"
#include "engine/solvers/affine_rows.h"
#include "engine/solvers/direct.h"
#include "engine/solvers/row_system.h"
#include "engine/substep.h"

namespace sheave {
namespace {

class GroundBatch final : public ConstraintBatch, public AffineFeature {
 public:
  GroundBatch(const GroundDef& ground, const BodySet& bodies)
      : point_(ground.point), normal_(ground.normal.normalized()) {
    for (int i = 0; i < bodies.count(); ++i) {
      const Mobility mobility = bodies[i].mobility;
      if (mobility == Mobility::free || mobility == Mobility::planar ||
          mobility == Mobility::slider || bodies[i].mount >= 0) {
        add_body(bodies, i);
      }
    }
    multipliers_.resize(contacts_.size());
    points_.reserve(contacts_.size());
  }

  [[nodiscard]] std::string_view name() const override { return "ground contacts"; }
  [[nodiscard]] FeatureState initial_state() const override {
    return {std::vector<double>(contacts_.size(), 0.0), {}};
  }
  [[nodiscard]] int row_count() const override { return static_cast<int>(contacts_.size()); }

  void begin(const Substep& substep, const FeatureState& state) override {
    std::fill(multipliers_.begin(), multipliers_.end(), 0.0);
    for (std::size_t i = 0; i < contacts_.size(); ++i) contacts_[i].pressed = state.reals[i] > 0.0;
    for (Owner& owner : owners_) {
      points_.clear();
      append_points(substep, owner);
      owner.touches = false;
      double reach_squared = 0.0;
      double round_reach = 0.0;
      std::size_t next = owner.first;
      for (const Vector3& point : points_) {
        Contact& contact = contacts_[next++];
        place(substep, owner, point, contact);
        reach_squared = std::max(reach_squared, dot(point, point));
        if (contact.surface == Surface::corners) continue;
        round_reach = std::max(round_reach, contact.point.norm() + owner.radius);
      }
      // The lowest point of a round form moves away from the centre of mass as the body turns.
      owner.reach = std::max(std::sqrt(reach_squared), round_reach);
      owner.near = may_come_near(substep, owner);
    }
  }

  double sweep(Substep& substep) override {
    double correction = 0.0;
    Row row;
    for (Owner& owner : owners_) {
      // One test for a shape that is far from the floor. A shape with a point that has been pushed
      // is always evaluated.
      if (!owner.touches && height(substep.position(owner.body)) > owner.reach) continue;
      for (std::size_t i = owner.first; i < owner.first + owner.count; ++i) {
        row.clear();
        evaluate(substep, contacts_[i], row);
        if (row.value >= 0.0 && multipliers_[i] == 0.0) continue;  // apart
        correction =
            std::max(correction, solve_row(row, substep.h, multipliers_[i], substep.moving));
        owner.touches = true;
      }
    }
    return correction;
  }

  void linearise(Substep& substep, RowList& rows) override {
    for (Owner& owner : owners_) {
      // A row that appears in the middle of a substep has no value at the start; `rattle` leaves
      // such a substep to `xpbd`.
      owner.near = owner.near || height(substep.position(owner.body)) <= owner.reach;
      if (!owner.near) continue;
      for (std::size_t i = owner.first; i < owner.first + owner.count; ++i) {
        Row& row = rows.emplace_back();
        evaluate(substep, contacts_[i], row);
        row.index = static_cast<int>(i);
        row.active = contacts_[i].pressed;
      }
    }
  }
  [[nodiscard]] std::span<double> multipliers() override { return multipliers_; }

  void finish(Substep& substep, FeatureState& next) override {
    for (std::size_t i = 0; i < multipliers_.size(); ++i) {
      next.reals[i] = multipliers_[i] / (substep.h * substep.h);
    }
  }

  void adopt(const ConstraintBatch& before, const FeatureState& from,
             FeatureState& own) const override {
    const auto* other = dynamic_cast<const GroundBatch*>(&before);
    if (other == nullptr) return;
    for (const Owner& owner : owners_) {
      const auto same = [&](const Owner& then) {
        return then.body == owner.body && then.shape->shape == owner.shape->shape &&
               then.count == owner.count;
      };
      const auto then = std::find_if(other->owners_.begin(), other->owners_.end(), same);
      if (then == other->owners_.end()) continue;
      std::copy_n(from.reals.begin() + static_cast<std::ptrdiff_t>(then->first), owner.count,
                  own.reals.begin() + static_cast<std::ptrdiff_t>(owner.first));
    }
  }

  // Affine substeps. All points of a shape that slides without turning move alike, so only the
  // lowest can touch. Other bodies have no force as long as they end a substep above the floor.
  bool append_affine(const AffineBodies& bodies, AffineRows& rows) override {
    sliding_.clear();
    above_ = DirectSolver::closed * bodies.set().scale();
    for (const Owner& owner : owners_) {
      const Sliding& body = sliding_.emplace_back(slide(bodies, owner));
      if (body.contact < 0) continue;
      rows.add_row(0.0, 0.0, body.contact);
      rows.add_term(body.number, body.along);
    }
    return true;
  }
  bool begin_affine(const AffineSubstep& substep, const FeatureState& state,
                    std::span<double> values, std::span<char> active) override {
    std::size_t row = 0;
    for (std::size_t i = 0; i < owners_.size(); ++i) {
      Sliding& body = sliding_[i];
      const auto first = state.reals.begin() + static_cast<std::ptrdiff_t>(owners_[i].first);
      const bool pressed = std::any_of(first, first + static_cast<std::ptrdiff_t>(owners_[i].count),
                                       [](double force) { return force > 0.0; });
      if (body.contact < 0) {
        if (pressed) return false;
        continue;
      }
      const double height = body.lowest + body.along * substep.places[at(body.number)];
      const double speed = std::abs(substep.speeds[at(body.number)]);
      body.near = comes_near(height + body.below, body.reach, substep.h * speed);
      values[row] = height;
      active[row++] = pressed ? 1 : 0;
    }
    return true;
  }
  bool finish_affine(const AffineSubstep& substep, const FeatureState& /*now*/,
                     FeatureState& next) override {
    std::size_t row = 0;
    for (std::size_t i = 0; i < owners_.size(); ++i) {
      const Sliding& body = sliding_[i];
      const double place = substep.places[at(body.number)] + substep.motion[at(body.number)];
      const double height = body.lowest + body.along * place;
      if (body.contact < 0) {
        if (!(height > above_)) return false;
        continue;
      }
      // A body that was too far to have a row at the start has fallen this far: see linearise().
      if (!body.near && height + body.below <= body.reach) return false;
      const auto first = next.reals.begin() + static_cast<std::ptrdiff_t>(owners_[i].first);
      std::fill_n(first, owners_[i].count, 0.0);
      next.reals[at(body.contact)] = substep.multipliers[row++] / (substep.h * substep.h);
    }
    return true;
  }

  [[nodiscard]] double elastic_energy(const BodySet& /*bodies*/, const State& /*state*/,
                                      const FeatureState& /*own*/) const override {
    return 0.0;
  }

 private:
  enum class Surface { corners, ball, cylinder };
  struct Contact {
    int body;
    Vector3 point;         // own frame [m], set in begin(); for round forms a point of the core
    bool pressed = false;  // whether it had a force in the last substep
    Surface surface = Surface::corners;
    double radius = 0.0;                 // of a ball [m]
    Vector3 own_axis = Vector3::Zero();  // of a cylinder, own frame
    // The following are values at the start of the substep.
    Vector3 axis = Vector3::Zero();
    Vector3 offset = Vector3::Zero();  // from the core to the surface [m]
  };
  struct Owner {
    int body;
    const PlacedShape* shape;
    Vector3 center_of_mass;  // body frame
    std::size_t first = 0;   // index of its first contact
    std::size_t count = 0;
    double reach =
        0.0;  // largest distance of a contact's point from the centre of mass in this substep [m]
    bool touches = false;  // whether one of its multipliers may differ from 0
    bool near = false;     // whether its speed allows it to touch the floor in this substep
    Surface surface = Surface::corners;
    double radius = 0.0;  // radius of a round form [m]
  };

  /// A body with one coordinate q: its lowest point is at the height `lowest` + `along` times q
  /// above the floor.
  struct Sliding {
    int number = 0;
    double along = 0.0;
    double lowest = 0.0;  ///< height at q = 0 [m]
    /// Index of the lowest contact; -1: it changes, or the body never reaches the floor
    int contact = -1;
    double below = 0.0;  ///< height of the centre of mass above the lowest point [m]
    double reach = 0.0;  ///< Owner::reach [m]
    bool near = false;   ///< Owner::near
  };

  [[nodiscard]] Sliding slide(const AffineBodies& bodies, const Owner& owner) {
    const BodySet& set = bodies.set();
    const State initial = set.initial_state();
    const int mount = set[owner.body].mount;
    const int body = mount >= 0 ? mount : owner.body;
    const int number = bodies.number_of(body);
    const double along = dot(normal_, bodies.axis(number));
    const double center = height(set.initial_point(owner.body, owner.center_of_mass)) -
                          along * dot(bodies.axis(number), initial.bodies[at(body)].position);
    Sliding sliding{number, along};
    if (mount >= 0) {
      // An upper bound for all angles of the rotor.
      sliding.below = (owner.shape->position - owner.center_of_mass).norm() +
                      owner.shape->shape->half_extent().norm();
    } else {
      points_.clear();
      append_points(Substep(set, initial, 1.0, 1), owner);
      std::vector<double> depths;
      for (const Vector3& point : points_) {
        depths.push_back(-dot(normal_, initial.bodies[at(body)].orientation * point));
        sliding.reach = std::max(sliding.reach, point.norm());
      }
      // Among points that differ by rounding only, the first bears the load, as in the stages.
      const double rounding = RowSystem::value_rounding * set.scale();
      double deepest = -std::numeric_limits<double>::infinity();
      std::size_t lowest = 0;
      for (std::size_t i = 0; i < depths.size(); ++i) {
        if (depths[i] > deepest + rounding) lowest = i;
        deepest = std::max(deepest, depths[i]);
      }
      sliding.below = depths.empty() ? 0.0 : depths[lowest];
      // A body on a level rail does not yield to the floor.
      constexpr double level = 1e-12;
      if (std::abs(along) > level && !depths.empty()) {
        sliding.contact = static_cast<int>(owner.first + lowest);
      }
    }
    sliding.lowest = center - sliding.below;
    return sliding;
  }
  [[nodiscard]] double height(const Vector3& point) const { return dot(normal_, point - point_); }

  void add_body(const BodySet& bodies, int body) {
    for (const PlacedShape& placed : bodies.definition(body).shapes) {
      points_.clear();
      placed.shape->append_contact_points(Vector3::UnitX(), points_);
      Owner owner{body, &placed, bodies[body].center_of_mass};
      owner.first = contacts_.size();
      owner.count = points_.size();
      find_surface(bodies, owner);
      owners_.push_back(owner);
      for (const Vector3& point : points_) contacts_.push_back({body, point, false});
    }
  }

  static void find_surface(const BodySet& bodies, Owner& owner) {
    // A slider does not turn.
    if (bodies[owner.body].mount < 0 && bodies[owner.body].mobility == Mobility::slider) return;
    const ConvexSolid solid = owner.shape->shape->solid();
    owner.radius = solid.radius;
    if (solid.kind == ConvexSolid::Kind::cylinder) {
      owner.surface = Surface::cylinder;
    } else if (solid.kind == ConvexSolid::Kind::rounded && solid.radius > 0.0) {
      owner.surface = Surface::ball;
    }
  }

  void place(const Substep& substep, const Owner& owner, const Vector3& point,
             Contact& contact) const {
    contact.surface = owner.surface;
    contact.radius = owner.radius;
    contact.point = point;
    if (owner.surface == Surface::corners) return;
    const Quaternion orientation = substep.orientation(owner.body);
    if (owner.surface == Surface::ball) {
      contact.point += rotated(orientation.conjugate(), owner.radius * normal_);
      return;
    }
    const Vector3 center = owner.shape->position - owner.center_of_mass;
    contact.own_axis = rotated(owner.shape->orientation, Vector3::UnitZ());
    contact.point = center + contact.own_axis * dot(contact.own_axis, point - center);
    contact.axis = rotated(orientation, contact.own_axis);
    contact.offset = rotated(orientation, point - contact.point);
  }

  /// The factor 2 allows for the speed that the body gains in the substep.
  [[nodiscard]] bool may_come_near(const Substep& substep, const Owner& owner) const {
    const double above = height(substep.position(owner.body));
    const int mount = substep.bodies[owner.body].mount;
    const BodyState& state = substep.start.bodies[at(mount >= 0 ? mount : owner.body)];
    return comes_near(above, owner.reach, substep.h * state.velocity.norm());
  }
  [[nodiscard]] static bool comes_near(double above, double reach, double way) {
    return above <= 2.0 * (reach + way);
  }

  void append_points(const Substep& substep, const Owner& owner) {
    const Quaternion shape_to_world = substep.orientation(owner.body) * owner.shape->orientation;
    owner.shape->shape->append_contact_points(shape_to_world.conjugate() * (-normal_), points_);
    for (Vector3& point : points_) {
      point = owner.shape->position + owner.shape->orientation * point - owner.center_of_mass;
    }
  }

  void evaluate(const Substep& substep, const Contact& contact, Row& row) const {
    Vector3 at = substep.point(contact.body, contact.point);
    row.lower = 0.0;
    row.contact = true;
    if (contact.surface == Surface::ball) {
      row.value = height(at) - contact.radius;
      substep.add_force(row, contact.body, at, normal_);
      return;
    }
    Vector3 spin = Vector3::Zero();
    if (contact.surface == Surface::cylinder) {
      // The offset turns by the smallest rotation that takes the axis from its start to its present
      // direction.
      const Vector3 axis = rotated(substep.orientation(contact.body), contact.own_axis);
      const double facing = 1.0 + dot(axis, contact.axis);  // 0 if the axis has been reversed
      const double tilt = facing > 1e-9 ? dot(axis, contact.offset) / facing : 0.0;
      const Vector3 offset = contact.offset - tilt * (contact.axis + axis);
      spin = axis * dot(axis, cross(offset, normal_));
      at += offset;
    }
    row.value = height(at);
    substep.add_force(row, contact.body, at, normal_);
    if (contact.surface == Surface::cylinder) substep.add_torque(row, contact.body, -spin);
  }

  Vector3 point_;
  Vector3 normal_;
  std::vector<Owner> owners_;
  double above_ = 0.0;            // height [m] below which `rattle` counts a row as closed
  std::vector<Sliding> sliding_;  // per owner, if all bodies have one coordinate
  std::vector<Contact> contacts_;
  std::vector<Vector3> points_;      // scratch
  std::vector<double> multipliers_;  // scratch
};

}  // namespace

std::unique_ptr<ConstraintBatch> make_ground_batch(const GroundDef& ground, const BodySet& bodies) {
  return std::make_unique<GroundBatch>(ground, bodies);
}

}  // namespace sheave
