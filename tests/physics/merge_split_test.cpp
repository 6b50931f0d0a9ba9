// Wheels that a cable leaves and touches again.

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "cable/links/hybrid.h"
#include "cable/step_warnings.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

using test::attach;
using test::cable;
using test::g;
using test::left;
using test::right;
using test::roll;

std::shared_ptr<RollingLink> passing(BodyId body, Winding winding) {
  auto link = roll(body, winding);
  link->lifted = true;
  return link;
}

BodyDef peg(std::string name, const Vector3& center, double radius) {
  BodyDef body = test::wheel(std::move(name), center, radius, 0.01);
  body.mobility = Mobility::fixed;
  body.axis.reset();
  return body;
}

/// Galileo's pendulum: a ball on 1 m of cable from the origin that catches on a peg half way down.
struct Pendulum {
  test::Machine machine;
  BodyId ball;
  explicit Pendulum(double h) {
    machine.model.gravity = test::down;
    machine.model.step = test::settings(h, 1, 20);
    const BodyId post = machine.model.add(peg("peg", {0.05, -0.5, 0.0}, 0.05));
    BodyDef body = test::lump("ball", {-std::sin(0.5), -std::cos(0.5), 0.0}, 1.0);
    body.mobility = Mobility::planar;
    ball = machine.model.add(body);
    // On its way down from the origin the cable passes with the peg on its left.
    machine.cables.push_back(
        cable("rope", {attach(BodyId::world()), passing(post, left), attach(ball)}));
  }
};

TEST(MergeSplit, APegBeyondTheEndIsNotTouched) {
  // In the peg's plane the line of the cable goes on through the peg, but the cable ends before it.
  // In space the line's nearest point to the peg's center is within the cable.
  const Vector3 along(0.0, -std::sqrt(0.5), std::sqrt(0.5));
  test::Machine machine;
  machine.model.gravity = g * along;
  machine.model.step = test::direct_settings(IntegratorKind::rattle, 0.01);
  const BodyId post = machine.model.add(peg("peg", {0.19, -0.3, 0.0}, 0.2));
  const BodyId weight = machine.model.add(test::lump("weight", 0.27 * along, 1.0));
  machine.cables.push_back(
      cable("rope", {attach(BodyId::world()), passing(post, left), attach(weight)}));
  Simulation s = test::start(machine);
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(s.world.step().ok());
    const CableReport report = s.cable_reports()[0];
    ASSERT_FALSE(report.links[1].touched) << i;
    ASSERT_NEAR(report.spans[0].tension, g, 1e-12 * g) << i;
    ASSERT_TRUE(s.certificate()->clean()) << i;
  }
}

/// A ball of 1 kg swings on 1 m of elastic cable in a plane beside that of a peg of 0.2 m, whose
/// groove has the distance `aside` from the cable.
Simulation swing_beside_a_peg(double aside, int substeps) {
  test::Machine machine;
  machine.model.gravity = test::down;
  machine.model.step = test::direct_settings(IntegratorKind::rattle, 1.0 / 240.0);
  machine.model.step.substeps = substeps;
  const BodyId post = machine.model.add(peg("peg", {0.2, -0.5, 0.0}, 0.2));
  const Vector3 above(0.0, 0.0, aside);
  const BodyId ball =
      machine.model.add(test::lump("ball", {-std::sin(0.5), -std::cos(0.5), aside}, 1.0));
  CableDef rope =
      cable("rope", {attach(BodyId::world(), above), passing(post, left), attach(ball)});
  rope.axial_stiffness = 1e5;
  machine.cables.push_back(rope);
  return test::start(machine);
}

struct PegPassage {
  double gain = 0.0;  ///< largest energy above that of the start [J]
  bool touched = false;
  std::string warned;  ///< kind of the warnings
};

PegPassage passage_of(Simulation s) {
  PegPassage passage;
  const double energy = s.world.energy().total();
  while (s.world.state().time < 0.8) {
    EXPECT_TRUE(s.world.step().ok());
    passage.gain = std::max(passage.gain, s.world.energy().total() - energy);
    passage.touched |= s.cable_reports()[0].links[1].touched;
  }
  std::vector<Warning> warnings;
  append_cable_warnings(*s.cables, s.world.bodies(), -1.0, warnings);
  for (const Warning& warning : warnings) passage.warned += warning.kind;
  return passage;
}

// In the groove the cable is bent by a (1/l1 + 1/l2) out of the plane, and longer by
// a^2 / 2 (1/l1 + 1/l2) = 20 mm for a = 0.1 m: EA 20 mm^2 / 2 L = 20 J, where a swing of the ball
// has 1.2 J. So the taut cable passes beside the groove. The motion is that of a pendulum, which
// the integrator keeps within (h w)^2 / 24 of m g = 9.81 J, with w = sqrt(EA / m L) = 316 1/s: 0.7 J.
TEST(MergeSplit, ATautCableBesideAGroovePassesIt) {
  const PegPassage passage = passage_of(swing_beside_a_peg(0.1, 4));
  EXPECT_LT(passage.gain, 0.05);
  EXPECT_FALSE(passage.touched);
  EXPECT_EQ(passage.warned, "beside_groove");
}

// At a = 2 mm the spans agree within 0.5 degrees: 8 um, 3e-6 J.
TEST(MergeSplit, ATautCableBesideAGrooveByLittleIsCaught) {
  const PegPassage passage = passage_of(swing_beside_a_peg(0.002, 4));
  EXPECT_LT(passage.gain, 0.05);
  EXPECT_TRUE(passage.touched);
  EXPECT_EQ(passage.warned, "");
}

TEST(MergeSplit, APendulumCatchesOnAPegAndComesFreeAgain) {
  const Pendulum pendulum(0.001);
  Simulation s = test::start(pendulum.machine);
  double energy = s.world.energy().total();
  double highest = -1.0;
  double rise = 0.0;
  for (int i = 0; i < 4000; ++i) {
    ASSERT_TRUE(s.world.step().ok());
    const CableReport report = s.cable_reports()[0];
    ASSERT_EQ(report.length_error, 0.0);
    const double now = s.world.energy().total();
    rise = std::max(rise, now - energy);
    energy = now;
    if (report.links[1].touched) highest = std::max(highest, s.world.position(pendulum.ball).y());
    // The ball stays on its cable: the sum of free lengths and arc is 1 m.
    double length = report.links[1].stored_length;
    for (const SpanReport& span : report.spans) length += span.length;
    EXPECT_NEAR(length, 1.0, 1e-6);
  }
  EXPECT_GE(s.cables->events().size(), 4U);
  EXPECT_EQ(s.cables->events()[0].kind, CableEvent::Kind::touch);
  EXPECT_EQ(s.cables->events()[1].kind, CableEvent::Kind::leave);
  // It rises to the height it came from, but for the integrator's damping.
  EXPECT_NEAR(highest, -std::cos(0.5), 0.01);
  EXPECT_LT(rise, 1e-6 * g);
}

TEST(MergeSplit, AThinPegIsNotPassedWithinASubstep) {
  // The cable moves farther in a substep than the peg is wide, and is clear of it on one side before
  // and on the other behind.
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    for (const double radius : {2e-3, 1e-5}) {
      for (const int substeps : {1, 4, 16}) {
        SCOPED_TRACE(std::to_string(radius) + ' ' + std::to_string(substeps));
        test::Machine m;
        m.model.gravity = test::down;
        m.model.step = test::direct_settings(integrator, 1.0 / 60.0, substeps);
        const BodyId post = m.model.add(peg("peg", {radius, -0.5, 0.0}, radius));
        const BodyId ball =
            m.model.add(test::lump("ball", {-std::sin(0.5), -std::cos(0.5), 0.0}, 1.0));
        m.cables.push_back(
            cable("rope", {attach(BodyId::world()), passing(post, left), attach(ball)}));
        Simulation s = test::start(m);
        double highest = -1.0;
        for (int i = 0; i < 60; ++i) {
          ASSERT_TRUE(s.world.step().ok());
          if (s.cable_reports()[0].links[1].touched) {
            highest = std::max(highest, s.world.position(ball).y());
          }
        }
        EXPECT_EQ(s.cables->events()[0].kind, CableEvent::Kind::touch);
        if (integrator == IntegratorKind::xpbd) continue;  // damps the swing in the first order
        // The ball rises to its first height, less what is lost at the touch: the cable is past the
        // peg by at most v h / 2 there, so it leads the ball by the angle a = v h to the old way,
        // and the part a of the speed is lost: a^2 of the height v^2 / 2 g = 1 m - cos 0.5 m. Frames
        // tell the height within g dt^2 / 8 of the turn.
        const double height = 1.0 - std::cos(0.5);
        const double led = std::sqrt(2.0 * g * height) / (60.0 * substeps);
        EXPECT_NEAR(highest, -std::cos(0.5), 2.0 * led * led * height + g / 28800.0);
      }
    }
  }
}

/// A ball at rest below the origin, and a peg of 1 mm that moves across its cable half way down,
/// by 33 mm in a step.
struct CrossedCable {
  Simulation simulation;
  BodyId peg;
  BodyId ball;
};

CrossedCable crossed(double speed, int substeps) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = test::direct_settings(IntegratorKind::rattle, 1.0 / 60.0, substeps);
  BodyDef thin = peg("peg", {-0.05 * speed, -0.5, 0.0}, 1e-3);
  thin.mobility = Mobility::kinematic;
  thin.velocity = {speed, 0.0, 0.0};
  const BodyId moving = m.model.add(thin);
  const BodyId ball = m.model.add(test::lump("ball", {0.0, -1.0, 0.0}, 1.0));
  const auto over = passing(moving, left);
  over->friction = 0.0;
  m.cables.push_back(cable("rope", {attach(BodyId::world()), over, attach(ball)}));
  return {test::start(m), moving, ball};
}

TEST(MergeSplit, AThinPegThatMovesTakesTheRopeAlong) {
  // `left` puts the peg at x > 0 of the cable that goes down.
  for (const int substeps : {1, 4, 16}) {
    SCOPED_TRACE(substeps);
    CrossedCable c = crossed(-2.0, substeps);
    for (int i = 0; i < 12; ++i) ASSERT_TRUE(c.simulation.world.step().ok());
    const CableReport report = c.simulation.cable_reports()[0];
    EXPECT_TRUE(report.links[1].touched);
    EXPECT_LE(report.length_error, 1e-9);
    // The ball has been lifted by the detour over the peg, which is 0.3 m to the left: both spans
    // together have the length of the cable, less an arc of at most half a turn.
    const Vector3 corner = c.simulation.world.position(c.peg);
    const double way = corner.norm() + (c.simulation.world.position(c.ball) - corner).norm();
    EXPECT_NEAR(way, 1.0, 4e-3);
    EXPECT_NEAR(corner.x(), -0.3, 1e-12);
  }
}

TEST(MergeSplit, AThinPegIsPassedFromTheFarSide) {
  // The peg comes from the side on which its winding has no place for the cable.
  for (const int substeps : {1, 4, 16}) {
    SCOPED_TRACE(substeps);
    CrossedCable c = crossed(2.0, substeps);
    for (int i = 0; i < 12; ++i) ASSERT_TRUE(c.simulation.world.step().ok());
    EXPECT_TRUE(c.simulation.cables->events().empty());
    EXPECT_LE((c.simulation.world.position(c.ball) - Vector3(0.0, -1.0, 0.0)).norm(), 1e-12);
  }
}

TEST(MergeSplit, TensionIsContinuousWhenACableTouches) {
  // Pulled by constant weights over two outer wheels, the cable is pushed up by a wheel that rises
  // slowly below it.
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = test::settings(0.002, 1, 200);
  const BodyId w1 = m.model.add(test::wheel("w1", {-1.0, 0.0, 0.0}, 0.1, 0.001));
  const BodyId w2 = m.model.add(test::wheel("w2", {1.0, 0.0, 0.0}, 0.1, 0.001));
  BodyDef pusher = peg("pusher", {0.0, -0.05, 0.0}, 0.1);
  pusher.mobility = Mobility::kinematic;
  pusher.velocity = {0.0, 0.2, 0.0};
  const BodyId p = m.model.add(pusher);
  const BodyId a = m.model.add(test::weight("a", {-1.1, -3.0, 0.0}, 1.0));
  const BodyId b = m.model.add(test::weight("b", {1.1, -3.0, 0.0}, 1.0));
  m.cables.push_back(
      cable("rope", {attach(a), roll(w1, right), passing(p, right), roll(w2, right), attach(b)}));
  Simulation s = test::start(m);
  double last = g;
  bool touched = false;
  for (int i = 0; i < 400; ++i) {
    ASSERT_TRUE(s.world.step().ok());
    const CableReport report = s.cable_reports()[0];
    ASSERT_EQ(report.length_error, 0.0);
    EXPECT_NEAR(report.spans[1].tension, last, 0.02 * g) << i;
    last = report.spans[1].tension;
    touched = touched || report.links[2].touched;
  }
  EXPECT_TRUE(touched);
  EXPECT_EQ(s.cables->events().size(), 1U);
}

TEST(MergeSplit, AHybridEndBehindALiftedWheelChangesLikeAnyOther) {
  // The weight's cable passes a peg without touching it and unwinds from a wheel until it is used
  // up.
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = test::settings(0.005, 1, 20);
  const BodyId wheel = m.model.add(test::wheel("wheel", Vector3::Zero(), 0.2, 0.02));
  const BodyId post = m.model.add(peg("peg", {0.9, -0.3, 0.0}, 0.05));
  const BodyId weight = m.model.add(test::weight("weight", {0.2, -0.5, 0.0}, 1.0));
  auto end = std::make_shared<HybridLink>();
  end->body = wheel;
  end->winding = left;
  end->stored_length = 0.5;
  m.cables.push_back(cable("rope", {attach(weight), passing(post, right), end}));
  Simulation s = test::start(m);
  for (int i = 0; i < 200 && s.cables->events().empty(); ++i) ASSERT_TRUE(s.world.step().ok());
  ASSERT_EQ(s.cables->events().size(), 1U);
  EXPECT_EQ(s.cables->events()[0].kind, CableEvent::Kind::attach);
  EXPECT_EQ(s.cables->events()[0].link, 2);
  const CableReport report = s.cable_reports()[0];
  EXPECT_FALSE(report.links[1].touched);
  EXPECT_EQ(report.links[2].winding, 0);
  EXPECT_EQ(report.links[2].stored_length, 0.0);
  EXPECT_NEAR(report.spans[0].rest_length, 1.0, 1e-12);
  EXPECT_EQ(report.length_error, 0.0);
  // Wound up again, with the peg still passed by, it moves as if there were no peg.
  m.cables[0].links.erase(m.cables[0].links.begin() + 1);
  Simulation without = test::start(m);
  test::run(without.world, 2.0);
  test::run(s.world, 2.0);
  EXPECT_GE(s.cables->events().size(), 5U);
  EXPECT_EQ(s.cables->events()[1].kind, CableEvent::Kind::wind);
  EXPECT_EQ(s.cables->events().size(), without.cables->events().size());
  EXPECT_NEAR((s.world.position(weight) - without.world.position(weight)).norm(), 0.0, 1e-9);
}

/// Cables through fields of six pegs, above or below the straight line; one end of each shakes up
/// and down, so that it winds the cable onto pegs and off again. What is where, how large and how
/// fast, is random.
test::Machine shaken_cables(int count) {
  std::mt19937 random(20180501);
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
  };
  test::Machine m;
  m.model.gravity = Vector3::Zero();
  m.model.step = test::settings(0.01, 1, 1);  // nothing here answers to a force
  for (int c = 0; c < count; ++c) {
    const std::string number = std::to_string(c);
    CableDef rope = cable("rope" + number, {attach(BodyId::world(), {-1.0, 0.0, 1.0 * c})});
    for (int i = 0; i < 6; ++i) {
      const double radius = between(0.05, 0.15);
      const double side = between(-1.0, 1.0) < 0.0 ? -1.0 : 1.0;
      const Vector3 center(0.4 * i + between(0.0, 0.08), side * (radius + between(0.001, 0.05)), c);
      const BodyId id = m.model.add(peg("peg" + number + std::to_string(i), center, radius));
      rope.links.push_back(passing(id, side > 0.0 ? left : right));
    }
    BodyDef shaker = peg("shaker" + number, {3.0, 0.0, 1.0 * c}, 0.1);
    shaker.mobility = Mobility::kinematic;
    shaker.oscillation = {between(0.0, 0.3), between(0.5, 1.5), 0.0};
    shaker.oscillation_frequency = between(2.0, 5.0);
    shaker.oscillation_phase = between(0.0, 2.0 * pi);
    rope.links.push_back(attach(m.model.add(shaker)));
    rope.compliance = 1e-3;
    m.cables.push_back(rope);
  }
  return m;
}

TEST(MergeSplit, TenThousandRandomEventsLoseNoLength) {
  Simulation s = test::start(shaken_cables(10));
  const auto& events = s.cables->events();
  for (int i = 0; i < 5000 && events.size() < 10000; ++i) ASSERT_TRUE(s.world.step().ok());
  EXPECT_GE(events.size(), 10000U);
  for (const CableReport& report : s.cable_reports())
    EXPECT_LT(std::abs(report.length_error), 1e-12);
  // No storm: a link has at most one event in a substep; and every touch is followed by a leave.
  std::map<std::pair<std::string, int>, const CableEvent*> last;
  for (const CableEvent& event : events) {
    const CableEvent*& before = last[{event.cable, event.link}];
    const bool touched = before != nullptr && before->kind == CableEvent::Kind::touch;
    ASSERT_EQ(event.kind, touched ? CableEvent::Kind::leave : CableEvent::Kind::touch);
    ASSERT_GT(event.time, before != nullptr ? before->time : 0.0) << event.cable << event.link;
    before = &event;
  }
}

TEST(MergeSplit, TouchingASkewOutlineNeverStoresLessThanNothing) {
  // Boxes that tumble up through a cable out of their planes; in these cases the tangents from the
  // corners that they touch with once went back over an edge.
  std::mt19937 random;
  const auto number = [&](double size) {
    return size * (static_cast<double>(random()) / 2147483648.0 - 1.0);
  };
  for (const unsigned seed : {1U, 119U, 223U, 282U, 907U, 1136U, 1968U}) {
    random.seed(seed);
    test::Machine m;
    m.model.step = test::settings(0.005, 1, 10);
    BodyDef body = test::lump("box", {0.0, -0.5, 0.0}, 1.0);
    body.mobility = Mobility::kinematic;
    body.orientation = rotation_by({number(0.5), number(0.5), number(0.5)});
    body.velocity = {0.0, 1.0, 0.0};
    body.angular_velocity = {number(2.0), number(2.0), number(2.0)};
    const BodyId box = m.model.add(body);
    const BodyId post = m.model.add(peg("post", {1.0, 0.1, number(0.3)}, 0.01));
    m.cables.push_back(cable("rope", {attach(BodyId::world(), {-1.0, 0.0, number(0.3)}),
                                      passing(box, right), attach(post)}));
    m.cables[0].compliance = 1e-4;
    Simulation s = test::start(m);
    for (int k = 0; k < 150; ++k) {
      ASSERT_TRUE(s.world.step().ok());
      // A whole edge of the box would be 0.3 m.
      ASSERT_GT(s.cable_reports()[0].links[1].stored_length, -0.1) << seed << ", step " << k;
    }
    EXPECT_FALSE(s.cables->events().empty());
  }
}

TEST(MergeSplit, ACableThatPassesFarOffTheWheelsPlaneDoesNotTouch) {
  // The cable sinks past a peg of 0.1 m radius whose plane is z = 0, in that plane and off it.
  for (const double z : {0.0, 0.05, 0.5, 3.0}) {
    test::Machine m;
    m.model.step = test::settings(0.005, 1, 10);
    const BodyId post = m.model.add(peg("peg", Vector3::Zero(), 0.1));
    BodyDef body = test::lump("carriage", {-1.0, 0.5, z}, 1.0);
    body.mobility = Mobility::kinematic;
    body.velocity = {0.0, -1.0, 0.0};
    const BodyId carriage = m.model.add(body);
    body.name = "other carriage";
    body.position = {1.0, 0.5, z};
    const BodyId other = m.model.add(body);
    m.cables.push_back(cable("rope", {attach(carriage), passing(post, right), attach(other)}));
    m.cables[0].compliance = 1e-4;
    Simulation s = test::start(m);
    for (int k = 0; k < 100; ++k) ASSERT_TRUE(s.world.step().ok());
    EXPECT_EQ(s.cable_reports()[0].links[1].touched, z < 0.1) << z;
  }
}

}  // namespace
}  // namespace sheave
