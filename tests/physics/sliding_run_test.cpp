// Spans between which cable slides: round rings, beside dry friction, and of elastic cables.

#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "cable/certificate.h"
#include "engine/joints/fixed.h"
#include "engine/joints/hinge.h"
#include "engine/joints/slider.h"
#include "engine/shapes/cylinder.h"
#include "tests/support/builders.h"
#include "tests/support/combinations.h"
#include "tests/support/friction_links.h"
#include "tests/support/shapes.h"

namespace sheave::sliding_run {
namespace {

using test::attach;
using test::cable;
using test::eyelet;
using test::g;
using test::left;
using test::post;
using test::right;
using test::tensions;
using test::wrapped;

class SlidingRun : public test::ForEveryCombination {
 protected:
  static test::Machine machine() {
    test::Machine m;
    m.model.gravity = test::down;
    m.model.step = step_settings(0.01, 20);
    return m;
  }
};
INSTANTIATE_TEST_SUITE_P(All, SlidingRun, testing::ValuesIn(test::combinations),
                         test::combination_name);

TEST_P(SlidingRun, RoundARingNotEveryLinkSlides) {
  // Two weights on a ring over a post. The tension comes back to itself round the ring, and is the
  // same on both sides of the smooth hole: what the post gains the rough hole has to lose, so the
  // one of them with the smaller exponent slides and the other one holds.
  test::Machine m = machine();
  m.model.step.dt = 1e-3;
  BodyDef upper = test::lump("upper", {0.4, 1.2, 0}, 2.4);
  BodyDef lower = test::lump("lower", {-0.9, -0.6, 0}, 0.9);
  upper.mobility = lower.mobility = Mobility::planar;
  m.model.add(upper);
  m.model.add(post("post", {-0.8, 0.6, 0}, 0.2));
  m.model.add(lower);
  CableDef ring = cable(
      "ring", {eyelet({0}, {0, 0, 0}, 0.0), wrapped({1}, left, 0.24), eyelet({2}, {0, 0, 0}, 0.3)});
  ring.closed = true;
  m.cables.push_back(ring);
  Simulation s = test::start(m);
  test::run(s.world, 0.005);
  const CableReport report = s.cable_reports()[0];
  const std::vector<double> t = tensions(report);
  const double post_exponent = 0.24 * report.links[1].wrap_angle;
  const double hole_exponent = 0.3 * report.links[2].wrap_angle;
  ASSERT_LT(post_exponent, hole_exponent);
  // Ratios are those of the directions of the start and the middle of a step, in which they turn by
  // v h = 5e-5 rad.
  constexpr double turned = 1e-4;
  ASSERT_GT(t[0], 1.0);
  EXPECT_NEAR(t[2] / t[0], 1.0, 1e-6);
  EXPECT_NEAR(t[1] / t[0], std::exp(post_exponent), turned);
  EXPECT_GT(report.links[1].slip, 0.0);
}

TEST_P(SlidingRun, CableBetweenDryFrictionAndAHoleHasATensionThatHolds) {
  // Sweeps end with either, and the velocities of `rattle` leave open what is redundant
  // (docs/explanation/friction.md).
  if (GetParam().solver != SolverKind::direct || GetParam().rattle()) GTEST_SKIP();
  // A block that dry friction holds, a rough hole in the world, a weight: the block does not move,
  // so nothing slides, and what the first span carries is within the cone of the hole.
  test::Machine m = machine();
  BodyDef block = test::lump("block", {0, 0, 0}, 1.0);
  block.mobility = Mobility::planar;
  m.model.add(block);
  m.model.add(test::weight("weight", {1.0, -1.0, 0}, 2.0));
  auto rail = std::make_shared<SliderJoint>();
  rail->name = "rail";
  rail->body_b = {0};
  rail->axis = Vector3::UnitX();
  rail->travel.friction = 100.0;
  m.model.joints.push_back(rail);
  m.cables.push_back(
      cable("rope", {attach({0}), eyelet(BodyId::world(), {1.0, 0, 0}, 0.3), attach({1})}));
  Simulation s = test::start(m);
  const double held = std::exp(0.3 * 0.5 * pi);
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(s.world.step().ok());
    const std::vector<double> t = tensions(s.cable_reports()[0]);
    EXPECT_NEAR(t[1], 2.0 * g, 1e-6);
    EXPECT_GE(t[0], t[1] / held - 1e-6);
    EXPECT_LE(t[0], t[1] * held + 1e-6);
  }
}

TEST_P(SlidingRun, ASpanThatComesTautTakesTheSlackOfItsNeighbour) {
  // Sweeps have moved the weight before they find that the link slides, and those of `rattle` do not
  // ask links by the impulses of the velocities.
  if (GetParam().solver == SolverKind::gauss_seidel) GTEST_SKIP();
  // The near weight's span is closed, but for 1e-9 m, at the end of the fifth step, when only the
  // velocities of `rattle` ask whether it pulls, while the far one's has 0.5 m to spare: the eyelet
  // bears no difference to a tension of 0, so both go on falling freely.
  test::Machine m = machine();
  m.model.add(test::weight("far", {-0.2, -1.0, 0}, 1.0));
  m.model.add(test::weight("near", {0.2, -1.0, 0}, 2.0));
  CableDef rope =
      cable("rope", {attach({0}), eyelet(BodyId::world(), {0, 0, 0}, 0.3), attach({1})});
  const double fallen = 0.5 * g * 0.05 * 0.05;
  rope.rest_lengths = {std::hypot(0.2, 1.0) + 0.5, std::hypot(0.2, 1.0 + fallen) + 1e-9};
  m.cables.push_back(rope);
  Simulation s = test::start(m);
  constexpr int steps = 20;  // after 0.23 s all is taut
  for (int i = 0; i < steps; ++i) {
    ASSERT_TRUE(s.world.step().ok());
    for (const double tension : tensions(s.cable_reports()[0])) EXPECT_EQ(tension, 0.0) << i;
    const auto certificate = s.certificate();
    ASSERT_TRUE(certificate);
    EXPECT_TRUE(certificate->clean()) << certificate->worst()->sentence();
  }
  EXPECT_NEAR(s.world.state().bodies[0].velocity.y(), -steps * 0.01 * g, 1e-12);
  EXPECT_NEAR(s.world.state().bodies[1].velocity.y(), -steps * 0.01 * g, 1e-12);
}

TEST_P(SlidingRun, SlidingCableHasStrainsInTheRatioOfItsTensions) {
  // Also where these are those of the middle of the step: what a run shares out is stretched in the
  // ratio e^(m a) after every step, over spans of unlike lengths. (With dampers: damped_run_test.cpp.)
  test::Machine m = machine();
  m.model.add(post("post", {0, 0, 0}, 0.2));
  m.model.add(test::weight("light", {-0.2, -1.0, 0}, 1.0));
  m.model.add(test::weight("heavy", {0.2, -3.0, 0}, 4.0));
  CableDef rope = cable("rope", {attach({1}), wrapped({0}, right, 0.2), attach({2})});
  rope.axial_stiffness = 2e4;
  m.cables.push_back(rope);
  Simulation s = test::start(m);
  const double ratio = std::exp(0.2 * pi);
  double slip = 0.0;
  for (int i = 0; i < 30; ++i) {
    ASSERT_TRUE(s.world.step().ok());
    const CableReport report = s.cable_reports()[0];
    const double slipped = report.links[1].slip;
    const bool slides = slipped > slip && i > 3;
    slip = slipped;
    if (!slides) continue;
    const auto strain = [&](std::size_t k) {
      return report.spans[k].length / report.spans[k].rest_length - 1.0;
    };
    // Lengths of 3 m that carry 1e-15 m, of stretches of 1 mm.
    EXPECT_NEAR(strain(1) / strain(0), ratio, 1e-9);
    EXPECT_NEAR(report.spans[1].tension / report.spans[0].tension, ratio, 1e-9);
  }
  EXPECT_GT(slip, 0.1);
}

TEST_P(SlidingRun, TheLinkThatClosesARingIsHeldByItsOwnFriction) {
  // A body draws a springy ring through three rough holes. Its cable comes from both sides over A
  // and C until that from A, which has less friction, needs more than B holds: then it comes over B,
  // too, and C holds. Where A and C alone slide, all spans are one run, whose ends B has to be asked
  // about.
  test::Machine m = machine();
  m.model.gravity.setZero();
  m.model.step.dt = 1e-4;
  BodyDef drawn = test::lump("drawn", {0, 1, 0}, 1.0);
  drawn.mobility = Mobility::planar;
  drawn.velocity = {0, 1, 0};
  m.model.add(drawn);
  const BodyId world = BodyId::world();
  CableDef ring = cable("ring", {eyelet({0}, {0, 0, 0}, 0.0), eyelet(world, {-1, 0, 0}, 0.1),
                                 eyelet(world, {0, -1, 0}, 0.05), eyelet(world, {1, 0, 0}, 0.5)});
  ring.closed = true;
  ring.compliance = 1e-3;
  m.cables.push_back(ring);
  Simulation s = test::start(m);
  test::run(s.world, 0.01);
  const CableReport report = s.cable_reports()[0];
  const std::vector<double> t = tensions(report);
  // Angles change by v h = 1e-4 rad in a step.
  constexpr double turned = 1e-4;
  ASSERT_GT(t[0], 3.0);
  EXPECT_NEAR(t[3] / t[0], 1.0, 1e-9);
  EXPECT_NEAR(t[1] / t[0], std::exp(-0.1 * report.links[1].wrap_angle), turned);
  EXPECT_NEAR(t[2] / t[1], std::exp(-0.05 * report.links[2].wrap_angle), turned);
  EXPECT_LT(std::log(t[3] / t[2]), 0.5 * report.links[3].wrap_angle);
  EXPECT_LT(report.links[1].slip, 0.0);
  EXPECT_LT(report.links[2].slip, 0.0);
  EXPECT_EQ(report.links[3].slip, 0.0);
}

// A ring over two drums of one swing and through two holes, of which none knows whether it slides
// before its neighbours do: changed all at once where they have to, they go round and end where one
// holds ever so much.
TEST(SlidingRing, CyclingLinksAreFoundOneAtATime) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = test::direct_settings(IntegratorKind::rattle, 0.00157);
  m.model.step.iterations = 100;
  const auto drum = [&](const char* name, const Vector3& place, double mass, double radius) {
    BodyDef body = test::lump(name, place, mass);
    body.inertia.reset();
    body.shapes = {{test::make<Cylinder>([&](Cylinder& c) { c.radius = radius, c.length = 0.1; })}};
    return m.model.add(body);
  };
  const BodyId first = drum("first", {1.386, 0, 0}, 0.47, 0.232);
  const BodyId second = drum("second", {0.672, 1.164, 0}, 1.54, 0.155);
  const BodyId upper = m.model.add(test::lump("upper", {-0.519, 0.898, 0}, 2.68));
  BodyDef rail = test::weight("rail", {-1.179, 0, 0}, 1.49);
  rail.axis = Vector3(-0.8, -0.6, 0.0);
  const BodyId slider = m.model.add(rail);
  const BodyId lower = m.model.add(test::lump("lower", {-0.555, -0.961, 0}, 2.28));
  auto hinge = std::make_shared<HingeJoint>();
  hinge->name = "hinge";
  hinge->body_b = first;
  hinge->anchor = {1.357, -0.093, 0.0};
  hinge->axis = Vector3::UnitZ();
  auto weld = std::make_shared<FixedJoint>();
  weld->name = "weld";
  weld->body_a = first;
  weld->body_b = second;
  weld->anchor = {0.705, 1.32, 0.0};
  m.model.joints = {hinge, weld};
  CableDef ring = cable("ring", {wrapped(first, left, 0.145), wrapped(second, left, 0.146),
                                 eyelet(upper, {0, 0, 0}, 0.0), attach(slider), attach(lower),
                                 eyelet(BodyId::world(), {0, 0, 0}, 0.357)});
  ring.closed = true;
  m.cables.push_back(ring);
  Simulation s = test::start(m);
  for (int step = 0; step < 20; ++step) {
    ASSERT_TRUE(s.world.step().ok());
    const CableReport report = s.cable_reports()[0];
    const std::vector<double> t = tensions(report);
    for (const auto& [link, friction] : {std::pair{0, 0.145}, {1, 0.146}, {5, 0.357}}) {
      const auto k = static_cast<std::size_t>(link);
      const double before = t[(k + 5) % 6];
      const double after = t[k];
      // The angle changes by v h / 1 m = 1e-4 rad at most between the halves of a substep.
      const double bound = std::exp(friction * report.links[k].wrap_angle + 1e-4);
      EXPECT_LE(std::max(before, after), bound * std::min(before, after) + 1e-6)
          << "link " << link << " in step " << step;
    }
  }
}

// A load swings and bounces on a rubber rope through a rough hole, over which the rope slides to and
// fro and holds in between. Where it comes to slide on with another strain than it held with, the
// ratio of the strains at the end of a substep can come about by sliding back alone: then it is that
// of their means. Springs have the forces of their strains throughout, to the 1e-6 that rounds which
// end at 1e-10 m leave of stretches of 1e-4 m, and links hold by their bound, to the m v h / r by
// which it changes in a step: 0.2 x 4 m/s x 0.01 s / 1 m.
TEST_P(SlidingRun, RubberRopesSlideToAndFro) {
  if (GetParam().solver != SolverKind::direct) GTEST_SKIP();  // sweeps end with less
  test::Machine m = machine();
  m.model.step.iterations = 100;
  BodyDef swinging = test::lump("swinging", {0.9, -0.5, 0}, 1.0);
  swinging.mobility = Mobility::planar;
  const BodyId load = m.model.add(swinging);
  m.cables.push_back(cable("rope", {attach(BodyId::world(), {-1, 0, 0}),
                                    eyelet(BodyId::world(), {0, 0, 0}, 0.2), attach(load)}));
  m.cables[0].axial_stiffness = 300.0;
  Simulation s = test::start(m);
  double slipped = 0.0;
  int turns = 0;
  int way = 0;
  for (int step = 0; step < 300; ++step) {
    ASSERT_TRUE(s.world.step().ok());
    const Certificate certificate = *s.certificate();
    for (const auto& [kind, most] :
         {std::pair{CertificateItem::Kind::friction, 8e-3}, {CertificateItem::Kind::span, 1e-6}}) {
      const CertificateItem* item = certificate.find(kind);
      ASSERT_NE(item, nullptr);
      EXPECT_LT(item->relative, most) << item->sentence();
    }
    const double slip = s.cable_reports()[0].links[1].slip;
    const int now = slip > slipped ? 1 : slip < slipped ? -1 : way;
    turns += now != way ? 1 : 0;
    way = now;
    slipped = slip;
  }
  EXPECT_GT(turns, 4);
}

// Two springs over a rough hole have the ratio of tensions that the hole carries. Weights without
// gravity let both springs slacken within one substep. The springs give the weights the energy that
// they stored, less that of the friction between the two, in the ratio of their tensions.
TEST(SlidingSprings, SlackenTogetherOverARoughHole) {
  constexpr double stretch = 1e-3;
  constexpr double way = 1.5e-3;
  constexpr double friction = 0.5;
  test::Machine m;
  m.model.gravity = Vector3::Zero();
  m.model.step = test::direct_settings(IntegratorKind::rattle, 0.01);
  const double ratio = std::exp(friction * std::acos(-1.0));
  for (const double length : {1.0, 2.0}) {
    BodyDef weight = test::weight(length < 2.0 ? "near" : "far", {0, -length, 0}, 1.0);
    weight.velocity = {0, way / m.model.step.dt, 0};
    m.model.add(weight);
  }
  m.cables.push_back(
      cable("rope", {attach({0}), eyelet(BodyId::world(), {0, 0, 0}, friction), attach({1})}));
  m.cables[0].compliance = 1e-5;
  m.cables[0].rest_lengths = {1.0 - stretch, 2.0 - stretch / ratio};
  ASSERT_LT(stretch + stretch / ratio, way);
  ASSERT_GT(2.0 * stretch, way);
  Simulation s = test::start(m);
  const Energy before = s.world.energy();
  ASSERT_TRUE(s.world.step().ok());
  const std::vector<CableReport> reports = s.cable_reports();
  for (const SpanReport& span : reports[0].spans) EXPECT_EQ(span.tension, 0.0);
  const double near = s.world.velocity({0}).y() - way / m.model.step.dt;
  const double far = s.world.velocity({1}).y() - way / m.model.step.dt;
  EXPECT_GT(far, 0.0);
  EXPECT_NEAR(near, ratio * far, 1e-12);
  EXPECT_LT(s.world.energy().total(), before.total());
  EXPECT_GT(s.world.energy().total(), before.total() - 0.5 * before.elastic);
  const Certificate certificate = *s.certificate();
  EXPECT_TRUE(certificate.clean(1e-9)) << certificate.worst()->sentence();
}

// The same, but in the mean they pull: with the ratio that the hole carries. At the end both are
// slack, and what is slack does not slide, however long the spans are.
TEST(SlidingSprings, SlackSpringsDoNotSlide) {
  constexpr double stretch = 1e-3;
  constexpr double way = 1.1e-3;
  constexpr double friction = 0.5;
  const double ratio = std::exp(friction * std::acos(-1.0));
  test::Machine m;
  m.model.gravity = Vector3::Zero();
  m.model.step = test::direct_settings(IntegratorKind::rattle, 0.01);
  for (const double length : {0.1, 2.0}) {
    BodyDef weight = test::weight(length < 2.0 ? "near" : "far", {0, -length, 0}, 1.0);
    weight.velocity = {0, way / m.model.step.dt, 0};
    m.model.add(weight);
  }
  m.cables.push_back(
      cable("rope", {attach({0}), eyelet(BodyId::world(), {0, 0, 0}, friction), attach({1})}));
  m.cables[0].compliance = 1.0;
  m.cables[0].rest_lengths = {0.1 - stretch, 2.0 - stretch / ratio};
  Simulation s = test::start(m);
  ASSERT_TRUE(s.world.step().ok());
  const std::vector<CableReport> reports = s.cable_reports();
  const State& state = s.world.state();
  const std::vector<CableReport> means =
      s.cables->report(s.world.bodies(), state, state.features.back(), SpanTensions::multipliers);
  const std::vector<double> pulls = tensions(means[0]);
  EXPECT_GT(pulls[1], 0.0);
  EXPECT_NEAR(pulls[0], ratio * pulls[1], 1e-9 * pulls[0]);
  EXPECT_EQ(reports[0].links[1].slip, 0.0);
  for (const SpanReport& span : reports[0].spans) EXPECT_LT(span.length, span.rest_length);
  const Certificate certificate = *s.certificate();
  EXPECT_TRUE(certificate.clean(1e-6)) << certificate.worst()->sentence();
}

// A weight that flies past below the hole: the angle by which the rope is bent there changes within
// the substep, and the springs, whose forces are the same in both halves of it, have the mean of
// the ratios at its ends.
TEST(SlidingSprings, HaveTheMeanOfTheRatiosOfBothEnds) {
  constexpr double friction = 0.5;
  test::Machine m;
  m.model.gravity = Vector3::Zero();
  m.model.step = test::direct_settings(IntegratorKind::rattle, 0.01);
  BodyDef weight = test::lump("weight", {0, -2.0, 0}, 1.0);
  weight.velocity = {60.0, 0, 0};
  m.model.add(weight);
  m.cables.push_back(cable("rope", {attach(BodyId::world(), {0, -1.0, 0}),
                                    eyelet(BodyId::world(), {0, 0, 0}, friction), attach({0})}));
  m.cables[0].compliance = 0.01;
  m.cables[0].rest_lengths = {0.98, 1.8};
  Simulation s = test::start(m);
  ASSERT_TRUE(s.world.step().ok());
  const double half_turn = std::acos(-1.0);
  const Vector3 place = s.world.position({0});
  const double bent = half_turn - std::atan2(place.x(), -place.y());
  ASSERT_LT(bent, half_turn - 0.2);
  const std::vector<double> pulls = tensions(s.cable_reports()[0]);
  const double ratio = 0.5 * (std::exp(friction * half_turn) + std::exp(friction * bent));
  EXPECT_NEAR(pulls[1], ratio * pulls[0], 1e-9 * pulls[1]);
  const Certificate certificate = *s.certificate();
  EXPECT_TRUE(certificate.clean(1e-6)) << certificate.worst()->sentence();
}

// A ring over posts and rails, of which one is held by a joint: nothing but its links says what the
// span to it carries. In the positions they go round for as often as they may; the impulses of
// `rattle` have to be free to let them slide again.
TEST(SlidingRing, ImpulsesReleaseLinksThatHaveCycled) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = test::direct_settings(IntegratorKind::rattle, 0.001556);
  m.model.step.iterations = 100;
  const auto rail = [&](const char* name, const Vector3& place, double mass, const Vector3& axis) {
    BodyDef body = test::weight(name, place, mass);
    body.axis = axis;
    return m.model.add(body);
  };
  const BodyId first = rail("first", {0.896, 0, 0}, 2.91, {-0.695, 0.719, 0});
  const BodyId upper = m.model.add(post("upper", {0.337, 1.037, 0}, 0.087));
  const BodyId held = rail("held", {-0.763, 0.554, 0}, 1.52, {-0.498, 0.867, 0});
  BodyDef swinging = test::lump("swinging", {-0.999, -0.726, 0}, 1.52);
  swinging.orientation = Quaternion(0.621, 0.0, 0.0, -0.784).normalized();
  swinging.velocity = {-0.8, -0.805, 0};
  const BodyId free = m.model.add(swinging);
  const BodyId lower = m.model.add(post("lower", {0.373, -1.148, 0}, 0.2));
  auto weld = std::make_shared<FixedJoint>();
  weld->name = "weld";
  weld->body_b = held;
  weld->anchor = {-1.0, 0.8, 0.0};
  m.model.joints = {weld};
  const auto over = [](BodyId body, double radius, double friction) {
    auto link = test::roll(body, left);
    if (radius > 0.0) link->radius = radius;
    if (friction > 0.0) link->friction = friction;
    return link;
  };
  auto twice = over(lower, 0.0, 0.117);
  twice->turns = 2;
  CableDef ring =
      cable("ring", {over(first, 0.163, 0.208), over(upper, 0.0, 0.426), over(held, 0.037, 0.0),
                     eyelet(free, {-0.106, -0.145, 0}, 0.263), twice});
  ring.closed = true;
  m.cables.push_back(ring);
  Simulation s = test::start(m);
  for (int step = 0; step < 20; ++step) {
    ASSERT_TRUE(s.world.step().ok());
    const Certificate certificate = *s.certificate();
    const CertificateItem* friction = certificate.find(CertificateItem::Kind::friction);
    ASSERT_NE(friction, nullptr);
    EXPECT_LT(friction->relative, 1e-3) << friction->sentence();
  }
}

// A ring from a post over a smooth hole to a wheel on a hinge, which holds it in two ways at once:
// nothing but friction says how they share the load. In the second half of a substep they share it
// as in the first one, however small the arm of the one is beside that of the other.
TEST(SlidingRing, BothHalvesShareTheLoadEqually) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = test::direct_settings(IntegratorKind::rattle, 0.006777262727830335);
  m.model.step.iterations = 100;
  m.model.add(post("post", {0.6919768024381397, 0, 0}, 0.08016989741667983));
  BodyDef swinging;
  swinging.name = "swinging";
  swinging.position = {-0.3203252210743784, -0.5548195578465556, 0};
  swinging.mass = 0.8191626064024857;
  swinging.shapes = {
      {test::make<Cylinder>([](Cylinder& c) { c.radius = 0.15301414356288062, c.length = 0.1; })}};
  const BodyId body = m.model.add(swinging);
  auto hinge = std::make_shared<HingeJoint>();
  hinge->name = "hinge";
  hinge->body_b = body;
  hinge->anchor = {-0.26827915273838876, -0.7087331747695156, 0};
  hinge->axis = {0, 0, 1};
  m.model.joints = {hinge};
  CableDef ring =
      cable("ring", {wrapped({0}, left, 0.144880817223291), eyelet(BodyId::world(), {0, 0, 0}, 0.0),
                     wrapped(body, left, 0.37676939949640875)});
  ring.closed = true;
  m.cables.push_back(ring);
  Simulation s = test::start(m);
  for (int step = 0; step < 5; ++step) {
    ASSERT_TRUE(s.world.step().ok());
    const Certificate certificate = *s.certificate();
    const CertificateItem* friction = certificate.find(CertificateItem::Kind::friction);
    ASSERT_NE(friction, nullptr);
    EXPECT_LT(friction->relative, 1e-3) << friction->sentence();
  }
}

}  // namespace
}  // namespace sheave::sliding_run
