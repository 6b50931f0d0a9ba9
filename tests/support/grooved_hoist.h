#pragma once
// A load on the rope of a drum with a groove.

#include <algorithm>
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "cable/links/spool.h"
#include "tests/support/builders.h"

namespace sheave::test::grooved {

inline constexpr double turn = 2.0 * pi;
inline constexpr double radius = 0.1;

/// Three turns per layer.
inline std::shared_ptr<SpoolLink> drum(BodyId body, Winding winding, double stored, double lead) {
  auto link = std::make_shared<SpoolLink>();
  link->body = body;
  link->winding = winding;
  link->stored_length = stored;
  link->lead = lead;
  link->turns_per_layer = 3.0;
  link->layer_height = 0.02;
  return link;
}

/// Gives the load, the last body, the speed along its rope with which the rope stays as long as it is:
/// a rope that became taut would take energy.
inline void keep_taut(Machine& m) {
  const CableReport report = start(m).cable_reports()[0];
  const SpanReport& span = report.spans[0];
  const bool reversed = report.links.back().groove.has_value();
  const Vector3 from = reversed ? span.end : span.start;
  const Vector3 to = reversed ? span.start : span.end;
  const Vector3 along = (to - from).normalized();
  const BodyDef& drum = m.model.bodies.front();
  BodyDef& load = m.model.bodies.back();
  const Vector3 end = drum.velocity + drum.angular_velocity.cross(from - drum.position);
  load.velocity += along * along.dot(end - load.velocity);
}

/// How a machine is put into the world; the motion must be the same.
struct Placed {
  Quaternion turned = Quaternion::Identity();
  double mirror = 1.0;    ///< -1: mirrored along the axle
  bool reversed = false;  ///< the cable is counted from the load
  double unit = 1.0;      ///< lengths times this, times by its root
};

/// A load that swings in space on the rope of a drum with spin inertia, at fleet angles of up to
/// some 6 degrees, and unwinds it from the second layer to the first.
struct Hoist {
  Placed placed{};
  double lead = 0.1;
  double inertia = 0.15;
  double stored = 2.6;
  bool layers = true;
  Vector3 throws{0.4, 0.0, 0.3};  ///< initial velocity of the load [m/s]

  [[nodiscard]] Vector3 at(const Vector3& point) const {
    return placed.unit * (placed.turned * Vector3(point.x(), point.y(), placed.mirror * point.z()));
  }
  [[nodiscard]] Machine machine(const StepSettings& step) const {
    Machine m;
    m.model.gravity = placed.turned * test::down;
    m.model.step = step;
    m.model.step.dt *= std::sqrt(placed.unit);
    BodyDef wheel = test::wheel("drum", Vector3::Zero(), placed.unit * radius,
                                inertia * placed.unit * placed.unit);
    wheel.axis = placed.turned * Vector3::UnitZ();
    wheel.orientation = placed.turned;
    const BodyId body = m.model.add(wheel);
    BodyDef load = test::lump("load", at({radius, -2.0, 0.05}), 5.0);
    load.shapes.clear();
    load.inertia = Vector3::Constant(0.1 * placed.unit * placed.unit);
    load.velocity = at(throws) / std::sqrt(placed.unit);
    const BodyId weight = m.model.add(load);
    auto spool = drum(body, placed.reversed ? test::left : test::right, placed.unit * stored,
                      placed.unit * placed.mirror * lead);
    spool->layer_height = placed.unit * 0.02;
    if (!layers) {
      spool->turns_per_layer.reset();
      spool->layer_height.reset();
      // So that the rope begins at z = 0.1 m.
      const double turns = stored / std::hypot(turn * radius, lead);
      spool->groove_start = placed.unit * placed.mirror * (0.1 - lead * turns);
    }
    m.cables.push_back(placed.reversed ? cable("rope", {attach(weight), spool})
                                       : cable("rope", {spool, attach(weight)}));
    keep_taut(m);
    return m;
  }
  /// The load's place, turned and mirrored back.
  [[nodiscard]] Vector3 load(const Simulation& s) const {
    const Vector3 own =
        placed.turned.conjugate() * s.world.state().bodies[1].position / placed.unit;
    return {own.x(), own.y(), placed.mirror * own.z()};
  }
};

inline const LinkReport& link_of(const CableReport& report) {
  return report.links[0].groove ? report.links[0] : report.links.back();
}

inline StepSettings rattle(double h) { return test::direct_settings(IntegratorKind::rattle, h); }

/// Largest change of the energy until `time`.
inline double drift(const Machine& machine, double time, double* unwound = nullptr) {
  Simulation s = test::start(machine);
  const double start = s.world.energy().total();
  double worst = 0.0;
  while (s.world.state().time < time - 1e-9) {
    EXPECT_TRUE(s.world.step().ok());
    // An elastic rope that comes off the drum with another strain loses energy, as on any wheel.
    const double energy = s.world.energy().total() + s.cable_reports()[0].creep_loss;
    worst = std::max(worst, std::abs(energy - start));
  }
  const CableReport report = s.cable_reports()[0];
  EXPECT_EQ(report.length_error, 0.0);
  if (unwound != nullptr) *unwound = link_of(report).groove->wound;
  return worst;
}

}  // namespace sheave::test::grooved
