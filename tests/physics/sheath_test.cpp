// Ropes in sheaths: loops of hysteresis and motions against a fine chain of places with friction,
// which is solved here by bisection; energy; mirrored, turned and other solvers; refusals.

#include "cable/links/sheath.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "cable/links/pinhole.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

using test::attach;
using test::cable;

constexpr double sheath_stiffness = 2e4;  // EA [N]

std::shared_ptr<SheathLink> sheath_between(const Vector3& entry, const Vector3& exit, double length,
                                           double bend, double friction) {
  auto link = std::make_shared<SheathLink>();
  link->points = {entry, exit};
  link->length = length;
  link->bend = bend;
  link->friction = friction;
  return link;
}

/// A rope in a sheath as a chain of places with Coulomb friction; the spans beside it have given
/// lengths. The tensions are found by bisection of the two conditions.
class FineRope {
 public:
  FineRope(std::size_t count, double length, double exponent, double tension)
      : pulls_(count, std::log(tension)),
        length_(length),
        exponent_(exponent),
        content_(content(pulls_, 0, count)) {}
  double rest_before = 0.0;  ///< of the spans [m]
  double rest_behind = 0.0;

  /// Tensions at both ends for these lengths of the spans [m]; the places follow.
  std::pair<double, double> pull(double before, double behind) {
    double first = 0.0;
    double second = 0.0;
    // Alternately, since each side depends on the other one only where fronts meet.
    const double most = 1e6;
    double t2 = std::exp(pulls_.back());
    for (int round = 0; round < 40; ++round) {
      first = root(most, [&](double t) { return lack_before(t, t2, before); });
      const double old = t2;
      t2 = second = root(most, [&](double t) { return lack_behind(first, t, behind); });
      if (std::abs(t2 - old) < 1e-13 * t2) break;
    }
    const double ratio = std::log(second / first);
    if (std::abs(ratio) > exponent_) {
      const double rise = ratio > 0.0 ? exponent_ : -exponent_;
      first = root(most, [&](double t) {
        const double other = t * std::exp(rise);
        return before / (1.0 + t / sheath_stiffness) + behind / (1.0 + other / sheath_stiffness) +
               content(limited(t, other), 0, pulls_.size()) - content(pulls_, 0, pulls_.size()) -
               rest_before - rest_behind;
      });
      second = first * std::exp(rise);
    }
    pulls_ = limited(first, second);
    rest_before = before / (1.0 + first / sheath_stiffness);
    rest_behind = behind / (1.0 + second / sheath_stiffness);
    return {first, second};
  }

 private:
  template <class Function>
  static double root(double high, Function lack) {
    double low = 1e-9;
    for (int i = 0; i < 60 && high - low > 1e-13 * high; ++i) {
      const double middle = 0.5 * (low + high);
      (lack(middle) > 0.0 ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }
  [[nodiscard]] double place(std::size_t i) const {
    return (static_cast<double>(i) + 0.5) / static_cast<double>(pulls_.size());
  }
  [[nodiscard]] std::vector<double> limited(double first, double second) const {
    std::vector<double> now = pulls_;
    const double a = std::log(first);
    const double b = std::log(second);
    for (std::size_t i = 0; i < now.size(); ++i) {
      const double t = place(i);
      now[i] = std::clamp(now[i], a - exponent_ * t, a + exponent_ * t);
      now[i] = std::clamp(now[i], b - exponent_ * (1.0 - t), b + exponent_ * (1.0 - t));
    }
    return now;
  }
  [[nodiscard]] double content(const std::vector<double>& pulls, std::size_t from,
                               std::size_t to) const {
    double sum = 0.0;
    for (std::size_t i = from; i < to; ++i)
      sum += 1.0 / (1.0 + std::exp(pulls[i]) / sheath_stiffness);
    return sum * length_ / static_cast<double>(pulls.size());
  }
  /// The first place that rope from the exit has reached, or all places if no rope slides there.
  [[nodiscard]] std::size_t divide(double first, double second) const {
    const std::vector<double> from_entry = [&] {
      std::vector<double> now = pulls_;
      for (std::size_t i = 0; i < now.size(); ++i) {
        const double reach = exponent_ * place(i);
        now[i] = std::clamp(now[i], std::log(first) - reach, std::log(first) + reach);
      }
      return now;
    }();
    if (std::abs(std::log(second / first)) > exponent_) {
      for (std::size_t i = pulls_.size(); i-- > 0;) {
        if (from_entry[i] != pulls_[i]) return i + 1;
      }
      return 0;
    }
    const std::vector<double> both = limited(first, second);
    for (std::size_t i = pulls_.size(); i-- > 0;) {
      if (both[i] == from_entry[i]) return i + 1;
    }
    return 0;
  }
  double lack_before(double first, double second, double length) const {
    const std::size_t middle = divide(first, second);
    return length / (1.0 + first / sheath_stiffness) - rest_before +
           content(limited(first, second), 0, middle) - content(pulls_, 0, middle);
  }
  double lack_behind(double first, double second, double length) const {
    const std::size_t middle = divide(first, second);
    const std::size_t end = pulls_.size();
    return length / (1.0 + second / sheath_stiffness) - rest_behind +
           content(limited(first, second), middle, end) - content(pulls_, middle, end);
  }

  std::vector<double> pulls_;
  double length_;
  double exponent_;
  double content_ = 0.0;
};

struct SheathScene {
  double friction = 0.1;
  double bend = pi;
  double length = 3.0;
  double pretension = 60.0;
  bool mirrored = false;
  Quaternion turned = Quaternion::Identity();
  StepSettings step = test::direct_settings(IntegratorKind::rattle, 1e-3);

  /// A weight of 10 kg on a rope that runs through a sheath in the world to a fixed end.
  [[nodiscard]] test::Machine machine() const {
    test::Machine machine;
    machine.model.step = step;
    machine.model.gravity = turned * test::down;
    BodyDef weight = test::weight("weight", turned * Vector3(1.0, -1.0, 0.0), 10.0);
    weight.axis = turned * Vector3::UnitY();
    const BodyId body = machine.model.add(weight);
    const Vector3 left = turned * Vector3(-1.0, 0.0, 0.0);
    const Vector3 right = turned * Vector3(1.0, 0.0, 0.0);
    const auto anchor = attach(BodyId::world(), turned * Vector3(-1.0, -1.0, 0.0));
    CableDef rope =
        mirrored
            ? cable("rope",
                    {attach(body), sheath_between(right, left, length, bend, friction), anchor})
            : cable("rope",
                    {anchor, sheath_between(left, right, length, bend, friction), attach(body)});
    rope.axial_stiffness = sheath_stiffness;
    rope.pretension = pretension;
    machine.cables.push_back(rope);
    return machine;
  }
};

std::pair<double, double> end_tensions(const Simulation& simulation) {
  const CableReport report = simulation.cable_reports()[0];
  return {report.spans[0].tension, report.spans[1].tension};
}

/// Both ends of the rope are fixed, and rope is fed at the first one.
test::Machine fed_sheath(double friction, double bend) {
  test::Machine machine;
  machine.model.step = test::direct_settings(IntegratorKind::xpbd, 0.01);
  machine.model.add(test::weight("aside", {9.0, 0.0, 0.0}, 1.0));
  auto mouth = attach(BodyId::world(), {-1.0, -1.0, 0.0});
  mouth->feed_speed = 0.0;
  CableDef rope =
      cable("rope", {mouth, sheath_between({-1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 3.0, bend, friction),
                     attach(BodyId::world(), {1.0, -1.0, 0.0})});
  rope.axial_stiffness = sheath_stiffness;
  rope.pretension = 400.0;
  machine.cables.push_back(rope);
  return machine;
}

TEST(Sheath, RunsThroughTenReversalsAsAFineChainOfFriction) {
  // 600 places: the midpoint rule over cells with a kink misses X / 8 / 600^2 of the stretch of the
  // sheath per kink, 1e-7, which is up to three times as much of a tension.
  Simulation simulation = test::start(fed_sheath(0.1, pi));
  FineRope fine(600, 3.0, 0.1 * pi, 400.0);
  fine.rest_before = fine.rest_behind = 1.0 / (1.0 + 400.0 / sheath_stiffness);
  for (int reversal = 0; reversal < 10; ++reversal) {
    const double speed = (reversal % 2 == 0 ? -1.0 : 1.0) * (0.2 - 0.012 * reversal);
    ASSERT_TRUE(simulation.set_feed_speed(0, 0, {speed, 0.0}).empty());
    for (int k = 0; k < 10; ++k) {
      ASSERT_TRUE(simulation.step().ok());
      fine.rest_before += 0.01 * speed;
      const auto [first, second] = fine.pull(1.0, 1.0);
      const auto [entry, exit] = end_tensions(simulation);
      ASSERT_NEAR(entry, first, 2e-6 * first) << reversal << " " << k;
      ASSERT_NEAR(exit, second, 2e-6 * second) << reversal << " " << k;
      const std::optional<Certificate> certificate = simulation.certificate();
      ASSERT_TRUE(certificate && certificate->clean(1e-8)) << certificate->worst()->sentence();
    }
  }
  EXPECT_LT(std::abs(simulation.cable_reports()[0].length_error), 1e-15);
}

TEST(Sheath, TwoInARowAreOneSheath) {
  // Two halves with a span of 1 mm between them: 3e-4 of the rope, which has no friction.
  test::Machine machine = fed_sheath(0.1, pi);
  auto& links = machine.cables[0].links;
  links[1] = sheath_between({-1.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, 1.5, 0.5 * pi, 0.1);
  links.insert(links.begin() + 2,
               sheath_between({1e-3, 0.0, 0.0}, {1.0, 0.0, 0.0}, 1.5, 0.5 * pi, 0.1));
  test::Machine one_sheath = fed_sheath(0.1, pi);
  // The losses are of second order of the step: 2e-3 with one substep.
  machine.model.step.substeps = one_sheath.model.step.substeps = 8;
  Simulation halves = test::start(machine);
  Simulation whole = test::start(one_sheath);
  for (int reversal = 0; reversal < 10; ++reversal) {
    const double speed = (reversal % 2 == 0 ? -1.0 : 1.0) * (0.2 - 0.012 * reversal);
    for (Simulation* one : {&halves, &whole}) {
      ASSERT_TRUE(one->set_feed_speed(0, 0, {speed, 0.0}).empty());
    }
    const double before = halves.cable_reports()[0].sheath_loss;
    for (int k = 0; k < 10; ++k) {
      ASSERT_TRUE(halves.step().ok());
      ASSERT_TRUE(whole.step().ok());
      const CableReport rope = halves.cable_reports()[0];
      const auto [entry, exit] = end_tensions(whole);
      EXPECT_NEAR(rope.spans[0].tension, entry, 1e-3 * entry);
      EXPECT_NEAR(rope.spans[2].tension, exit, 1e-3 * exit);
    }
    const double loss = halves.cable_reports()[0].sheath_loss;
    EXPECT_GT(loss, before);
    EXPECT_NEAR(loss, whole.cable_reports()[0].sheath_loss, 1e-3 * loss);
  }
}

TEST(Sheath, HasTheRatioOfACapstanWhileTheWholeRopeSlides) {
  for (const double friction : {0.1, 0.15}) {
    for (const double bend : {pi, 2.0 * pi, 3.0 * pi}) {
      for (const double way : {-1.0, 1.0}) {
        Simulation simulation = test::start(fed_sheath(friction, bend));
        ASSERT_TRUE(simulation.set_feed_speed(0, 0, {0.01 * way, 0.0}).empty());
        for (int k = 0; k < 100; ++k) ASSERT_TRUE(simulation.step().ok());
        ASSERT_TRUE(simulation.set_feed_speed(0, 0, {-0.6, 0.0}).empty());
        for (int k = 0; k < 100; ++k) ASSERT_TRUE(simulation.step().ok());
        const auto [entry, exit] = end_tensions(simulation);
        // Rest lengths are multiples of 2^-50 of the cable; strains of 0.05.
        EXPECT_NEAR(exit / entry, std::exp(-friction * bend), 1e-12);
        EXPECT_GT(simulation.cable_reports()[0].links[1].slip, -1.0);
      }
    }
  }
}

struct SheathSwing {
  double position, tension;
};

/// The weight of a SheathScene by Verlet's method with small steps, on a FineRope.
SheathSwing reference_swing(const SheathScene& scene, double time, int steps, std::size_t places) {
  FineRope fine(places, scene.length, scene.friction * scene.bend, scene.pretension);
  fine.rest_before = fine.rest_behind = 1.0 / (1.0 + scene.pretension / sheath_stiffness);
  const double h = time / steps;
  double y = -1.0;
  double v = 0.0;
  double tension = scene.pretension;
  for (int i = 0; i < steps; ++i) {
    v += 0.5 * h * (tension / 10.0 - test::g);
    y += h * v;
    tension = fine.pull(1.0, -y).second;
    v += 0.5 * h * (tension / 10.0 - test::g);
  }
  return {y, tension};
}

double swing_of(const SheathScene& scene, double time) {
  Simulation simulation = test::start(scene.machine());
  test::run(simulation.world, time);
  return scene.turned.conjugate().operator*(simulation.world.state().bodies[0].position).y();
}

TEST(Sheath, LetsAWeightSwingAsAFineChainOfFriction) {
  // Two periods of 0.2 s with an amplitude of 7 mm. A run with `rattle` has the phase error
  // (w h)^2 / 24 at w = 30 rad/s, 4e-5 per radian at 1e-3 s, of which second order remains: 1e-6 m
  // with the damped amplitude. The reference has 2.7e-4 s with (w h)^2 / 24 of its own and 150
  // places: 4e-7 m. XPBD with 64 substeps damps the amplitude by w h / 4 per radian: 1e-5 m.
  const SheathScene scene;
  const double time = 0.4;
  const SheathSwing reference = reference_swing(scene, time, 1500, 150);
  SheathScene fine = scene;
  double error_before = 1.0;
  for (const double dt : {2e-3, 1e-3, 5e-4}) {
    fine.step = test::direct_settings(IntegratorKind::rattle, dt);
    const double error = std::abs(swing_of(fine, time) - reference.position);
    EXPECT_LT(error, 1e-6 * (dt / 1e-3) * (dt / 1e-3) + 4e-7) << dt;
    EXPECT_LT(error, std::max(0.7 * error_before, 4e-7)) << dt;
    error_before = error;
  }
  fine.step = test::direct_settings(IntegratorKind::xpbd, 1e-3, 64);
  EXPECT_NEAR(swing_of(fine, time), reference.position, 1e-5);
}

TEST(Sheath, IsTheSameFromEitherEndTurnedAndWithOtherSolvers) {
  const double time = 0.3;
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    SheathScene scene;
    scene.step = test::direct_settings(integrator, 2e-3);
    const double reference = swing_of(scene, time);
    SheathScene mirrored = scene;
    mirrored.mirrored = true;
    // Sums in another order: rounding grows with 150 steps.
    EXPECT_NEAR(swing_of(mirrored, time), reference, 1e-11);
    SheathScene turned = scene;
    turned.turned = Quaternion(Eigen::AngleAxisd(0.7, Vector3(1.0, 2.0, 3.0).normalized()));
    EXPECT_NEAR(swing_of(turned, time), reference, 1e-11);
    if (integrator == IntegratorKind::rattle) continue;
    SheathScene swept = scene;
    swept.step.solver = SolverKind::gauss_seidel;
    swept.step.iterations = 60;
    EXPECT_NEAR(swing_of(swept, time), reference, 1e-9);
  }
}

TEST(Sheath, LosesTheEnergyThatItsFrictionTakes) {
  // The sum of the machine's energy and the loss, 0.177 J, stays the same up to the error of the
  // integrator. At a reversal within a step a force has an error of (w h)^2 of its change, for which
  // a few of the 5 reversals give 1e-6 J each.
  for (const double dt : {1e-3, 5e-4, 2.5e-4}) {
    SheathScene scene;
    scene.step = test::direct_settings(IntegratorKind::rattle, dt);
    Simulation simulation = test::start(scene.machine());
    const double start = simulation.world.energy().total();
    test::run(simulation.world, 0.5);
    const double loss = simulation.cable_reports()[0].sheath_loss;
    EXPECT_GT(loss, 0.1);
    const double off = std::abs(simulation.world.energy().total() + loss - start);
    EXPECT_LT(off, 1e-5) << dt;
  }
}

TEST(Sheath, WithoutFrictionIsARopeThroughTwoHoles) {
  for (const double bend : {0.0, pi}) {
    SheathScene scene;
    scene.friction = 0.0;
    scene.bend = bend;
    scene.length = 2.0;
    test::Machine machine = scene.machine();
    Simulation simulation = test::start(machine);
    const auto hole = [](const Vector3& point) {
      auto link = std::make_shared<PinholeLink>();
      link->point = point;
      return link;
    };
    auto& links = machine.cables[0].links;
    const auto anchor = links.front();
    const auto weight = links.back();
    links = {anchor, hole({-1.0, 0.0, 0.0}), hole({1.0, 0.0, 0.0}), weight};
    Simulation holes = test::start(machine);
    test::run(simulation.world, 0.5);
    test::run(holes.world, 0.5);
    // Rounding over 500 steps.
    EXPECT_NEAR(simulation.world.state().bodies[0].position.y(),
                holes.world.state().bodies[0].position.y(), 1e-11);
    const auto [entry, exit] = end_tensions(simulation);
    EXPECT_NEAR(entry, exit, 1e-10 * exit);
    EXPECT_NEAR(simulation.cable_reports()[0].sheath_loss, 0.0, 1e-6);
  }
}

TEST(Sheath, ReturnsToASavedStateBitForBit) {
  Simulation simulation = test::start(SheathScene{}.machine());
  test::run(simulation.world, 0.1);
  const State saved = simulation.world.state();
  test::run(simulation.world, 0.2);
  const auto after = hash(simulation.world.state());
  ASSERT_TRUE(simulation.world.restore(saved).empty());
  test::run(simulation.world, 0.2);
  EXPECT_EQ(hash(simulation.world.state()), after);
  State bad = saved;
  bad.features.back().reals.back() = 0.0;
  // The number of nodes of the profile is the first of its numbers.
  bad.features.back().reals[bad.features.back().reals.size() - SheathProfile::real_count - 1] =
      77.0;
  EXPECT_FALSE(simulation.world.restore(bad).empty());
}

TEST(Sheath, HasNoEnergyOfARopeThatIsCut) {
  test::Machine machine = SheathScene{}.machine();
  machine.cables[0].cut_time = 0.1;
  Simulation simulation = test::start(machine);
  test::run(simulation.world, 0.09);
  EXPECT_GT(simulation.world.energy().elastic, 0.1);
  test::run(simulation.world, 0.2);
  EXPECT_EQ(simulation.world.energy().elastic, 0.0);
}

TEST(Sheath, GoesSlackAndComesBack) {
  // The weight starts 5 cm above the point at which the rope is taut, falls into it and bounces.
  SheathScene scene;
  test::Machine machine = scene.machine();
  machine.cables[0].pretension.reset();
  machine.cables[0].rest_lengths = {1.0, 1.05};
  Simulation simulation = test::start(machine);
  bool was_taut = false;
  bool slack_again = false;
  for (int k = 0; k < 1500; ++k) {
    ASSERT_TRUE(simulation.step().ok()) << k;
    const auto [entry, exit] = end_tensions(simulation);
    was_taut = was_taut || exit > 100.0;
    slack_again = slack_again || (was_taut && exit == 0.0);
    const double most = std::max(entry, exit);
    ASSERT_LE(most, std::min(entry, exit) * std::exp(0.1 * pi) * (1.0 + 1e-9) + 1e-6) << k;
    ASSERT_LT(std::abs(simulation.cable_reports()[0].length_error), 1e-14);
  }
  EXPECT_TRUE(was_taut);
  EXPECT_TRUE(slack_again);
}

std::string sheath_fault(const test::Machine& machine) {
  const auto made = Simulation::create(machine.model, machine.cables);
  return made ? std::string() : test::text(made.errors());
}

TEST(Sheath, TellsThatItsFrictionStays) {
  Simulation simulation = test::start(fed_sheath(0.1, pi));
  const Errors errors = simulation.set_friction(0, 1, 0.2);
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_NE(errors[0].message.find("is a sheath, whose friction stays"), std::string::npos);
}

TEST(Sheath, RefusesByNameTheRopesThatItCannotGuide) {
  const auto changed = [](const auto& change) {
    test::Machine machine = SheathScene{}.machine();
    change(machine.cables[0]);
    return sheath_fault(machine);
  };
  const auto has = [](const std::string& text, std::string_view part) {
    return text.find(part) != std::string::npos;
  };
  const auto with = [](const std::shared_ptr<SheathLink>& link) {
    return [link](CableDef& rope) { rope.links[1] = link; };
  };
  const Vector3 a(-1.0, 0.0, 0.0);
  const Vector3 b(1.0, 0.0, 0.0);
  EXPECT_TRUE(has(changed([](CableDef& r) {
                    r.axial_stiffness.reset();
                    r.pretension.reset();
                  }),
                  "needs \"axial_stiffness\""));
  EXPECT_TRUE(has(changed([](CableDef& r) { r.linear_density = 1.0; }), "/linear_density"));
  EXPECT_TRUE(has(changed([](CableDef& r) { r.damping = 1.0; }), "/damping"));
  EXPECT_TRUE(has(changed([](CableDef& r) { r.links.pop_back(); }), "cannot end in a sheath"));
  EXPECT_TRUE(has(changed(with(sheath_between(a, b, 1.5, 0.0, 0.1))), "2 m apart"));
  EXPECT_TRUE(has(changed(with(sheath_between(a, b, -3.0, 1.0, 0.1))), "/links/1/length"));
  EXPECT_TRUE(has(changed(with(sheath_between(a, b, 3.0, -1.0, 0.1))), "/links/1/bend"));
  EXPECT_TRUE(has(changed(with(sheath_between(a, b, 3.0, 1.0, -0.1))), "/links/1/friction"));
  EXPECT_TRUE(has(changed(with(sheath_between(a, b, 3.0, 100.0, 0.6))), "at most 50"));
  auto drawn = sheath_between(a, b, 4.0, 1.0, 0.1);
  drawn->points = {a, Vector3(0.0, 1.0, 0.0), b};
  drawn->bend.reset();
  EXPECT_TRUE(has(changed(with(drawn)), "the points give 2.8"));
  drawn->points = {a};
  EXPECT_TRUE(has(changed(with(drawn)), "2 to 10000 points"));
  drawn->points = {a, a};
  drawn->length.reset();
  EXPECT_TRUE(has(changed(with(drawn)), "are the same"));
  EXPECT_TRUE(has(changed([](CableDef& r) {
                    r.pretension.reset();
                    r.pretensions = {60.0, 100.0};
                  }),
                  "holds at most the ratio 1.36"));
  EXPECT_TRUE(has(changed([&](CableDef& r) {
                    r.links.insert(r.links.begin() + 2, std::make_shared<PinholeLink>());
                  }),
                  "for a hole use a short \"sheath\""));
}

}  // namespace
}  // namespace sheave
