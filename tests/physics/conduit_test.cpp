// Sheaths between two bodies: motions against closed forms, momentum, energy, and refusals.
//
// A rope without mass or friction has one tension T. A sheath with neither mass nor bending stiffness
// exerts no force, so each of its two bodies feels T along the free span at its end. A body and the
// weight on the span before it are thus a pair without forces from outside, and so are the two others.

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "cable/links/sheath.h"
#include "cable/step_warnings.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

using test::attach;
using test::cable;

std::shared_ptr<SheathLink> conduit(BodyId from, const Vector3& entry, BodyId to,
                                    const Vector3& exit, double length, double bend = 2.0,
                                    double friction = 0.0) {
  auto link = std::make_shared<SheathLink>();
  link->body = from;
  link->exit = to;
  link->points = {entry, exit};
  link->length = length;
  link->bend = bend;
  link->friction = friction;
  return link;
}

/// Two pairs of bodies without gravity: "near" and "far" on a span each, with a conduit between the
/// near ones. Forces that balance the tension T0 act on all four.
struct Pairs {
  static constexpr double stiffness = 2e3;                 // EA [N]
  static constexpr double tension = 20.0;                  // T0 [N]
  static constexpr double length = 1.5;                    // of the conduit [m]
  static constexpr std::array<double, 2> spans{0.7, 0.9};  // [m]
  static constexpr std::array<double, 2> near_masses{2.0, 3.0};
  static constexpr std::array<double, 2> far_masses{1.0, 0.5};
  static constexpr double speed = 0.1;  // of the first far body [m/s]

  StepSettings step;
  Quaternion turned = Quaternion::Identity();
  bool mirrored = false;
  Vector3 mouth = Vector3::Zero();  // of both ends, body frame
  Vector3 spin = Vector3::Zero();   // of the near bodies [rad/s]

  [[nodiscard]] Vector3 way(std::size_t pair) const {
    return turned * (pair == 0 ? Vector3(1.0, 0.0, 0.0) : Vector3(0.2, 0.7, 0.4).normalized());
  }
  [[nodiscard]] test::Machine machine() const {
    test::Machine m;
    m.model.step = step;
    std::array<BodyId, 2> near, far;
    for (const std::size_t i : {0U, 1U}) {
      const Vector3 place = turned * Vector3(i == 0 ? 0.0 : 0.8, 0.0, 0.0);
      BodyDef body = test::lump("near " + std::to_string(i), place, near_masses[i]);
      body.force = tension * -way(i);
      body.angular_velocity = spin;
      BodyDef weight =
          test::lump("far " + std::to_string(i), place + mouth + spans[i] * way(i), far_masses[i]);
      weight.force = tension * way(i);
      if (i == 0) {
        weight.velocity = speed * way(i);
        body.velocity = -speed * far_masses[i] / near_masses[i] * way(i);
      }
      near[i] = m.model.add(body);
      far[i] = m.model.add(weight);
    }
    CableDef rope =
        mirrored ? cable("rope", {attach(far[1]), conduit(near[1], mouth, near[0], mouth, length),
                                  attach(far[0])})
                 : cable("rope", {attach(far[0]), conduit(near[0], mouth, near[1], mouth, length),
                                  attach(far[1])});
    rope.axial_stiffness = stiffness;
    rope.pretension = tension;
    m.cables.push_back(rope);
    return m;
  }
  /// Length of the first span at `time` [m]. With the stretch x of the whole rope, x'' = -w^2 x with
  /// w^2 = k (sum of 1 / m), and x1'' = -w1^2 x for the first span alone.
  [[nodiscard]] static double first_span(double time) {
    const double total = spans[0] + spans[1] + length;
    const double k = stiffness / (total / (1.0 + tension / stiffness));
    const double own = k * (1.0 / near_masses[0] + 1.0 / far_masses[0]);
    const double all = own + k * (1.0 / near_masses[1] + 1.0 / far_masses[1]);
    const double w = std::sqrt(all);
    const double rate = speed * (1.0 + far_masses[0] / near_masses[0]);
    return spans[0] + rate * time - own / all * rate * (time - std::sin(w * time) / w);
  }
};

/// Momentum, and angular momentum about the origin, of a pair.
std::array<Vector3, 2> momenta(const Simulation& s, std::size_t pair) {
  std::array<Vector3, 2> sum{Vector3::Zero(), Vector3::Zero()};
  for (const std::size_t i : {2 * pair, 2 * pair + 1}) {
    const BodyProperties& body = s.world.bodies()[static_cast<int>(i)];
    const BodyState& now = s.world.state().bodies[i];
    const Vector3 momentum = body.mass * now.velocity;
    const Vector3 own = now.orientation.conjugate() * now.angular_velocity;
    sum[0] += momentum;
    sum[1] += now.position.cross(momentum) + now.orientation * Vector3(body.inertia * own);
  }
  return sum;
}

TEST(Conduit, FourBodiesMoveAsOnOneSpring) {
  // w = 49.4/s and a = 0.15 m/s / w is the amplitude of x. The midpoint rule has the frequency error
  // (w h)^2 / 24 to w^2 / 12: at t = 0.3 s a w t (w h)^2 / 12. XPBD damps by w h / 2 per radian.
  // Velocities are differences of positions, whose rounding of 2.2e-16 m makes accelerations of
  // 2.2e-16 m / h^2; masses are 3 kg at most.
  constexpr double time = 0.3;
  constexpr double w = 49.4;
  constexpr double amplitude = 0.15 / w;
  const Quaternion other(Eigen::AngleAxisd(2.0, Vector3(1.0, 2.0, -0.5).normalized()));
  for (const Quaternion& turned : {Quaternion(Quaternion::Identity()), other}) {
    for (const bool mirrored : {false, true}) {
      for (const int substeps : {1, 4, 64}) {
        for (const IntegratorKind integrator : {IntegratorKind::rattle, IntegratorKind::xpbd}) {
          Pairs pairs;
          pairs.turned = turned;
          pairs.mirrored = mirrored;
          pairs.step = test::direct_settings(integrator, 2e-3, substeps);
          Simulation s = test::start(pairs.machine());
          test::run(s.world, time);
          const auto& bodies = s.world.state().bodies;
          const double span = (bodies[1].position - bodies[0].position).norm();
          const double h = 2e-3 / substeps;
          const double wh = w * h;
          const double bound = integrator == IntegratorKind::rattle
                                   ? amplitude * w * time * wh * wh / 12.0
                                   : amplitude * w * time * wh;
          EXPECT_NEAR(span, Pairs::first_span(time), bound + 1e-12)
              << substeps << ' ' << static_cast<int>(integrator);
          for (const std::size_t pair : {0U, 1U}) {
            EXPECT_LT(momenta(s, pair)[0].norm(), 3.0 * time * 2.2e-16 / (h * h));
          }
        }
      }
    }
  }
}

/// Pairs without forces from outside: each far body circles its near one, whose mouth is beside its
/// centre of mass, so that the rope draws them with about T0 all the time. `turn`: 1 or -1.
test::Machine circling_pairs(const StepSettings& step, double turn, bool mirrored) {
  Pairs pairs;
  pairs.step = step;
  pairs.mirrored = mirrored;
  pairs.mouth = {0.1, -0.15, 0.05};
  pairs.spin = turn * Vector3(0.5, -0.3, 0.8);
  test::Machine machine = pairs.machine();
  for (const std::size_t i : {0U, 1U}) {
    const double far = Pairs::far_masses[i];
    const double near = Pairs::near_masses[i];
    const double speed = std::sqrt(Pairs::tension * Pairs::spans[i] * (1.0 / far + 1.0 / near));
    const Vector3 across = turn * speed * pairs.way(i).cross(Vector3(0.3, -0.4, 0.9)).normalized();
    machine.model.bodies[2 * i].velocity = -far / (far + near) * across;
    machine.model.bodies[2 * i + 1].velocity = near / (far + near) * across;
  }
  for (BodyDef& body : machine.model.bodies) body.force = Vector3::Zero();
  return machine;
}

TEST(Conduit, CirclingPairsKeepEnergyAndMomenta) {
  // More than half a turn of each pair in space, while rope runs to and fro through the conduit. The
  // error of the energy is of second order of the step.
  for (const double turn : {1.0, -1.0}) {
    for (const bool mirrored : {false, true}) {
      std::array<double, 3> off{};
      for (std::size_t k = 0; k < off.size(); ++k) {
        const double dt = 2e-3 / static_cast<double>(1U << k);
        Simulation s = test::start(
            circling_pairs(test::direct_settings(IntegratorKind::rattle, dt), turn, mirrored));
        const std::array<std::array<Vector3, 2>, 2> first{momenta(s, 0), momenta(s, 1)};
        const double energy = s.world.energy().total();
        const Vector3 start = s.world.state().bodies[1].position;
        while (s.world.state().time < 0.5 - 1e-9) {
          ASSERT_TRUE(s.world.step().ok());
          off[k] = std::max(off[k], std::abs(s.world.energy().total() - energy));
        }
        EXPECT_GT((s.world.state().bodies[1].position - start).norm(), 0.5);
        for (const std::size_t pair : {0U, 1U}) {
          EXPECT_LT((momenta(s, pair)[0] - first[pair][0]).norm(), 1e-10) << dt;
          EXPECT_LT((momenta(s, pair)[1] - first[pair][1]).norm(), 1e-10) << dt;
        }
        const std::optional<Certificate> certificate = s.certificate();
        ASSERT_TRUE(certificate && certificate->clean(1e-6)) << certificate->worst()->sentence();
      }
      // Terms of fourth order are a tenth of those of second order at 2 ms.
      EXPECT_NEAR(off[0] / off[1], 4.0, 0.8);
      EXPECT_NEAR(off[1] / off[2], 4.0, 0.4);
    }
  }
}

TEST(Conduit, CirclingPairsKeepMomentumWithXpbd) {
  for (const int substeps : {1, 64}) {
    Simulation s = test::start(
        circling_pairs(test::direct_settings(IntegratorKind::xpbd, 2e-3, substeps), 1.0, false));
    const double h = 2e-3 / substeps;
    const std::array<Vector3, 2> first{momenta(s, 0)[0], momenta(s, 1)[0]};
    test::run(s.world, 0.3);
    for (const std::size_t pair : {0U, 1U}) {
      EXPECT_LT((momenta(s, pair)[0] - first[pair]).norm(), 3.0 * 0.3 * 2.2e-16 / (h * h));
    }
  }
}

TEST(Conduit, ToABodyThatStandsIsAsASheathOfTheWorld) {
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    std::array<double, 2> heights{};
    for (const bool between : {false, true}) {
      test::Machine m;
      m.model.gravity = test::down;
      m.model.step = test::direct_settings(integrator, 2e-3);
      BodyDef post = test::lump("post", {0.5, 0.2, 0.0}, 1.0);
      post.mobility = Mobility::fixed;
      const BodyId standing = m.model.add(post);
      const BodyId load = m.model.add(test::weight("load", {1.0, -1.0, 0.0}, 10.0));
      auto sheath =
          conduit(BodyId::world(), {-1.0, 0.0, 0.0}, between ? standing : BodyId::world(),
                  between ? Vector3(0.5, -0.2, 0.0) : Vector3(1.0, 0.0, 0.0), 3.0, 3.0, 0.1);
      CableDef rope =
          cable("rope", {attach(BodyId::world(), {-1.0, -1.0, 0.0}), sheath, attach(load)});
      rope.axial_stiffness = 2e4;
      rope.pretension = 60.0;
      m.cables.push_back(rope);
      Simulation s = test::start(m);
      test::run(s.world, 0.3);
      heights[between ? 1 : 0] = s.world.state().bodies[1].position.y();
    }
    EXPECT_NEAR(heights[0], heights[1], 1e-13);
    EXPECT_GT(std::abs(heights[0] + 1.0), 1e-3);
  }
}

TEST(Conduit, ItsFaultsAreNamed) {
  const auto fault = [](const std::function<void(test::Machine&, SheathLink&)>& change) {
    test::Machine m = Pairs{test::direct_settings(IntegratorKind::rattle, 1e-3)}.machine();
    const auto link =
        std::make_shared<SheathLink>(dynamic_cast<const SheathLink&>(*m.cables[0].links[1]));
    change(m, *link);
    m.cables[0].links[1] = link;
    const auto made = Simulation::create(m.model, m.cables);
    return made ? std::string() : test::text(made.errors());
  };
  EXPECT_EQ(fault([](test::Machine&, SheathLink&) {}), "");
  EXPECT_NE(fault([](test::Machine&, SheathLink& l) { l.length = 0.79; }).find("0.8 m apart"),
            std::string::npos);
  EXPECT_NE(fault([](test::Machine&, SheathLink& l) { l.bend.reset(); }).find("needs length"),
            std::string::npos);
  EXPECT_NE(fault([](test::Machine&, SheathLink& l) {
              l.points.insert(l.points.begin() + 1, Vector3::Zero());
            }).find("two points"),
            std::string::npos);
  EXPECT_NE(fault([](test::Machine&, SheathLink& l) { l.exit = BodyId{9}; }).find("number 9"),
            std::string::npos);
  EXPECT_NE(fault([](test::Machine& m, SheathLink& l) {
              l.exit = m.model.add(test::wheel("wheel", {0.5, 0.0, 0.0}, 0.1, 0.1));
            }).find("rotor \"wheel\""),
            std::string::npos);
}

TEST(Conduit, BodiesFartherApartThanItReachesAreTold) {
  Pairs pairs;
  pairs.step = test::direct_settings(IntegratorKind::rattle, 1e-2);
  test::Machine m = pairs.machine();
  // The second pair flies away with 1 m/s; after 0.7 s it is 1.5 m away.
  for (const std::size_t i : {2U, 3U}) m.model.bodies[i].velocity = {1.0, 0.0, 0.0};
  Simulation s = test::start(m);
  std::vector<Warning> warnings;
  test::run(s.world, 0.6);
  append_cable_warnings(*s.cables, s.world.bodies(), 0.0, warnings);
  EXPECT_TRUE(warnings.empty());
  test::run(s.world, 0.9);
  append_cable_warnings(*s.cables, s.world.bodies(), 0.0, warnings);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].kind, "sheath_too_short");
  EXPECT_NE(warnings[0].message.find("it is 1.5 m long"), std::string::npos) << warnings[0].message;
}

}  // namespace
}  // namespace sheave
