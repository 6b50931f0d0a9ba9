// The evaluation of expressions allocates no memory.

#include <array>
#include <cmath>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "scenes/quantity_list.h"
#include "tests/control/allocation_count.h"
#include "tests/support/builders.h"

namespace sheave::test {
namespace {

TEST(ExpressionAllocation, IsZeroInEachEvaluation) {
  Machine machine;
  machine.model.add(lump("first", {1.0, 2.0, 3.0}, 2.0));
  machine.model.add(lump("second", {4.0, 5.0, 6.0}, 1.0));
  const Simulation simulation = start(machine);
  const std::vector<std::string> texts{"first.x", "hypot(first.x - second.x, first.y - second.y)",
                                       "if(sin(first.x / 2[m]) > 0, first.x, second.x) ^ 2.5"};
  QuantityList list(QuantityIndex::of(simulation, texts));
  for (const std::string& one : texts) EXPECT_EQ(text(list.add(one)), "");
  std::array<double, 3> values{};
  const std::int64_t before = allocation_count();
  for (int i = 0; i < 100; ++i) list.sample(simulation, values);
  EXPECT_EQ(allocation_count(), before);
  EXPECT_NEAR(values[1], std::sqrt(18.0), 1e-15 * 18.0);
  EXPECT_NEAR(values[2], 1.0, 1e-15) << "sin(1/2) > 0, and 1^2.5";
}

}  // namespace
}  // namespace sheave::test
