// One row per drive, along the angle c of the rotor relative to its carrier. The gradient is the
// axle a on the rotor and -a on the carrier. Rotor and carrier therefore receive opposite torques,
// and angular momentum is conserved. The rows are those of a driven hinge:
//
//   angle    C = c - (table(t) - table(0))
//   speed    C = c - c0 - integral of the table
//   torque   the multiplier has equal bounds: the mean of the torque over the substep

#include "engine/dynamics/mounted_drive.h"

#include <algorithm>

#include "engine/body_drive.h"
#include "engine/index.h"
#include "engine/substep.h"

namespace sheave {
namespace {

class MountedDrives final : public ConstraintBatch {
 public:
  explicit MountedDrives(const BodySet& bodies) {
    for (int i = 0; i < bodies.count(); ++i) {
      const BodyProperties& rotor = bodies[i];
      if (rotor.mounted_drive == DriveKind::none) continue;
      drives_.push_back(i);
    }
    multipliers_.resize(drives_.size());
    acted_.resize(drives_.size());
    demands_.resize(drives_.size());
  }

  [[nodiscard]] std::string_view name() const override { return mounted_drives_name; }
  [[nodiscard]] FeatureState initial_state() const override {
    return {std::vector<double>(drives_.size(), 0.0), {}};
  }
  [[nodiscard]] int row_count() const override { return static_cast<int>(drives_.size()); }

  void begin(const Substep& /*substep*/, const FeatureState& state) override {
    std::fill(multipliers_.begin(), multipliers_.end(), 0.0);
    for (std::size_t i = 0; i < drives_.size(); ++i) acted_[i] = state.reals[i] != 0.0 ? 1 : 0;
    for (Demand& demand : demands_) demand.time = not_set;
  }

  double sweep(Substep& substep) override {
    double correction = 0.0;
    Row row;
    for (std::size_t i = 0; i < drives_.size(); ++i) {
      row.clear();
      evaluate(substep, i, row);
      correction = std::max(correction, solve_row(row, substep.h, multipliers_[i], substep.moving));
    }
    return correction;
  }

  void linearise(Substep& substep, RowList& rows) override {
    for (std::size_t i = 0; i < drives_.size(); ++i) {
      Row& row = rows.emplace_back();
      evaluate(substep, i, row);
      row.index = static_cast<int>(i);
      row.active = acted_[i] != 0;
    }
  }
  [[nodiscard]] std::span<double> multipliers() override { return multipliers_; }
  void adopt(const ConstraintBatch& before, const FeatureState& from,
             FeatureState& own) const override {
    const auto* other = dynamic_cast<const MountedDrives*>(&before);
    if (other == nullptr) return;
    for (std::size_t i = 0; i < drives_.size(); ++i) {
      const auto then = std::find(other->drives_.begin(), other->drives_.end(), drives_[i]);
      if (then == other->drives_.end()) continue;
      own.reals[i] = from.reals[at(static_cast<int>(then - other->drives_.begin()))];
    }
  }

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
  /// Demand of a drive; the same in all rounds of a substep.
  struct Demand {
    double time = not_set;  ///< of the positions to which the demand belongs [s]
    double way = 0.0;       ///< the angle, or the angle since the start of the substep [rad]
    double rate = 0.0;      ///< [rad/s]
    double torque = 0.0;    ///< mean over the substep [N m]
  };

  static Demand demand_of(const Substep& substep, int rotor) {
    const BodyProperties& body = substep.bodies[rotor];
    const BodyDrive drive(body, substep.start.controls, rotor);
    const double from = substep.start.time;
    const double to = substep.time;
    switch (body.mounted_drive) {
      case DriveKind::none:
        break;
      case DriveKind::angle:
        return {to, drive.at(to), drive.rate(to)};
      case DriveKind::speed:
        return {to, to > from ? drive.integral(from, to) : 0.0, drive.at(to)};
      case DriveKind::torque: {
        const double end = substep.next.time;
        return {to, 0.0, 0.0, drive.integral(from, end) / (end - from)};
      }
    }
    return {to};
  }

  void evaluate(const Substep& substep, std::size_t index, Row& row) {
    const int rotor = drives_[index];
    const BodyProperties& body = substep.bodies[rotor];
    const MovingBody& carrier = substep.moving[at(body.mount)];
    const Vector3 axle = rotated(carrier.orientation, body.axis);
    const double start = substep.start.bodies[at(rotor)].angle;
    const double turned = dot(axle, substep.moving[at(rotor)].turn - carrier.turn);
    row.lever = body.size;
    row.add(rotor, Vector3::Zero(), axle);
    row.add(body.mount, Vector3::Zero(), -axle);
    Demand& demand = demands_[index];
    if (demand.time != substep.time) demand = demand_of(substep, rotor);
    switch (body.mounted_drive) {
      case DriveKind::none:
        break;
      case DriveKind::angle:
        row.value = start + turned - demand.way;
        row.rate = -demand.rate;
        break;
      case DriveKind::speed:
        row.value = turned - demand.way;
        row.rate = -demand.rate;
        break;
      case DriveKind::torque:
        row.value = turned;
        row.lower = row.upper = demand.torque * substep.h * substep.h;
        break;
    }
  }

  std::vector<int> drives_;  // rotors with a drive
  // Scratch of a substep.
  std::vector<double> multipliers_;
  std::vector<Demand> demands_;
  std::vector<char> acted_;  // whether the drive had a torque in the last substep
};

}  // namespace

bool has_mounted_drives(const BodySet& bodies) {
  for (int i = 0; i < bodies.count(); ++i) {
    if (bodies[i].mounted_drive != DriveKind::none) return true;
  }
  return false;
}

std::unique_ptr<ConstraintBatch> make_mounted_drives(const BodySet& bodies) {
  return std::make_unique<MountedDrives>(bodies);
}

}  // namespace sheave
