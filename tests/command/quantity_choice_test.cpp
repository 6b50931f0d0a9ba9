// Lists of names, patterns and expressions in options.

#include "command/input/quantity_choice.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/random.h"

namespace sheave::test {
namespace {

using command::split_quantities;
using testing::ElementsAre;
using testing::HasSubstr;

const std::vector<std::string> columns{"t", "a.x", "a.y", "b.x", "'odd', name"};

class ColumnsOfTest final : public QuantityNames {
 public:
  [[nodiscard]] std::optional<int> find(std::string_view name) const override {
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (columns[i] == name) return static_cast<int>(i);
    }
    return {};
  }
  [[nodiscard]] std::size_t longest() const override { return 20; }
  [[nodiscard]] Unit unit(int /*index*/) const override { return Unit("m"); }
  [[nodiscard]] std::string fault(std::string_view name) const override {
    return "no " + std::string(name);
  }
};

TEST(QuantityChoice, CommasInParenthesesAndQuotesSeparateNothing) {
  EXPECT_THAT(split_quantities("a.x"), ElementsAre("a.x"));
  EXPECT_THAT(split_quantities("a.x, b.x ,c"), ElementsAre("a.x", "b.x", "c"));
  EXPECT_THAT(split_quantities("hypot(a.x, b.x),max(a, min(b, c)),d"),
              ElementsAre("hypot(a.x, b.x)", "max(a, min(b, c))", "d"));
  EXPECT_THAT(split_quantities("'a,b'.x,c"), ElementsAre("'a,b'.x", "c"));
  EXPECT_THAT(split_quantities("a[xy,z],c"), ElementsAre("a[xy,z]", "c"));
  EXPECT_THAT(split_quantities(""), ElementsAre(""));
  EXPECT_THAT(split_quantities("a,,b,"), ElementsAre("a", "", "b", ""));
  EXPECT_THAT(split_quantities("a),b"), ElementsAre("a)", "b"));
  EXPECT_THAT(split_quantities("f(a,b"), ElementsAre("f(a,b"));
  const std::vector<std::string> lists{"a,b", "c"};
  EXPECT_THAT(split_quantities(lists), ElementsAre("a", "b", "c"));
}

TEST(QuantityChoice, ANameComesBeforeAPatternAndThatBeforeAnExpression) {
  const auto chosen = [](const std::string& text) {
    return command::chosen_quantities(text, columns, ColumnsOfTest());
  };
  EXPECT_THAT(chosen("a.x")->indices, ElementsAre(1));
  EXPECT_THAT(chosen("'odd', name")->indices, ElementsAre(4));
  EXPECT_THAT(chosen("a.*")->indices, ElementsAre(1, 2));
  EXPECT_THAT(chosen("?.[x]")->indices, ElementsAre(1, 3));
  EXPECT_THAT(chosen("a.x * b.x")->indices, ElementsAre()) << "no name matches";
  ASSERT_TRUE(chosen("a.x * b.x")->expression.has_value());
  EXPECT_EQ(chosen("a.x * b.x")->expression->unit().text(), "m2");
  EXPECT_THAT(chosen("c.*").errors().front().message,
              HasSubstr("no quantity matches \"c.*\"; nor is it an expression: "));
  EXPECT_EQ(chosen("c.x").errors().front().message, "no c.x");
}

// No part is lost, whatever the text: the parts with commas between them are the text again, but
// for spaces.
TEST(QuantityChoice, PartsOfRandomTextsMakeUpTheText) {
  Random random(1);
  const std::string characters = "ab,()[]' .";
  for (int i = 0; i < 10000; ++i) {
    std::string text;
    const int count = random.below(20);
    for (int k = 0; k < count; ++k) {
      text +=
          characters[static_cast<std::size_t>(random.below(static_cast<int>(characters.size())))];
    }
    std::string again = fmt::format("{}", fmt::join(split_quantities(text), ","));
    std::erase(again, ' ');
    std::erase(text, ' ');
    EXPECT_EQ(again, text);
  }
}

}  // namespace
}  // namespace sheave::test
