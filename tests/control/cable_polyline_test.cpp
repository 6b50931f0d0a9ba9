// The lines of a running world's cables.

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "scenes/control/scene_supervisor.h"
#include "scenes/load_world.h"
#include "tests/control/allocation_count.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

using test::allocation_count;

LiveWorld world_of(const std::string& name) {
  auto world = load(std::string(SHEAVE_SOURCE_DIR) + "/scenes/" + name + ".json");
  if (!world) throw std::runtime_error(test::text(world.errors()));
  return std::move(world).value();
}

/// The lengths of all lines of a cable, one after the other.
double drawn_length(const LiveWorld& world, CableHandle cable, int spans, double tolerance) {
  CableReports reports;
  reports.read(world.simulation());
  double sum = 0.0;
  for (int k = 0; k < spans; ++k) {
    const PolylineOptions options{.tolerance = tolerance};
    std::vector<Vector3> line(*world.cable_polyline(cable, k, reports, options, {}));
    EXPECT_TRUE(world.cable_polyline(cable, k, reports, options, line).ok());
    for (std::size_t i = 1; i < line.size(); ++i) sum += (line[i] - line[i - 1]).norm();
  }
  return sum;
}

TEST(LivePolyline, HasTheLengthOfSpansAndArcs) {
  LiveWorld world = world_of("paper/pulley");
  const CableHandle rope = world.cables().front();
  for (int step = 0; step < 60; ++step) EXPECT_TRUE(world.step().ok());
  const CableReport report = world.simulation().cable_reports()[0];
  double whole = 0.0;
  for (const SpanReport& span : report.spans) whole += span.length;
  for (const LinkReport& link : report.links) whole += link.stored_length;
  // Chords with a sagitta s on a radius r are shorter than their arcs by s / (3 r).
  const auto spans = static_cast<int>(report.spans.size());
  EXPECT_NEAR(drawn_length(world, rope, spans, 1e-8), whole, 1e-6 * whole);
}

TEST(LivePolyline, ReadsFrameAfterFrameWithoutAllocation) {
  for (const char* name : {"paper/pulley", "machines/crane", "paper/hilbert3", "analytic/belt"}) {
    LiveWorld world = world_of(name);
    CableReports reports;
    reports.read(world.simulation());
    std::vector<Vector3> points(1000);
    const std::vector<CableHandle> cables = world.cables();
    for (int step = 0; step < 10; ++step) {
      EXPECT_TRUE(world.step().ok());
      const std::int64_t before = allocation_count();
      reports.read(world.simulation());
      for (std::size_t c = 0; c < cables.size(); ++c) {
        const auto spans = static_cast<int>(reports.all()[c].spans.size());
        for (int k = 0; k < spans; ++k) {
          ASSERT_TRUE(world.cable_polyline(cables[c], k, reports, {}, points).ok()) << name;
        }
      }
      EXPECT_EQ(allocation_count() - before, 0) << name << " step " << step;
    }
  }
}

TEST(LivePolyline, KeptReportsEqualFreshOnes) {
  LiveWorld world = world_of("machines/crane");
  CableReports reports;
  for (int step = 0; step < 30; ++step) {
    EXPECT_TRUE(world.step().ok());
    reports.read(world.simulation());
    const std::vector<CableReport> fresh = world.simulation().cable_reports();
    ASSERT_EQ(reports.all().size(), fresh.size());
    for (std::size_t c = 0; c < fresh.size(); ++c) {
      const CableReport& kept = reports.all()[c];
      EXPECT_EQ(kept.total_length, fresh[c].total_length);
      for (std::size_t k = 0; k < fresh[c].spans.size(); ++k) {
        EXPECT_EQ(kept.spans[k].start, fresh[c].spans[k].start);
        EXPECT_EQ(kept.spans[k].tension, fresh[c].spans[k].tension);
      }
      for (std::size_t k = 0; k < fresh[c].links.size(); ++k) {
        EXPECT_EQ(kept.links[k].exit, fresh[c].links[k].exit);
        EXPECT_EQ(kept.links[k].path, fresh[c].links[k].path);
      }
    }
  }
}

TEST(LivePolyline, RefusesWhatIsNotThere) {
  LiveWorld world = world_of("paper/pulley");
  const CableHandle rope = world.cables().front();
  CableReports reports;
  const auto text_of = [&](int span, const PolylineOptions& options) {
    return test::text(world.cable_polyline(rope, span, reports, options, {}).errors());
  };
  EXPECT_NE(text_of(0, {}).find("call CableReports::read()"), std::string::npos);
  reports.read(world.simulation());
  EXPECT_NE(text_of(-1, {}).find("has no span number -1"), std::string::npos);
  EXPECT_NE(text_of(1000, {}).find("has no span number 1000"), std::string::npos);
  EXPECT_NE(text_of(0, {.tolerance = 0.0}).find("above 0"), std::string::npos);
  EXPECT_TRUE(world.step().ok());
  EXPECT_TRUE(world.cut(rope).empty());
  EXPECT_TRUE(world.step().ok());
  reports.read(world.simulation());
  EXPECT_NE(text_of(2, {}).find("its pieces are 0 and 1"), std::string::npos);
  EXPECT_GE(*world.cable_polyline(rope, 1, reports, {}, {}), 2U);
}

}  // namespace
}  // namespace sheave
