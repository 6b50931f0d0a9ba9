#include "engine/joints/joint_effect.h"

#include <cmath>

#include "engine/field_check.h"
#include "engine/joint.h"

namespace sheave {

void append_effects(const JointCoordinate& settings, int coordinate,
                    std::vector<JointEffect>& effects) {
  using Kind = JointEffect::Kind;
  const auto add = [&](Kind kind) -> JointEffect& {
    effects.push_back({.kind = kind, .coordinate = coordinate, .signal = {}});
    return effects.back();
  };
  if (settings.stiffness > 0.0) {
    JointEffect& spring = add(Kind::spring);
    spring.at = settings.rest;
    spring.compliance = 1.0 / settings.stiffness;
    spring.damping = settings.damping;
  } else if (settings.damping > 0.0) {
    add(Kind::damper).damping = settings.damping;
  }
  switch (settings.drive) {
    case CoordinateDrive::none:
      break;
    case CoordinateDrive::position:
      add(Kind::position).compliance = settings.drive_compliance;
      break;
    case CoordinateDrive::speed:
      add(Kind::speed);
      break;
    case CoordinateDrive::force:
      add(Kind::force);
      break;
  }
  if (settings.drive != CoordinateDrive::none) {
    effects.back().limit = settings.drive_limit.value_or(Row::unbounded);
    effects.back().signal = settings.signal();
  }
  if (settings.friction > 0.0) add(Kind::friction).limit = settings.friction;
  for (const auto& [stop, kind] :
       {std::pair{settings.lower, Kind::lower}, std::pair{settings.upper, Kind::upper}}) {
    if (!stop) continue;
    JointEffect& effect = add(kind);
    effect.at = *stop;
    effect.compliance = settings.limit_compliance;
  }
}

void append_resistance(double damping, double friction, int first, int count,
                       std::vector<JointEffect>& effects) {
  JointCoordinate damper;
  damper.damping = damping;
  for (int k = 0; k < count; ++k) append_effects(damper, first + k, effects);
  if (!(friction > 0.0)) return;
  JointCoordinate rubbing;
  rubbing.friction = friction;
  const std::size_t own = effects.size();
  for (int k = 0; k < count; ++k) append_effects(rubbing, first + k, effects);
  effects[own].shares = count;
  for (std::size_t k = own; k < effects.size(); ++k) effects[k].shared = true;
}

double drive_error(const JointEffect& drive, const DriveDemand& demand, double time, double force,
                   double value, double rate) {
  constexpr double nearly = 1.0 - 1e-9;
  const bool stalls = std::abs(force) >= nearly * demand.limit();
  if (stalls || drive.compliance > 0.0) return 0.0;
  if (drive.kind == JointEffect::Kind::position) return value - demand.at(time);
  if (drive.kind == JointEffect::Kind::speed) return rate - demand.at(time);
  return 0.0;
}

std::string hold_fault(const JointEffect& effect, const JointCoordinateInfo& info, const Row& row,
                       double scale) {
  // Residual of a stop at which a run has come to rest.
  constexpr double slop = 1e-6;
  const bool rigid =
      row.compliance == 0.0 && (row.lower == -Row::unbounded || row.upper == Row::unbounded);
  const bool asks = effect.holds() || effect.kind == JointEffect::Kind::position;
  if (!asks || !rigid || row.is_free()) return {};
  const double off = std::abs(row.value);
  if (off <= slop * (info.angle ? 1.0 : scale)) return {};
  return "its " + std::string(info.name) + " is " + number_text(off) +
         (info.angle ? " rad" : " m") +
         (effect.is_drive() ? " off the target of its drive" : " beyond a stop");
}

void set_effect(const JointEffect& effect, const Substep& substep, double now, double start,
                Row& row) {
  using Kind = JointEffect::Kind;
  const double from = substep.start.time;
  const double to = substep.time;
  const double square = substep.h * substep.h;
  const DriveDemand drive(effect, substep.start.controls);
  row.compliance = effect.compliance;
  row.upper = drive.limit() * square;
  row.lower = -row.upper;
  switch (effect.kind) {
    case Kind::lower:
      row.value = now - effect.at;
      row.lower = 0.0;
      break;
    case Kind::upper:
      row.value = now - effect.at;
      row.upper = 0.0;
      break;
    case Kind::coupling:
      row.value = now;
      break;
    case Kind::spring:
      row.value = now - effect.at;
      row.damping = effect.damping;
      break;
    case Kind::damper:
      row.value = now - start;
      row.compliance = substep.damper_compliance(effect.damping);
      break;
    case Kind::friction:
      row.value = now - start;
      row.shares = effect.shares;
      break;
    case Kind::position:
      row.value = now - drive.at(to);
      row.rate = -drive.rate(to);
      break;
    case Kind::speed:
      row.value = now - start - drive.integral(from, to);
      row.rate = -drive.at(to);
      break;
    case Kind::force: {
      const double end = substep.next.time;
      row.value = now - start;
      row.lower = row.upper = drive.integral(from, end) / (end - from) * square;
      break;
    }
  }
}

}  // namespace sheave
