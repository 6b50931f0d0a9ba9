// Curves and scenes of sheave generate hilbert.

#include <cmath>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/check.h"
#include "scenes/generators.h"
#include "tests/support/builders.h"

namespace sheave::test {
namespace {

Scene hilbert(int order, double slack = 0.0) {
  HilbertOptions options;
  options.order = order;
  options.slack = slack;
  return *generate_hilbert(options);
}

/// Runs a scene and returns the messages of the checks that fail.
std::string failures(const Scene& scene) {
  Simulation simulation = start(Machine{scene.model, scene.cables});
  CheckRecorder recorder(scene, simulation);
  recorder.record(simulation);
  const auto steps = static_cast<int>(std::lround(scene.duration / scene.model.step.dt));
  for (int i = 0; i < steps; ++i) {
    const StepReport report = simulation.world.step();
    if (!report.ok()) return report.divergence->message;
    recorder.record(simulation);
  }
  std::string text;
  for (const CheckResult& result : recorder.results()) {
    if (!result.passed) text += result.message + "\n";
  }
  return text;
}

TEST(Hilbert, CurveVisitsEveryPointOfACubeOnceInStepsOfOne) {
  for (int order = 1; order <= 5; ++order) {
    const std::vector<Vector3> curve = hilbert_curve(order);
    ASSERT_EQ(curve.size(), std::size_t{1} << (3 * order));
    std::set<std::array<double, 3>> visited;
    const double half = 0.5 * (std::exp2(order) - 1.0);
    for (std::size_t i = 0; i < curve.size(); ++i) {
      EXPECT_LE(curve[i].cwiseAbs().maxCoeff(), half);
      visited.insert({curve[i].x(), curve[i].y(), curve[i].z()});
      if (i > 0) {
        EXPECT_EQ((curve[i] - curve[i - 1]).norm(), 1.0);
      }
    }
    EXPECT_EQ(visited.size(), curve.size());
    EXPECT_EQ(curve.back() - curve[curve.size() - 2], -Vector3::UnitY());
    // The cube's curve is made of eight curves of the order below: each octant is left once.
    if (order < 2) continue;
    const std::size_t eighth = curve.size() / 8;
    for (std::size_t i = 0; i < curve.size(); ++i) {
      const Vector3& first = curve[i / eighth * eighth];
      for (int axis = 0; axis < 3; ++axis) EXPECT_GT(curve[i][axis] * first[axis], 0.0);
    }
  }
}

TEST(Hilbert, HasAsManyJointsAsThePaperLists) {
  EXPECT_EQ(hilbert(2).cables[0].span_count(), 62);
  EXPECT_EQ(hilbert(3).cables[0].span_count(), 498);
  EXPECT_EQ(hilbert(2, 0.05).cables[0].span_count(), 62);
}

TEST(Hilbert, SpansRunAlongTheCurveAndWheelsKeepApart) {
  for (int order = 1; order <= 3; ++order) {
    const Scene scene = hilbert(order);
    EXPECT_EQ(text(validate_scene(scene)), "");
    const std::vector<Vector3> curve = hilbert_curve(order);
    const Simulation simulation = start(Machine{scene.model, scene.cables});
    const CableReport cable = simulation.cable_reports()[0];
    for (std::size_t k = 0; k < cable.spans.size(); ++k) {
      const SpanReport& span = cable.spans[k];
      // Along an edge: parallel to an axis, and on lines through points of the curve
      // (half-integers).
      const Vector3 along = (span.end - span.start).normalized();
      EXPECT_NEAR(along.cwiseAbs().maxCoeff(), 1.0, 1e-12) << k;
      for (int axis = 0; axis < 3; ++axis) {
        if (std::abs(along[axis]) > 0.5) continue;
        EXPECT_NEAR(std::abs(span.start[axis] - std::floor(span.start[axis]) - 0.5), 0.0, 1e-12);
      }
      // A quarter of each wheel is covered. Lengths are kept as multiples of some 1e-13 m.
      if (k > 0) {
        EXPECT_NEAR(cable.links[k].wrap_angle, std::acos(0.0), 1e-11);
      }
    }
    const std::vector<BodyDef>& bodies = scene.model.bodies;
    for (std::size_t i = 0; i + 1 < bodies.size(); ++i) {
      for (std::size_t j = i + 1; j + 1 < bodies.size(); ++j) {
        const double radii = (i == 0 ? 0.4 : 0.2) + 0.2;
        EXPECT_GT((bodies[i].position - bodies[j].position).norm(), radii) << i << ' ' << j;
      }
    }
  }
}

TEST(Hilbert, KeepsItsPromisesWithEitherIntegrator) {
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    for (const double slack : {0.0, 0.02, 0.3}) {
      SCOPED_TRACE(slack);
      Scene scene = hilbert(1, slack);
      scene.model.step.integrator = integrator;
      EXPECT_EQ(failures(scene), "");
    }
  }
}

TEST(Hilbert, OtherSizesKeepTheirPromises) {
  HilbertOptions options;
  options.order = 2;
  options.spacing = 0.1;
  options.radius = 0.024;
  options.wheel_mass = 0.01;
  options.drag = 0.0;
  options.load = 0.3;
  options.motor = 0.1;
  options.ramp = 0.2;
  options.substeps = 2;
  EXPECT_EQ(failures(*generate_hilbert(options)), "");
  options.slack = 0.003;
  EXPECT_EQ(failures(*generate_hilbert(options)), "");
}

TEST(Hilbert, RefusesWheelsThatTouch) {
  HilbertOptions options;
  options.radius = 0.25;
  EXPECT_EQ(generate_hilbert(options).errors()[0].path, "/radius");
  EXPECT_THAT(to_string(generate_scene("hilbert", {{"order", "6"}}).errors.at(0)),
              testing::HasSubstr("/order: value 6: must be 1 ... 5"));
}

}  // namespace
}  // namespace sheave::test
