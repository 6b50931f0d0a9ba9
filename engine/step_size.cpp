#include "engine/step_size.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/body_set.h"
#include "engine/index.h"
#include "engine/state.h"
#include "engine/step_settings.h"

namespace sheave {
namespace {

constexpr std::size_t numbers_per_body = 6;
/// The time in which errors add up to the tolerance [s].
constexpr double unit_time = 1.0;
/// Share of the tolerance that an event may take.
constexpr double event_share = 0.25;
/// A jerk that exceeds the largest one by this factor is an event.
constexpr double event_ratio = 4.0;
/// A jump that grows by this factor when the length is halved is the residual of a position. Such a
/// residual alone grows by 2, and a jump of a velocity by 1.
constexpr double residual_ratio = 1.2;
/// Largest residual of a position, as a share of the size of the scene: ten times the tolerance of the
/// direct solver, because a body has several rows.
constexpr double residual_of_positions = 1e-9;
/// A jerk that grows counts as large as it would be after so many further substeps. Velocities have
/// errors of h^3 / 12 times its rate of change, which the jerk does not show where it is small.
constexpr double look_ahead = 8.0;
/// A jump of the velocity is as large in a substep of a 256th of the length. A jump of the
/// acceleration that lies at the end of its substep may seem to do so over a few levels.
constexpr std::int64_t levels_of_proof = 8;
static_assert(StepSizeControl::length_of_proof == 1 << levels_of_proof);
/// Level of the shortest substeps: in shorter ones, rounding of positions would become velocity.
constexpr std::int64_t shortest = 15;
/// Rounding and residuals of positions, as a share of the size of the scene.
constexpr double rounding_of_positions = 5e-12;
/// A window lasts so many times acceleration / jerk, which is 1 / (angular frequency) in a
/// vibration. Half a vibration has a largest jerk.
constexpr double window_length = 4.0;
/// The largest jerk of earlier windows counts so much less after each window. A pendulum that swings
/// far has its largest jerks five windows apart.
constexpr double fading = 0.917;  // 2^(-1/8)
/// A window with a jerk below this share of the earlier ones is the beginning of another motion.
constexpr double quiet_share = 1e-3;
/// Share of the tolerance that doubled substeps must not exceed.
constexpr double share_to_lengthen = 0.5;

}  // namespace

bool StepSizeMemory::is_sound(std::size_t movable) const {
  const auto finite = [](double x) { return std::isfinite(x); };
  const bool fits = accelerations.empty() || accelerations.size() == movable * numbers_per_body;
  return fits && level >= 0 && level <= StepSizeControl::finest && finite(middle) &&
         finite(window) &&
         std::min({jerk_before, jerk, acceleration_before, acceleration}) >= 0.0 &&
         finite(jerk_before + jerk + acceleration_before + acceleration) &&
         std::all_of(accelerations.begin(), accelerations.end(), finite);
}

StepSizeControl::StepSizeControl(const StepSettings& step, const BodySet& bodies,
                                 StepSizeMemory& memory)
    : tolerance_(step.tolerance),
      dt_(step.dt),
      coarsest_(step.coarsest_level),
      bodies_(bodies),
      memory_(memory),
      accelerations_(numbers_per_body * bodies.coordinates().movable().size()),
      jumps_(at(finest) + 1) {
  memory_.level = std::max(memory_.level, coarsest_);
}

StepSizeControl::Change StepSizeControl::change_of(const State& from, const State& to) {
  const double h = to.time - from.time;
  Change change;
  double* own = accelerations_.data();
  const double* last = knows() ? memory_.accelerations.data() : nullptr;
  for (const BodyFreedom& freedom : bodies_.coordinates().movable()) {
    const BodyState& start = from.bodies[at(freedom.body)];
    const BodyState& end = to.bodies[at(freedom.body)];
    const double size = bodies_[freedom.body].size;
    const Vector3 linear = (end.velocity - start.velocity) / h;
    const Vector3 angular = (end.angular_velocity - start.angular_velocity) * (size / h);
    double moved = 0.0;
    double turned = 0.0;
    for (int i = 0; i < 3; ++i) {
      own[i] = linear[i];
      own[3 + i] = angular[i];
      if (last == nullptr) continue;
      moved += (linear[i] - last[i]) * (linear[i] - last[i]);
      turned += (angular[i] - last[3 + i]) * (angular[i] - last[3 + i]);
    }
    const double changed = std::sqrt(moved) + std::sqrt(turned);
    change.size = std::max(change.size, linear.norm() + angular.norm());
    if (change.body < 0 || changed > change.largest) {
      change.body = freedom.body;
      change.largest = changed;
    }
    own += numbers_per_body;
    if (last != nullptr) last += numbers_per_body;
  }
  change.largest =
      std::max(0.0, change.largest - rounding_of_positions * bodies_.scale() / (h * h));
  return change;
}

void StepSizeControl::note(const State& from, const State& to) {
  static_cast<void>(change_of(from, to));
  memory_.accelerations = accelerations_;
  memory_.middle = 0.5 * (from.time + to.time);
}

double StepSizeControl::held_jerk() const { return std::max(memory_.jerk_before, memory_.jerk); }

bool StepSizeControl::may_contain(double jump) const {
  return jump * unit_time <= event_share * tolerance_;
}

bool StepSizeControl::is_jump_of_velocity(double h, double jump) const {
  if (memory_.level < levels_of_proof || h * jump > event_share * tolerance_) return false;
  const double before = jumps_[static_cast<std::size_t>(memory_.level - levels_of_proof)];
  return before > 0.0 && is_jump(jump, before);
}

double StepSizeControl::jump_after(const StepSizeMemory& before, const State& from,
                                   const State& to) {
  memory_.accelerations = before.accelerations;
  const double jump = knows() ? (to.time - from.time) * change_of(from, to).largest : 0.0;
  memory_.accelerations.clear();
  return jump;
}

double StepSizeControl::change_of_velocity(const State& from, const State& to) {
  return (to.time - from.time) * change_of(from, to).size;
}

StepSizeVerdict StepSizeControl::judge(const State& from, const State& to) {
  ++attempts_;
  const double h = to.time - from.time;
  const Change change = change_of(from, to);
  const double middle = 0.5 * (from.time + to.time);
  const double jerk = change.largest / (middle - memory_.middle);
  const double jump = h * change.largest;
  const double allowed = 6.0 * tolerance_ / unit_time;
  // An error that is far below the tolerance needs no reason.
  const bool matters = h * h * jerk > 0.1 * allowed;
  // Of the first substep after restart() no other jerk is known.
  const bool known = from.time > memory_.window || memory_.jerk_before > 0.0;
  const bool sudden = matters && known && jerk > event_ratio * held_jerk();
  StepSizeVerdict verdict{.event = sudden, .error = h * h * h * jerk / 6.0, .body = change.body};
  const double growth = std::max(0.0, jerk - held_jerk());
  const bool fits = !sudden && h * h * (jerk + look_ahead * growth) <= allowed;
  verdict.of_velocity = !fits && is_jump_of_velocity(h, jump);
  verdict.accepted = fits || may_contain(jump) || verdict.of_velocity;
  if (!fits) verdict.jump = jump;
  verdict.is_placed = h * jump <= event_share * tolerance_;
  if (!verdict.accepted) {
    jumps_[static_cast<std::size_t>(memory_.level)] = jump;
    verdict.may_pass = sudden && verdict.is_placed;
    verdict.error = std::max(verdict.error, h * jump);
    // A first half that was done for comparison is as long as the next attempt.
    if (memory_.middle > from.time) memory_.accelerations.clear();
    if (seek(from.time, h, jump)) return verdict;
    verdict.may_pass = false;
    verdict.is_last = true;
  }
  if (!fits) {
    restart(to.time);
    if (search_from_ >= 0) memory_.level = std::min(memory_.level, search_from_);
    search_from_ = -1;
    return verdict;
  }
  search_from_ = -1;
  memory_.accelerations.swap(accelerations_);
  accelerations_.resize(memory_.accelerations.size());
  memory_.middle = middle;
  follow(to.time, jerk, change.size);
  return verdict;
}

void StepSizeControl::follow(double time, double jerk, double acceleration) {
  StepSizeMemory& m = memory_;
  m.jerk = std::max(m.jerk, jerk);
  m.acceleration = std::max(m.acceleration, acceleration);
  const double held = std::max(m.acceleration_before, m.acceleration);
  if (held_jerk() == 0.0 || (time - m.window) * held_jerk() < window_length * held) return;
  const double left = m.jerk < quiet_share * m.jerk_before ? 0.0 : fading;
  m.window = time;
  m.jerk_before = std::max(std::exchange(m.jerk, 0.0), left * m.jerk_before);
  m.acceleration_before =
      std::max(std::exchange(m.acceleration, 0.0), left * m.acceleration_before);
}

void StepSizeControl::restart(double time) {
  memory_.accelerations.clear();
  memory_.jerk_before = memory_.jerk = 0.0;
  memory_.acceleration_before = memory_.acceleration = 0.0;
  memory_.window = memory_.middle = time;
  std::fill(jumps_.begin(), jumps_.end(), 0.0);
}

bool StepSizeControl::allows(double error, double length) const {
  return error * unit_time <= tolerance_ * length;
}

bool StepSizeControl::is_shortest() const {
  return memory_.level >= shortest || attempts_ >= most_attempts;
}

bool StepSizeControl::seek(double time, double h, double jump) {
  if (search_from_ < 0) search_from_ = memory_.level;
  if (time == settled_) return false;
  const Refusal before = std::exchange(refused_, {time, memory_.level, jump});
  const bool is_halved = before.time == time && before.level + 1 == memory_.level;
  const bool is_small = h * jump <= residual_of_positions * bodies_.scale();
  if (is_halved && is_small && jump > residual_ratio * before.jump) {
    settled_ = time;
    --memory_.level;
    return true;
  }
  return shorten();
}

bool StepSizeControl::shorten() {
  if (is_shortest()) return false;
  ++memory_.level;
  return true;
}

void StepSizeControl::lengthen() {
  if (attempts_ >= most_attempts) {
    memory_.level = std::min(memory_.level, last_resort_level);
    return;
  }
  if (memory_.level <= coarsest_ || !knows()) return;
  const double twice = 2.0 * std::ldexp(dt_, -static_cast<int>(memory_.level));
  const double allowed = share_to_lengthen * 6.0 * tolerance_ / unit_time;
  if (twice * twice * held_jerk() <= allowed) --memory_.level;
}

}  // namespace sheave
