#include "scenes/unit.h"

#include <gtest/gtest.h>

namespace sheave {
namespace {

TEST(Units, ProductsAreNamedInFewFactors) {
  const Unit metre("m");
  const Unit second("s");
  const Unit newton("N");
  const Unit kilogram("kg");
  EXPECT_EQ(newton.times(metre).text(), "N m");
  EXPECT_EQ(newton.over(metre).text(), "N/m");
  EXPECT_EQ(newton.times(second).over(metre).text(), "N s/m");
  EXPECT_EQ(kilogram.times(metre).over(second).text(), "kg m/s");
  EXPECT_EQ(kilogram.times(metre).over(second).over(second).text(), "N");
  EXPECT_EQ(metre.over(metre).text(), "");
  EXPECT_EQ(Unit().over(newton.times(metre)).text(), "1/(N m)");
  EXPECT_EQ(newton.to_the(2.0).over(metre.to_the(3.0)).text(), "N2/m3");
  EXPECT_EQ(metre.to_the(-0.5).text(), "1/m^0.5");
}

TEST(Units, FactorsWithoutAUnitLeaveTheName) {
  EXPECT_EQ(Unit("J").times(Unit()).text(), "J");
  EXPECT_EQ(Unit().times(Unit("J")).text(), "J");
  EXPECT_EQ(Unit("J").over(Unit()).text(), "J");
  EXPECT_EQ(Unit("J").to_the(1.0).text(), "J");
  EXPECT_TRUE(Unit("J").agrees_with(Unit("N m")));
}

TEST(Units, RadiansVanishBesideMatter) {
  EXPECT_EQ(Unit("rad").times(Unit("m")).text(), "m");
  EXPECT_EQ(Unit("N m").times(Unit("rad/s")).text(), "W");
  EXPECT_EQ(Unit("N m").over(Unit("rad")).text(), "N m/rad");
  EXPECT_EQ(Unit("rad").over(Unit("s")).text(), "rad/s");
  EXPECT_TRUE(Unit("rad").agrees_with(Unit()));
  EXPECT_TRUE(Unit("rad").is_pure());
  EXPECT_FALSE(Unit("rad/s").is_pure());
  EXPECT_FALSE(Unit("rad/s").agrees_with(Unit("rad")));
}

TEST(Units, OneOfSeveralIsOpen) {
  const Unit open("N, N m");
  EXPECT_TRUE(open.is_open());
  EXPECT_TRUE(open.agrees_with(Unit("s")));
  EXPECT_TRUE(Unit("s").agrees_with(open));
  EXPECT_EQ(open.text(), "N, N m");
  EXPECT_TRUE(open.times(Unit("m")).is_open());
  EXPECT_EQ(open.times(Unit("m")).text(), "");
  EXPECT_EQ(open.to_the(0.0).is_open(), false);
}

TEST(Units, TextsReadBack) {
  for (const char* text : {"", "m", "N", "N m", "N/m", "m/s", "m/s2", "rad/s", "kg m2/s", "kg m/s",
                           "W", "N m/rad", "1/s", "N2", "kg/m3", "N s/m"}) {
    const Unit unit(text);
    EXPECT_FALSE(unit.is_open()) << text;
    EXPECT_EQ(unit.to_the(2.0).to_the(0.5).text(), text);
  }
}

}  // namespace
}  // namespace sheave
