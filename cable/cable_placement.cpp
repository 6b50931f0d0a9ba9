// Placement of bodies between two steps, as a substep of almost no time without forces. Wheels take
// and give the arcs between the old and the new contacts, as they do when bodies move there, so
// lengths are conserved to the last bit. If the cable's length is to be kept, spans get longer or
// shorter than before; otherwise their rest lengths are adapted so that each span keeps its stretch
// or its slack.

#include <algorithm>
#include <cmath>

#include "cable/cable_system.h"
#include "cable/sheaths.h"
#include "engine/field_check.h"
#include "engine/index.h"
#include "engine/math/portable.h"

namespace sheave {
namespace {

/// Rotation vector of the shorter rotation between two orientations.
Vector3 shorter_turn(const Quaternion& from, const Quaternion& to) {
  Quaternion change = to * from.conjugate();
  if (change.w() < 0.0) change.coeffs() = -change.coeffs();
  const double sine = change.vec().norm();
  if (!(sine > 0.0)) return Vector3::Zero();
  return change.vec() * (2.0 * portable::atan2(sine, change.w()) / sine);
}

/// Gives the bodies of a substep their poses in `end`.
void move_bodies(const State& end, Substep& substep) {
  const BodySet& bodies = substep.bodies;
  for (int i = 0; i < bodies.count(); ++i) {
    const BodyState& from = substep.start.bodies[at(i)];
    const BodyState& to = end.bodies[at(i)];
    if (bodies[i].mount >= 0) continue;
    MovingBody& moving = substep.moving[at(i)];
    if (bodies[i].mobility == Mobility::rotor) {
      moving.turn = (to.angle - from.angle) * bodies[i].axis;
      continue;
    }
    moving.position = to.position;
    moving.orientation = to.orientation;
    moving.turn = bodies[i].mobility == Mobility::planar
                      ? Vector3((to.angle - from.angle) * bodies[i].axis)
                      : shorter_turn(from.orientation, to.orientation);
    for (const int rotor : bodies[i].mounted_rotors) {
      const Vector3 axle = from.orientation * bodies[rotor].axis;
      const double spin = end.bodies[at(rotor)].angle - substep.start.bodies[at(rotor)].angle;
      double turn = axle.dot(moving.turn) + spin;
      // The spin is measured along the axle at the end, which the carrier may have tilted.
      constexpr double upright = 1.0 - 1e-12;
      const double tilt = axle.dot(to.orientation * bodies[rotor].axis);
      if (tilt < upright) turn /= tilt;
      substep.moving[at(rotor)].turn = axle * turn;
    }
  }
  substep.time = substep.next.time;
}

/// The rest length with which a span of this length has the tension that it had with this stretch.
double rest_length_for(const CompiledCable& cable, double before, double stretch, double length) {
  // With a material the tension follows from the strain.
  const bool strained = cable.inverse_stiffness > 0.0 && stretch > 0.0 && before > 0.0;
  return strained ? length / (1.0 + stretch / before) : length - stretch;
}

std::string knots_fault(const std::string& name) {
  return "the machine has knots without mass, such as \"" + name +
         "\", and bodies of such a machine cannot be placed at once: move them by drives or loads, "
         "or give the knots mobility \"free\" and a mass";
}

}  // namespace

CableSystem::Placed CableSystem::place(const BodySet& bodies, const State& start, const State& end,
                                       const FeatureState& own, bool keeps_tension) {
  constexpr double no_time = 1e-9;  // [s] long enough for h^2 to be a usable number
  Placed placed{own, std::vector<double>(cables_.size(), 0.0), {}};
  FeatureState& next = placed.own;
  if (!knots_.empty()) return {own, {}, knots_fault(bodies.name(knots_.front().body))};
  Substep substep(bodies, start, no_time, 1);
  substep.next = end;
  substep.next.time = start.time + no_time;
  begin(substep, own);
  // Bodies may be put anywhere, so no span counts as affine.
  for (int k = 0; k < span_count(); ++k) {
    if (!spans_[at(k)].active || is_affine_[at(k)] == 0) continue;
    is_affine_[at(k)] = 0;
    begin_moving_span(substep, own, k);
  }
  known_.forget();
  std::fill(fed_.begin(), fed_.end(), std::array<double, 2>{});
  std::vector<double> stretches(spans_.size(), 0.0);
  for (int k = 0; k < span_count(); ++k) {
    if (!spans_[at(k)].active) continue;
    stretches[at(k)] = geometry_of(substep, k).length - own.reals[rest_length_index(k)];
  }
  move_bodies(end, substep);
  turn_geodesics(substep);
  if (!stored_.empty()) stored_end_ = stored_;
  std::fill(end_strains_.begin(), end_strains_.end(), -1.0);
  for (const CompiledCable& cable : cables_) {
    if (cable.has_sheaths && !keeps_tension) Sheaths(*this).keep_end_strains(substep, cable);
  }
  for (int k = 0; k < span_count(); ++k) {
    if (!spans_[at(k)].active) continue;
    if (is_affine_[at(k)] != 0) {
      finish_affine(substep, k, next);
    } else {
      finish_span(substep, k, next);
    }
    next.reals[tension_index(k)] = own.reals[tension_index(k)];
    if (!keeps_tension) continue;
    const int index = spans_[at(k)].cable;
    const CompiledCable& cable = cables_[at(index)];
    double& rest_length = next.reals[rest_length_index(k)];
    const double wanted = rest_length_for(cable, own.reals[rest_length_index(k)], stretches[at(k)],
                                          geometry_of(substep, k).length);
    const double more = cable.quantised(wanted - rest_length);
    rest_length += more;
    placed.added[at(index)] += more;
  }
  if (!stored_end_.empty()) keep_strains(next);
  for (const CompiledCable& cable : cables_) {
    if (cable.has_sheaths && !keeps_tension) Sheaths(*this).finish(substep, cable, next);
    placed.fault = placement_fault(substep, cable, next);
    if (!placed.fault.empty()) break;
  }
  if (placed.fault.empty()) {
    keep_geodesics(next);
    if (!changing_links_.empty()) change_ends(substep, next);
    if (course_changes_) leave_and_touch(substep, next);
  }
  knows_lengths_ = false;
  return placed;
}

std::string CableSystem::placement_fault(const Substep& substep, const CompiledCable& cable,
                                         const FeatureState& next) const {
  const double slop = 1e-9 * substep.bodies.scale();
  const std::string name = "cable \"" + cable.name + "\"";
  if (cable.inverse_stiffness > 0.0) {
    // The strain of the cable stored on a wheel depends on the path of the bodies, which a
    // placement does not have.
    for (int k = cable.first_span; k < cable.first_span + cable.span_count; ++k) {
      const SpanSetup& setup = spans_[at(k)];
      if (!setup.active) continue;
      const bool wheels = links_[at(setup.first)].wraps() || links_[at(setup.second)].wraps();
      Substep before(substep.bodies, substep.start, substep.h, 1);
      const Vector3 turned = geometry_of(substep, k).direction - geometry_of(before, k).direction;
      if (wheels && turned.norm() > 1e-9) {
        return name +
               " has an axial_stiffness or a tension_table and lies on wheels whose contacts would "
               "move; such a cable "
               "cannot be placed at once";
      }
    }
  }
  double excess = 0.0;
  int at_span = 0;
  for_each_run(cable, [&](Run run) {
    // Cable passes the links within a run, so only the sum of its spans counts.
    double missing = 0.0;
    int k = run.first;
    for (int i = 0; i < run.count; ++i, k = next_span(cable, k)) {
      missing += geometry_of(substep, k).length - next.reals[rest_length_index(k)];
    }
    if (missing <= excess) return;
    excess = missing;
    at_span = run.first - cable.first_span;
  });
  if (cable.compliance == 0.0 && cable.inverse_stiffness == 0.0 && excess > slop) {
    return name + " is " + number_text(excess) + " m too short for that at its span " +
           std::to_string(at_span) + ", and it is rigid; keep its tension instead of its length";
  }
  for (int k = cable.first_span; k < cable.first_span + cable.span_count; ++k) {
    if (!spans_[at(k)].active) continue;
    const std::string span = " at its span " + std::to_string(k - cable.first_span);
    if (next.reals[rest_length_index(k)] < 0.0)
      return name + " would need a negative rest length" + span;
    if (!geometry_of(substep, k).has_tangent) return name + " would run through a wheel" + span;
  }
  return {};
}

}  // namespace sheave
