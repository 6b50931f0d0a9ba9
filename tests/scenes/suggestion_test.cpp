#include "scenes/suggestion.h"

#include <string>

#include <gtest/gtest.h>

namespace sheave {
namespace {

std::string best(std::string_view text, std::initializer_list<std::string_view> candidates) {
  Suggestion suggestion(text);
  for (const std::string_view candidate : candidates) suggestion.consider(candidate);
  return std::string(suggestion.best());
}

TEST(Suggestion, FindsTheNearestWord) {
  EXPECT_EQ(best("poisition", {"orientation", "position", "posture"}), "position");
  EXPECT_EQ(best("mas", {"mount", "mass", "axis"}), "mass");
  EXPECT_EQ(best("Winding", {"winding"}), "winding");
}

TEST(Suggestion, ASwapOfNeighboursIsOneMistake) {
  EXPECT_EQ(best("whele", {"whale5", "wheel"}), "wheel");
}

TEST(Suggestion, IsEmptyIfNoWordIsNear) {
  EXPECT_EQ(best("colour", {"mass", "axis", "position"}), "");
  EXPECT_EQ(best("x", {"y", "zz"}), "");
  EXPECT_EQ(best("", {"a"}), "");
  EXPECT_EQ(Suggestion("abc").question(), "");
}

TEST(Suggestion, TheFirstOfEqualWordsWins) {
  EXPECT_EQ(best("bodyx", {"bodya", "bodyb"}), "bodya");
}

TEST(Suggestion, VeryLongWordsCostNothing) {
  const std::string endless(1'000'000, 'a');
  Suggestion suggestion(endless);
  suggestion.consider(endless);
  EXPECT_EQ(suggestion.best(), "");
}

}  // namespace
}  // namespace sheave
