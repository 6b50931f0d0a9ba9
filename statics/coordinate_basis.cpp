#include "statics/coordinate_basis.h"

#include <algorithm>
#include <array>

#include "engine/index.h"
#include "engine/joint.h"
#include "statics/decompositions.h"

namespace sheave {
namespace {

/// Part of a gradient of norm 1, with lengths in body sizes, that must be independent of the
/// gradients before it. Rounding leaves some 1e-15; four-bar linkages near their singular
/// configuration leave more.
constexpr double independent_part = 1e-7;

/// Orthonormal rows that grow one by one.
class RowSpace {
 public:
  RowSpace(int freedoms, std::span<const double> levers)
      : rows_(MatrixX::Zero(freedoms, freedoms)), levers_(levers) {}

  [[nodiscard]] bool is_full() const { return count_ == rows_.cols(); }
  /// Adds a gradient; false if it depends on those before it.
  bool add(VectorX gradient) {
    if (is_full()) return false;
    for (Eigen::Index i = 0; i < gradient.size(); ++i) {
      // Number 0 of the levers stands for the bodies that do not move.
      gradient[i] /= levers_[static_cast<std::size_t>(i + 1)];
    }
    const double norm = gradient.norm();
    if (!(norm > 0.0)) return false;
    gradient /= norm;
    // Twice is enough for orthogonality to rounding.
    for (int round = 0; round < 2; ++round) {
      const auto before = rows_.leftCols(count_);
      gradient -= before * (before.transpose() * gradient);
    }
    const double part = gradient.norm();
    if (!(part > independent_part)) return false;
    rows_.col(count_++) = gradient / part;
    return true;
  }

 private:
  MatrixX rows_;  // as columns
  Eigen::Index count_ = 0;
  std::span<const double> levers_;
};

/// Whether joints of this type measure coordinates of bodies that other joints and axles carry.
bool only_measures(std::string_view type) {
  return type == "distance" || type == "gear" || type == "rack" || type == "coupling";
}

std::string part_name(Freedom kind, int part) {
  constexpr std::array<const char*, 6> parts{"x", "y", "z", "turn_x", "turn_y", "turn_z"};
  switch (kind) {
    case Freedom::line:
      return "along";
    case Freedom::angle:
      return "turn";
    case Freedom::plane:
      return part == 2 ? "turn" : part == 0 ? "along" : "across";
    case Freedom::none:
    case Freedom::turn:
    case Freedom::space:
      break;
  }
  return parts[at(part)];
}

/// Rotations first: a body on a ball joint then has its three rotations as coordinates.
void append_body(const BodySet& bodies, const BodyFreedom& freedom,
                 std::vector<MachineCoordinate>& all) {
  const int count = size_of(freedom.kind);
  for (const bool rotations : {true, false}) {
    for (int k = 0; k < count; ++k) {
      if (is_rotation(freedom.kind, k) != rotations) continue;
      MachineCoordinate own;
      own.name = bodies.name(freedom.body) + "." + part_name(freedom.kind, k);
      own.body = freedom.body;
      own.part = k;
      own.angle = rotations;
      own.turns_freely = rotations && freedom.kind == Freedom::space;
      all.push_back(std::move(own));
    }
  }
}

/// Joints in the order of the model, then bodies, each with its translations first.
bool is_before(const MachineCoordinate& a, const MachineCoordinate& b) {
  const auto place = [](const MachineCoordinate& one) {
    return std::array<int, 4>{one.joint < 0 ? 1 : 0, one.joint < 0 ? one.body : one.joint,
                              one.coordinate, one.part};
  };
  return place(a) < place(b);
}

}  // namespace

std::vector<MachineCoordinate> all_coordinates(const World& world, const MachinePose& pose) {
  std::vector<MachineCoordinate> all;
  const auto& joints = world.model().joints;
  const auto append_joints = [&](bool measuring) {
    for (std::size_t j = 0; j < joints.size(); ++j) {
      const std::string_view type = joints[j]->type();
      // Swing and twist of a ball joint are singular where its axes are parallel.
      if (type == "ball" || pose.is_broken(static_cast<int>(j))) continue;
      if (only_measures(type) != measuring) continue;
      const auto coordinates = joints[j]->coordinates();
      for (std::size_t k = 0; k < coordinates.size(); ++k) {
        MachineCoordinate own;
        own.name = joints[j]->name + "." + std::string(coordinates[k].name);
        own.joint = static_cast<int>(j);
        own.coordinate = static_cast<int>(k);
        own.angle = coordinates[k].angle;
        all.push_back(std::move(own));
      }
    }
  };
  append_joints(false);
  const BodySet& bodies = world.bodies();
  for (const BodyFreedom& freedom : bodies.coordinates().movable()) {
    append_body(bodies, freedom, all);
  }
  append_joints(true);
  return all;
}

PoseMeasure measure(const MachinePose& pose, const MachineCoordinate& coordinate) {
  if (coordinate.joint >= 0) return pose.joint_coordinate(coordinate.joint, coordinate.coordinate);
  return pose.body_coordinate(coordinate.body, coordinate.part);
}

std::vector<MachineCoordinate> independent_coordinates(
    MachinePose& pose, const std::vector<MachineCoordinate>& candidates, std::size_t given) {
  RowSpace space(pose.freedoms(), pose.substep().bodies.coordinates().levers());
  const JointLocks locks = pose.locks();
  for (Eigen::Index r = 0; r < locks.gradients.rows(); ++r) {
    space.add(locks.gradients.row(r).transpose());
  }
  std::vector<MachineCoordinate> chosen;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (i >= given && space.is_full()) break;
    const bool more = space.add(measure(pose, candidates[i]).gradient);
    if (more || i < given) chosen.push_back(candidates[i]);
  }
  if (given == 0) std::stable_sort(chosen.begin(), chosen.end(), is_before);
  return chosen;
}

CoordinateBasis basis_of(MachinePose& pose, const std::vector<MachineCoordinate>& coordinates) {
  const JointLocks locks = pose.locks();
  const Eigen::Index rows = locks.gradients.rows();
  const auto n = static_cast<Eigen::Index>(coordinates.size());
  const int freedoms = pose.freedoms();
  CoordinateBasis basis;
  basis.gradients = MatrixX::Zero(n, freedoms);
  basis.turning = VectorX::Zero(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const PoseMeasure own = measure(pose, coordinates[static_cast<std::size_t>(i)]);
    basis.gradients.row(i) = own.gradient.transpose();
    basis.turning[i] = own.drift;
  }
  basis.motions = MatrixX::Zero(freedoms, n);
  basis.drift = VectorX::Zero(freedoms);
  if (freedoms == 0) return basis;
  MatrixX system(rows + n, freedoms);
  system << locks.gradients, basis.gradients;
  // Rates of the coordinates, and in the last column the effect of prescribed bodies.
  MatrixX wanted = MatrixX::Zero(rows + n, n + 1);
  wanted.block(rows, 0, n, n).setIdentity();
  wanted.block(0, n, rows, 1) = -locks.drift;
  wanted.block(rows, n, n, 1) = -basis.turning;
  const MatrixX solution = least_norm_solutions(system, wanted);
  basis.motions = solution.leftCols(n);
  basis.drift = solution.col(n);
  return basis;
}

}  // namespace sheave
