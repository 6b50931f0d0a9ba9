// Bearings that brake wheels with inertia.
//
// A rolling link has the efficiency e: at a steady speed the incoming cable has e times the tension
// of the outgoing cable, T1 = e T2. A wheel without inertia is a capstan with this ratio
// (cable/cable_friction.cpp). A wheel with inertia transmits the tensions to its rim, and its
// bearing brakes it with a torque M against its rotation relative to the carrier. Its equation
//
//   I w' = R (T2 - T1) - M
//
// has that ratio at w' = 0 if M = R (1 - e) / (1 + e) (T1 + T2). M is dry friction whose bound
// is proportional to the sum of both tensions, so it is the same for both directions of the cable.
// For a wrap of half a turn that sum is the load on the pin, and the law is that of a journal, M =
// r mu (T1 + T2), with r mu = R (1 - e) / (1 + e). At rest M is anything within the bound.
// Bending loss and friction of the pin are the general case (cable/bearing_loss.h): M = arm x
// pressed, where a part of `pressed` is the load of the pin in place of the sum of the tensions.
//
// The row of a span with weight has its chord tension. The tension at the wheel is higher or lower by
// the weight of the rope, which hardly depends on the tension (cable/cable_weight.cpp). The friction of
// the row is larger by the ratio of both sums, from the last round.
//
// One row per wheel describes the bearing: its coordinate is the wheel's rotation c relative to the
// carrier, C = c - c0, and its bounds are those of friction (Row::friction) pressed by the rows of
// both spans. The carrier gets the torque -M.

#include <algorithm>
#include <cmath>

#include "cable/cable_system.h"
#include "engine/index.h"

namespace sheave {
namespace {

/// Relative changes of the bound up to this count as converged.
constexpr double settled_bound = 1e-10;

/// By how much the load of a pin exceeds the sum of the tensions; times the share of the pin.
/// Forces are multipliers of a whole substep.
double beyond_tensions(const LinkGeometry& link, const cable_parts::Bearing& bearing,
                       const std::array<double, 2>& pulls, const Vector3& weight) {
  const Vector3 load = pulls[0] * bearing.away[0] + pulls[1] * bearing.away[1] + weight;
  return link.pin_share * (load.norm() - (pulls[0] + pulls[1]));
}

Vector3 weight_on_pin(const Substep& substep, const cable_parts::Bearing& bearing) {
  return substep.h * substep.h * substep.bodies[bearing.rotor].mass * substep.gravity;
}

}  // namespace

double CableSystem::pressing(const Substep& substep, const cable_parts::Bearing& bearing) const {
  double sum = above_chords(substep, bearing);
  for (const int k : bearing.spans) {
    if (k >= 0) sum += multipliers_[at(k)] / substep.load_share;
  }
  return sum;
}

double CableSystem::above_chords(const Substep& substep,
                                 const cable_parts::Bearing& bearing) const {
  const auto [in, out] = bearing.spans;
  const LinkGeometry& link = links_[at(bearing.link)];
  if (link.pin_share > 0.0) {
    const auto pull = [&](int k) {
      return k >= 0 ? multipliers_[at(k)] / substep.load_share : 0.0;
    };
    return beyond_tensions(link, bearing, {pull(in), pull(out)}, weight_on_pin(substep, bearing));
  }
  if (!weighs_) return 0.0;
  double sum = 0.0;
  if (in >= 0 && hangs(substep, in)) sum += hanging_[at(in)].above[1];
  if (out >= 0 && hangs(substep, out)) sum += hanging_[at(out)].above[0];
  return substep.h * substep.h * sum;
}

void CableSystem::begin_bearings(const Substep& substep) {
  if (bearings_.empty()) return;
  for (cable_parts::Bearing& bearing : bearings_) {
    bearing.spans = {-1, -1};
    bearing.pressed = bearing.above = 0.0;
    bearing.pressure = {};
  }
  const auto press = [&](int link, std::size_t side, int span) {
    if (bearing_of(link) < 0) return;
    cable_parts::Bearing& bearing = bearings_[at(bearing_of(link))];
    bearing.spans[side] = span;
    bearing.pressed += substep.h * substep.h * start_tensions_[at(span)];
  };
  for (int k = 0; k < span_count(); ++k) {
    if (!spans_[at(k)].active) continue;
    press(spans_[at(k)].second, 0, k);
    press(spans_[at(k)].first, 1, k);
  }
  for (cable_parts::Bearing& bearing : bearings_) {
    const LinkGeometry& link = links_[at(bearing.link)];
    if (link.pin_share > 0.0) {
      find_pin(substep, bearing);
      const auto pull = [&](int k) {
        return k >= 0 ? substep.h * substep.h * start_tensions_[at(k)] : 0.0;
      };
      bearing.above =
          beyond_tensions(link, bearing, {pull(bearing.spans[0]), pull(bearing.spans[1])},
                          weight_on_pin(substep, bearing));
    } else {
      bearing.above = above_chords(substep, bearing);
    }
    bearing.pressed += bearing.above;
  }
}

void CableSystem::find_pin(const Substep& substep, cable_parts::Bearing& bearing) const {
  const auto [in, out] = bearing.spans;
  bearing.away = {Vector3::Zero(), Vector3::Zero()};
  if (in >= 0) bearing.away[0] = -geometry_of(substep, in).direction;
  if (out >= 0) bearing.away[1] = geometry_of(substep, out).direction;
}

void CableSystem::evaluate_bearing(const Substep& substep, std::size_t bearing, Row& row) const {
  const cable_parts::Bearing& own = bearings_[bearing];
  const LinkGeometry& link = links_[at(own.link)];
  const BodyProperties& wheel = substep.bodies[own.rotor];
  Vector3 axle = wheel.axis;
  Vector3 turn = substep.moving[at(own.rotor)].turn;
  if (wheel.mount >= 0) {
    const MovingBody& carrier = substep.moving[at(wheel.mount)];
    axle = rotated(carrier.orientation, axle);
    turn -= carrier.turn;
    row.add(wheel.mount, Vector3::Zero(), -axle);
  }
  row.add(own.rotor, Vector3::Zero(), axle);
  row.value = dot(axle, turn);
  row.lever = std::abs(link.signed_radius);
  const double chords = own.pressed - own.above;
  row.friction = link.bearing_arm * (own.above != 0.0 && chords > 0.0 ? own.pressed / chords : 1.0);
  row.upper = link.bearing_arm * own.pressed;
  row.lower = -row.upper;
  row.told = wheel.mount < 0;
  row.index = span_count() + static_cast<int>(bearing);
}

double CableSystem::sweep_bearings(Substep& substep) {
  double correction = 0.0;
  for (std::size_t b = 0; b < bearings_.size(); ++b) {
    const bool pinned = links_[at(bearings_[b].link)].pin_share > 0.0;
    if (pinned && substep.load_share == 1.0) find_pin(substep, bearings_[b]);
    bearings_[b].pressed = pressing(substep, bearings_[b]);
    bearings_[b].above = above_chords(substep, bearings_[b]);
    row_.clear();
    evaluate_bearing(substep, b, row_);
    double& multiplier = multipliers_[spans_.size() + b];
    const double error = solve_row(row_, substep.h, multiplier, substep.moving);
    correction = std::max(correction, error * row_.lever);
  }
  return correction;
}

void CableSystem::linearise_bearings(const Substep& substep, std::size_t first, RowList& rows) {
  if (bearings_.empty()) return;
  row_places_.assign(spans_.size(), 0);
  for (std::size_t i = first; i < rows.size(); ++i) {
    // Rows of loads come behind those of spans and bearings.
    if (at(rows[i].index) < spans_.size()) row_places_[at(rows[i].index)] = i;
  }
  for (std::size_t b = 0; b < bearings_.size(); ++b) {
    const std::size_t place = rows.size();
    const bool pinned = links_[at(bearings_[b].link)].pin_share > 0.0;
    // The first half of a substep of `rattle` has the directions of the start.
    if (pinned && substep.load_share == 1.0) find_pin(substep, bearings_[b]);
    Row& row = rows.emplace_back();
    evaluate_bearing(substep, b, row);
    const std::array<int, 2>& beside = bearings_[b].spans;
    const auto distance = [&](int span) { return static_cast<int>(place - row_places_[at(span)]); };
    if (beside[0] < 0 || beside[1] < 0) {
      row.friction = row.lower = row.upper = 0.0;
      continue;
    }
    if (pinned) bearings_[b].early = {multipliers_[at(beside[0])], multipliers_[at(beside[1])]};
    // A slack rope presses nothing; the weight of the wheel does.
    if (pinned && !(bearings_[b].pressed > bearings_[b].above)) {
      row.friction = 0.0;
      continue;
    }
    row.pressed_by = distance(beside[0]);
    row.pressed_also = distance(beside[1]);
  }
}

bool CableSystem::revise_pins(const Substep& substep) {
  bool changed = false;
  for (cable_parts::Bearing& bearing : bearings_) {
    const LinkGeometry& link = links_[at(bearing.link)];
    const auto [in, out] = bearing.spans;
    if (!(link.pin_share > 0.0) || in < 0 || out < 0) continue;
    find_pin(substep, bearing);
    // The second half of the substep alone, as a whole substep.
    const std::array<double, 2> pulls{2.0 * (multipliers_[at(in)] - bearing.early[0]),
                                      2.0 * (multipliers_[at(out)] - bearing.early[1])};
    const double above = beyond_tensions(link, bearing, pulls, weight_on_pin(substep, bearing));
    const double now = pulls[0] + pulls[1] + above;
    const double chords = bearing.pressed - bearing.above;
    if (!(pulls[0] + pulls[1] > 0.0 && chords > 0.0)) continue;
    const double ratio = now / (pulls[0] + pulls[1]);
    changed = changed || std::abs(ratio - bearing.pressed / chords) > settled_bound * ratio;
    bearing.pressed = now;
    bearing.above = above;
  }
  return changed;
}

bool CableSystem::revise_bearings(const Substep& substep) {
  bool changed = false;
  for (std::size_t b = 0; b < bearings_.size(); ++b) {
    cable_parts::Bearing& bearing = bearings_[b];
    const double now = pressing(substep, bearing);
    // A bound that friction does not reach may change without any effect.
    const double used = std::abs(multipliers_[spans_.size() + b]) / substep.load_share;
    const double arm = links_[at(bearing.link)].bearing_arm;
    const bool matters = used >= (1.0 - 1e-9) * arm * std::min(now, bearing.pressed);
    const double off = std::abs(now - bearing.pressed);
    changed = changed || (matters && off > settled_bound * std::max(now, bearing.pressed));
    bearing.pressed = bearing.pressure.next(bearing.pressed, now);
    bearing.above = above_chords(substep, bearing);
  }
  return changed;
}

}  // namespace sheave
