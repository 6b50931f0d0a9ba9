#include "statics/modes.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>

#include "engine/body_set.h"
#include "engine/index.h"
#include "statics/tangent.h"

namespace sheave {
namespace {

/// What acts at the pose: rows that are closed or have a force.
struct Acting {
  ConfigurationRows rows;
  VectorX unknowns;
  std::vector<char> acts;
  bool slides = false;
};

/// Forces of rigid rows that balance loads as well as any can, in turns with which rows act.
Acting find_acting(Configuration& configuration, double size) {
  constexpr double closed = 1e-8;
  Acting acting{configuration.rows(), {}, {}, false};
  const auto count = static_cast<Eigen::Index>(acting.rows.unknowns.size());
  acting.unknowns = VectorX::Zero(count);
  acting.acts.assign(acting.rows.unknowns.size(), 0);
  VectorX sum = acting.rows.loads;
  std::vector<Eigen::Index> rigid;
  for (Eigen::Index i = 0; i < count; ++i) {
    const ForceUnknown& unknown = acting.rows.unknowns[static_cast<std::size_t>(i)];
    if (unknown.damper) continue;
    double force = 0.0;
    bool acts = false;
    if (unknown.given()) {
      force = unknown.lower;
    } else if (unknown.compliance > 0.0) {
      force = std::clamp(-unknown.value / unknown.compliance, unknown.lower, unknown.upper);
      acts = force != 0.0 || unknown.bilateral();
    } else {
      acts = unknown.lower == 0.0   ? unknown.value <= closed * size
             : unknown.upper == 0.0 ? unknown.value >= -closed * size
                                    : true;
      if (acts) rigid.push_back(i);
    }
    acting.unknowns[i] = force;
    acting.acts[static_cast<std::size_t>(i)] = acts ? 1 : 0;
    if (force != 0.0) sum += force * acting.rows.actions.row(i).transpose();
  }
  const MatrixX mass = configuration.mass();
  // Rows that would push where they can only pull are let go one by one.
  while (!rigid.empty()) {
    MatrixX columns(sum.size(), static_cast<Eigen::Index>(rigid.size()));
    VectorX weights(sum.size());
    for (Eigen::Index k = 0; k < sum.size(); ++k) weights[k] = 1.0 / std::sqrt(mass(k, k));
    VectorX norms(columns.cols());
    for (Eigen::Index r = 0; r < columns.cols(); ++r) {
      columns.col(r) = weights.cwiseProduct(
          acting.rows.actions.row(rigid[static_cast<std::size_t>(r)]).transpose());
      norms[r] = std::max(columns.col(r).norm(), 1e-300);
      columns.col(r) /= norms[r];
    }
    const VectorX solution =
        Eigen::CompleteOrthogonalDecomposition<MatrixX>(columns).solve(-weights.cwiseProduct(sum));
    const double largest = solution.cwiseAbs().maxCoeff();
    Eigen::Index worst = -1;
    double most = 1e-9 * largest;
    for (Eigen::Index r = 0; r < solution.size(); ++r) {
      const Eigen::Index i = rigid[static_cast<std::size_t>(r)];
      const ForceUnknown& unknown = acting.rows.unknowns[static_cast<std::size_t>(i)];
      acting.unknowns[i] = solution[r] / norms[r];
      const double beyond = unknown.lower == 0.0   ? -solution[r]
                            : unknown.upper == 0.0 ? solution[r]
                                                   : 0.0;
      if (beyond <= most) continue;
      most = beyond;
      worst = r;
    }
    if (worst < 0) break;
    const Eigen::Index gone = rigid[static_cast<std::size_t>(worst)];
    acting.acts[static_cast<std::size_t>(gone)] = 0;
    acting.unknowns[gone] = 0.0;
    rigid.erase(rigid.begin() + worst);
  }
  for (Eigen::Index i = 0; i < count; ++i) {
    const ForceUnknown& unknown = acting.rows.unknowns[static_cast<std::size_t>(i)];
    if (unknown.lower == 0.0) acting.unknowns[i] = std::max(acting.unknowns[i], 0.0);
    if (unknown.upper == 0.0) acting.unknowns[i] = std::min(acting.unknowns[i], 0.0);
  }
  acting.slides = acting.rows.weighted;
  return acting;
}

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

void find_poles(Modes& modes) {
  const Eigen::Index k = modes.motions.cols();
  if (k == 0) return;
  const Eigen::EigenSolver<MatrixX> solver(modes.state_matrix.topLeftCorner(2 * k, 2 * k), false);
  for (const std::complex<double>& pole : solver.eigenvalues()) modes.poles.push_back(pole);
  std::stable_sort(modes.poles.begin(), modes.poles.end(),
                   [](const auto& a, const auto& b) { return std::abs(a) < std::abs(b); });
}

/// M-orthogonal displacement that rigid rows make of a unit of a drive's angle.
VectorX driven_motion(const Tangent& tangent, const ConfigurationRows& rows,
                      const std::vector<char>& acts, const VectorX& by_drive) {
  VectorX wanted(tangent.constraints.rows());
  Eigen::Index r = 0;
  for (std::size_t g = 0; g < acts.size(); ++g) {
    const auto i = static_cast<Eigen::Index>(g);
    const ForceUnknown& unknown = rows.unknowns[g];
    if (acts[g] == 0 || unknown.damper || unknown.compliance > 0.0) continue;
    if (rows.gradients.row(i).norm() > 0.0) wanted[r++] = -by_drive[i];
  }
  if (wanted.size() == 0) return VectorX::Zero(tangent.mass.rows());
  const MatrixX inverse = tangent.mass.inverse();
  const MatrixX along = inverse * tangent.constraints.transpose();
  const MatrixX yield = tangent.constraints * along;
  return along * Eigen::CompleteOrthogonalDecomposition<MatrixX>(yield).solve(wanted);
}

void fill_state_space(Configuration& configuration, const Tangent& tangent, const Acting& acting,
                      const std::vector<ModeInput>& inputs, Modes& modes) {
  const Eigen::Index k = modes.motions.cols();
  Eigen::Index drives = 0;
  for (const ModeInput& input : inputs) drives += input.kind == ModeInput::Kind::drive ? 1 : 0;
  modes.state_matrix = MatrixX::Zero(2 * k + drives, 2 * k + drives);
  modes.input_matrix = MatrixX::Zero(2 * k + drives, static_cast<Eigen::Index>(inputs.size()));
  modes.state_matrix.block(0, k, k, k).setIdentity();
  modes.state_matrix.block(k, 0, k, k) = -modes.stiffness;
  modes.state_matrix.block(k, k, k, k) = -modes.damping;
  Eigen::Index place = 2 * k;
  for (std::size_t j = 0; j < inputs.size(); ++j) {
    const auto column = static_cast<Eigen::Index>(j);
    const ModeInput& input = inputs[j];
    if (input.kind != ModeInput::Kind::drive) {
      const bool force = input.kind == ModeInput::Kind::force;
      const Vector3 zero = Vector3::Zero();
      modes.input_matrix.block(k, column, k, 1) =
          modes.motions.transpose() *
          configuration.along(input.body, force ? input.axis : zero, force ? zero : input.axis);
      continue;
    }
    const VectorX by_drive = configuration.by_drive(input.body);
    const VectorX led = driven_motion(tangent, acting.rows, acting.acts, by_drive);
    VectorX pull = tangent.stiffness * led;
    VectorX drag = tangent.damping * led;
    for (std::size_t g = 0; g < acting.acts.size(); ++g) {
      const auto i = static_cast<Eigen::Index>(g);
      const ForceUnknown& unknown = acting.rows.unknowns[g];
      const VectorX action = acting.rows.actions.row(i).transpose();
      if (unknown.damper || (acting.acts[g] != 0 && unknown.compliance > 0.0)) {
        drag += unknown.damping * by_drive[i] * action;
      }
      if (!unknown.damper && acting.acts[g] != 0 && unknown.compliance > 0.0) {
        pull += by_drive[i] / unknown.compliance * action;
      }
    }
    modes.state_matrix.block(k, place, k, 1) = -modes.motions.transpose() * pull;
    modes.input_matrix.block(k, column, k, 1) = -modes.motions.transpose() * drag;
    modes.input_matrix(place++, column) = 1.0;
  }
}

/// Moves a displaced configuration to where its rigid rows are met.
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
    const VectorX back = Eigen::CompleteOrthogonalDecomposition<MatrixX>(gradients).solve(values);
    displacement -= back;
    if (back.norm() < 1e-13) break;
  }
  configuration.place(displacement);
}

}  // namespace

Modes find_modes(Simulation& simulation, const std::vector<ModeInput>& inputs) {
  const State state = simulation.world.state();
  Configuration configuration(simulation, state, 1.0);
  const Acting acting = find_acting(configuration, simulation.world.bodies().scale());
  const ForceTurn turn = turn_of_forces(configuration, acting.unknowns);
  const Tangent tangent = make_tangent(configuration, acting.rows, turn, acting.acts);
  Modes modes;
  modes.redundant = tangent.redundant();
  modes.error = tangent.difference_error;
  modes.friction_slides = acting.slides;
  modes.forces = configuration.forces_of(acting.rows, acting.unknowns);
  const VectorX loads = tangent.motions.transpose() * acting.rows.loads;
  const VectorX left = tangent.motions.transpose() *
                       (acting.rows.loads + acting.rows.actions.transpose() * acting.unknowns);
  // Beside all that acts, not beside what of it is along the motions.
  VectorX whole = acting.rows.loads.cwiseAbs() +
                  acting.rows.actions.cwiseAbs().transpose() * acting.unknowns.cwiseAbs();
  for (Eigen::Index i = 0; i < whole.size(); ++i) whole[i] /= std::sqrt(tangent.mass(i, i));
  if (left.size() > 0 && whole.norm() > 0.0) modes.imbalance = left.norm() / whole.norm();

  const Eigen::SelfAdjointEigenSolver<MatrixX> solver(tangent.reduced_stiffness());
  const Eigen::Index k = tangent.motions.cols();
  // Coordinates are those of the modes themselves: M is 1 and K diagonal.
  modes.motions = tangent.motions * solver.eigenvectors();
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
    mode.eigenvalue = solver.eigenvalues()[i];
    if (std::abs(mode.eigenvalue) <= tangent.rounding) mode.eigenvalue = 0.0;
    if (mode.eigenvalue > 0.0) {
      const double rate = std::sqrt(mode.eigenvalue);
      mode.frequency = rate / (2.0 * pi);
      mode.damping_ratio = modes.damping(i, i) / (2.0 * rate);
    }
    mode.shape = modes.motions.col(i);
    describe_mode(simulation.world.bodies(), tangent.mass, mode);
    modes.modes.push_back(std::move(mode));
  }
  fill_state_space(configuration, tangent, acting, inputs, modes);
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

State displaced_state(Simulation& simulation, const Modes& modes, const Eigen::VectorXd& shape,
                      double amplitude) {
  const State state = simulation.world.state();
  Configuration configuration(simulation, state, 1.0);
  const Acting acting = find_acting(configuration, simulation.world.bodies().scale());
  VectorX displacement = amplitude * shape;
  meet_rows(configuration, acting.acts, displacement);
  return configuration.finish(modes.forces);
}

State perturbed_state(Simulation& simulation, const Modes& modes,
                      const Eigen::VectorXd& displacement, const Eigen::VectorXd& velocity) {
  const State state = simulation.world.state();
  Configuration configuration(simulation, state, 1.0);
  const Acting acting = find_acting(configuration, simulation.world.bodies().scale());
  const ForceTurn turn = turn_of_forces(configuration, acting.unknowns);
  const Tangent tangent = make_tangent(configuration, acting.rows, turn, acting.acts);
  const VectorX q = modes.motions * displacement;
  const VectorX rate = modes.motions * velocity;
  const VectorX acceleration =
      modes.motions * (-modes.stiffness * displacement - modes.damping * velocity);
  VectorX unknowns = acting.unknowns;
  // What rigid rows do follows from the motion that they leave.
  const VectorX missing =
      tangent.mass * acceleration + tangent.damping * rate + tangent.stiffness * q;
  std::vector<Eigen::Index> rigid;
  for (std::size_t g = 0; g < acting.acts.size(); ++g) {
    const auto i = static_cast<Eigen::Index>(g);
    const ForceUnknown& unknown = acting.rows.unknowns[g];
    if (acting.acts[g] == 0 || unknown.damper) continue;
    if (unknown.compliance > 0.0) {
      const VectorX gradient = (acting.rows.gradients.row(i) + turn.yields.row(i)).transpose();
      unknowns[i] -= gradient.dot(q) / unknown.compliance +
                     unknown.damping * acting.rows.gradients.row(i).dot(rate);
    } else {
      rigid.push_back(i);
    }
  }
  if (!rigid.empty()) {
    MatrixX columns(missing.size(), static_cast<Eigen::Index>(rigid.size()));
    for (Eigen::Index r = 0; r < columns.cols(); ++r) {
      columns.col(r) = acting.rows.actions.row(rigid[static_cast<std::size_t>(r)]).transpose();
    }
    const VectorX more = Eigen::CompleteOrthogonalDecomposition<MatrixX>(columns).solve(missing);
    for (Eigen::Index r = 0; r < more.size(); ++r) {
      unknowns[rigid[static_cast<std::size_t>(r)]] += more[r];
    }
  }
  configuration.place(q);
  State result = configuration.finish(configuration.forces_of(acting.rows, unknowns));
  configuration.set_velocities(rate, result);
  return result;
}

}  // namespace sheave
