#include "statics/place_joints.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "engine/index.h"
#include "engine/joint.h"
#include "engine/number_text.h"
#include "statics/coordinate_basis.h"
#include "statics/decompositions.h"

namespace sheave {
namespace {

/// Longest part of a way [rad, or sizes of the scene]: Newton's method converges in a few rounds, and
/// contacts of cables with wheels move by less than half a turn.
constexpr double part_of_way = 0.2;
constexpr int most_rounds = 30;
/// Residuals [rad, or sizes of the scene] below which loops are closed.
constexpr double closed = 1e-9;
/// Size of the correction at which the rounds end. The next one is about its square, and where bodies
/// turn about all axes, a tenth of it: gradients are by rotations after the one so far.
constexpr double settled = 1e-12;

/// A coordinate on the way from one value to another.
struct Demand {
  MachineCoordinate coordinate;
  double from = 0.0;
  double to = 0.0;
  [[nodiscard]] double at(double share) const { return from + share * (to - from); }
};

/// The coordinates of the joint with this name, or if there is none, of the body.
std::vector<std::size_t> owned_by(const std::vector<MachineCoordinate>& all, const World& world,
                                  const std::string& name) {
  std::vector<std::size_t> found;
  for (const bool joints : {true, false}) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      if ((all[i].joint >= 0) != joints) continue;
      const std::string& owner =
          joints ? world.model().joints[at(all[i].joint)]->name : world.bodies().name(all[i].body);
      if (owner == name) found.push_back(i);
    }
    if (!found.empty()) break;
  }
  return found;
}

/// The index of the coordinate with this name, or the error.
Result<std::size_t> find(const std::vector<MachineCoordinate>& all, const World& world,
                         const std::string& name) {
  std::string names;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].name == name) return i;
    constexpr std::size_t enough = 300;
    if (names.size() < enough) names += (names.empty() ? "" : ", ") + all[i].name;
  }
  const std::vector<std::size_t> owned = owned_by(all, world, name);
  if (owned.size() == 1) return owned.front();
  if (owned.size() > 1) {
    return Error{"", "\"" + name + "\" has several coordinates; name one of them, such as \"" +
                         all[owned.back()].name + "\""};
  }
  return Error{"", "there is no coordinate \"" + name + "\"; " +
                       (names.empty() ? "the machine has none" : "there are: " + names)};
}

/// The orientations of bodies that turn about all axes, per body.
using Orientations = std::map<int, Quaternion>;

/// One machine on its way.
class Way {
 public:
  Way(Simulation& simulation, std::vector<Demand> demands)
      : simulation_(simulation),
        demands_(std::move(demands)),
        scale_(simulation.world.bodies().scale()) {
    double longest = 0.0;
    for (const Demand& demand : demands_) {
      const double unit = demand.coordinate.angle ? 1.0 : scale_;
      longest = std::max(longest, std::abs(demand.to - demand.from) / unit);
    }
    parts_ = std::max(1, static_cast<int>(std::ceil(longest / part_of_way)));
    find_orientations();
  }

  /// The states after each part of the way, or why there are none.
  Result<std::vector<State>> states() {
    std::vector<State> way;
    State now = simulation_.world.state();
    for (int part = 1; part <= parts_; ++part) {
      MachinePose pose(simulation_, now);
      std::string fault = close(pose, static_cast<double>(part) / parts_);
      if (!fault.empty()) return Error{"", std::move(fault)};
      State next = pose.state_here();
      way.push_back(next);
      now = std::move(next);
    }
    return way;
  }

 private:
  /// Start and end of the bodies whose rotation vectors are demanded.
  void find_orientations() {
    const BodySet& bodies = simulation_.world.bodies();
    std::map<int, Vector3> vectors;
    for (const Demand& demand : demands_) {
      const MachineCoordinate& own = demand.coordinate;
      if (!own.turns_freely) continue;
      const Quaternion start = bodies.initial_orientation(own.body);
      const Quaternion& now = simulation_.world.state().bodies[at(own.body)].orientation;
      const auto first =
          vectors.try_emplace(own.body, rotation_vector(now * start.conjugate())).first;
      first->second[own.part - 3] = demand.to;
    }
    for (const auto& [body, vector] : vectors) {
      from_[body] = simulation_.world.state().bodies[at(body)].orientation;
      to_[body] = rotation_by(vector) * bodies.initial_orientation(body);
      const double angle = rotation_vector(to_[body] * from_[body].conjugate()).norm();
      parts_ = std::max(parts_, static_cast<int>(std::ceil(angle / part_of_way)));
    }
  }

  /// The deviation from a demand in the present pose, and the gradient of the coordinate.
  PoseMeasure rest_of(const MachinePose& pose, const Demand& demand, double share) const {
    const MachineCoordinate& own = demand.coordinate;
    PoseMeasure rest = measure(pose, own);
    if (own.turns_freely) {
      const Quaternion wanted = from_.at(own.body).slerp(share, to_.at(own.body));
      rest.value = -pose.turn_to(own.body, wanted)[own.part - 3];
    } else {
      rest.value -= demand.at(share);
    }
    return rest;
  }

  /// The rows of the present pose: those of joints first, then the demands.
  struct Rows {
    Eigen::Index locks = 0;
    MatrixX gradients;
    VectorX rest;
    [[nodiscard]] double open() const { return largest(rest.head(locks)); }
    [[nodiscard]] double off() const { return largest(rest.tail(rest.size() - locks)); }
    static double largest(const VectorX& values) {
      return values.size() > 0 ? values.cwiseAbs().maxCoeff() : 0.0;
    }
  };
  Rows rows_of(MachinePose& pose, double share) const {
    const JointLocks locks = pose.locks();
    Rows rows;
    rows.locks = locks.values.size();
    const auto count = static_cast<Eigen::Index>(demands_.size());
    rows.gradients.resize(rows.locks + count, pose.freedoms());
    rows.rest.resize(rows.locks + count);
    rows.gradients.topRows(rows.locks) = locks.gradients;
    rows.rest.head(rows.locks) = locks.values;
    for (Eigen::Index i = 0; i < count; ++i) {
      const PoseMeasure own = rest_of(pose, demands_[static_cast<std::size_t>(i)], share);
      rows.gradients.row(rows.locks + i) = own.gradient.transpose();
      rows.rest[rows.locks + i] = own.value;
    }
    return rows;
  }

  /// Newton's method; returns why the loops do not close.
  std::string close(MachinePose& pose, double share) const {
    VectorX displacement = VectorX::Zero(pose.freedoms());
    double correction = 0.0;
    for (int round = 0; round < most_rounds; ++round) {
      const Rows rows = rows_of(pose, share);
      if (rows.rest.size() == 0) return {};
      if (round > 0 && correction < settled * scale_) return fault_of(rows, share);
      const VectorX step = least_norm_solution(rows.gradients, rows.rest);
      correction = step.cwiseAbs().maxCoeff();
      // A longer step leaves the region in which the gradients hold.
      if (!(correction < std::max(1.0, scale_))) break;
      displacement -= step;
      pose.place(displacement, 0.0);
    }
    return fault_of(least_open(pose, share), share);
  }

  /// The rows of the pose that meets the demands and leaves loops open as little as possible: the
  /// method of Levenberg and Marquardt.
  Rows least_open(MachinePose& pose, double share) const {
    constexpr double weight_of_demands = 1e3;
    constexpr int most_attempts = 200;
    const auto weighted = [&](const VectorX& displacement) {
      pose.place(displacement, 0.0);
      Rows rows = rows_of(pose, share);
      const Eigen::Index count = rows.rest.size() - rows.locks;
      rows.rest.tail(count) *= weight_of_demands;
      rows.gradients.bottomRows(count) *= weight_of_demands;
      return rows;
    };
    VectorX displacement = VectorX::Zero(pose.freedoms());
    Rows best = weighted(displacement);
    double damping = 1.0;
    for (int attempt = 0; attempt < most_attempts && damping < 1e12; ++attempt) {
      MatrixX normal = best.gradients.transpose() * best.gradients;
      normal.diagonal().array() += damping;
      const std::optional<VectorX> step =
          positive_solution(normal, best.gradients.transpose() * best.rest);
      if (!step) {
        damping *= 5.0;
        continue;
      }
      Rows next = weighted(displacement - *step);
      const bool better = next.rest.squaredNorm() < best.rest.squaredNorm();
      damping *= better ? 0.2 : 5.0;
      if (!better) continue;
      displacement -= *step;
      best = std::move(next);
    }
    pose.place(displacement, 0.0);
    best.rest.tail(best.rest.size() - best.locks) /= weight_of_demands;
    return best;
  }

  std::string fault_of(const Rows& rows, double share) const {
    const double allowed = closed * std::max(scale_, 1.0);
    if (rows.open() > allowed) {
      return "the loops of joints cannot be closed: a residual of " + number_text(rows.open(), 4) +
             " (m or rad) is left" + where(share) +
             "; leave out coordinates that depend on others, or choose values within reach";
    }
    if (rows.off() > allowed) {
      return "the coordinates cannot have these values together: " + number_text(rows.off(), 4) +
             " (m or rad) is left" + where(share);
    }
    return {};
  }

  [[nodiscard]] std::string where(double share) const {
    return share < 1.0 ? " at " + std::to_string(std::lround(100.0 * share)) + " % of the way" : "";
  }

  Simulation& simulation_;
  std::vector<Demand> demands_;
  double scale_;
  int parts_ = 1;
  Orientations from_;
  Orientations to_;
};

/// The targets first, then the coordinates that keep their values.
Result<std::vector<Demand>> demands_of(const World& world, MachinePose& pose,
                                       const std::vector<CoordinateTarget>& targets) {
  const std::vector<MachineCoordinate> all = all_coordinates(world, pose);
  std::vector<MachineCoordinate> order;
  std::map<std::string, double> wanted;
  for (const CoordinateTarget& target : targets) {
    Result<std::size_t> index = find(all, world, target.name);
    if (!index) return index.errors();
    const MachineCoordinate& own = all[*index];
    if (!wanted.emplace(own.name, target.value).second) {
      return Error{"", "coordinate \"" + own.name + "\" has two values; give one"};
    }
    order.push_back(own);
  }
  for (const MachineCoordinate& own : all) {
    if (!wanted.contains(own.name)) order.push_back(own);
  }
  std::vector<Demand> demands;
  for (const MachineCoordinate& own : independent_coordinates(pose, order, targets.size())) {
    const double now = measure(pose, own).value;
    const auto found = wanted.find(own.name);
    const double value = found == wanted.end() ? now : found->second;
    const double most = most_placement * (own.angle ? 1.0 : world.bodies().scale());
    if (!(std::abs(value - now) <= most)) {
      return Error{"", "coordinate \"" + own.name + "\": the value must be a number within " +
                           number_text(most) + (own.angle ? " rad" : " m") + " of " +
                           number_text(now, 6) + ", was " + number_text(value)};
    }
    demands.push_back({own, now, value});
  }
  return demands;
}

/// Why the machine is too large; empty if it is not.
Errors size_fault(const World& world) {
  const int freedoms = world.bodies().coordinates().count() - 1;
  if (freedoms <= JointSpace::most_freedoms) return {};
  return {{"", "the bodies have " + std::to_string(freedoms) +
                   " degrees of freedom; coordinates of joints are for at most " +
                   std::to_string(JointSpace::most_freedoms)}};
}

/// Gives the bodies of `there`, which is a pose of the machine, the rates of the coordinates that
/// they have in the present state.
void keep_rates(Simulation& simulation, State& there) {
  const State state = simulation.world.state();
  MachinePose before(simulation, state);
  const auto all = all_coordinates(simulation.world, before);
  const auto coordinates = independent_coordinates(before, all, 0);
  const CoordinateBasis basis = basis_of(before, coordinates);
  const VectorX rates = basis.gradients * before.velocities_of(state) + basis.turning;
  MachinePose after(simulation, there);
  const CoordinateBasis moved = basis_of(after, coordinates);
  State next = there;
  after.set_velocities(moved.motions * rates + moved.drift, next);
  there = std::move(next);
}

}  // namespace

Result<Placement> place_joints(LiveWorld& world, const std::vector<CoordinateTarget>& targets,
                               Keep keep) {
  if (Errors fault = size_fault(world.simulation().world); !fault.empty()) return fault;
  std::optional<Result<std::vector<State>>> way;
  Errors errors = world.examine([&](Simulation& simulation) {
    const State state = simulation.world.state();
    MachinePose pose(simulation, state);
    Result<std::vector<Demand>> demands = demands_of(simulation.world, pose, targets);
    if (!demands) {
      way.emplace(demands.errors());
      return;
    }
    way.emplace(Way(simulation, std::move(*demands)).states());
    if (way->ok()) keep_rates(simulation, (*way)->back());
  });
  if (!errors.empty()) return errors;
  if (!way->ok()) return way->errors();
  return world.place(**way, keep);
}

Errors set_joint_rates(LiveWorld& world, const std::vector<CoordinateTarget>& rates) {
  if (Errors fault = size_fault(world.simulation().world); !fault.empty()) return fault;
  State next = world.state();
  Errors faults;
  Errors errors = world.examine([&](Simulation& simulation) {
    const State state = simulation.world.state();
    MachinePose pose(simulation, state);
    const auto coordinates =
        independent_coordinates(pose, all_coordinates(simulation.world, pose), 0);
    const CoordinateBasis basis = basis_of(pose, coordinates);
    VectorX wanted = basis.gradients * pose.velocities_of(state) + basis.turning;
    for (const CoordinateTarget& rate : rates) {
      Result<std::size_t> index = find(coordinates, simulation.world, rate.name);
      if (!index) {
        faults = index.errors();
        return;
      }
      if (!std::isfinite(rate.value)) {
        faults = {{"", "coordinate \"" + rate.name + "\": the rate must be a finite number"}};
        return;
      }
      wanted[static_cast<Eigen::Index>(*index)] = rate.value;
    }
    pose.set_velocities(basis.motions * wanted + basis.drift, next);
  });
  if (!errors.empty()) return errors;
  if (!faults.empty()) return faults;
  return world.restore(next);
}

}  // namespace sheave
