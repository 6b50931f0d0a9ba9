// MuJoCo documents both numbers. acc0 is the norm of the accelerations that a unit force of the
// actuator causes in the pose of the text. For lengthrange the model moves without gravity, springs,
// dampers and dry friction; a force of the actuator, scaled so that the accelerations without
// constraints have a given norm, draws it to its shortest and to its longest length, while all
// velocities decay; the extremes in the last seconds are the range.
//
// The limits of joints are MuJoCo's soft ones with their default solref and solimp, because the
// lengths at rest include how far they give way. Dampers have no force, but MuJoCo's Euler step is
// implicit in them and has the inertia M + h D. This inertia decides where joints stop that the
// muscle does not move.

#include "scenes/import/mjcf/muscle_range.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include "engine/index.h"
#include "engine/math/portable.h"
#include "engine/number_text.h"
#include "scenes/import/mjcf/joint_motion.h"

namespace sheave::import::mjcf {
namespace {

// Products in all factorisations, above which a model asks for too much: some seconds.
constexpr double most_work = 4e9;
constexpr double least_norm = 1e-15;

/// A joint at one end of its range.
struct Stop {
  int velocity = 0;
  double sense = 1.0;  ///< 1: the lower end, -1: the upper one
  double depth = 0.0;  ///< beyond the end [m or rad], > 0
};

/// MuJoCo's soft constraint with default settings: reference acceleration and softness.
struct SoftLimit {
  double stiffness = 0.0;  ///< [1/s2]
  double damping = 0.0;    ///< [1/s]
  double give = 0.0;       ///< regularisation over the inverse inertia

  SoftLimit(double depth, double step) {
    constexpr double least = 0.9;
    constexpr double most = 0.95;
    constexpr double width = 0.001;
    const double part = std::min(depth / width, 1.0);
    const double rise = part <= 0.5 ? 2.0 * part * part : 1.0 - 2.0 * (1.0 - part) * (1.0 - part);
    const double impedance = least + rise * (most - least);
    const double time = std::max(0.02, 2.0 * step);
    stiffness = impedance / (most * most * time * time);
    damping = 2.0 / (most * time);
    give = (1.0 - impedance) / impedance;
  }
};

/// The motion by which a muscle finds its range.
class RangeSearch {
 public:
  RangeSearch(const Model& model, const Tendon& tendon, double gear)
      : model_(model), tendon_(tendon), gear_(gear), settings_(model.compiler.length_range) {}

  /// Looks at the pose of the text. Empty, or why neither number can be had.
  std::string begin() {
    if (model_.velocity_count == 0) return "the model has no joints";
    const Pose pose = pose_of(model_, reference_positions(model_), {});
    const std::optional<TendonPull> pull = tendon_pull(model_, pose, tendon_);
    if (!pull) return "its tendon has a side site within a geom";
    const JointMotion motion(model_, pose);
    const Eigen::LLT<JointMatrix> factor(motion.mass_matrix());
    if (factor.info() != Eigen::Success) return "a joint of the model moves no mass";
    acceleration_ = factor.solve(gear_ * motion.arms(*pull)).norm();
    const auto count = static_cast<Eigen::Index>(model_.velocity_count);
    damping_ = JointVector::Zero(count);
    for (const Joint& joint : model_.joints) {
      damping_.segment(joint.qvel, joint.velocity_count()).setConstant(joint.damping);
    }
    give_ = factor.solve(JointMatrix::Identity(count, count)).diagonal();
    if (!(acceleration_ > 1e-9)) return "no joint moves it in the pose of the text";
    return {};
  }

  /// MuJoCo's acc0.
  [[nodiscard]] double acceleration() const { return acceleration_; }

  /// Why there is no range; empty: `range` has it.
  std::string find(std::array<double, 2>& range) {
    std::array<double, 2> spread{};
    for (const std::size_t side : {0U, 1U}) {
      if (!move(side == 0 ? -1.0 : 1.0)) return "the motion to the ends of its range diverges";
      range[side] = side == 0 ? shortest_ : longest_;
      spread[side] = longest_ - shortest_;
    }
    const double width = range[1] - range[0];
    if (!(width > 0.0)) return "the motion of the model leaves its length as it is";
    if (std::max(spread[0], spread[1]) > settings_.tolerance * width) {
      return fmt::format("the motion to the ends of its range does not come to rest within {} s",
                         number_text(settings_.total_time, 6));
    }
    return {};
  }

 private:
  /// Moves to one end; false if the motion has no finite numbers.
  bool move(double sense) {
    const double h = settings_.step;
    const double decay = portable::exp(-h / std::max(0.01, settings_.time_constant));
    const auto steps = static_cast<std::int64_t>(std::ceil(settings_.total_time / h - 1e-9));
    std::vector<double> positions = reference_positions(model_);
    JointVector velocity = JointVector::Zero(model_.velocity_count);
    bool seen = false;
    for (std::int64_t i = 0; i < steps; ++i) {
      velocity *= decay;
      const Pose pose = pose_of(model_, positions, {});
      const std::optional<TendonPull> pull = tendon_pull(model_, pose, tendon_);
      if (!pull || !std::isfinite(pull->length)) return false;
      const JointMotion motion(model_, pose);
      const JointVector change = accelerations(motion, *pull, sense, positions, velocity);
      velocity += h * change;
      if (!velocity.allFinite()) return false;
      advance(model_, velocity, h, positions);
      if (h * static_cast<double>(i + 1) <= settings_.total_time - settings_.interval) continue;
      const double length = gear_ * pull->length;
      shortest_ = seen ? std::min(shortest_, length) : length;
      longest_ = seen ? std::max(longest_, length) : length;
      seen = true;
    }
    return seen;
  }

  JointVector accelerations(const JointMotion& motion, const TendonPull& pull, double sense,
                            const std::vector<double>& positions, const JointVector& velocity) {
    JointMatrix mass = motion.mass_matrix();
    const Eigen::LLT<JointMatrix> factor(mass);
    JointVector force = gear_ * motion.arms(pull);
    JointVector free = factor.solve(force);
    double scale = sense * settings_.acceleration / std::max(least_norm, free.norm());
    const double size = std::abs(scale) * force.norm();
    if (settings_.most_force > 0.0 && size > settings_.most_force) {
      scale *= settings_.most_force / size;
    }
    free = scale * free - factor.solve(motion.bias(velocity));
    add_stops(factor, positions, velocity, free);
    if (damping_.isZero()) return free;
    const JointVector total = mass * free;
    mass.diagonal() += settings_.step * damping_;
    return Eigen::LLT<JointMatrix>(mass).solve(total);
  }

  /// Adds the accelerations of the joints that are beyond their ranges: forces f >= 0 with
  /// (A + R) f + a - a_ref >= 0, of which one is 0, by Gauss and Seidel.
  void add_stops(const Eigen::LLT<JointMatrix>& factor, const std::vector<double>& positions,
                 const JointVector& velocity, JointVector& free) const {
    const std::vector<Stop> stops = stops_at(positions);
    if (stops.empty()) return;
    const auto count = static_cast<Eigen::Index>(stops.size());
    JointMatrix rows = JointMatrix::Zero(model_.velocity_count, count);
    JointVector wanted(count);
    JointVector softness(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const Stop& stop = stops[static_cast<std::size_t>(i)];
      const SoftLimit soft(stop.depth, settings_.step);
      rows(stop.velocity, i) = stop.sense;
      wanted[i] = soft.stiffness * stop.depth - soft.damping * stop.sense * velocity[stop.velocity];
      softness[i] = soft.give * give_[stop.velocity];
    }
    const JointMatrix effects = factor.solve(rows);
    JointMatrix matrix = rows.transpose() * effects;
    matrix.diagonal() += softness;
    const JointVector lack = wanted - rows.transpose() * free;
    JointVector forces = JointVector::Zero(count);
    constexpr int most_rounds = 200;
    for (int round = 0; round < most_rounds; ++round) {
      double change = 0.0;
      for (Eigen::Index i = 0; i < count; ++i) {
        const double step = (lack[i] - matrix.row(i).dot(forces)) / matrix(i, i);
        const double next = std::max(forces[i] + step, 0.0);
        change = std::max(change, matrix(i, i) * std::abs(next - forces[i]));
        forces[i] = next;
      }
      if (change < 1e-12 * settings_.acceleration) break;
    }
    free += effects * forces;
  }

  [[nodiscard]] std::vector<Stop> stops_at(const std::vector<double>& positions) const {
    std::vector<Stop> stops;
    for (const Joint& joint : model_.joints) {
      if (!joint.range || joint.velocity_count() != 1) continue;
      const double q = positions[at(joint.qpos)];
      if (q < (*joint.range)[0]) stops.push_back({joint.qvel, 1.0, (*joint.range)[0] - q});
      if (q > (*joint.range)[1]) stops.push_back({joint.qvel, -1.0, q - (*joint.range)[1]});
    }
    return stops;
  }

  const Model& model_;
  const Tendon& tendon_;
  double gear_;
  LengthRangeSettings settings_;
  double acceleration_ = 0.0;
  JointVector damping_;  // of each velocity
  JointVector give_;     // inverse inertia of each velocity in the pose of the text
  double shortest_ = 0.0;
  double longest_ = 0.0;
};

/// Why the range of a muscle cannot be found in this model; empty: it can.
std::string model_fault(const Model& model) {
  const LengthRangeSettings& settings = model.compiler.length_range;
  if (!settings.enabled) return "<lengthrange mode=\"none\"/> leaves it open";
  if (settings.uses_limits) {
    return "<lengthrange uselimit=\"true\"/> takes it from ranges, which is not read here";
  }
  if (!model.equalities.empty()) {
    return fmt::format("the model has equalities (line {}), with which it is not searched",
                       model.equalities.front().element->line);
  }
  for (const Tendon& tendon : model.tendons) {
    if (!tendon.range) continue;
    return fmt::format("tendon \"{}\" (line {}) has a range, with which it is not searched",
                       tendon.name, tendon.element->line);
  }
  for (const Joint& joint : model.joints) {
    if (!joint.range || joint.type != JointType::ball) continue;
    return fmt::format("ball \"{}\" (line {}) has a range, with which it is not searched",
                       joint.name, joint.element->line);
  }
  return {};
}

/// Products that one muscle needs, with a search or without.
double work_of(const Model& model, bool searches) {
  const LengthRangeSettings& settings = model.compiler.length_range;
  const double size = model.velocity_count;
  if (!searches) return size * size * size;
  const double parts = 100.0 * static_cast<double>(model.bodies.size() + model.joints.size());
  return 2.0 * settings.total_time / settings.step * (parts + size * size * (1.0 + size / 6.0));
}

/// Why the muscle is skipped; empty: force and length range are set.
std::string complete(const Model& model, Actuator& actuator, double& work, Log& log) {
  MuscleLaw& law = *actuator.muscle;
  const Tendon& tendon = model.tendons[at(actuator.tendon)];
  const bool searches = !law.length_range;
  if (!searches && law.force >= 0.0) return {};
  if (tendon.path.empty() || !tendon.branches.empty()) {
    return "without force and lengthrange it needs a spatial tendon without branches";
  }
  const std::string give = "; give lengthrange, which MuJoCo writes out when it saves a model";
  if (std::string fault = searches ? model_fault(model) : std::string(); !fault.empty()) {
    return "it has no lengthrange, and " + fault + give;
  }
  work += work_of(model, searches);
  if (work > most_work) {
    return "the model is too large to find its force and lengthrange here; give both";
  }
  RangeSearch search(model, tendon, actuator.gear);
  if (const std::string fault = search.begin(); !fault.empty()) {
    return fmt::format("it has no force or lengthrange, and {}; give both", fault);
  }
  if (searches) {
    std::array<double, 2> range{};
    if (const std::string fault = search.find(range); !fault.empty()) {
      return "it has no lengthrange, and " + fault + give;
    }
    law.length_range = range;
    log.same(*actuator.element, fmt::format("lengthrange \"{} {}\", found as MuJoCo does",
                                            number_text(range[0], 8), number_text(range[1], 8)));
  }
  if (law.force < 0.0) {
    law.force = law.scale / search.acceleration();
    log.same(*actuator.element,
             fmt::format("force {} N is scale / acc0, with acc0 = {}", number_text(law.force, 8),
                         number_text(search.acceleration(), 8)));
  }
  return {};
}

}  // namespace

void complete_muscles(Model& model, Log& log) {
  double work = 0.0;
  for (Actuator& actuator : model.actuators) {
    if (!actuator.muscle || actuator.tendon < 0) continue;
    const std::string fault = complete(model, actuator, work, log);
    if (fault.empty()) continue;
    log.skipped(*actuator.element, fault);
    actuator.tendon = -1;
  }
}

}  // namespace sheave::import::mjcf
