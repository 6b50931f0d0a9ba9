// Where the geometry of a span has no solution: wheels that overlap or coincide, points inside a
// wheel, spans of no length.
//
// The bodies here move as functions of time, so nothing but the geometry decides about C = rest
// length - length, which the reports show. The gradient of C is a unit force at either end (and on
// the rims), so C changes by at most what the ends move, as long as there is a tangent. Without one
// the length is 0 and the direction of the span turns with the line between the centres: by motion
// / distance, which moves cable by that times the radii. So, in one plane,
//   |dC| <= M (1 + (|q1| + |q2|) / d),
// with M the ends' motion and d the least distance of the centres in the substep; where the centres
// pass each other within M the turn may be anything up to pi.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "tests/property/campaign.h"
#include "tests/support/random.h"

namespace sheave::test {
namespace {

/// Two ends of one span on bodies that move through each other.
struct Encounter {
  Machine machine;
  double radii = 0.0;  ///< sum of the radii [m]
  /// Continuity is asked for where the centres are this times the radii apart; beyond that states
  /// are finite and count.
  double clearance = 0.0;
  double gradient = 1.0;  ///< bound of the gradient of C
};

/// A body with a disc that passes the origin within `miss` at time 0.5 s.
BodyDef passing_body(Random& random, double miss) {
  BodyDef body = lump("", Vector3::Zero(), 1.0);
  body.mobility = Mobility::kinematic;
  const double angle = random.between(0.0, 2.0 * pi);
  body.velocity = random.between(1.0, 3.0) * Vector3(std::cos(angle), std::sin(angle), 0.0);
  body.position = -0.5 * body.velocity + miss * Vector3(-std::sin(angle), std::cos(angle), 0.0);
  body.angular_velocity = Vector3(0.0, 0.0, random.between(-3.0, 3.0));
  return body;
}

Encounter random_encounter(std::uint64_t seed, double tilt, bool boxes) {
  Random random(seed);
  Encounter encounter;
  Machine& m = encounter.machine;
  m.model.step = settings(0.002, 1, 2);
  choose_method(seed, m.model.step);
  CableDef rope;
  rope.name = "rope";
  for (const char* name : {"first", "second"}) {
    // Exactly through the centre at times.
    const double miss = random.chance(0.3) ? 0.0 : random.between(-0.4, 0.4);
    BodyDef body = passing_body(random, miss);
    body.name = name;
    const BodyId id = m.model.add(body);
    const Vector3 skew = random.vector(tilt);
    if (random.chance(0.3)) {
      rope.links.push_back(attach(id));
      continue;
    }
    auto end = roll(id, random.chance(0.5) ? left : right);
    end->center = Vector3::Zero();
    end->normal = rotation_by(skew) * Vector3::UnitZ();
    end->stored_length = 50.0;  // never used up, though a span may run round a wheel many times
    if (!boxes) end->radius = random.between(0.05, 0.4);
    // A box of 0.3 m lies within 0.22 m of its centre.
    encounter.radii += end->radius.value_or(0.22);
    rope.links.push_back(end);
  }
  m.cables.push_back(rope);
  return encounter;
}

Finding encounter_finding(const Encounter& encounter) {
  Result<Simulation> made = Simulation::create(encounter.machine.model, encounter.machine.cables);
  if (!made) return {false, 0.0, 0.0, ""};  // they overlap at time 0
  Simulation& s = *made;
  // Where the wheels would wind more than the span has, its rest length stays 0 and cable slides
  // over them: as much as is told.
  const auto value = [&] {
    const CableReport cable = s.cable_reports()[0];
    const double slid = cable.links[0].slip - cable.links[1].slip;
    return cable.spans[0].rest_length - slid - cable.spans[0].length;
  };
  const auto apart = [&] { return (s.world.position({1}) - s.world.position({0})).norm(); };
  const double h = encounter.machine.model.step.dt;
  Finding worst;
  double before = value();
  double distance = apart();
  bool had = true;
  long without = 0;
  for (int i = 0; i < 500; ++i) {
    if (!s.world.step().ok()) return {true, 1.0, 0.0, "a step fails"};
    const double moved = h * (s.world.velocity({0}) - s.world.velocity({1})).norm();
    const double rims =
        h * encounter.radii *
        std::max(s.world.angular_velocity({0}).norm(), s.world.angular_velocity({1}).norm());
    // The centres move on a straight line relative to each other.
    const double least = std::min(distance, apart()) - moved;
    const double turn = least > 0.0 ? std::min(moved / least, pi) : pi;
    const bool has = s.cable_reports()[0].spans[0].has_tangent;
    if (encounter.clearance == 0.0 || (had && has && least > encounter.clearance * encounter.radii))
      worst.worsen(std::abs(value() - before),
                   encounter.gradient * (moved + rims + encounter.radii * turn) + 1e-13,
                   "step " + std::to_string(i));
    before = value();
    had = has;
    distance = apart();
    without += static_cast<long>(!s.cable_reports()[0].spans[0].has_tangent);
  }
  const auto warnings = s.cables->tangent_warnings();
  const long counted = warnings.empty() ? 0 : warnings[0].substeps;
  if (counted != without) return {true, 1.0, 0.0, "spans without tangent are not counted"};
  return worst;
}

TEST(Degenerate, EncountersOfWheelsInOnePlaneAreContinuousAndCounted) {
  run_campaign("encounters of wheels", {}, [](const Machine&, std::uint64_t seed) {
    return encounter_finding(random_encounter(seed, 0.0, false));
  });
}

// What outlines that overlap have for a tangent is whatever pair of corners the search ends with,
// so C jumps there.
TEST(Degenerate, EncountersOfOutlinesInOnePlaneAreContinuousUntilTheyOverlap) {
  run_campaign("encounters of boxes", {}, [](const Machine&, std::uint64_t seed) {
    Encounter encounter = random_encounter(seed, 0.0, true);
    encounter.clearance = 1.0;
    return encounter_finding(encounter);
  });
}

// The span's ends lie at r / cos b from the axles (cable/span_geometry.h), and b is below 0.6 if
// the centres are 2 (r1 + r2) apart: 1.22 r.
TEST(Degenerate, EncountersOfSkewWheelsAreContinuousAtADistance) {
  run_campaign("encounters of skew wheels", {}, [](const Machine&, std::uint64_t seed) {
    Encounter encounter = random_encounter(seed, 0.3, false);
    encounter.clearance = 2.0;
    encounter.gradient = 1.3;
    return encounter_finding(encounter);
  });
}

// The same with bodies that the cable pulls at. Its row stays exact where there is no tangent
// (SpanGradient.PlanarWithoutATangent), so the encounter makes no energy but what the second order
// of a substep does: less than there was. Not where the centres nearly meet: as they pass, the
// span's end runs round the wheel by up to half a turn at once, and winds that much cable on.
Finding collision_finding(std::uint64_t seed) {
  Machine machine = random_encounter(seed, 0.0, false).machine;
  machine.model.step.iterations = 20;
  machine.cables[0].compliance = 1e-3;
  for (BodyDef& body : machine.model.bodies) body.mobility = Mobility::planar;
  Result<Simulation> made = Simulation::create(machine.model, machine.cables);
  if (!made) return {false, 0.0, 0.0, ""};
  const double energy = made->world.energy().total();
  Finding worst;
  for (int i = 0; i < 500; ++i) {
    const StepReport report = made->world.step();
    if (!report.ok()) {
      // A point that comes into its drum ends the run by name (cable/cable_doubts.cpp).
      const auto is_point = [](const auto& link) { return link->type() == "attachment"; };
      const auto& links = machine.cables[0].links;
      const bool named = report.divergence && report.divergence->message.find(
                                                  "has reached the wheel of") != std::string::npos;
      if (named && std::count_if(links.begin(), links.end(), is_point) == 1) return worst;
      return {true, 1.0, 0.0, "a step fails"};
    }
    const double distance = (made->world.position({1}) - made->world.position({0})).norm();
    if (distance < 0.05) return {false, 0.0, 0.0, ""};
    worst.worsen(made->world.energy().total(), 2.0 * energy, "step " + std::to_string(i));
  }
  return worst;
}

TEST(Degenerate, CollisionsOfWheelsInOnePlaneCreateNoEnergy) {
  run_campaign("collisions of wheels", {},
               [](const Machine&, std::uint64_t seed) { return collision_finding(seed); });
}

}  // namespace
}  // namespace sheave::test
