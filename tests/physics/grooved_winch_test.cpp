// Drums with a helical groove in programs: states, edits, events, warnings, checks, refusals.

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cable/cable_polyline.h"
#include "cable/cable_system.h"
#include "cable/step_warnings.h"
#include "tests/support/checked_run.h"
#include "tests/support/grooved_hoist.h"
#include "tests/support/live.h"

namespace sheave {
namespace {

using test::attach;
using test::cable;
using test::g;
using test::Machine;
using test::grooved::drift;
using test::grooved::drum;
using test::grooved::Hoist;
using test::grooved::radius;
using test::grooved::rattle;
using test::grooved::turn;

TEST(GroovedWinch, IsRestoredBitForBit) {
  Simulation s = test::start(Hoist{}.machine(rattle(4e-3)));
  for (int i = 0; i < 60; ++i) ASSERT_TRUE(s.world.step().ok());
  const State middle = s.world.state();
  for (int i = 0; i < 120; ++i) ASSERT_TRUE(s.world.step().ok());
  const std::uint64_t end = hash(s.world.state());
  ASSERT_TRUE(s.world.restore(middle).empty());
  for (int i = 0; i < 120; ++i) ASSERT_TRUE(s.world.step().ok());
  EXPECT_EQ(hash(s.world.state()), end);
  Simulation other = test::start(Hoist{}.machine(rattle(4e-3)));
  ASSERT_TRUE(other.world.restore(middle).empty());
  for (int i = 0; i < 120; ++i) ASSERT_TRUE(other.world.step().ok());
  EXPECT_EQ(hash(other.world.state()), end);
}

/// A winch that winds 1 m/s of a rope to a load 3 m below.
Machine winch() {
  Machine m;
  m.model.gravity = test::down;
  m.model.step = rattle(0.01);
  BodyDef body = test::wheel("winch", Vector3::Zero(), radius, 0.02);
  body.drive = DriveKind::speed;
  body.drive_values = {10.0};
  const BodyId id = m.model.add(body);
  const BodyId load = m.model.add(test::weight("load", {radius, -8.0, 0.0}, 10.0));
  auto spool = drum(id, test::right, 1.0, 0.3);
  spool->layers = 2;
  spool->most_fleet_angle = 0.05;
  m.cables.push_back(cable("rope", {spool, attach(load)}));
  return m;
}

TEST(GroovedWinch, TellsThatItIsFullAndOfLargeFleetAngles) {
  Simulation s = test::start(winch());
  double largest = 0.0;
  double full_at = 0.0;
  for (int i = 0; i < 450; ++i) {
    ASSERT_TRUE(s.world.step().ok());
    const CableReport report = s.cable_reports()[0];
    largest = std::max(largest, std::abs(report.links[0].groove->fleet_angle));
    if (full_at == 0.0 && report.links[0].wrap_angle > 6.0 * turn) full_at = s.world.state().time;
  }
  ASSERT_EQ(s.cables->events().size(), 1U);
  const CableEvent& event = s.cables->events()[0];
  EXPECT_EQ(event.kind, CableEvent::Kind::full);
  EXPECT_EQ(event.body, "winch");
  // The same length, over the angle.
  EXPECT_NEAR(event.time, full_at, 1e-12);
  std::vector<Warning> warnings;
  append_cable_warnings(*s.cables, s.world.bodies(), -1.0, warnings);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].kind, "fleet_angle");
  EXPECT_GT(largest, 0.05);
  EXPECT_THAT(warnings[0].message, testing::HasSubstr("\"winch\""));
  EXPECT_THAT(warnings[0].message, testing::HasSubstr("2.86 degrees"));
}

TEST(GroovedWinch, WarnsOfNothingWithinItsLimit) {
  Machine m = winch();
  auto spool = drum({0}, test::right, 1.0, 0.3);
  spool->most_fleet_angle = 0.3;
  m.cables[0].links[0] = spool;
  Simulation s = test::start(m);
  for (int i = 0; i < 450; ++i) ASSERT_TRUE(s.world.step().ok());
  std::vector<Warning> warnings;
  append_cable_warnings(*s.cables, s.world.bodies(), -1.0, warnings);
  EXPECT_TRUE(warnings.empty());
  EXPECT_TRUE(s.cables->events().empty());
}

TEST(GroovedWinch, KeepsItsCableWhenItIsWoundOutAndBack) {
  for (const IntegratorKind integrator : {IntegratorKind::rattle, IntegratorKind::xpbd}) {
    Hoist hoist;
    hoist.stored = 0.7;
    Simulation s = test::start(hoist.machine(test::direct_settings(integrator, 1e-3, 4)));
    const double start = s.world.energy().total();
    bool seen_attached = false;
    bool seen_back = false;
    double most = 0.0;
    for (int i = 0; i < 2500; ++i) {
      ASSERT_TRUE(s.world.step().ok());
      const CableReport report = s.cable_reports()[0];
      ASSERT_EQ(report.length_error, 0.0);
      seen_attached = seen_attached || report.links[0].winding == 0;
      seen_back = seen_back || report.links[0].winding == 1;
      most = std::max(most, s.world.energy().total() - start);
    }
    EXPECT_TRUE(seen_attached);
    EXPECT_TRUE(seen_back);
    // As for other drums (tests/physics/wound_out_test.cpp): each end of a rope may cost 1e-3 of the
    // energy, of 5 kg x g x 3 m.
    EXPECT_LT(most, 1e-2 * 5.0 * g * 3.0);
  }
}

// The certificate has the law of the groove by code of its own. It finds a run doubtful in which a
// figure is off by 1 %: that of the way along the axle, lead / 2 pi R, is 1.3 % for 10 % of the lead.
TEST(GroovedWinch, IsCheckedByTheCertificate) {
  for (const IntegratorKind integrator : {IntegratorKind::rattle, IntegratorKind::xpbd}) {
    const StepSettings step = test::direct_settings(integrator, 2e-3);
    const Certificate all = test::checked_run(Hoist{}.machine(step), 1.2);
    EXPECT_TRUE(all.clean(1e-3)) << all.worst()->sentence();
    for (const auto& [lead, height] : {std::pair{0.11, 0.02}, {-0.1, 0.02}, {0.1, 0.022}}) {
      Machine m = Hoist{}.machine(step);
      Simulation s = test::start(m);
      auto other = drum({0}, test::right, 2.6, lead);
      other->layer_height = height;
      m.cables[0].links[0] = other;
      s.cable_definitions = std::make_shared<const std::vector<CableDef>>(m.cables);
      RunCheck check(s);
      for (int i = 0; i < 100; ++i) {
        const StepReport report = s.step();
        check.observe(s, report.statistics, i == 99);
      }
      EXPECT_FALSE(check.certificate().clean()) << check.certificate().worst()->sentence();
    }
  }
}

TEST(GroovedWinch, WindsElasticRopeByItsStretchedLength) {
  Hoist hoist;
  const auto error = [&](double h) {
    Machine m = hoist.machine(rattle(h));
    m.cables[0].axial_stiffness = 5e4;
    m.cables[0].pretension = 20.0;
    return drift(m, 0.6);
  };
  // A span of 2 m vibrates with 70 rad/s.
  EXPECT_LT(error(5e-4), 1e-4 * 5.0 * g * 2.0);
  EXPECT_GT(error(1e-3) / error(2.5e-4), 8.0);
  Machine m = hoist.machine(rattle(1e-3));
  m.cables[0].axial_stiffness = 5e4;
  m.cables[0].pretension = 500.0;
  const CableReport report = test::start(m).cable_reports()[0];
  // The rope on the drum has the strain, too: 1 %, and the place of the rope is that of its arc.
  EXPECT_NEAR(report.links[0].stored_stretch, 0.01 * 2.6, 1e-12);
  EXPECT_NEAR(report.spans[0].length / report.spans[0].rest_length, 1.01, 1e-13);
}

// The line on the drum begins at the groove's start, ends where the free rope leaves, and is as long as
// the stored rope. Where layers change, its slope lengthens it by up to (0.02 m / pi)^2 / 2r per radian,
// 0.6 mm; its chords are shorter than their arcs by a third of tolerance / radius.
TEST(GroovedWinch, IsDrawnAlongItsGroove) {
  for (const bool reversed : {false, true}) {
    Hoist hoist;
    hoist.placed.reversed = reversed;
    const Simulation s = test::start(hoist.machine(rattle(1e-3)));
    const CableReport report = s.cable_reports()[0];
    const std::size_t link = reversed ? 1 : 0;
    std::vector<Vector3> line(5000);
    line.resize(link_polyline(report, link, {.tolerance = 1e-6}, line));
    if (reversed) std::reverse(line.begin(), line.end());
    double length = 0.0;
    for (std::size_t k = 1; k < line.size(); ++k) length += (line[k] - line[k - 1]).norm();
    EXPECT_NEAR(length, 2.6, 1e-3);
    EXPECT_GT(length, 2.6 * (1.0 - 1e-5));
    EXPECT_NEAR(line.front().z(), -0.15, 1e-12);
    EXPECT_NEAR(std::hypot(line.front().x(), line.front().y()), 0.1, 1e-12);
    const Vector3 leaves = reversed ? report.spans[0].end : report.spans[0].start;
    EXPECT_NEAR(line.back().z(), leaves.z(), 1e-12);
    EXPECT_NEAR(std::hypot(line.back().x(), line.back().y()), 0.12, 1e-12);
    // Off its helix by some degrees, the rope has climbed a flank by less than a millimetre.
    EXPECT_LT((line.back() - leaves).norm(), 1e-3);
    double farthest = -1.0;
    for (const Vector3& point : line) farthest = std::max(farthest, point.z());
    EXPECT_NEAR(farthest, 0.15 - 0.1 / 8.0, 1e-4);
  }
}

TEST(GroovedWinch, GoesOnAfterEdits) {
  const Machine m = Hoist{}.machine(rattle(4e-3));
  LiveWorld plain = test::live(m);
  LiveWorld world = test::live(m);
  test::advance(plain, 150);
  test::advance(world, 60);
  const CableHandle rope = *world.cable("rope");
  test::edit(world, [](Edit& e) { e.add(test::weight("another", {0.5, -1.0, 0.0}, 1.0)); });
  test::advance(world, 90);
  const Vector3 expected = plain.pose(*plain.body("load"))->position;
  EXPECT_LT((world.pose(*world.body("load"))->position - expected).norm(), 1e-10);
  EXPECT_EQ(*world.length(rope), *plain.length(*plain.cable("rope")));
  // A load that is tied on elsewhere takes rope with it. The contact moves by some tenths of a radian,
  // and the rope along the drum by lead / 2 pi times that.
  test::edit(world, [&](Edit& e) {
    e.detach(rope, CableEnd::last);
    e.attach(rope, CableEnd::last, e.id(*world.body("another")), Vector3::Zero());
  });
  test::advance(world, 20);
  EXPECT_EQ(*world.length(rope), *plain.length(*plain.cable("rope")));
}

/// The message with which a machine is refused.
std::string refusal(const std::function<void(SpoolLink&)>& change,
                    const std::function<void(Machine&)>& more = {}) {
  Machine m = winch();
  auto spool = drum({0}, test::right, 1.0, 0.3);
  change(*spool);
  m.cables[0].links[0] = spool;
  if (more) more(m);
  const Result<Simulation> made = Simulation::create(m.model, m.cables);
  return made ? "" : test::text(made.errors());
}

TEST(GroovedWinch, RefusesByName) {
  using testing::HasSubstr;
  const auto none = [](SpoolLink&) {};
  EXPECT_EQ(refusal(none), "");
  EXPECT_THAT(refusal([](SpoolLink& s) { s.layer_pitch = 0.01; }),
              HasSubstr("links/0/layer_pitch"));
  EXPECT_THAT(refusal([](SpoolLink& s) { s.layer_height.reset(); }),
              HasSubstr("links/0/layer_height"));
  EXPECT_THAT(refusal([](SpoolLink& s) { s.turns_per_layer.reset(); }),
              HasSubstr("one layer without end"));
  EXPECT_THAT(refusal([](SpoolLink& s) {
                s.lead.reset();
                s.turns_per_layer.reset();
                s.layer_height.reset();
                s.layers = 2;
              }),
              HasSubstr("links/0/layers"));
  EXPECT_THAT(refusal([](SpoolLink& s) {
                s.layers = 1;
                s.stored_length = 3.0;
              }),
              HasSubstr("hold 2.0"));
  EXPECT_THAT(refusal([](SpoolLink& s) { s.turns_per_layer = 0.5; }),
              HasSubstr("links/0/turns_per_layer"));
  EXPECT_THAT(refusal(none,
                      [](Machine& m) {
                        m.cables[0].linear_density = 1.0;
                        m.cables[0].axial_stiffness = 1e6;
                      }),
              HasSubstr("leave lead and turns_per_layer out"));
  EXPECT_THAT(refusal(none,
                      [](Machine& m) {
                        m.cables[0].strain_table = {0.0, 0.1};
                        m.cables[0].tension_table = {0.0, 1000.0};
                      }),
              HasSubstr("wound in one plane"));
  EXPECT_THAT(
      refusal(none, [](Machine& m) { m.cables[0].tangent_update = TangentUpdate::substep; }),
      HasSubstr("tangent_update"));
  EXPECT_THAT(refusal(none,
                      [](Machine& m) {
                        BodyDef post = test::wheel("post", {3.0, 0.0, 0.0}, 0.1, 1.0);
                        post.mobility = Mobility::fixed;
                        post.axis.reset();
                        post.wrappable = true;
                        m.model.add(post);
                      }),
              HasSubstr("most_wraps"));
}

}  // namespace
}  // namespace sheave
