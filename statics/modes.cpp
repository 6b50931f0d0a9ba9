#include "statics/modes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/body_set.h"
#include "engine/index.h"
#include "statics/acting.h"
#include "statics/decompositions.h"
#include "statics/refined_rows.h"
#include "statics/relaxation.h"
#include "statics/state_space.h"
#include "statics/tangent.h"

namespace sheave {
namespace {

void describe_mode(const BodySet& bodies, const MatrixX& mass, Mode& mode) {
  const VectorX momentum = mass * mode.shape;
  for (const BodyFreedom& freedom : bodies.coordinates().movable()) {
    double share = 0.0;
    for (int k = 0; k < size_of(freedom.kind); ++k) {
      share += momentum[freedom.first - 1 + k] * mode.shape[freedom.first - 1 + k];
    }
    if (share <= mode.body_share) continue;
    mode.body_share = share;
    mode.body = freedom.body;
  }
}

/// Z^T D Z of a mode at its own angular frequency w [1/s].
double damping_of(const Modes& modes, Eigen::Index mode, double w, const Acting& acting,
                  const std::vector<Relaxation>& relaxations) {
  double damping = modes.damping(mode, mode);
  for (const Relaxation& one : relaxations) {
    const double slow = acting.rows.unknowns[static_cast<std::size_t>(one.unknown)].damping;
    damping += (one.damping_at(w) - slow) *
               acting.rows.actions.row(one.unknown).dot(modes.motions.col(mode)) *
               acting.rows.gradients.row(one.unknown).dot(modes.motions.col(mode));
  }
  return damping;
}

void find_poles(Modes& modes) {
  const Eigen::Index k = modes.motions.cols();
  if (k == 0) return;
  // Coordinates of drives have no poles of their own.
  const Eigen::Index driven = modes.driven_motions.cols();
  const Eigen::Index relaxing = modes.state_matrix.rows() - 2 * k - driven;
  const Eigen::Index last = 2 * k + driven;
  MatrixX own(2 * k + relaxing, 2 * k + relaxing);
  own << modes.state_matrix.topLeftCorner(2 * k, 2 * k),
      modes.state_matrix.block(0, last, 2 * k, relaxing),
      modes.state_matrix.block(last, 0, relaxing, 2 * k),
      modes.state_matrix.bottomRightCorner(relaxing, relaxing);
  modes.poles = eigenvalues_of(own);
  std::stable_sort(modes.poles.begin(), modes.poles.end(),
                   [](const auto& a, const auto& b) { return std::abs(a) < std::abs(b); });
}

/// Moves a displaced configuration until its rigid rows are met.
void meet_rows(Configuration& configuration, const std::vector<char>& acts, VectorX& displacement) {
  constexpr int rounds = 12;
  for (int round = 0; round < rounds; ++round) {
    configuration.place(displacement);
    const ConfigurationRows rows = configuration.rows();
    if (rows.unknowns.size() != acts.size()) return;
    std::vector<Eigen::Index> rigid;
    for (std::size_t g = 0; g < acts.size(); ++g) {
      const ForceUnknown& unknown = rows.unknowns[g];
      if (acts[g] != 0 && !unknown.damper && unknown.compliance == 0.0) {
        rigid.push_back(static_cast<Eigen::Index>(g));
      }
    }
    if (rigid.empty()) return;
    MatrixX gradients(static_cast<Eigen::Index>(rigid.size()), rows.gradients.cols());
    VectorX values(gradients.rows());
    for (Eigen::Index r = 0; r < gradients.rows(); ++r) {
      gradients.row(r) = rows.gradients.row(rigid[static_cast<std::size_t>(r)]);
      values[r] = rows.unknowns[static_cast<std::size_t>(rigid[static_cast<std::size_t>(r)])].value;
    }
    const VectorX back = least_norm_solution(gradients, values);
    displacement -= back;
    if (back.norm() < 1e-13) break;
  }
  configuration.place(displacement);
}

}  // namespace

Modes find_modes(Simulation& simulation, const std::vector<ModeInput>& inputs) {
  const State state = remembered_state(simulation);
  Configuration configuration(simulation, state, 1.0);
  const double size = simulation.world.bodies().scale();
  Acting acting = find_acting(configuration, size);
  configuration.assume(configuration.forces_of(acting.rows, acting.unknowns));
  acting = find_acting(configuration, size);
  refine_rows(configuration, acting.unknowns, size, acting.rows);
  const ForceTurn turn = turn_of_forces(configuration, acting.unknowns, size);
  const Tangent tangent = make_tangent(configuration, acting.rows, turn, acting.acts);
  Modes modes;
  modes.redundant = tangent.redundant();
  modes.error = tangent.difference_error;
  modes.friction_slides = acting.slides;
  modes.forces = configuration.forces_of(acting.rows, acting.unknowns);
  const VectorX loads = tangent.motions.transpose() * acting.rows.loads;
  const VectorX left = tangent.motions.transpose() *
                       (acting.rows.loads + acting.rows.actions.transpose() * acting.unknowns);
  // Relative to all forces, not only to their components along the motions.
  VectorX whole = acting.rows.loads.cwiseAbs() +
                  acting.rows.actions.cwiseAbs().transpose() * acting.unknowns.cwiseAbs();
  for (Eigen::Index i = 0; i < whole.size(); ++i) whole[i] /= std::sqrt(tangent.mass(i, i));
  if (left.size() > 0 && whole.norm() > 0.0) modes.imbalance = left.norm() / whole.norm();

  const std::vector<Relaxation> relaxations = relaxations_of(acting);
  const Eigen::Index k = tangent.motions.cols();
  const SymmetricEigen own = symmetric_eigen(tangent.reduced_stiffness());
  // The coordinates are those of the modes: M is 1 and K is diagonal.
  modes.motions = tangent.motions;
  if (k > 0) modes.motions = tangent.motions * own.vectors;
  for (Eigen::Index i = 0; i < k; ++i) {
    VectorX shape = modes.motions.col(i);
    Eigen::Index largest = 0;
    shape.cwiseAbs().maxCoeff(&largest);
    if (shape[largest] < 0.0) modes.motions.col(i) *= -1.0;
  }
  modes.mass = modes.motions.transpose() * tangent.mass * modes.motions;
  modes.damping = modes.motions.transpose() * tangent.damping * modes.motions;
  modes.stiffness = modes.motions.transpose() * tangent.stiffness * modes.motions;
  for (Eigen::Index i = 0; i < k; ++i) {
    Mode mode;
    mode.eigenvalue = own.values[i];
    if (std::abs(mode.eigenvalue) <= tangent.rounding) mode.eigenvalue = 0.0;
    if (mode.eigenvalue > 0.0) {
      const double rate = std::sqrt(mode.eigenvalue);
      mode.frequency = rate / (2.0 * pi);
      mode.damping_ratio = damping_of(modes, i, rate, acting, relaxations) / (2.0 * rate);
    }
    mode.shape = modes.motions.col(i);
    describe_mode(simulation.world.bodies(), tangent.mass, mode);
    modes.modes.push_back(std::move(mode));
  }
  fill_state_space(configuration, simulation.world, tangent, acting, relaxations, inputs, modes);
  find_poles(modes);
  return modes;
}

std::vector<std::string> freedom_names(const Simulation& simulation) {
  const BodySet& bodies = simulation.world.bodies();
  std::vector<std::string> names(static_cast<std::size_t>(bodies.coordinates().count() - 1));
  for (const BodyFreedom& freedom : bodies.coordinates().movable()) {
    const std::string& body = bodies.name(freedom.body);
    const auto name = [&](int k) -> std::string {
      switch (freedom.kind) {
        case Freedom::line:
          return ".along";
        case Freedom::angle:
          return ".turn";
        case Freedom::plane:
          return k == 2 ? ".turn" : k == 0 ? ".along" : ".across";
        case Freedom::none:
        case Freedom::turn:
        case Freedom::space:
          break;
      }
      constexpr std::array<const char*, 6> parts{".x", ".y", ".z", ".turn_x", ".turn_y", ".turn_z"};
      return parts[at(k)];
    };
    for (int k = 0; k < size_of(freedom.kind); ++k) {
      names[at(freedom.first - 1 + k)] = body + name(k);
    }
  }
  return names;
}

std::string largest_motion(const Simulation& simulation, const Mode& mode) {
  if (mode.body < 0) return "";
  const BodyFreedom& freedom = simulation.world.bodies().coordinates()[mode.body];
  const auto part = [&](int k) { return mode.shape[freedom.first - 1 + k]; };
  const auto parts = [&](int k) { return Vector3(part(k), part(k + 1), part(k + 2)); };
  Vector3 way = Vector3::Zero();
  Vector3 turn = Vector3::Zero();  // about axes of the world; for a planar body only its magnitude
  switch (freedom.kind) {
    case Freedom::line:
      way = part(0) * freedom.along;
      break;
    case Freedom::plane:
      way = part(0) * freedom.along + part(1) * freedom.across;
      turn.z() = part(2);
      break;
    case Freedom::space:
      way = parts(0);
      turn = parts(3);
      break;
    case Freedom::none:
    case Freedom::turn:
    case Freedom::angle:
      return "turn";
  }
  constexpr std::array<const char*, 3> axes{"x", "y", "z"};
  constexpr double stays = 1e-6;  // above the rounding of a shape [m per rad]
  const bool moves = way.norm() > stays * turn.norm();
  if (!moves && freedom.kind == Freedom::plane) return "turn";
  Eigen::Index largest = 0;
  (moves ? way : turn).cwiseAbs().maxCoeff(&largest);
  return (moves ? "" : "turn_") + std::string(axes[at(static_cast<int>(largest))]);
}

State displaced_state(Simulation& simulation, const Modes& modes, const ModalVector& shape,
                      double amplitude) {
  const State state = remembered_state(simulation);
  Configuration configuration(simulation, state, 1.0);
  const Acting acting = find_acting(configuration, simulation.world.bodies().scale());
  VectorX displacement = amplitude * shape;
  meet_rows(configuration, acting.acts, displacement);
  return configuration.finish(modes.forces);
}

}  // namespace sheave
