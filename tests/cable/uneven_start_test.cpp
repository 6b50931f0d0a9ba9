// Rest lengths that give an elastic rope several tensions where it passes freely: the start has one
// tension and the same length of rope (cable/cable_compile_strain.cpp).
//
// Tolerances. Lengths are rounded to 2^-50 of the rope, 1e-15, and strains of 1e-2 to 1e-13 of
// themselves. Energies of `rattle` have an error of h^2, which the test of the order uses.

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "cable/start_warnings.h"
#include "tests/support/builders.h"
#include "tests/support/friction_links.h"

namespace sheave {
namespace {

using test::attach;
using test::cable;
using test::eyelet;

constexpr double uneven_stiffness = 2e4;  // EA [N]

/// A bead of 20 kg on a rope between two points of the world, each sqrt(5) / 2 m away.
test::Machine bead(std::vector<double> rest_lengths, double friction = 0.0) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = test::direct_settings(IntegratorKind::rattle, 1.0 / 240.0);
  const BodyId body = m.model.add(test::weight("bead", {0.0, -0.5, 0.0}, 20.0));
  m.cables.push_back(cable(
      "rope", {attach(BodyId::world(), {-1.0, 0.0, 0.0}), eyelet(body, Vector3::Zero(), friction),
               attach(BodyId::world(), {1.0, 0.0, 0.0})}));
  m.cables[0].axial_stiffness = uneven_stiffness;
  m.cables[0].rest_lengths = std::move(rest_lengths);
  return m;
}

std::vector<double> start_lengths_of(const Simulation& s) {
  const CableReport report = s.cable_reports()[0];
  std::vector<double> lengths;
  for (const SpanReport& span : report.spans) lengths.push_back(span.rest_length);
  return lengths;
}

std::vector<Warning> uneven_warnings(const Simulation& s) {
  std::vector<Warning> warnings;
  append_uneven_warnings(s, warnings);
  return warnings;
}

const double uneven_side = std::sqrt(1.25);

TEST(UnevenStart, HasTheEnergyOfOneStrain) {
  const std::vector<double> given{uneven_side, uneven_side / 1.095};
  const double rest = given[0] + given[1];
  const double strain = 2.0 * uneven_side / rest - 1.0;
  const Simulation s = test::start(bead(given));
  for (const double length : start_lengths_of(s)) EXPECT_NEAR(length, 0.5 * rest, 1e-14);
  const double energy = 0.5 * uneven_stiffness * strain * strain * rest;
  EXPECT_NEAR(s.world.energy().elastic, energy, 1e-10 * energy);
  const std::vector<Warning> warnings = uneven_warnings(s);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].kind, "uneven_start");
  EXPECT_EQ(warnings[0].subject.substr(0, 5), "rope.");
}

TEST(UnevenStart, MovesAsTheEvenRopeAndKeepsItsEnergyToSecondOrder) {
  const std::vector<double> given{uneven_side, uneven_side / 1.095};
  const double rest = given[0] + given[1];
  std::vector<double> drifts;
  for (const int substeps : {2, 4, 8}) {
    test::Machine uneven = bead(given);
    test::Machine even = bead({0.5 * rest, 0.5 * rest});
    uneven.model.step.substeps = even.model.step.substeps = substeps;
    Simulation one = test::start(uneven);
    Simulation other = test::start(even);
    const double energy = one.world.energy().total();
    double drift = 0.0;
    for (int i = 0; i < 60; ++i) {
      ASSERT_TRUE(one.world.step().ok() && other.world.step().ok());
      EXPECT_NEAR(one.world.position({0}).y(), other.world.position({0}).y(), 1e-12);
      drift = std::max(drift, std::abs(one.world.energy().total() - energy));
    }
    drifts.push_back(drift);
  }
  EXPECT_NEAR(drifts[0] / drifts[1], 4.0, 0.8);
  EXPECT_NEAR(drifts[1] / drifts[2], 4.0, 0.8);
}

TEST(UnevenStart, HasOneStretchWithACompliance) {
  // Spans of 3 m, 1 m and 2 m with 0.3 m less rope than that: each is stretched by 0.1 m.
  for (const bool reversed : {false, true}) {
    test::Machine m;
    const double second = reversed ? 2.0 : 3.0;
    m.cables.push_back(cable(
        "rope",
        {attach(BodyId::world()), eyelet(BodyId::world(), {second, 0.0, 0.0}),
         eyelet(BodyId::world(), {second, 1.0, 0.0}), attach(BodyId::world(), {5.0, 1.0, 0.0})}));
    m.cables[0].compliance = 1e-4;
    m.cables[0].rest_lengths =
        reversed ? std::vector<double>{2.0, 1.0, 2.7} : std::vector<double>{2.7, 1.0, 2.0};
    const std::vector<double> lengths = start_lengths_of(test::start(m));
    EXPECT_NEAR(lengths[0], second - 0.1, 1e-14);
    EXPECT_NEAR(lengths[1], 0.9, 1e-14);
    EXPECT_NEAR(lengths[2], 5.0 - second - 0.1, 1e-14);
  }
}

TEST(UnevenStart, AShortSpanOfAComplianceIsStretchedWholly) {
  // 3 m and 0.05 m with 2.85 m of rope: a stretch of 0.1 m each is more than the second span has.
  test::Machine m;
  m.cables.push_back(
      cable("rope", {attach(BodyId::world()), eyelet(BodyId::world(), {3.0, 0.0, 0.0}),
                     attach(BodyId::world(), {3.05, 0.0, 0.0})}));
  m.cables[0].compliance = 1e-4;
  m.cables[0].rest_lengths = {2.8, 0.05};
  const std::vector<double> lengths = start_lengths_of(test::start(m));
  EXPECT_NEAR(lengths[0], 2.85, 1e-14);
  EXPECT_NEAR(lengths[1], 0.0, 1e-14);
}

TEST(UnevenStart, SlackOfASpanGoesToAStretchedOne) {
  const Simulation s = test::start(bead({uneven_side / 1.05, uneven_side * 1.1}));
  // A stretch by rounding, 1e-15 m.
  EXPECT_LT(s.world.energy().elastic, 1e-24);
  const std::vector<double> lengths = start_lengths_of(s);
  EXPECT_NEAR(lengths[0], uneven_side, 1e-14);
  EXPECT_NEAR(lengths[0] + lengths[1], uneven_side * (1.0 / 1.05 + 1.1), 1e-14);
}

TEST(UnevenStart, ARingHasOneStrain) {
  test::Machine m;
  CableDef ring = cable("rope", {eyelet(BodyId::world()), eyelet(BodyId::world(), {3.0, 0.0, 0.0}),
                                 eyelet(BodyId::world(), {3.0, 4.0, 0.0})});
  ring.closed = true;
  ring.axial_stiffness = uneven_stiffness;
  ring.rest_lengths = {3.0, 3.9, 4.98};
  m.cables.push_back(ring);
  const std::vector<double> lengths = start_lengths_of(test::start(m));
  const double ratio = (3.0 + 3.9 + 4.98) / 12.0;
  EXPECT_NEAR(lengths[0], 3.0 * ratio, 2e-14);
  EXPECT_NEAR(lengths[1], 4.0 * ratio, 2e-14);
  EXPECT_NEAR(lengths[2], 5.0 * ratio, 2e-14);
}

TEST(UnevenStart, FrictionDampersAndEvenRopesKeepTheirLengths) {
  const std::vector<double> given{uneven_side, uneven_side / 1.01};
  test::Machine rough = bead(given, 0.3);
  test::Machine damped = bead(given);
  damped.cables[0].damping = 10.0;
  const test::Machine even = bead({uneven_side / 1.01, uneven_side / 1.01});
  for (const test::Machine& m : {rough, damped, even}) {
    const Simulation s = test::start(m);
    const std::vector<double> lengths = start_lengths_of(s);
    for (std::size_t k = 0; k < 2; ++k) EXPECT_NEAR(lengths[k], m.cables[0].rest_lengths[k], 1e-14);
    EXPECT_TRUE(uneven_warnings(s).empty());
  }
}

}  // namespace
}  // namespace sheave
