#include "statics/state_space.h"

#include "engine/body_set.h"
#include "engine/index.h"
#include "engine/joint.h"
#include "engine/joint_feature.h"
#include "statics/decompositions.h"
#include "statics/refined_rows.h"

namespace sheave {
namespace {

/// Whether the row is rigid and active.
bool holds_rigidly(const Acting& acting, std::size_t g) {
  const ForceUnknown& unknown = acting.rows.unknowns[g];
  return acting.acts[g] != 0 && !unknown.damper && unknown.compliance == 0.0;
}

/// M-orthogonal displacement that rigid rows cause per unit of a drive's motion.
VectorX driven_motion(const Tangent& tangent, const Acting& acting, const VectorX& by_drive) {
  VectorX wanted(tangent.constraints.rows());
  Eigen::Index r = 0;
  for (std::size_t g = 0; g < acting.acts.size(); ++g) {
    const auto i = static_cast<Eigen::Index>(g);
    if (!holds_rigidly(acting, g)) continue;
    if (acting.rows.gradients.row(i).norm() > 0.0) wanted[r++] = -by_drive[i];
  }
  if (wanted.size() == 0) return VectorX::Zero(tangent.mass.rows());
  const MatrixX along = inverse_of(tangent.mass) * tangent.constraints.transpose();
  const MatrixX yield = tangent.constraints * along;
  return along * least_norm_solution(yield, wanted);
}

/// The motion of a drive, as a state d with d' = u.
class DrivenState {
 public:
  DrivenState(const Tangent& tangent, const Acting& acting, VectorX by_drive)
      : by_drive_(std::move(by_drive)), motion_(driven_motion(tangent, acting, by_drive_)) {
    pull_ = tangent.stiffness * motion_;
    drag_ = tangent.damping * motion_;
    for (std::size_t g = 0; g < acting.acts.size(); ++g) {
      const auto i = static_cast<Eigen::Index>(g);
      const ForceUnknown& unknown = acting.rows.unknowns[g];
      const VectorX action = acting.rows.actions.row(i).transpose();
      const bool elastic = !unknown.damper && acting.acts[g] != 0 && unknown.compliance > 0.0;
      if (unknown.damper || elastic) drag_ += unknown.damping * by_drive_[i] * action;
      if (elastic) pull_ += by_drive_[i] / unknown.compliance * action;
    }
  }

  /// Writes it as the state with index `place` and the input with index `column`.
  void write(Eigen::Index place, Eigen::Index column, Modes& modes) const {
    const Eigen::Index k = modes.motions.cols();
    modes.state_matrix.block(k, place, k, 1) = -modes.motions.transpose() * pull_;
    modes.input_matrix.block(k, column, k, 1) = -modes.motions.transpose() * drag_;
    modes.input_matrix(place, column) = 1.0;
    modes.driven_motions.col(place - 2 * k) = motion_;
    modes.driven_rows.col(place - 2 * k) = by_drive_;
  }

 private:
  VectorX by_drive_;
  VectorX motion_;
  VectorX pull_;  // forces that balance a unit of d
  VectorX drag_;  // forces that balance a unit of its speed
};

struct DriveRow {
  std::size_t feature = 0;
  int multiplier = -1;  // -1: no drive
};

/// Adds the coordinates e of spans that relax, as the last states. The matrices have their slow
/// spring and damper already.
class RelaxingStates {
 public:
  RelaxingStates(const Acting& acting, Modes& modes)
      : acting_(acting),
        modes_(modes),
        k_(modes.motions.cols()),
        driven_(modes.driven_motions.cols()) {}

  void add(const Relaxation& relaxation) {
    const ForceUnknown& unknown =
        acting_.rows.unknowns[static_cast<std::size_t>(relaxation.unknown)];
    const VectorX action =
        modes_.motions.transpose() * acting_.rows.actions.row(relaxation.unknown).transpose();
    const double whole = relaxation.rates();
    const double spring = 1.0 / (whole * relaxation.last_time());
    // T of a relaxation beyond that of its slow spring and damper.
    find_stretch(relaxation.unknown);
    modes_.state_matrix.middleRows(k_, k_) +=
        action *
        ((spring - 1.0 / unknown.compliance) * stretch_ + (1.0 / whole - unknown.damping) * rate_);
    modes_.input_matrix.middleRows(k_, k_) += action * ((1.0 / whole - unknown.damping) * pushed_);
    const Eigen::Index first = 2 * k_ + driven_ + relaxation.first;
    for (Eigen::Index g = 0; g < relaxation.count(); ++g) {
      const Relaxation::Group& group = relaxation.groups[static_cast<std::size_t>(g)];
      const double share = group.rate / whole;
      const double pull = relaxation.pull(g);
      modes_.state_matrix.col(first + g).segment(k_, k_) += pull / whole * action;
      modes_.state_matrix.row(first + g) += group.rate * spring * stretch_ + share * rate_;
      modes_.input_matrix.row(first + g) += share * pushed_;
      modes_.state_matrix(first + g, first + g) -= 1.0 / group.time;
      for (Eigen::Index j = 0; j < relaxation.count(); ++j) {
        modes_.state_matrix(first + g, first + j) += share * relaxation.pull(j);
      }
    }
  }

 private:
  /// E = stretch_ x, E' = rate_ x + pushed_ u.
  void find_stretch(Eigen::Index unknown) {
    const Eigen::RowVectorXd gradient = acting_.rows.gradients.row(unknown);
    const Eigen::RowVectorXd along = gradient * modes_.motions;
    stretch_ = rate_ = Eigen::RowVectorXd::Zero(modes_.state_matrix.cols());
    stretch_.head(k_) = rate_.segment(k_, k_) = -along;
    const Eigen::RowVectorXd by_drives =
        gradient * modes_.driven_motions + modes_.driven_rows.row(unknown);
    stretch_.segment(2 * k_, driven_) = -by_drives;
    // The derivative of driven coordinates is u.
    pushed_ = -by_drives * modes_.input_matrix.middleRows(2 * k_, driven_);
  }

  const Acting& acting_;
  Modes& modes_;
  Eigen::Index k_;
  Eigen::Index driven_;
  Eigen::RowVectorXd stretch_;
  Eigen::RowVectorXd rate_;
  Eigen::RowVectorXd pushed_;
};

/// The row of the drive of a joint's coordinate.
DriveRow joint_drive_row(const World& world, int joint, int coordinate) {
  const auto& joints = world.model().joints;
  const std::string_view type = joints[at(joint)]->type();
  // A feature has the joints of its type in the order of the model.
  int index = 0;
  for (int j = 0; j < joint; ++j) index += joints[at(j)]->type() == type ? 1 : 0;
  const auto features = world.features();
  for (std::size_t f = 0; f < features.size(); ++f) {
    const auto* batch = dynamic_cast<const JointFeature*>(features[f].get());
    if (batch != nullptr && batch->type() == type) return {f, batch->drive_row(index, coordinate)};
  }
  return {};
}

/// The unknown of that row; -1: none.
Eigen::Index drive_unknown(const World& world, const ConfigurationRows& rows,
                           const ModeInput& input) {
  const DriveRow drive = joint_drive_row(world, input.joint, input.coordinate);
  for (std::size_t g = 0; drive.multiplier >= 0 && g < rows.unknowns.size(); ++g) {
    const ForceUnknown& unknown = rows.unknowns[g];
    if (unknown.feature == drive.feature && unknown.parts.front().index == drive.multiplier) {
      return static_cast<Eigen::Index>(g);
    }
  }
  return -1;
}

/// Effect of an input: a force along the degrees of freedom, or a motion.
struct InputEffect {
  VectorX force;     ///< empty if the input is a motion
  VectorX by_drive;  ///< change of each row's C per unit of the motion
};

InputEffect effect_of(Configuration& configuration, const World& world, const Acting& acting,
                      const ModeInput& input) {
  using Kind = ModeInput::Kind;
  const Vector3 zero = Vector3::Zero();
  const auto count = static_cast<Eigen::Index>(acting.rows.unknowns.size());
  InputEffect effect;
  switch (input.kind) {
    case Kind::force:
      effect.force = configuration.along(input.body, input.axis, zero);
      break;
    case Kind::torque:
      effect.force = configuration.along(input.body, zero, input.axis);
      break;
    case Kind::drive:
      effect.by_drive = configuration.by_drive(input.body);
      break;
    case Kind::joint_drive: {
      // C = c - d, or a given force.
      const Eigen::Index row = drive_unknown(world, acting.rows, input);
      effect.by_drive = VectorX::Zero(count);
      if (row < 0) break;
      if (acting.rows.unknowns[static_cast<std::size_t>(row)].given()) {
        effect.force = acting.rows.actions.row(row).transpose();
      } else {
        effect.by_drive[row] = -1.0;
      }
      break;
    }
  }
  return effect;
}

/// A small motion from the pose of a linearised machine.
struct SmallMotion {
  VectorX q;         ///< along degrees of freedom
  VectorX rate;      ///< of q
  VectorX by_drive;  ///< change of the rows' values by drives
  VectorX relaxed;   ///< coordinates e of spans that relax
};

/// Changes the forces of spans that relax from those of their slow springs and dampers, and the
/// forces along the degrees of freedom that rigid rows have to give.
void add_relaxed(const Acting& acting, const SmallMotion& motion, VectorX& unknowns,
                 VectorX& missing) {
  const std::vector<Relaxation> relaxations = relaxations_of(acting);
  if (count_of(relaxations) != motion.relaxed.size()) return;
  for (const Relaxation& relaxation : relaxations) {
    const Eigen::Index i = relaxation.unknown;
    const ForceUnknown& unknown = acting.rows.unknowns[static_cast<std::size_t>(i)];
    const double stretch = -acting.rows.gradients.row(i).dot(motion.q) - motion.by_drive[i];
    const double rate = -acting.rows.gradients.row(i).dot(motion.rate);
    const double slow = stretch / unknown.compliance + unknown.damping * rate;
    const double more = relaxation.tension(stretch, rate, motion.relaxed) - slow;
    unknowns[i] += more;
    missing -= more * acting.rows.actions.row(i).transpose();
  }
}

}  // namespace

bool has_joint_drive(const World& world, int joint, int coordinate) {
  return joint_drive_row(world, joint, coordinate).multiplier >= 0;
}

void fill_state_space(Configuration& configuration, const World& world, const Tangent& tangent,
                      const Acting& acting, const std::vector<Relaxation>& relaxations,
                      const std::vector<ModeInput>& inputs, Modes& modes) {
  std::vector<InputEffect> effects;
  Eigen::Index driven = 0;
  for (const ModeInput& input : inputs) {
    effects.push_back(effect_of(configuration, world, acting, input));
    if (effects.back().force.size() == 0) ++driven;
  }
  const Eigen::Index k = modes.motions.cols();
  const auto columns = static_cast<Eigen::Index>(inputs.size());
  const Eigen::Index states = 2 * k + driven + count_of(relaxations);
  modes.state_matrix = MatrixX::Zero(states, states);
  modes.input_matrix = MatrixX::Zero(states, columns);
  modes.driven_motions = MatrixX::Zero(modes.motions.rows(), driven);
  modes.driven_rows = MatrixX::Zero(acting.unknowns.size(), driven);
  modes.state_matrix.block(0, k, k, k).setIdentity();
  modes.state_matrix.block(k, 0, k, k) = -modes.stiffness;
  modes.state_matrix.block(k, k, k, k) = -modes.damping;
  Eigen::Index place = 2 * k;
  for (Eigen::Index j = 0; j < columns; ++j) {
    const InputEffect& effect = effects[static_cast<std::size_t>(j)];
    if (effect.force.size() > 0) {
      modes.input_matrix.block(k, j, k, 1) = modes.motions.transpose() * effect.force;
    } else {
      DrivenState(tangent, acting, effect.by_drive).write(place++, j, modes);
    }
  }
  for (const Relaxation& relaxation : relaxations) RelaxingStates(acting, modes).add(relaxation);
}

State perturbed_state(Simulation& simulation, const Modes& modes, const ModalVector& x) {
  const State state = remembered_state(simulation);
  Configuration configuration(simulation, state, 1.0);
  const double size = simulation.world.bodies().scale();
  Acting acting = find_acting(configuration, size);
  refine_rows(configuration, acting.unknowns, size, acting.rows);
  const ForceTurn turn = turn_of_forces(configuration, acting.unknowns, size);
  const Tangent tangent = make_tangent(configuration, acting.rows, turn, acting.acts);
  const Eigen::Index k = modes.motions.cols();
  const VectorX driven = x.segment(2 * k, modes.driven_motions.cols());
  const VectorX q = modes.motions * x.head(k) + modes.driven_motions * driven;
  const VectorX by_drive = modes.driven_rows * driven;
  const VectorX rate = modes.motions * x.segment(k, k);
  const VectorX acceleration = modes.motions * (modes.state_matrix.middleRows(k, k) * x);
  VectorX unknowns = acting.unknowns;
  // Forces of rigid rows follow from the motion that they allow.
  VectorX missing = tangent.mass * acceleration + tangent.damping * rate + tangent.stiffness * q;
  std::vector<Eigen::Index> rigid;
  for (std::size_t g = 0; g < acting.acts.size(); ++g) {
    const auto i = static_cast<Eigen::Index>(g);
    const ForceUnknown& unknown = acting.rows.unknowns[g];
    if (holds_rigidly(acting, g)) rigid.push_back(i);
    if (acting.acts[g] == 0 || unknown.damper || unknown.compliance == 0.0) continue;
    unknowns[i] -= (acting.rows.gradients.row(i).dot(q) + by_drive[i]) / unknown.compliance +
                   unknown.damping * acting.rows.gradients.row(i).dot(rate);
    missing += by_drive[i] / unknown.compliance * acting.rows.actions.row(i).transpose();
  }
  add_relaxed(acting, {q, rate, by_drive, x.tail(x.size() - 2 * k - driven.size())}, unknowns,
              missing);
  if (!rigid.empty()) {
    MatrixX columns(missing.size(), static_cast<Eigen::Index>(rigid.size()));
    for (Eigen::Index r = 0; r < columns.cols(); ++r) {
      columns.col(r) = acting.rows.actions.row(rigid[static_cast<std::size_t>(r)]).transpose();
    }
    const VectorX more = least_norm_solution(columns, missing);
    for (Eigen::Index r = 0; r < more.size(); ++r) {
      unknowns[rigid[static_cast<std::size_t>(r)]] += more[r];
    }
  }
  configuration.place(q);
  State result = configuration.finish(configuration.forces_of(acting.rows, unknowns));
  configuration.set_velocities(rate, result);
  configuration.set_rope_forces(acceleration, result);
  return result;
}

}  // namespace sheave
