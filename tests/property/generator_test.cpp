// The generator itself: reproducible, accepted as a rule, and with all that it promises among its machines.

#include <map>

#include <gtest/gtest.h>

#include "tests/property/campaign.h"

namespace sheave::test {
namespace {

TEST(RandomMachine, IsTheSameForTheSameSeed) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    EXPECT_EQ(describe(random_machine(seed).machine), describe(random_machine(seed).machine));
  }
  EXPECT_NE(describe(random_machine(1).machine), describe(random_machine(2).machine));
}

TEST(RandomMachine, IsAcceptedAsARule) {
  int refused = 0;
  constexpr int seeds = 300;
  std::map<std::string, int> reasons;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const RandomMachine random = random_machine(seed);
    refused += random.refused;
    if (random.refused > 0) ++reasons[random.first_refusal];
  }
  std::string list;
  for (const auto& [reason, count] : reasons) list += std::to_string(count) + " x " + reason;
  EXPECT_LT(refused, seeds / 4) << list;
}

TEST(RandomMachine, HasEveryKindOfLink) {
  std::string all;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) all += describe(random_machine(seed).machine);
  for (const char* part :
       {"attachment(", "rolling(",   "pinhole(",       "hybrid(",   "spool(",
        "closed",      "lifted",     "turns",          " J=0",      "(free",
        "(planar",     "(slider",    "(kinematic",     "(rotor on", "mu 0.",
        "EA",          "compliance", "frozen",         "radius",    "rest lengths given",
        "pitch 0.0",   " direct ",   " gauss-seidel ", " xpbd;",    " rattle;"}) {
    EXPECT_NE(all.find(part), std::string::npos) << part;
  }
}

}  // namespace
}  // namespace sheave::test
