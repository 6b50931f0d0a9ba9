// One row per point that can touch the floor: C = n . (p - p0) >= 0 with l in [0, inf), gradient n
// at p. The points of a body are those its shapes name for the floor's direction at the start of
// the substep; they are fixed to the body for the substep, so the gradient is exact. A rotor on a
// fixed axle cannot fall and has no points; a mounted rotor's shape counts as part of its carrier.

#include "engine/contacts/ground_batch.h"

#include <algorithm>

#include "engine/substep.h"

namespace sheave {
namespace {

class GroundBatch final : public ConstraintBatch {
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
    std::size_t next = 0;
    for (const Owner& owner : owners_) {
      points_.clear();
      append_points(substep, owner);
      for (const Vector3& point : points_) contacts_[next++].point = point;
    }
  }

  double sweep(Substep& substep) override {
    double correction = 0.0;
    Row row;
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      row.clear();
      evaluate(substep, contacts_[i], row);
      if (row.value >= 0.0 && multipliers_[i] == 0.0) continue;  // apart
      correction = std::max(correction, solve_row(row, substep.h, multipliers_[i], substep.moving));
    }
    return correction;
  }

  void linearise(Substep& substep, std::vector<Row>& rows) override {
    int index = 0;
    for (const Contact& contact : contacts_) {
      Row& row = rows.emplace_back();
      evaluate(substep, contact, row);
      row.index = index++;
      row.active = contact.pressed;
    }
  }
  [[nodiscard]] std::span<double> multipliers() override { return multipliers_; }

  void finish(Substep& substep, FeatureState& next) override {
    for (std::size_t i = 0; i < multipliers_.size(); ++i) {
      next.reals[i] = multipliers_[i] / (substep.h * substep.h);
    }
  }

  [[nodiscard]] double elastic_energy(const BodySet& /*bodies*/, const State& /*state*/,
                                      const FeatureState& /*own*/) const override {
    return 0.0;
  }

 private:
  struct Contact {
    int body;
    Vector3 point;         // own frame [m], set in begin()
    bool pressed = false;  // in the last substep
  };
  struct Owner {
    int body;
    const PlacedShape* shape;
    Vector3 center_of_mass;  // body frame
  };

  void add_body(const BodySet& bodies, int body) {
    for (const PlacedShape& placed : bodies.definition(body).shapes) {
      owners_.push_back({body, &placed, bodies[body].center_of_mass});
      points_.clear();
      placed.shape->append_contact_points(Vector3::UnitX(), points_);
      for (const Vector3& point : points_) contacts_.push_back({body, point, false});
    }
  }

  void append_points(const Substep& substep, const Owner& owner) {
    const Quaternion shape_to_world = substep.orientation(owner.body) * owner.shape->orientation;
    owner.shape->shape->append_contact_points(shape_to_world.conjugate() * (-normal_), points_);
    for (Vector3& point : points_) {
      point = owner.shape->position + owner.shape->orientation * point - owner.center_of_mass;
    }
  }

  void evaluate(const Substep& substep, const Contact& contact, Row& row) const {
    const Vector3 at = substep.point(contact.body, contact.point);
    row.value = normal_.dot(at - point_);
    row.lower = 0.0;
    substep.add_force(row, contact.body, at, normal_);
  }

  Vector3 point_;
  Vector3 normal_;
  std::vector<Owner> owners_;
  std::vector<Contact> contacts_;
  std::vector<Vector3> points_;      // scratch
  std::vector<double> multipliers_;  // scratch
};

}  // namespace

std::unique_ptr<ConstraintBatch> make_ground_batch(const GroundDef& ground, const BodySet& bodies) {
  return std::make_unique<GroundBatch>(ground, bodies);
}

}  // namespace sheave
