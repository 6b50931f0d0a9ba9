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

TEST(suggestion, finds_the_nearest_word) {
  EXPECT_EQ(best("poisition", {"orientation", "position", "posture"}), "position");
  EXPECT_EQ(best("mas", {"mount", "mass", "axis"}), "mass");
  EXPECT_EQ(best("Winding", {"winding"}), "winding");
}

TEST(suggestion, a_swap_of_neighbours_is_one_mistake) {
  EXPECT_EQ(best("whele", {"whale5", "wheel"}), "wheel");
}

TEST(suggestion, says_nothing_if_nothing_is_near) {
  EXPECT_EQ(best("colour", {"mass", "axis", "position"}), "");
  EXPECT_EQ(best("x", {"y", "zz"}), "");
  EXPECT_EQ(best("", {"a"}), "");
  EXPECT_EQ(Suggestion("abc").question(), "");
}

TEST(suggestion, of_equals_the_first_wins) {
  EXPECT_EQ(best("bodyx", {"bodya", "bodyb"}), "bodya");
}

TEST(suggestion, very_long_words_cost_nothing) {
  const std::string endless(1'000'000, 'a');
  Suggestion suggestion(endless);
  suggestion.consider(endless);
  EXPECT_EQ(suggestion.best(), "");
}

}  // namespace
}  // namespace sheave
