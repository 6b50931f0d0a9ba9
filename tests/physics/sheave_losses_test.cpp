// Losses of sheaves by their parts (cable/bearing_loss.h): with the share b = bending_loss / 2, the
// arm p = journal_radius x bearing_friction and the load P of the pin, a sheave of radius R at a
// steady speed has
//
//   R (T_out - T_in) = R b (T_in + T_out) + p P,   P = |T_in u_in + T_out u_out + m g|,
//
// where the rope comes in on the one side and goes out on the other. The speed and the forces are
// constant between corners of the drive, so steps are exact but for rounding and the accuracy of 1e-7
// to which bounds of friction follow the tensions.

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "cable/links/spool.h"
#include "cable/reactions.h"
#include "tests/support/builders.h"
#include "tests/support/friction_links.h"
#include "tests/support/sheave_cases.h"

namespace sheave::sheave_losses {
namespace {

using test::attach;
using test::cable;
using test::g;
using test::left;
using test::right;

constexpr double wheel_radius = 0.1;

/// Settings of a link, and of its wheel.
struct Losses {
  double bending = 0.0;
  double friction = 0.0;
  double journal = 0.02;
  double inertia = 0.0;
  double mass = 3.0;  ///< of the wheel; without inertia it does not count

  [[nodiscard]] double share() const { return 0.5 * bending; }
  [[nodiscard]] double arm() const { return journal * friction; }
  [[nodiscard]] Vector3 weight() const {
    return inertia > 0.0 ? Vector3(0, -mass * g, 0) : Vector3(0, 0, 0);
  }
  /// Largest torque of both losses.
  [[nodiscard]] double bound(const Vector3& pull1, const Vector3& pull2) const {
    return wheel_radius * share() * (pull1.norm() + pull2.norm()) +
           arm() * (pull1 + pull2 + weight()).norm();
  }
};

class LossesOfSheaves : public test::SheaveCases {
 protected:
  [[nodiscard]] static test::Machine machine() { return test::SheaveCases::machine(300); }
  /// Of a tension T that accelerates `mass`: 1e-7 of T by the bounds, and the rounding of lengths
  /// of up to 8 m, some 1e-15 of themselves, as a force over h^2.
  [[nodiscard]] static double tolerance(double tension, double mass) {
    return 2e-7 * tension + 1e-13 * mass / (h() * h());
  }
};
INSTANTIATE_TEST_SUITE_P(All, LossesOfSheaves,
                         testing::Combine(testing::ValuesIn(test::combinations),
                                          testing::Values(1, 4, 64)),
                         test::sheave_case_name);

std::shared_ptr<RollingLink> losing(BodyId body, Winding winding, const Losses& losses) {
  auto link = test::roll(body, winding);
  link->bending_loss = losses.bending;
  link->bearing_friction = losses.friction;
  if (losses.friction > 0.0) link->journal_radius = losses.journal;
  return link;
}

BodyDef losing_wheel(std::string name, const Vector3& center, const Losses& losses) {
  BodyDef wheel = test::wheel(std::move(name), center, wheel_radius, 1.0);
  wheel.mass = losses.mass;
  wheel.spin_inertia = losses.inertia;
  return wheel;
}

const std::vector<Losses> kinds{{.bending = 0.04},
                                {.friction = 0.3},
                                {.bending = 0.06, .friction = 0.5},
                                {.bending = 0.04, .inertia = 0.5},
                                {.friction = 0.3, .inertia = 0.5},
                                {.bending = 0.06, .friction = 0.5, .inertia = 0.5, .mass = 60.0}};

/// A load of 100 kg hangs from a sheave at the origin; a drum at `drum` hauls and lowers it.
test::Machine losing_winch(test::Machine m, const Losses& losses, const Vector3& drum_at) {
  m.model.add(test::weight("load", {-wheel_radius, -3, 0}, 100.0));
  m.model.add(losing_wheel("sheave", {0, 0, 0}, losses));
  BodyDef drum = test::wheel("drum", drum_at, wheel_radius, 1.0);
  drum.drive = DriveKind::speed;
  drum.drive_times = {0.0, 0.2, 0.4, 0.6, 0.8, 1.0, 1.2};
  drum.drive_values = {0.0, -3.0, -3.0, 0.0, 3.0, 3.0, 0.0};
  m.model.add(drum);
  auto spool = std::make_shared<SpoolLink>();
  spool->body = {2};
  spool->winding = right;
  spool->stored_length = 3.0;
  m.cables.push_back(cable("rope", {attach({0}), losing({1}, right, losses), spool}));
  return m;
}

struct DriveMoment {
  double time;
  double acceleration;  ///< of the rope towards the drum [m/s2]
  int way;
};
constexpr std::array<DriveMoment, 6> drive_moments{{{0.15, 1.5, 1},
                                                    {0.35, 0.0, 1},
                                                    {0.55, -1.5, 1},
                                                    {0.75, -1.5, -1},
                                                    {0.95, 0.0, -1},
                                                    {1.15, 1.5, -1}}};

TEST_P(LossesOfSheaves, BrakeTheRopeOfAWinch) {
  // Wraps of a right angle and less, of half a turn, and of more.
  const std::array<Vector3, 4> drums{Vector3(0.6, 3, 0), Vector3(2, 0, 0), Vector3(0.1, -2, 0),
                                     Vector3(-1.5, -2, 0)};
  for (const Losses& losses : kinds) {
    for (std::size_t d = 0; d < drums.size(); ++d) {
      // Every second one is counted from the drum.
      for (const bool turned : {d % 2 == 1}) {
        SCOPED_TRACE(testing::Message() << losses.bending << " " << losses.friction << " "
                                        << losses.inertia << " drum " << d << " " << turned);
        test::Machine m = losing_winch(machine(), losses, drums.at(d));
        if (turned) test::count_from_the_other_end(m.cables[0]);
        Simulation s = test::start(m);
        for (const DriveMoment& at : drive_moments) {
          test::run(s.world, at.time);
          const CableReport report = s.cable_reports()[0];
          const std::size_t near = turned ? 1 : 0;
          const SpanReport& at_load = report.spans[near];
          const SpanReport& at_drum = report.spans[1 - near];
          const double load = 100.0 * (g + at.acceleration);
          EXPECT_NEAR(at_load.tension, load, tolerance(load, 100.0));
          const auto pull = [&](const SpanReport& span, bool begins_at_sheave) {
            const Vector3 way = (span.end - span.start).normalized();
            return Vector3(span.tension * (begins_at_sheave ? way : -way));
          };
          const double bound = losses.bound(pull(at_load, turned), pull(at_drum, !turned));
          const double torque = at.way * wheel_radius * (at_drum.tension - at_load.tension) -
                                at.way * losses.inertia * at.acceleration / wheel_radius;
          EXPECT_GT(bound, 0.0);
          EXPECT_NEAR(torque, bound, wheel_radius * tolerance(4.0 * load, 200.0)) << at.time;
          expect_clean(s);
        }
      }
    }
  }
}

TEST_P(LossesOfSheaves, AreTheEfficiencyOfHalfATurn) {
  // (1 - b - k) / (1 + b + k) with k = p / R. Three sheaves in a row, up and down; only sheaves
  // without weight have one ratio for all loads.
  const Losses losses{.bending = 0.06, .friction = 0.5};
  const double loss = losses.share() + losses.arm() / wheel_radius;
  for (const bool parts : {true, false}) {
    test::Machine m = machine();
    m.model.add(test::weight("load", {-wheel_radius, -3, 0}, 100.0));
    CableDef rope = cable("rope", {attach({0})});
    for (int k = 0; k < 3; ++k) {
      const double x = 2.0 * k * wheel_radius;
      const bool over = k % 2 == 0;
      const BodyId wheel = m.model.add(
          losing_wheel("sheave " + std::to_string(k), {x, over ? 1.0 : -1.0, 0}, losses));
      auto link = losing(wheel, over ? right : left, losses);
      if (!parts) {
        link = test::roll(wheel, over ? right : left);
        link->efficiency = (1.0 - loss) / (1.0 + loss);
      }
      rope.links.push_back(link);
    }
    BodyDef drum = test::wheel("drum", {6.0 * wheel_radius, -2, 0}, wheel_radius, 1.0);
    drum.drive = DriveKind::speed;
    drum.drive_times = {0.0, 0.2, 0.4, 0.6, 0.8, 1.0, 1.2};
    drum.drive_values = {0.0, 3.0, 3.0, 0.0, -3.0, -3.0, 0.0};
    auto spool = std::make_shared<SpoolLink>();
    spool->body = m.model.add(drum);
    spool->winding = left;
    spool->stored_length = 3.0;
    rope.links.push_back(spool);
    m.cables.push_back(rope);
    Simulation s = test::start(m);
    for (const DriveMoment& at : drive_moments) {
      test::run(s.world, at.time);
      const std::vector<double> t = test::tensions(s.cable_reports()[0]);
      const double load = 100.0 * (g + at.acceleration);
      for (int k = 0; k <= 3; ++k) {
        const double expected = load * std::pow((1.0 + loss) / (1.0 - loss), at.way * k);
        EXPECT_NEAR(t[static_cast<std::size_t>(k)], expected, tolerance(expected, 200.0))
            << at.time << " s, span " << k;
      }
      expect_clean(s);
    }
  }
}

/// Two weights over a sheave; the second one moves down with `speed`.
struct Pair {
  double m1 = 2.0;
  double m2 = 2.0;
  double speed = 0.0;
  Losses losses;

  /// (m1 + m2 + I / R^2) a = (m2 - m1) g - s (c (T1 + T2) + k W), c = b + k, with the weight W of
  /// the sheave and T1 + T2 = (m1 + m2) g + (m1 - m2) a.
  [[nodiscard]] double acceleration(int way) const {
    const double k = losses.arm() / wheel_radius;
    const double c = way * (losses.share() + k);
    const double weight = losses.weight().norm();
    return ((m2 - m1) * g - c * (m1 + m2) * g - way * k * weight) /
           (m1 + m2 + losses.inertia / (wheel_radius * wheel_radius) + c * (m1 - m2));
  }
  [[nodiscard]] bool starts() const {
    const double k = losses.arm() / wheel_radius;
    return std::abs(m2 - m1) * g >
           (losses.share() + k) * (m1 + m2) * g + k * losses.weight().norm();
  }
  [[nodiscard]] test::Machine added_to(test::Machine m) const {
    for (const int side : {-1, 1}) {
      BodyDef weight = test::weight(side < 0 ? "first" : "second", {side * wheel_radius, -4, 0},
                                    side < 0 ? m1 : m2);
      weight.velocity = {0.0, -side * speed, 0.0};
      m.model.add(weight);
    }
    BodyDef wheel = losing_wheel("sheave", {0, 0, 0}, losses);
    wheel.angular_velocity = {0.0, 0.0, -speed / wheel_radius};
    m.cables.push_back(
        cable("rope", {attach({0}), losing(m.model.add(wheel), right, losses), attach({1})}));
    return m;
  }
};

TEST_P(LossesOfSheaves, BrakeWeightsThatCoastAndHoldThemAtRest) {
  for (const Losses& losses : kinds) {
    for (const auto& [m1, m2, speed] : std::vector<std::array<double, 3>>{{2.0, 2.0, 2.0},
                                                                          {2.0, 2.0, -2.0},
                                                                          {2.0, 2.02, 0.0},
                                                                          {2.0, 6.0, 0.0},
                                                                          {6.0, 2.0, 0.0},
                                                                          {2.0, 1.0, 3.0},
                                                                          {2.0, 1.0, -2.0}}) {
      const Pair w{m1, m2, speed, losses};
      if (losses.mass > 10.0 && speed != 0.0) continue;  // stops within the run
      SCOPED_TRACE(testing::Message() << m1 << " " << m2 << " " << speed << " " << losses.bending
                                      << " " << losses.friction << " " << losses.inertia);
      Simulation s = test::start(w.added_to(machine()));
      constexpr double time = 0.2;
      test::run(s.world, time);
      const int way = speed != 0.0 ? (speed > 0.0 ? 1 : -1) : (m2 > m1 ? 1 : -1);
      const double a = speed != 0.0 || w.starts() ? w.acceleration(way) : 0.0;
      EXPECT_NEAR(-s.world.velocity({1}).y(), speed + a * time, tolerance(g, 1.0));
      const std::vector<double> t = test::tensions(s.cable_reports()[0]);
      EXPECT_NEAR(t[0], m1 * (g + a), m1 * tolerance(g, 1.0));
      EXPECT_NEAR(t[1], m2 * (g - a), m2 * tolerance(g, 1.0));
      expect_clean(s);
      // The loss is R (T2 - T1) - I a / R times the rate of the sheave, the mean of the substep.
      const auto reactions = Reactions::of(s);
      ASSERT_TRUE(reactions.has_value());
      const bool rattle = std::get<0>(GetParam()).rattle();
      const double mean = speed + a * (rattle ? time - 0.5 * h() : time);
      const double torque = wheel_radius * (t[1] - t[0]) - losses.inertia * a / wheel_radius;
      EXPECT_NEAR(reactions->friction(), torque * mean / wheel_radius,
                  1e-4 * (1.0 + std::abs(mean)));
    }
  }
}

// A wheel that no rope presses is braked by p m g alone: w' = -p m g / I.
TEST_P(LossesOfSheaves, AWheelUnderSlackRopeIsBrakedByItsWeight) {
  const Losses losses{.friction = 0.1, .inertia = 0.02, .mass = 2.0};
  test::Machine m = machine();
  BodyDef wheel = losing_wheel("sheave", {0, 0, 0}, losses);
  wheel.angular_velocity = {0, 0, -1.0};
  m.model.add(wheel);
  CableDef rope =
      cable("rope", {attach(BodyId::world(), {-wheel_radius, -1, 0}), losing({0}, right, losses),
                     attach(BodyId::world(), {wheel_radius, -1, 0})});
  rope.rest_lengths = {1.5, 1.5};
  m.cables.push_back(rope);
  Simulation s = test::start(m);
  test::run(s.world, 0.25);
  const double rate = losses.arm() * losses.mass * g / losses.inertia;
  EXPECT_NEAR(s.world.angular_velocity({0}).z(), -1.0 + rate * 0.25, 1e-9);
  expect_clean(s);
}

/// A load that bounces on an elastic rope over a heavy sheave, or swings below one.
test::Machine unsteady(IntegratorKind integrator, int substeps, bool swings, double inertia) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = test::direct_settings(integrator, 0.02, substeps);
  const Losses losses{.bending = 0.02, .friction = 0.5, .inertia = inertia, .mass = 20.0};
  BodyDef first = test::weight("first", {-wheel_radius, -4, 0}, 4.0);
  first.velocity = {0, 2, 0};
  m.model.add(first);
  BodyDef second = test::weight("second", {wheel_radius, -4, 0}, 6.0);
  second.velocity = {0, -2, 0};
  if (swings) {
    second = test::lump("second", {wheel_radius, -3, 0}, 3.0);
    second.mobility = Mobility::planar;
    second.velocity = {1.5, -2, 0};  // across the rope, so that nothing jerks
  }
  m.model.add(second);
  BodyDef wheel = losing_wheel("sheave", {0, 0, 0}, losses);
  wheel.angular_velocity = {0, 0, -2.0 / wheel_radius};
  m.model.add(wheel);
  CableDef rope = cable("rope", {attach({0}), losing({2}, right, losses), attach({1})});
  if (!swings) {
    rope.compliance = 2e-4;
    rope.rest_lengths = {3.99, 3.99};
  }
  m.cables.push_back(rope);
  return m;
}

// The load of the pin changes in size and, below a swinging load, in direction. The error is the
// distance to the limit that Richardson's extrapolation of `rattle` gives. The order between n and
// 4 n substeps is that of the integrator up to the next term of the error: of `xpbd` with 64
// substeps that term is 10 % of the error (the order from 16 to 64 is 0.86), from 64 to 256 a
// quarter of it is left.
TEST(SheaveLosses, HaveTheOrderOfTheIntegrator) {
  for (const bool swings : {false, true}) {
    for (const double inertia : {0.05, 0.0}) {
      if (!swings && inertia == 0.0) continue;  // the sheave sticks and slips: no order
      const auto end = [&](IntegratorKind integrator, int substeps) {
        Simulation s = test::start(unsteady(integrator, substeps, swings, inertia));
        test::run(s.world, 0.4);
        const auto certificate = s.certificate();
        EXPECT_TRUE(certificate && certificate->clean(1e-4))
            << certificate->worst()->sentence() << substeps;
        return s.world.position({1});
      };
      const Vector3 fine = end(IntegratorKind::rattle, 256);
      const Vector3 limit = fine + (fine - end(IntegratorKind::rattle, 128)) / 3.0;
      for (const auto& [integrator, order] :
           {std::pair(IntegratorKind::rattle, 2.0), std::pair(IntegratorKind::xpbd, 1.0)}) {
        const int substeps = integrator == IntegratorKind::rattle ? 16 : 64;
        const double coarse = (end(integrator, substeps) - limit).norm();
        const double error = (end(integrator, 4 * substeps) - limit).norm();
        EXPECT_NEAR(0.5 * std::log2(coarse / error), order, 0.05)
            << swings << " " << inertia << ": " << coarse << ", " << error;
      }
    }
  }
}

// The torque of the pin acts on the carrier in the opposite sense: a frame that floats freely with
// two wheels and a belt keeps its angular momentum. The idler's pin brakes the belt.
TEST_P(LossesOfSheaves, KeepTheAngularMomentumOfAFloatingFrame) {
  for (const double inertia : {0.0, 0.02}) {
    test::Machine m = machine();
    m.model.gravity = Vector3::Zero();
    const BodyId frame = m.model.add(test::lump("frame", {0, 0, 0}, 5.0));
    BodyDef driver = test::sheave("driver", frame, {-0.5, 0, 0}, wheel_radius, 0.2, 0.02);
    driver.angular_velocity = {0, 0, 10.0};
    const BodyId first = m.model.add(driver);
    BodyDef idler = test::sheave("idler", frame, {0.5, 0, 0}, wheel_radius, 0.2, 0.02);
    idler.spin_inertia = inertia;
    idler.angular_velocity = {0, 0, 10.0};
    const BodyId second = m.model.add(idler);
    CableDef belt = cable("belt", {test::roll(first, left),
                                   losing(second, left, {.bending = 0.02, .friction = 0.2})});
    belt.closed = true;
    belt.axial_stiffness = 1e4;
    belt.rest_lengths = {0.99, 0.99};
    m.cables.push_back(belt);
    Simulation s = test::start(m);
    const double before = momentum(s.world).angular.z();
    test::run(s.world, 0.5);
    EXPECT_NEAR(momentum(s.world).angular.z(), before, 1e-8 * std::abs(before)) << inertia;
    EXPECT_LT(s.world.angular_velocity(first).z(), 9.99) << inertia;
    EXPECT_GT(s.world.angular_velocity(frame).z(), 1e-4) << inertia;
  }
}

TEST(SheaveLosses, AreRefusedByName) {
  const auto fault = [](const std::function<void(RollingLink&)>& set, double inertia = 0.1) {
    test::Machine m;
    m.model.add(losing_wheel("sheave", {0, 0, 0}, {.inertia = inertia}));
    auto link = test::roll({0}, right);
    set(*link);
    m.cables.push_back(cable("rope", {attach(BodyId::world(), {-wheel_radius, -1, 0}), link,
                                      attach(BodyId::world(), {wheel_radius, -1, 0})}));
    const auto made = Simulation::create(m.model, m.cables);
    return made ? std::string() : made.errors()[0].path + " " + made.errors()[0].message;
  };
  const auto expect = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  expect(fault([](RollingLink& l) { l.efficiency = 0.9, l.bending_loss = 0.1; }),
         "one number stands for all losses");
  expect(fault([](RollingLink& l) { l.bearing_friction = 0.1; }), "give the radius of the pin");
  expect(fault([](RollingLink& l) { l.journal_radius = 0.1; }), "give a bearing_friction");
  expect(fault([](RollingLink& l) { l.journal_radius = 0.1, l.bearing_friction = 1.5; }),
         "must be less than 0.1 m");
  expect(fault([](RollingLink& l) { l.bending_loss = 1.0; }), "bending_loss");
  expect(fault([](RollingLink& l) { l.bending_loss = -0.1; }), "bending_loss");
  EXPECT_EQ(fault([](RollingLink& l) { l.journal_radius = 0.05, l.bearing_friction = 1.5; }), "");
}

}  // namespace
}  // namespace sheave::sheave_losses
