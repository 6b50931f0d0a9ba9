// The inertia of ropes, by the balance of their momentum over the substep (cable/rope_inertia.cpp has
// the model). From the start to the end of a substep of either integrator a span with the mean mass m
// changes the mean U and the difference D of the velocities of its ends; the forces along them are
//
//   -m (dU / h - D (S0' + S1') / 2 L)   and   -(m / 12) (dD / h - D (S1' - S0') / L)
//
// with the difference D of the substep, and the rates S0' and S1' at which rope passes its ends, from
// the travel of the rims.

#include <cmath>
#include <limits>

#include "cable/certificate/checks.h"

namespace sheave::certify {
namespace {

using Kind = CertificateItem::Kind;

struct Velocities {
  Vector3 mean;
  Vector3 difference;
};

Velocities velocities_of(const Evidence& e, const SpanEvidence& span, End when) {
  const Moment& now = e.moments[at(when)];
  const Vector3 from = now.velocity(span.from.body, span.from.point[at(when)]);
  const Vector3 to = now.velocity(span.to.body, span.to.point[at(when)]);
  return {0.5 * (from + to), to - from};
}

/// Difference of the displacements of both ends over the substep, per time [m/s].
Vector3 mean_difference(const Evidence& e, const SpanEvidence& span) {
  const auto way = [&](End when) -> Vector3 {
    return e.displacement(span.to.body, span.to.point[at(when)], when) -
           e.displacement(span.from.body, span.from.point[at(when)], when);
  };
  if (!e.rattle) return way(last_end) / e.h;
  return 0.5 * (way(first_end) + way(last_end)) / e.h;
}

double rounding_of(const Evidence& e, double mass, const SpanEvidence& span) {
  constexpr double eps = 64.0 * std::numeric_limits<double>::epsilon();
  const double reach = span.from.point[last_end].norm() + span.to.point[last_end].norm() +
                       span.length[last_end] + e.bodies.scale();
  return eps * mass * reach / (e.h * e.h);
}

void check_span(const Evidence& e, const CableEvidence& cable, const SpanEvidence& span,
                Findings& findings) {
  const double length = 0.5 * (span.rest_length[first_end] + span.rest_length[last_end]);
  if (!(length > 0.0)) return;
  const double mass = cable.definition->linear_density * length;
  const Velocities before = velocities_of(e, span, first_end);
  const Velocities after = velocities_of(e, span, last_end);
  const Vector3 apart = mean_difference(e, span);
  const double gained = span.rest_length[last_end] - span.rest_length[first_end];
  const double strain = span.tension() / *cable.definition->axial_stiffness;
  const auto [first, second] = rim_travels(e, cable, span, gained);
  const double s0 = -first / (1.0 + strain) / e.h;
  const double s1 = second / (1.0 + strain) / e.h;
  const Vector3 mean =
      -mass * ((after.mean - before.mean) / e.h - 0.5 / length * (s0 + s1) * apart);
  const Vector3 difference =
      -mass / 12.0 * ((after.difference - before.difference) / e.h - (s1 - s0) / length * apart);
  const Vector3 told = span.inertia_mean[0] + span.inertia_mean[1];
  const Vector3 told_difference = span.inertia_difference[0] + span.inertia_difference[1];
  const double off = (mean - told).norm() + (difference - told_difference).norm();
  // Rope that comes off a wheel has another strain than the span.
  const double unsure = 2.0 * strain * mass / length * apart.norm() * (std::abs(s0) + std::abs(s1));
  findings.note(Kind::momentum, "N", off, std::max(told.norm(), span.tension()),
                rounding_of(e, mass, span) + unsure, [&] { return span.name(); });
}

void check_wheel(const Evidence& e, const CableEvidence& cable, const WheelRopeEvidence& wheel,
                 Findings& findings) {
  const auto velocity = [&](End when, End arm) {
    return e.moments[at(when)].velocity(wheel.body, wheel.center[at(when)] + wheel.arm[at(arm)]);
  };
  const Vector3 turn = e.turn_of(wheel.body);
  const double spin = turn.dot(wheel.axle[last_end]) / e.h;
  const Vector3 arm = 0.5 * (wheel.arm[first_end] + wheel.arm[last_end]);
  Vector3 change = velocity(last_end, last_end) - velocity(first_end, first_end);
  const Vector3 moved = wheel.arm[last_end] - wheel.arm[first_end];
  // The arc moves over the wheel; its rope does not.
  const Vector3 w =
      e.rattle ? Vector3(turn / e.h) : e.start.bodies[at(wheel.body)].angular_velocity;
  change -= w.cross(moved);
  const Vector3 force = -wheel.mass * (change / e.h - spin * spin * arm);
  const Vector3 told = wheel.force[0] + wheel.force[1];
  const auto spin_at = [&](End when) {
    const std::vector<BodyState>& states = *e.moments[at(when)].states;
    return states[at(wheel.body)].angular_velocity.dot(wheel.axle[at(when)]);
  };
  const double square = wheel.radius * wheel.radius;
  const double inertia =
      0.5 * wheel.mass *
      (2.0 * square - wheel.arm[first_end].squaredNorm() - wheel.arm[last_end].squaredNorm());
  const double torque = -inertia * (spin_at(last_end) - spin_at(first_end)) / e.h;
  const double off =
      (force - told).norm() + std::abs(torque - wheel.torque[0] - wheel.torque[1]) / wheel.radius;
  double tension = told.norm();
  double strain = 0.0;
  for (const SpanEvidence& span : cable.spans) {
    if (span.from.link != wheel.link && span.to.link != wheel.link) continue;
    tension = std::max(tension, span.tension());
    strain = std::max(strain, span.tension() / *cable.definition->axial_stiffness);
  }
  constexpr double eps = 64.0 * std::numeric_limits<double>::epsilon();
  const double rounded_off =
      eps * wheel.mass * (wheel.center[last_end].norm() + e.bodies.scale()) / (e.h * e.h);
  const double unsure = 2.0 * strain * (force.norm() + std::abs(torque) / wheel.radius);
  findings.note(Kind::momentum, "N", off, tension, rounded_off + unsure, [&] {
    return "link " + std::to_string(wheel.link) + " of \"" + std::string(cable.name) + "\"";
  });
}

/// Directions in which rope comes to a link and leaves it; 0 without a span there.
Vector3 turned_at(const CableEvidence& cable, int link, End when, int& spans) {
  Vector3 turned = Vector3::Zero();
  for (const SpanEvidence& span : cable.spans) {
    if (span.to.link == link) turned += span.direction[at(when)], ++spans;
    if (span.from.link == link) turned -= span.direction[at(when)], ++spans;
  }
  return turned;
}

}  // namespace

void Evidence::collect_rope_inertia(const LastSubstep& last, std::size_t feature) {
  const auto late = last.late_forces.size() > feature
                        ? std::span<const double>(last.late_forces[feature])
                        : std::span<const double>();
  const auto force = parts(end.features[feature].reals, rattle, late);
  const auto vector = [&](End when, std::size_t first) {
    const double* f = force[at(when)].data() + first;
    return Vector3(f[0], f[1], f[2]);
  };
  std::size_t place = 0;
  for (CableEvidence& cable : cables) {
    if (!cable.definition->axial_inertia) continue;
    for (SpanEvidence& span : cable.spans) {
      for (const End when : {first_end, last_end}) {
        const std::size_t first = place + 6 * at(span.place);
        span.inertia_mean[at(when)] = vector(when, first);
        span.inertia_difference[at(when)] = vector(when, first + 3);
      }
    }
    place += 6 * at(cable.definition->span_count());
  }
  for (CableEvidence& cable : cables) {
    if (!cable.definition->axial_inertia) continue;
    for (std::size_t i = 0; i < cable.start.links.size(); ++i) {
      const std::array<const LinkReport*, 2> link{&cable.start.links[i], &cable.end.links[i]};
      if (link[0]->winding == 0) continue;
      const std::size_t first = place;
      place += 4;
      if (cable.start.cut) continue;
      WheelRopeEvidence wheel;
      wheel.body = bodies.index(link[0]->body);
      wheel.link = static_cast<int>(i);
      wheel.radius = link[0]->radius;
      const double density = cable.definition->linear_density;
      wheel.last_mass = density * link[1]->stored_length;
      wheel.mass = 0.5 * (density * link[0]->stored_length + wheel.last_mass);
      for (const End when : {first_end, last_end}) {
        int spans = 0;
        const Vector3 turned = turned_at(cable, wheel.link, when, spans);
        const double stored = link[at(when)]->stored_length;
        wheel.center[at(when)] = link[at(when)]->center;
        wheel.axle[at(when)] = link[at(when)]->normal;
        wheel.arm[at(when)] = Vector3::Zero();
        if (spans == 2 && stored > 0.0) {
          wheel.arm[at(when)] = wheel.radius * wheel.radius / stored * turned;
        }
        wheel.force[at(when)] = vector(when, first);
        wheel.torque[at(when)] = force[at(when)][first + 3];
      }
      cable.wheels.push_back(wheel);
    }
  }
}

void Evidence::apply_rope_inertia() {
  for (const CableEvidence& cable : cables) {
    if (!cable.definition->axial_inertia || cable.has_changed) continue;
    for (const End when : {first_end, last_end}) {
      for (const SpanEvidence& span : cable.spans) {
        const Vector3 half = 0.5 * span.inertia_mean[at(when)];
        const Vector3& apart = span.inertia_difference[at(when)];
        push(when, when, span.from.body, span.from.point[at(when)], half - apart);
        push(when, when, span.to.body, span.to.point[at(when)], half + apart);
      }
      for (const WheelRopeEvidence& wheel : cable.wheels) {
        push(when, when, wheel.body, wheel.center[at(when)] + wheel.arm[at(when)],
             wheel.force[at(when)]);
        twist(when, wheel.body, wheel.torque[at(when)] * wheel.axle[at(when)]);
      }
    }
  }
}

void check_rope_motion(const Evidence& evidence, Findings& findings) {
  for (const CableEvidence& cable : evidence.cables) {
    if (!cable.definition->axial_inertia || cable.has_changed || cable.start.cut) continue;
    for (const SpanEvidence& span : cable.spans) check_span(evidence, cable, span, findings);
    for (const WheelRopeEvidence& wheel : cable.wheels) {
      check_wheel(evidence, cable, wheel, findings);
    }
  }
}

double rope_energy(const Evidence& evidence) {
  double energy = 0.0;
  for (const CableEvidence& cable : evidence.cables) {
    if (!cable.definition->axial_inertia || cable.end.cut) continue;
    for (const SpanEvidence& span : cable.spans) {
      const double mass = cable.definition->linear_density * span.rest_length[last_end];
      const Velocities now = velocities_of(evidence, span, last_end);
      energy += 0.5 * mass * (now.mean.squaredNorm() + now.difference.squaredNorm() / 12.0);
    }
    for (const WheelRopeEvidence& wheel : cable.wheels) {
      const Moment& end = evidence.moments[last_end];
      const Vector3& arm = wheel.arm[last_end];
      const double spin = end.states->at(at(wheel.body)).angular_velocity.dot(wheel.axle[last_end]);
      energy += 0.5 * wheel.last_mass *
                (end.velocity(wheel.body, wheel.center[last_end] + arm).squaredNorm() +
                 (wheel.radius * wheel.radius - arm.squaredNorm()) * spin * spin);
    }
  }
  return energy;
}

}  // namespace sheave::certify
