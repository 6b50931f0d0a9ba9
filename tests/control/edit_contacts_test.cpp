// What lies on wheels when an edit leads a cable another way.

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cable/edit.h"
#include "cable/live_world.h"
#include "cable/span_geometry.h"
#include "tests/support/builders.h"
#include "tests/support/live.h"

namespace sheave {
namespace {

using test::advance;
using test::attach;
using test::cable;
using test::edit;
using test::live;
using test::refused;
using test::roll;
using test::worst_figure;
using testing::HasSubstr;

constexpr double arc_radius = 0.2;

/// By how much what is stored on the wheels between two spans is not the arc from where the cable
/// comes to where it goes [m]. But for wheels that the cable is about to leave: what is less than
/// nothing has no strain of its own.
double worst_arc(const LiveWorld& world) {
  double worst = 0.0;
  for (const CableReport& cable : world.simulation().cable_reports()) {
    for (std::size_t i = 0; i < cable.links.size(); ++i) {
      const LinkReport& link = cable.links[i];
      const bool between = cable.closed || (i > 0 && i + 1 < cable.links.size());
      if (!between || !link.touched || link.winding == 0 || link.stored_length < 0.0) continue;
      const Vector3 entry = (link.entry - link.center) / link.radius;
      const Vector3 exit = (link.exit - link.center) / link.radius;
      const double angle = link.winding * angle_between(entry, exit, link.normal);
      const double off = link.stored_length + link.stored_stretch - link.radius * angle;
      worst = std::max(worst, std::abs(std::remainder(off, 2.0 * pi * link.radius)));
    }
  }
  return worst;
}

/// A rope from the world over two wheels to a weight, and a third wheel above them.
test::Machine rope_over_wheels(double axial_stiffness) {
  test::Machine machine;
  machine.model.gravity = test::down;
  machine.model.step = test::direct_settings(IntegratorKind::rattle, 0.002);
  const auto add_wheel = [&](const char* name, const Vector3& center, double radius) {
    BodyDef wheel = test::wheel(name, center, radius, 0.03);
    wheel.angular_damping = 0.5;
    return machine.model.add(wheel);
  };
  const BodyId a = add_wheel("a", Vector3::Zero(), arc_radius);
  const BodyId b = add_wheel("b", {2.0, 0.0, 0.0}, arc_radius);
  add_wheel("c", {1.0, 1.0, 0.0}, 0.3);
  BodyDef weight = test::weight("weight", {2.2, -2.0, 0.0}, 3.0);
  weight.damping = 20.0;
  CableDef rope = cable("rope", {attach(BodyId::world(), {-1.0, -2.0, 0.0}), roll(a, test::right),
                                 roll(b, test::right), attach(machine.model.add(weight))});
  if (axial_stiffness > 0.0) rope.axial_stiffness = axial_stiffness;
  machine.cables = {rope};
  return machine;
}

class EditContacts : public testing::TestWithParam<double> {};

// Of a rigid rope, and of one that lies on the wheels with a strain of 1 % or 10 %.
TEST_P(EditContacts, WheelsTakeTheArcBetweenTheirTangents) {
  LiveWorld world = live(rope_over_wheels(GetParam()));
  const CableHandle rope = *world.cable("rope");
  const BodyHandle c = *world.body("c");
  advance(world, 50);
  const auto led = [&](const std::function<void(Edit&)>& how) {
    const double whole = *world.length(rope);
    const double before = worst_arc(world);
    const EditReport done = edit(world, how);
    const double added = done.cables.empty() ? 0.0 : done.cables[0].added;
    EXPECT_EQ(*world.length(rope), whole + added);
    EXPECT_LT(worst_arc(world), before + 1e-12);
    advance(world, 100);
    EXPECT_LT(worst_figure(world), 1e-5);
  };
  // Its end goes elsewhere: the arc on the first wheel shrinks by about a third of a turn.
  led([&](Edit& e) {
    e.pay_out(rope, 0, 1.0);
    e.detach(rope, CableEnd::first);
    e.attach(rope, CableEnd::first, BodyId::world(), {-2.0, 0.0, 0.0});
  });
  // Up over another wheel, between both, and off it again.
  led([&](Edit& e) {
    e.pay_out(rope, 1, 1.5);
    e.insert(rope, 1, roll(e.id(c), test::right));
  });
  led([&](Edit& e) { e.remove_link(rope, 1); });
  led([&](Edit& e) { e.remove_link(rope, 1); });
  // At last it hangs from the second wheel.
  advance(world, 12000);
  const CableReport report = world.simulation().cable_reports()[0];
  ASSERT_EQ(report.spans.size(), 2U);
  EXPECT_NEAR(report.spans[1].tension, 3.0 * test::g, 1e-6);
  // The trapezoidal rule by which an elastic rope comes onto wheels leaves a part in 10^6 of the
  // arcs, less with a smaller step.
  EXPECT_LT(worst_arc(world), GetParam() > 0.0 ? 1e-6 * 2.0 * pi * arc_radius : 1e-12);
  double way = report.links[1].stored_length;
  for (const SpanReport& span : report.spans) {
    way += GetParam() > 0.0 ? span.length / (1.0 + span.tension / GetParam()) : span.length;
  }
  EXPECT_NEAR(way, *world.length(rope), 1e-6);
}

std::vector<double> rest_lengths(const LiveWorld& world) {
  std::vector<double> lengths;
  const std::vector<CableReport> reports = world.simulation().cable_reports();
  for (const SpanReport& span : reports[0].spans) {
    lengths.push_back(span.rest_length);
  }
  return lengths;
}

// Whatever comes to the spans beside it in the same edit, before or after.
TEST_P(EditContacts, AnInsertedLinkSharesAllCableAddedToItsSpans) {
  constexpr double paid = 6.0;
  using Change = std::function<void(Edit&, CableHandle, BodyId)>;
  const auto lead = [](Edit& e, CableHandle rope, int span, BodyId c) {
    e.insert(rope, span, roll(c, test::right));
  };
  // The same twice: the length first and the link last, and in another order.
  const std::vector<std::pair<Change, Change>> pairs = {
      {[&](Edit& e, CableHandle rope, BodyId c) {
         e.pay_out(rope, 1, paid);
         lead(e, rope, 1, c);
       },
       [&](Edit& e, CableHandle rope, BodyId c) {
         lead(e, rope, 1, c);
         e.pay_out(rope, 2, paid);
       }},
      {[&](Edit& e, CableHandle rope, BodyId c) {
         e.pay_out(rope, 1, paid);
         e.remove_link(rope, 2);
         lead(e, rope, 1, c);
       },
       [&](Edit& e, CableHandle rope, BodyId c) {
         e.pay_out(rope, 1, paid);
         lead(e, rope, 1, c);
         e.remove_link(rope, 3);
       }},
      {[&](Edit& e, CableHandle rope, BodyId c) {
         e.pay_out(rope, 0, paid);
         e.remove_link(rope, 1);
         lead(e, rope, 0, c);
       },
       [&](Edit& e, CableHandle rope, BodyId c) {
         lead(e, rope, 1, c);
         e.pay_out(rope, 0, paid);
         e.remove_link(rope, 1);
       }},
      {[&](Edit& e, CableHandle rope, BodyId c) {
         e.detach(rope, CableEnd::first);
         e.attach(rope, CableEnd::first, BodyId::world(), {-1.0, -1.8, 0.0});
         e.pay_out(rope, 0, paid);
         lead(e, rope, 0, c);
       },
       [&](Edit& e, CableHandle rope, BodyId c) {
         e.pay_out(rope, 0, paid);
         lead(e, rope, 0, c);
         e.detach(rope, CableEnd::first);
         e.attach(rope, CableEnd::first, BodyId::world(), {-1.0, -1.8, 0.0});
       }},
  };
  for (const auto& [plain, other] : pairs) {
    std::vector<double> expected;
    for (const Change& change : {plain, other}) {
      LiveWorld world = live(rope_over_wheels(GetParam()));
      advance(world, 50);
      const CableHandle rope = *world.cable("rope");
      const BodyHandle c = *world.body("c");
      const double whole = *world.length(rope);
      const EditReport done = edit(world, [&](Edit& e) { change(e, rope, e.id(c)); });
      EXPECT_EQ(done.cables.at(0).added, paid);
      EXPECT_EQ(*world.length(rope), whole + paid);
      EXPECT_LT(worst_arc(world), 1e-9);
      if (expected.empty()) expected = rest_lengths(world);
      EXPECT_THAT(rest_lengths(world), testing::Pointwise(testing::DoubleNear(1e-12), expected));
    }
  }
}

// The link comes first, since the belt begins where the rope did.
TEST(EditBeltContacts, AnInsertedLinkCanBeTheFirstOne) {
  constexpr double paid = 1.0;
  std::vector<double> expected;
  for (const bool at_once : {false, true}) {
    LiveWorld world = live(rope_over_wheels(0.0));
    advance(world, 50);
    const CableHandle rope = *world.cable("rope");
    const BodyHandle c = *world.body("c");
    const double whole = *world.length(rope);
    const auto join = [&](Edit& e) {
      e.detach(rope, CableEnd::first);
      e.detach(rope, CableEnd::last);
      e.join(rope, rope);
    };
    edit(world, [&](Edit& e) {
      e.pay_out(rope, 0, paid);
      if (at_once) e.insert(rope, 0, roll(e.id(c), test::left));
      join(e);
      if (!at_once) e.insert(rope, 1, roll(e.id(c), test::left));
    });
    EXPECT_EQ(*world.length(rope), whole + paid);
    EXPECT_LT(worst_arc(world), 1e-9);
    std::vector<double> lengths = rest_lengths(world);
    ASSERT_EQ(lengths.size(), 3U);
    if (at_once) std::rotate(lengths.begin(), lengths.begin() + 1, lengths.end());
    if (expected.empty()) expected = lengths;
    EXPECT_THAT(lengths, testing::Pointwise(testing::DoubleNear(1e-12), expected));
    advance(world, 200);
    EXPECT_LT(worst_figure(world), 1e-5);
  }
}

// How long the pieces would be is not known before.
TEST_P(EditContacts, ASplitBesideALinkJustInsertedIsRefused) {
  LiveWorld world = live(rope_over_wheels(GetParam()));
  const CableHandle rope = *world.cable("rope");
  const BodyHandle c = *world.body("c");
  for (const int span : {1, 2}) {
    EXPECT_THAT(
        refused(world,
                [&](Edit& e) {
                  e.pay_out(rope, 1, 6.0);
                  e.insert(rope, 1, roll(e.id(c), test::right));
                  e.split(rope, span, 0.5, "rest");
                }),
        HasSubstr("\"rope\" has a new link beside its span number " + std::to_string(span)));
  }
  edit(world, [&](Edit& e) {
    e.pay_out(rope, 1, 6.0);
    e.insert(rope, 1, roll(e.id(c), test::right));
    e.split(rope, 3, 0.5, "rest");
  });
}

// It holds by itself, but there is nothing before it that it could share.
TEST_P(EditContacts, AnInsertedAttachmentCannotBecomeAnEnd) {
  for (const CableEnd end : {CableEnd::first, CableEnd::last}) {
    LiveWorld world = live(rope_over_wheels(GetParam()));
    const CableHandle rope = *world.cable("rope");
    EXPECT_THAT(refused(world,
                        [&](Edit& e) {
                          const int span = end == CableEnd::first ? 0 : 2;
                          e.insert(rope, span, attach(BodyId::world(), {1.0, -1.5, 0.0}));
                          e.detach(rope, end);
                        }),
                HasSubstr("would have an inserted link at its"));
  }
}

INSTANTIATE_TEST_SUITE_P(Ropes, EditContacts, testing::Values(0.0, 3000.0, 300.0));

// What lies on a wheel would not be what it was, were this another one.
TEST(EditSizes, WheelsUnderCablesKeepTheirSize) {
  LiveWorld world = live(rope_over_wheels(0.0));
  const BodyHandle wheel = *world.body("a");
  EXPECT_THAT(refused(world,
                      [&](Edit& e) {
                        e.change(wheel, [](BodyDef& body) {
                          body.shapes = test::wheel("larger", body.position, 0.4, 1.0).shapes;
                        });
                      }),
              HasSubstr("\"rope\" lies on link 1, which would have another size"));
  edit(world, [&](Edit& e) { e.change(wheel, [](BodyDef& body) { body.mass = 7.0; }); });
}

}  // namespace
}  // namespace sheave
