// Prefixes of units in figures.

#include "scenes/unit_scale.h"

#include <gtest/gtest.h>

namespace sheave {
namespace {

TEST(UnitScale, OnlyUsualUnitsHaveAPrefix) {
  EXPECT_EQ(unit_scale(76'400.0, "N").prefix, "k");
  EXPECT_EQ(unit_scale(76'400.0, "N").factor, 1e3);
  EXPECT_EQ(unit_scale(-2e7, "N m").prefix, "M");
  EXPECT_EQ(unit_scale(0.01, "m/s").prefix, "m");
  EXPECT_EQ(unit_scale(2e4, "J").prefix, "k");
  for (const char* unit : {"", "rad", "rad/s", "kg", "kg m2", "1/s2", "m2", "N, N m"}) {
    EXPECT_EQ(unit_scale(76'400.0, unit).prefix, "") << unit;
    EXPECT_EQ(unit_scale(76'400.0, unit).factor, 1.0) << unit;
  }
}

TEST(UnitScale, SecondsHaveNoKilo) {
  EXPECT_EQ(unit_scale(1e5, "s").prefix, "");
  EXPECT_EQ(unit_scale(1e-3, "s").prefix, "m");
}

}  // namespace
}  // namespace sheave
