// Cables that are cut at a length from their first link.

#include "cable/cut_place.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cable/edit.h"
#include "cable/live_world.h"
#include "engine/shapes/cylinder.h"
#include "tests/support/builders.h"
#include "tests/support/live.h"

namespace sheave {
namespace {

using test::advance;
using test::attach;
using test::g;
using test::live;
using testing::HasSubstr;

constexpr double pi = 3.14159265358979323846;
/// Two weights over a wheel: 2 m, an arc of pi r, 2 m.
constexpr double arc = 0.25 * pi;
constexpr double whole = 4.0 + arc;
/// The state keeps a place to half of 2^-30 of its span, here of at most 4 m: 2e-9 m.
constexpr double kept = 2e-9;

CableReport report_of(const LiveWorld& world) { return world.simulation().cable_reports()[0]; }

test::Machine atwood(bool from_the_other_end) {
  test::Machine machine = test::Atwood{}.machine();
  if (!from_the_other_end) return machine;
  machine.cables = {test::cable(
      "rope", {attach(BodyId{2}), test::roll(BodyId{0}, test::left), attach(BodyId{1})})};
  return machine;
}

TEST(CutPlace, ACodeOfTheStateIsASpanAndAShare) {
  EXPECT_FALSE(CutPlace::of(0).has_value());
  EXPECT_EQ(CutPlace{7}.code(), 8) << "without a share as before places were chosen";
  for (const int span : {0, 1, 1'000'000}) {
    EXPECT_FALSE(CutPlace::of(CutPlace{span}.code())->share.has_value());
    for (const double share : {0.0, 1e-6, 0.25, 0.5, 0.7, 1.0}) {
      const auto place = CutPlace::of(CutPlace{span, share}.code());
      ASSERT_TRUE(place.has_value());
      EXPECT_EQ(place->span, span);
      EXPECT_NEAR(place->share.value_or(-1.0), share, std::ldexp(0.5, -30));
      EXPECT_TRUE(CutPlace::is_code(CutPlace(*place).code(), span + 1));
      EXPECT_FALSE(CutPlace::is_code(CutPlace(*place).code(), span)) << "there is no such span";
    }
  }
  EXPECT_TRUE(CutPlace::is_code(0, 3));
  for (const std::int64_t code : {std::int64_t{-1}, std::int64_t{4}, std::int64_t{1} << 32,
                                  std::numeric_limits<std::int64_t>::max()}) {
    EXPECT_FALSE(CutPlace::is_code(code, 3)) << code;
  }
}

// The pieces have the lengths up to the place and from there on, and both weights fall freely.
TEST(CutPlace, DividesTheLengthAndLetsGo) {
  for (const SolverKind solver : {SolverKind::direct, SolverKind::gauss_seidel}) {
    for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
      for (const int substeps : {1, 4, 64}) {
        for (const bool other_end : {false, true}) {
          test::Machine machine = atwood(other_end);
          machine.model.step.solver = solver;
          machine.model.step.integrator = integrator;
          machine.model.step.substeps = substeps;
          LiveWorld world = live(machine);
          advance(world, 12);
          const CableHandle rope = world.cables()[0];
          // In the span of the left weight, 1.3 m above it.
          ASSERT_EQ(test::text(world.cut(rope, other_end ? whole - 1.3 : 1.3)), "");
          EXPECT_TRUE(world.is_cut(rope));
          const CableReport report = report_of(world);
          EXPECT_NEAR(report.pieces[other_end ? 1 : 0], 1.3, kept);
          EXPECT_NEAR(report.pieces[other_end ? 0 : 1], whole - 1.3, kept);
          const double before = world.pose(world.bodies()[2])->velocity.y();
          const double time = world.time();
          advance(world, 6);
          EXPECT_EQ(*world.tension(rope, 0), 0.0);
          // Each substep h rounds a place of at most 2.5 m, and so the velocity by 2 eps 2.5 m / h.
          const double h = machine.model.step.dt / substeps;
          const double rounding = 6.0 * substeps * 2.0 * 2.2e-16 * 2.5 / h;
          EXPECT_NEAR(world.pose(world.bodies()[2])->velocity.y(),
                      before - g * (world.time() - time), rounding);
          EXPECT_NEAR(report_of(world).pieces[0], report.pieces[0], 1e-15);
        }
      }
    }
  }
}

TEST(CutPlace, NeedsNoTensionAndNoStep) {
  test::Machine machine = test::Atwood{}.machine();
  machine.cables[0].rest_lengths = {3.0, 3.0};  // slack on both sides
  LiveWorld world = live(machine);
  const CableHandle rope = world.cables()[0];
  ASSERT_EQ(test::text(world.cut(rope, 4.5)), "");
  EXPECT_TRUE(world.is_cut(rope));
  EXPECT_NEAR(report_of(world).pieces[0], 4.5, kept);
  const LiveReport report = world.step();
  ASSERT_EQ(report.events.size(), 1U);
  EXPECT_EQ(report.events[0].kind, CableEvent::Kind::cut);
  EXPECT_EQ(report.events[0].link, 1) << "in the span behind the wheel";
  EXPECT_EQ(test::text(world.cut(rope, 1.0)), "") << "a cable parts once";
  EXPECT_NEAR(report_of(world).pieces[0], 4.5, kept);
}

TEST(CutPlace, IsRefusedOffTheFreeSpans) {
  LiveWorld world = live(test::Atwood{}.machine());
  const CableHandle rope = world.cables()[0];
  const std::uint64_t before = hash(world.state());
  for (const double place :
       {2.0, 2.4, 2.0 + arc - 1e-6, 0.0, -1.0, whole, 9.0, std::numeric_limits<double>::quiet_NaN(),
        std::numeric_limits<double>::infinity()}) {
    const Errors errors = world.cut(rope, place);
    ASSERT_EQ(errors.size(), 1U) << place;
    EXPECT_EQ(errors[0].path, "/cables/0/place");
    EXPECT_THAT(errors[0].message, HasSubstr("is not free at"));
    EXPECT_THAT(errors[0].message, HasSubstr("0 m to 2 m, 2.78539"));
  }
  EXPECT_EQ(hash(world.state()), before);
  EXPECT_EQ(world.cut({}, 1.0).size(), 1U);
  EXPECT_EQ(world.simulation().world.state().controls.cables_any(), false);
}

TEST(CutPlace, IsPartOfTheState) {
  LiveWorld world = live(test::Atwood{}.machine());
  advance(world, 3);
  ASSERT_EQ(test::text(world.cut(world.cables()[0], 3.5)), "");
  const LiveSnapshot cut = world.snapshot();
  advance(world, 5);
  const std::uint64_t later = hash(world.state());
  ASSERT_TRUE(world.restore(cut).empty());
  EXPECT_NEAR(report_of(world).pieces[0], 3.5, kept);
  advance(world, 5);
  EXPECT_EQ(hash(world.state()), later);
}

// Edits of other parts keep the place, and a split takes it.
TEST(CutPlace, StaysThroughEditsAndDecidesASplit) {
  LiveWorld world = live(test::Atwood{}.machine());
  advance(world, 3);
  const CableHandle rope = world.cables()[0];
  ASSERT_EQ(test::text(world.cut(rope, 3.5)), "");
  // A wrappable body needs another layout of the state, so that the cable is made anew.
  for (const bool wrappable : {false, true}) {
    test::edit(world, [&](Edit& e) {
      BodyDef post;
      post.name = wrappable ? "post" : "stone";
      post.mobility = Mobility::fixed;
      post.position = {9.0, 9.0, 0.0};
      post.shapes.push_back({std::make_shared<Cylinder>()});
      post.wrappable = wrappable;
      e.add(post);
    });
    EXPECT_NEAR(report_of(world).pieces[0], 3.5, 2.0 * kept);
  }
  CableHandle rest;
  test::edit(world, [&](Edit& e) { rest = e.split(rope, 0, 0.9, "rest"); });
  EXPECT_NEAR(*world.length(rope), 3.5, 3.0 * kept);
  EXPECT_NEAR(*world.length(rope) + *world.length(rest), whole, 1e-14);
}

// A cut is over when its ends are loose: a piece that is tied again has the strength of the rope.
TEST(CutPlace, APieceThatIsTiedAgainHolds) {
  for (const bool at_place : {false, true}) {
    for (const bool first_piece : {false, true}) {
      SCOPED_TRACE(testing::Message() << "place " << at_place << ", first piece " << first_piece);
      LiveWorld world = live(test::Atwood{}.machine());
      const auto bodies = world.bodies();
      const std::size_t load = first_piece ? 1 : 2;
      const Vector3 start = world.pose(bodies[3 - load])->position;  // 2 m below the wheel
      advance(world, 3);
      const CableHandle rope = world.cables()[0];
      // Without a place the cut is behind the wheel.
      ASSERT_EQ(test::text(at_place ? world.cut(rope, 1.2) : world.cut(rope)), "");
      ASSERT_TRUE(world.is_cut(rope));
      // A piece over the wheel hangs from the other side, 0.2 m below the wheel.
      const bool over_wheel = first_piece != at_place;
      const Vector3 hook =
          over_wheel ? Vector3(start + Vector3(0.0, 1.8, 0.0))
                     : Vector3(world.pose(bodies[load])->position + Vector3(0.0, 0.5, 0.0));
      CableHandle held = rope;
      test::edit(world, [&](Edit& e) {
        const CableHandle tail = e.split(rope, 0, 0.5, "tail");
        held = first_piece ? rope : tail;
        e.attach(held, first_piece ? CableEnd::last : CableEnd::first, BodyId::world(), hook);
        // The solver's residual may have left the span at the load longer than its rope.
        if (over_wheel) e.pay_out(held, first_piece ? 0 : 1, 0.01);
      });
      advance(world, 90);
      EXPECT_FALSE(world.is_cut(held));
      EXPECT_GT(world.pose(bodies[load])->position.y(), start.y() - 4.0) << "it holds its load";
    }
  }
}

TEST(CutPlace, OpensABelt) {
  LiveWorld world = live(test::belt(0.3, 0.2, 2.0, 0.1, 0.1));
  advance(world, 2);
  const CableHandle belt = world.cables()[0];
  const double length = *world.length(belt);
  const CableReport report = report_of(world);
  // A tenth of the first span behind the first wheel.
  const double place = report.links[0].stored_length + 0.1 * report.spans[0].rest_length;
  ASSERT_EQ(test::text(world.cut(belt, place)), "");
  EXPECT_NEAR(report_of(world).pieces[0], place, kept);
  test::edit(world, [&](Edit& e) { e.open(belt, 0, 0.5); });
  EXPECT_NEAR(*world.length(belt), length, 1e-14);
}

// The line of a piece has the length of the piece.
TEST(CutPlace, IsSeenInTheLines) {
  LiveWorld world = live(test::Atwood{}.machine());
  advance(world, 3);
  const CableHandle rope = world.cables()[0];
  ASSERT_EQ(test::text(world.cut(rope, 1.2)), "");
  CableReports reports;
  reports.read(world.simulation());
  for (const int piece : {0, 1}) {
    const PolylineOptions options{.tolerance = 1e-6};
    std::vector<Vector3> line(*world.cable_polyline(rope, piece, reports, options, {}));
    ASSERT_TRUE(world.cable_polyline(rope, piece, reports, options, line).ok());
    double length = 0.0;
    for (std::size_t i = 1; i < line.size(); ++i) length += (line[i] - line[i - 1]).norm();
    EXPECT_NEAR(length, piece == 0 ? 1.2 : whole - 1.2, 1e-4);
  }
}

}  // namespace
}  // namespace sheave
