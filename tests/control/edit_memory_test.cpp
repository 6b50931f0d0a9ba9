// Edits of worlds with ropes that remember how they were stretched.

#include <array>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/live.h"
#include "tests/support/rope_memory.h"

namespace sheave::edit_memory {
namespace {

using test::rope_memory::hanging;
using test::rope_memory::Law;
using ::testing::HasSubstr;

constexpr std::array laws{Law::yields, Law::has_two_curves};

TEST(EditOfARopeWithMemory, OfAnotherPartKeepsTheMemory) {
  // A weight without a rope, and a rope of its own, come to the world in the middle of a swing: the
  // first load moves on, bit for bit, because it shares nothing with them.
  for (const Law law : laws) {
    test::Machine m = hanging(law, 0.016);
    m.model.step = test::direct_settings(IntegratorKind::rattle, 0.005);
    LiveWorld world = test::live(m);
    LiveWorld alone = test::live(m);
    for (int i = 0; i < 60; ++i) {
      ASSERT_TRUE(world.step().ok());
      ASSERT_TRUE(alone.step().ok());
    }
    ASSERT_GT(world.simulation().cable_reports()[0].spans[0].remembered, 0.0);
    test::edit(world, [&](Edit& e) {
      const BodyHandle other = e.add(test::weight("other", {3.0, -2.0, 0.0}, 1.0));
      e.add(test::cable(
          "line", {test::attach(BodyId::world(), {3.0, 0.0, 0.0}), test::attach(e.id(other))}));
    });
    for (int i = 0; i < 60; ++i) {
      ASSERT_TRUE(world.step().ok());
      ASSERT_TRUE(alone.step().ok());
      ASSERT_EQ(world.simulation().world.position({0}).y(),
                alone.simulation().world.position({0}).y());
    }
    EXPECT_EQ(world.simulation().cable_reports()[0].hysteresis_loss,
              alone.simulation().cable_reports()[0].hysteresis_loss);
  }
}

TEST(EditOfARopeWithMemory, ThatTakesTheRopeApartIsRefused) {
  LiveWorld world = test::live(hanging(Law::yields, 0.016));
  const CableHandle rope = *world.cable("rope");
  EXPECT_THAT(test::refused(world, [&](Edit& e) { e.detach(rope, CableEnd::last); }),
              HasSubstr("remembers how it was stretched"));
  EXPECT_THAT(test::refused(world, [&](Edit& e) { e.pay_out(rope, 0, 0.1); }),
              HasSubstr("cut it instead"));
}

}  // namespace
}  // namespace sheave::edit_memory
