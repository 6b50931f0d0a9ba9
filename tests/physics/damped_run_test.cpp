// Damped elastic cables over a link with friction: every span has a damper of its own
// (cable/cable_damping.cpp).

#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "cable/certificate.h"
#include "tests/support/builders.h"
#include "tests/support/combinations.h"
#include "tests/support/friction_links.h"

namespace sheave::damped_run {
namespace {

using test::attach;
using test::cable;
using test::eyelet;
using test::g;
using test::post;
using test::right;
using test::wrapped;

/// A cable of two spans, 1 m and 3 m long, over a rough eyelet; nothing but the cable moves.
struct Creep {
  static constexpr double stiffness = 1e8;  ///< EA [N]: strains of 1e-7, so lengths are constants
  static constexpr double damping = 2e6;    ///< [N s/m]
  static constexpr double first_length = 1.0;
  static constexpr double second_length = 3.0;
  static constexpr double friction = 0.3;
  static constexpr double first_strain = 4e-7;  ///< at time 0
  static constexpr double second_strain = 1e-7;

  /// k e^(m a) of the eyelet: the cable runs along y on both sides of it, bent by half a turn.
  static double ratio() { return std::exp(friction * test_pi); }
  static constexpr double test_pi = 3.14159265358979323846;

  /// With e_i + t_i e_i' = k_i T / EA, t_i = b L_i / EA and e1 L1 + e2 L2 = X the first strain
  /// comes to k X / (k L1 + L2) as exp(-t / tau).
  static double final_strain() {
    const double whole = first_strain * first_length + second_strain * second_length;
    return ratio() * whole / (ratio() * first_length + second_length);
  }
  static double time_constant() {
    return damping / stiffness * first_length * second_length * (1.0 + ratio()) /
           (second_length + ratio() * first_length);
  }
  static double strain_at(double time) {
    return final_strain() + (first_strain - final_strain()) * std::exp(-time / time_constant());
  }

  static test::Machine machine(const StepSettings& step) {
    test::Machine m;
    m.model.step = step;
    CableDef rope = cable("rope", {attach(BodyId::world(), {0, -first_length, 0}),
                                   eyelet(BodyId::world(), {0, 0, 0}, friction),
                                   attach(BodyId::world(), {0, -second_length, 0})});
    rope.axial_stiffness = stiffness;
    rope.damping = damping;
    rope.rest_lengths = {first_length / (1.0 + first_strain),
                         second_length / (1.0 + second_strain)};
    m.cables.push_back(rope);
    return m;
  }
};

double strain(const SpanReport& span) { return span.length / span.rest_length - 1.0; }

class DampedRun : public test::ForEveryCombination {};
INSTANTIATE_TEST_SUITE_P(All, DampedRun, testing::ValuesIn(test::combinations),
                         test::combination_name);

TEST_P(DampedRun, CreepsToRestOverARoughEyelet) {
  // The closed form, to the order of the integrator.
  const double end = 0.5 * Creep::time_constant();
  const auto error = [&](int steps) {
    Simulation s = test::start(Creep::machine(step_settings(end / steps, 20)));
    for (int i = 0; i < steps; ++i) EXPECT_TRUE(s.world.step().ok());
    return strain(s.cable_reports()[0].spans[0]) - Creep::strain_at(end);
  };
  const double coarse = error(5);
  const double fine = error(10);
  const double order = GetParam().rattle() ? 2.0 : 1.0;
  // The next term of the error is h / tau = 0.1 of it.
  EXPECT_NEAR(std::log2(coarse / fine), order, 0.1);
  // Implicit Euler: of exp(-t / tau) the share h t / (2 tau^2), 1/40 of it at the end; the midpoint
  // rule (h / tau)^2 t / (12 tau), 1/2400.
  const double left = (Creep::first_strain - Creep::final_strain()) * std::exp(-0.5);
  EXPECT_LT(std::abs(coarse), (GetParam().rattle() ? 4.5e-4 : 2.6e-2) * left);
}

TEST_P(DampedRun, EndsWhereTheSpringsAloneBalance) {
  Simulation s = test::start(Creep::machine(step_settings(0.1 * Creep::time_constant(), 20)));
  for (int i = 0; i < 400; ++i) ASSERT_TRUE(s.world.step().ok());
  const CableReport report = s.cable_reports()[0];
  // Lengths of 3 m in quanta of 1e-15 of them, of stretches of 1e-7 m.
  EXPECT_NEAR(strain(report.spans[0]) / Creep::final_strain(), 1.0, 1e-6);
  EXPECT_NEAR(report.spans[0].tension / report.spans[1].tension, Creep::ratio(), 1e-6);
  EXPECT_NEAR(report.spans[0].tension / (Creep::stiffness * Creep::final_strain()), 1.0, 1e-6);
}

TEST_P(DampedRun, HasTheRatioOfTheBoundWhileSliding) {
  Simulation s = test::start(Creep::machine(step_settings(0.05 * Creep::time_constant(), 20)));
  double slip = 0.0;
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(s.world.step().ok());
    const CableReport report = s.cable_reports()[0];
    ASSERT_LT(report.links[1].slip, slip);
    slip = report.links[1].slip;
    EXPECT_NEAR(report.spans[0].tension / report.spans[1].tension, Creep::ratio(), 1e-9);
    const auto certificate = s.certificate();
    ASSERT_TRUE(certificate);
    EXPECT_TRUE(certificate->clean()) << certificate->worst()->sentence();
  }
}

/// A light and a heavy weight over `round`, with spans of unlike lengths and dampers, g of 0.5 to 7.
/// While the rope slides T / EA = e + g (e - e0), of `rattle` at the middle of the step, and the
/// tensions have the ratio of the bound. Returns the length that has slipped, to and fro [m].
double slide_over(const BodyDef& round, const StepSettings& step, bool rattle) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = step;
  m.model.add(round);
  m.model.add(test::weight("light", {-0.2, -1.0, 0}, 1.0));
  m.model.add(test::weight("heavy", {0.2, -3.0, 0}, 4.0));
  CableDef rope = cable("rope", {attach({1}), wrapped({0}, right, 0.2), attach({2})});
  rope.axial_stiffness = 2e4;
  rope.damping = 40.0;
  m.cables.push_back(rope);
  Simulation s = test::start(m);
  const double ratio = std::exp(0.2 * Creep::test_pi);
  const double h = step.dt / step.substeps;
  CableReport before = s.cable_reports()[0];
  double slip = 0.0;
  for (int i = 0; i < 100; ++i) {
    EXPECT_TRUE(s.world.step().ok());
    const CableReport now = s.cable_reports()[0];
    const double passed = now.links[1].slip - before.links[1].slip;
    slip += std::abs(passed);
    if (passed != 0.0 && i > 3) {
      const double bound = passed > 0.0 ? ratio : 1.0 / ratio;
      EXPECT_NEAR(now.spans[1].tension / now.spans[0].tension, bound, 1e-9);
      for (const std::size_t k : {0U, 1U}) {
        // Before cable passes a span is as long as it was at the start.
        const double length = before.spans[k].rest_length;
        const double share = rope.damping * length / (*rope.axial_stiffness * h);
        const double e0 = strain(before.spans[k]);
        const double e1 = strain(now.spans[k]);
        const double mean = rattle ? 0.5 * (e0 + e1) : e1;
        // Rounds end at residuals of 1e-10 of the scene's size, 4 m here, and rounding is below 1e-9
        // of the tension.
        const double residual = 4e-10 * *rope.axial_stiffness * (1.0 + share) / length;
        EXPECT_NEAR(*rope.axial_stiffness * (mean + share * (e1 - e0)), now.spans[k].tension,
                    residual + 1e-9 * now.spans[k].tension);
      }
    }
    const auto certificate = s.certificate();
    EXPECT_TRUE(certificate && certificate->clean()) << certificate->worst()->sentence();
    before = now;
  }
  return slip;
}

TEST_P(DampedRun, EachSpanHasItsOwnDamperWhileSliding) {
  const double slip =
      slide_over(post("post", {0, 0, 0}, 0.2), step_settings(1e-3, 200), GetParam().rattle());
  EXPECT_GT(slip, 0.01);
}

TEST_P(DampedRun, AWheelThatTurnsUnderTheRopeMovesNoDamper) {
  // The wheel follows the rope at a half of its acceleration or less, or turns against it.
  for (const double speed : {0.0, 2.0, -5.0}) {
    SCOPED_TRACE(speed);
    BodyDef wheel = test::wheel("wheel", {0, 0, 0}, 0.2, 1.0);
    wheel.angular_velocity = {0.0, 0.0, speed};
    EXPECT_GT(slide_over(wheel, step_settings(1e-3, 200), GetParam().rattle()), 0.005);
  }
}

TEST_P(DampedRun, ALinkThatSlidAndHoldsLeavesItsSpansTheirStrains) {
  // A load draws a rope over a wheel, whose rim comes up with the rope after some slip. From then on
  // the wheel turns with the rope, so the rope does not slide on: the wheel's rim has the speed at
  // which the short span behind it gets longer.
  for (const double h : {4e-3, 1e-3, 1e-4}) {
    SCOPED_TRACE(h);
    test::Machine m;
    m.model.gravity = test::down;
    m.model.step = step_settings(h, 200);
    const BodyId wheel = m.model.add(test::wheel("wheel", {0, 0, 0}, 0.15, 0.0086));
    const BodyId load = m.model.add(test::weight("load", {0.15, -5.0, 0}, 2.8));
    CableDef rope = cable("rope", {attach(BodyId::world(), {-0.15, -0.25, 0}),
                                   wrapped(wheel, right, 0.385), attach(load)});
    rope.axial_stiffness = 424.0;
    rope.damping = 15.6;
    m.cables.push_back(rope);
    Simulation s = test::start(m);
    for (int i = 0; i < std::lround(0.1 / h); ++i) ASSERT_TRUE(s.world.step().ok());
    const double slip = s.cable_reports()[0].links[1].slip;
    const double before = s.cable_reports()[0].spans[0].rest_length;
    const double turned = s.world.angular_velocity(wheel).z();
    for (int i = 0; i < std::lround(0.02 / h); ++i) {
      ASSERT_TRUE(s.world.step().ok());
      EXPECT_EQ(s.cable_reports()[0].links[1].slip, slip);
    }
    const SpanReport span = s.cable_reports()[0].spans[0];
    const double given = (before - span.rest_length) / 0.02 * (1.0 + strain(span));
    const double rim = -0.15 * 0.5 * (turned + s.world.angular_velocity(wheel).z());
    // The mean of both ends is the mean speed of 20 ms to 3 %.
    EXPECT_NEAR(rim, given, 0.03 * given);
  }
}

TEST_P(DampedRun, CableOnAPostCreepsWithItsSpans) {
  // Two spans of the length L and a post between them. All of the cable has the time constant
  // tau = b L / EA, T / EA = e + tau e', and on the post T falls as e^(-m phi). The whole stretch X
  // does not change, so T is constant, and each part comes to its last stretch as exp(-t / tau).
  constexpr double stiffness = 1e8;  // strains of 1e-7, so lengths are constants
  constexpr double damping = 2e6;
  constexpr double length = 2.0;
  constexpr double radius = 0.2;
  constexpr double tau = damping * length / stiffness;
  const double exponent = 0.3 * Creep::test_pi;
  const double end = 0.5 * tau;
  struct Parts {
    double span = 0.0;
    double arc = 0.0;
  };
  const auto parts = [](const Simulation& s) {
    const CableReport report = s.cable_reports()[0];
    return Parts{report.spans[0].length - report.spans[0].rest_length,
                 report.links[1].stored_stretch};
  };
  const auto error = [&](int steps) {
    test::Machine m;
    m.model.step = step_settings(end / steps, 20);
    m.model.add(post("post", {0, 0, 0}, radius));
    CableDef rope =
        cable("rope", {attach(BodyId::world(), {-radius, -length, 0}), wrapped({0}, right, 0.3),
                       attach(BodyId::world(), {radius, -length, 0})});
    rope.axial_stiffness = stiffness;
    rope.damping = damping;
    rope.rest_lengths = {length / (1.0 + 4e-7), length / (1.0 + 1e-7)};
    m.cables.push_back(rope);
    Simulation s = test::start(m);
    const Parts first = parts(s);
    // Stretch of the first span when all is at rest, and that of the cable on the post.
    const double on_post = radius * Creep::test_pi * -std::expm1(-exponent) / exponent;
    const double whole = first.span + 1e-7 * length + first.arc;
    const double last = whole / (length + on_post + length * std::exp(-exponent));
    for (int i = 0; i < steps; ++i) EXPECT_TRUE(s.world.step().ok());
    const Parts now = parts(s);
    const auto at_end = [&](double from, double to) { return to + (from - to) * std::exp(-0.5); };
    return Parts{now.span - at_end(first.span, last * length),
                 now.arc - at_end(first.arc, last * on_post)};
  };
  const Parts coarse = error(5);
  const Parts fine = error(10);
  // The next term of the error is h / tau = 0.1 of it.
  const double order = GetParam().rattle() ? 2.0 : 1.0;
  EXPECT_NEAR(std::log2(coarse.span / fine.span), order, 0.1);
  EXPECT_NEAR(std::log2(coarse.arc / fine.arc), order, 0.1);
}

TEST_P(DampedRun, ALinkThatBeginsToSlideStretchesItsArcInTime) {
  // A weight and a block on a massless wheel begin at rest with unstrained cable. Soon the cable
  // slides over the post between them, at any length of the substep.
  const auto height = [&](int substeps) {
    test::Machine m;
    m.model.gravity = test::down;
    m.model.step = step_settings(1.0 / 60.0, 50);
    m.model.step.substeps = substeps;
    m.model.add(post("post", {0, 0, 0}, 0.1));
    m.model.add(test::weight("weight", {-0.1, -2.5, 0}, 15.8));
    const BodyId block = m.model.add(test::weight("block", {0.2, -2.9, 0}, 20.0));
    BodyDef sheave = test::sheave("sheave", block, {0.2, -2.9, 0}, 0.1, 0.1, 1e-3);
    sheave.spin_inertia = 0.0;
    const BodyId wheel = m.model.add(sheave);
    CableDef rope =
        cable("rope", {attach({1}), wrapped({0}, right, 0.1), test::roll(wheel, test::left),
                       attach(BodyId::world(), {0.3, 1.0, 0})});
    rope.axial_stiffness = 8e4;
    rope.damping = 72.0;
    m.cables.push_back(rope);
    Simulation s = test::start(m);
    for (int i = 0; i < 18; ++i) {
      EXPECT_TRUE(s.world.step().ok());
      const auto certificate = s.certificate();
      // The tension of `rattle` is the mean of a substep. In the one before the cable begins to slide
      // it may be beyond the bound by half of its change, 1.4 % here with 256 substeps.
      const double trust = GetParam().rattle() ? 0.02 : 0.01;
      EXPECT_TRUE(certificate && certificate->clean(trust)) << certificate->worst()->sentence();
    }
    return s.world.position(block).y();
  };
  const double fine = height(256);
  // The block rises by 16 mm. Errors of the first order are at most 1.3e-4 m with 4 substeps, and
  // fall to a sixteenth with 64.
  EXPECT_NEAR(height(4), fine, 2e-4);
  EXPECT_NEAR(height(64), fine, 4e-5);
  EXPECT_NEAR(fine, -2.9 + 0.01598, 5e-5);
}

TEST_P(DampedRun, SpansBesideALinkThatHoldsRelaxSeparately) {
  // m x'' = m g - EA x / L - b x' on either side, of a light weight: it comes down within the time
  // constants b L / EA of 20 and 60 ms.
  constexpr double mass = 1e-3;
  constexpr double stiffness = 100.0;
  constexpr double damping = 2.0;
  const auto exact = [&](double length, double time) {
    const double frequency = stiffness / (length * mass);
    const double drag = 0.5 * damping / mass;
    const double root = std::sqrt(drag * drag - frequency);
    const double slow = drag - root;
    const double fast = drag + root;
    const double rest = g / frequency;
    return rest *
           (1.0 - (fast * std::exp(-slow * time) - slow * std::exp(-fast * time)) / (fast - slow));
  };
  constexpr double end = 0.03;
  const auto stretches = [&](int steps) {
    test::Machine m;
    m.model.gravity = test::down;
    m.model.step = step_settings(end / steps, 50);
    m.model.add(test::weight("near", {0, -1.0, 0}, mass));
    m.model.add(test::weight("far", {0, -3.0, 0}, mass));
    CableDef rope =
        cable("rope", {attach({0}), eyelet(BodyId::world(), {0, 0, 0}, 5.0), attach({1})});
    rope.axial_stiffness = stiffness;
    rope.damping = damping;
    m.cables.push_back(rope);
    Simulation s = test::start(m);
    test::run(s.world, end);
    EXPECT_EQ(s.cable_reports()[0].links[1].slip, 0.0);
    return std::vector<double>{-1.0 - s.world.position({0}).y(), -3.0 - s.world.position({1}).y()};
  };
  const std::vector<double> coarse = stretches(200);
  const std::vector<double> fine = stretches(400);
  for (const std::size_t k : {0U, 1U}) {
    const double length = k == 0 ? 1.0 : 3.0;
    const double right_one = exact(length, end);
    const double order = GetParam().rattle() ? 2.0 : 1.0;
    EXPECT_NEAR(std::log2((coarse[k] - right_one) / (fine[k] - right_one)), order, 0.1) << k;
    // h b / m = 0.03 and, at the end, h / tau < 0.01.
    EXPECT_NEAR(coarse[k], right_one, (GetParam().rattle() ? 1e-4 : 1e-2) * right_one) << k;
  }
}

TEST_P(DampedRun, WithConstantComplianceTheTensionIsConstantDuringCreep) {
  // Dampers of equal springs: x1 comes to k X / (1 + k) in the time a b of either, and the tension
  // has its last value from the start, since x1 + a b x1' is constant.
  constexpr double compliance = 1e-3;
  constexpr double damping = 20.0;
  constexpr double tau = compliance * damping;
  const double k = Creep::ratio();
  const auto run = [&](double h, int steps) {
    test::Machine m = Creep::machine(step_settings(h, 20));
    CableDef& rope = m.cables[0];
    rope.axial_stiffness.reset();
    rope.compliance = compliance;
    rope.damping = damping;
    rope.rest_lengths = {Creep::first_length - 0.04, Creep::second_length - 0.01};
    Simulation s = test::start(m);
    for (int i = 0; i < steps; ++i) EXPECT_TRUE(s.world.step().ok());
    return s.cable_reports()[0];
  };
  const double final_stretch = k * 0.05 / (1.0 + k);
  const CableReport report = run(0.05 * tau, 20);
  EXPECT_NEAR(report.spans[0].tension, final_stretch / compliance, 1e-9);
  EXPECT_NEAR(report.spans[1].tension, final_stretch / compliance / k, 1e-9);
  const double stretch = report.spans[0].length - report.spans[0].rest_length;
  // Exactly what the rule makes of exp(-1).
  const double factor = GetParam().rattle() ? (1.0 - 0.025) / (1.0 + 0.025) : 1.0 / 1.05;
  EXPECT_NEAR(stretch, final_stretch + (0.04 - final_stretch) * std::pow(factor, 20), 1e-9);
}

TEST_P(DampedRun, ADamperOfASlackSpanDoesNotPull) {
  // The weight falls 0.1 m before the cable is taut, and no sooner is there a tension.
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = step_settings(1e-3, 20);
  m.model.add(test::weight("weight", {0, -1.0, 0}, 1.0));
  CableDef rope = cable("rope", {attach(BodyId::world()), attach({0})});
  rope.compliance = 1e-4;
  rope.damping = 500.0;
  rope.rest_lengths = {1.1};
  m.cables.push_back(rope);
  Simulation s = test::start(m);
  bool pulled = false;
  for (int i = 0; i < 200; ++i) {
    ASSERT_TRUE(s.world.step().ok());
    const SpanReport span = s.cable_reports()[0].spans[0];
    pulled = pulled || span.tension > 0.0;
    // `rattle` has the mean over the step, which may be one of its end.
    const bool slack = span.length < span.rest_length && !GetParam().rattle();
    EXPECT_TRUE(!slack || span.tension == 0.0);
    const auto certificate = s.certificate();
    ASSERT_TRUE(certificate);
    EXPECT_TRUE(certificate->clean()) << certificate->worst()->sentence();
  }
  EXPECT_TRUE(pulled);
}

}  // namespace
}  // namespace sheave::damped_run
