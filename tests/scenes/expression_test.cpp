// Expressions against trees that the test evaluates itself, closed forms, and texts of no sense.

#include "scenes/expression.h"

#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/random.h"

namespace sheave::test {
namespace {

using testing::HasSubstr;

struct Named {
  std::string name;
  std::string unit;
  double value;
};
const std::vector<Named> quantities{
    {"t", "s", 2.0},
    {"a.x", "m", 3.0},
    {"b.x", "m", 5.0},
    {"a.angle", "rad", 0.5},
    {"hoist cable.0.tension", "N", 12.0},
    {"my-rope.0.tension", "N", 7.0},
    {"t-rope.0.tension", "N", 8.0},
    {"rope.0.tension", "N", 9.0},
    {"-left.x", "m", 4.0},
    {"left.x", "m", 6.0},
    {"2-drum.angle", "rad", 1.5},
    {"drum.angle", "rad", 2.5},
    {"max.x", "m", 11.0},
    {"rope.wraps", "", 2.0},
    {"winch.drive_force", "N, N m", 10.0},
    {"motor.drive_torque", "N m", 20.0},
    {"motor.wz", "rad/s", 30.0},
    {"nothing.x", "m", std::numeric_limits<double>::quiet_NaN()},
};

class Names final : public QuantityNames {
 public:
  [[nodiscard]] std::optional<int> find(std::string_view name) const override {
    for (std::size_t i = 0; i < quantities.size(); ++i) {
      if (quantities[i].name == name) return static_cast<int>(i);
    }
    return {};
  }
  [[nodiscard]] std::size_t longest() const override { return 40; }
  [[nodiscard]] Unit unit(int index) const override {
    return Unit(quantities[static_cast<std::size_t>(index)].unit);
  }
  [[nodiscard]] std::string fault(std::string_view name) const override {
    return fmt::format("no \"{}\"", name);
  }
};

/// A pure number "x".
class OneName final : public QuantityNames {
 public:
  [[nodiscard]] std::optional<int> find(std::string_view name) const override {
    return name == "x" ? std::optional(0) : std::nullopt;
  }
  [[nodiscard]] std::size_t longest() const override { return 1; }
  [[nodiscard]] Unit unit(int /*index*/) const override { return {}; }
  [[nodiscard]] std::string fault(std::string_view name) const override {
    return std::string(name);
  }
};

std::vector<double> all_values() {
  std::vector<double> values;
  for (const Named& one : quantities) values.push_back(one.value);
  return values;
}

double value(const std::string& text) {
  const Result<Expression> expression = Expression::compile(text, Names());
  EXPECT_TRUE(expression) << expression.errors().front().message;
  return expression ? expression->value(all_values()) : 1e99;
}
std::string unit(const std::string& text) {
  const Result<Expression> expression = Expression::compile(text, Names());
  EXPECT_TRUE(expression) << expression.errors().front().message;
  return expression ? expression->unit().text() : "?";
}
std::string fault(const std::string& text) {
  const Result<Expression> expression = Expression::compile(text, Names());
  EXPECT_FALSE(expression) << text;
  return expression ? "" : expression.errors().front().message;
}

TEST(Expressions, OperatorsHaveTheUsualPrecedence) {
  EXPECT_EQ(value("1 + 2 * 3"), 7.0);
  EXPECT_EQ(value("(1 + 2) * 3"), 9.0);
  EXPECT_EQ(value("8 - 4 - 2"), 2.0) << "from the left";
  EXPECT_EQ(value("8 / 4 / 2"), 1.0);
  EXPECT_EQ(value("8 / 4 * 2"), 4.0);
  EXPECT_EQ(value("2 ^ 3 ^ 2"), 512.0) << "from the right";
  EXPECT_EQ(value("-2 ^ 2"), -4.0);
  EXPECT_EQ(value("(-2) ^ 2"), 4.0);
  EXPECT_EQ(value("2 ^ -1"), 0.5);
  EXPECT_EQ(value("2 ^ -2 ^ 2"), 0.0625) << "2^(-(2^2))";
  EXPECT_EQ(value("2 * -3"), -6.0);
  EXPECT_EQ(value("- - 3"), 3.0);
  EXPECT_EQ(value("+3"), 3.0);
  EXPECT_EQ(value("1 + 2 < 4"), 1.0);
  EXPECT_EQ(value("3 >= 3"), 1.0);
  EXPECT_EQ(value("3 != 3"), 0.0);
  EXPECT_EQ(value("(1 < 2) == (3 < 4)"), 1.0);
  EXPECT_EQ(value("if(a.x > b.x, 1, 2)"), 2.0);
  EXPECT_EQ(value("max(1, 3, 2) - min(5, 4)"), -1.0);
  EXPECT_EQ(value("hypot(2, 3, 6)"), 7.0);
  EXPECT_EQ(value("  1+  2 "), 3.0);
  EXPECT_EQ(value(".5 + 1.5e1 + 2E-1 + 007"), 0.5 + 15.0 + 0.2 + 7.0);
}

TEST(Expressions, ANameIsItselfAndNoDifference) {
  EXPECT_EQ(value("my-rope.0.tension"), 7.0);
  EXPECT_EQ(value("t-rope.0.tension"), 8.0) << "the whole text is a name";
  EXPECT_EQ(value("hoist cable.0.tension / 2"), 6.0);
  EXPECT_EQ(value("my-rope.0.tension*2"), 14.0);
  EXPECT_EQ(value("a.x-b.x"), -2.0);
  EXPECT_EQ(value("a.x-my-rope.0.tension/rope.0.tension*a.x"), 3.0 - 7.0 / 9.0 * 3.0);
  EXPECT_EQ(value("'hoist cable'.0.tension + 'my-rope'.0.tension"), 19.0);
  EXPECT_EQ(value("'hoist cable.0.tension'*2"), 24.0);
  EXPECT_EQ(value("max.x + max(max.x, 1)"), 22.0);
  EXPECT_EQ(value("2*'2-drum'.angle"), 3.0);
  EXPECT_EQ(value("'-left'.x - left.x"), -2.0);
  EXPECT_EQ(value("b.x - left.x"), -1.0);
}

TEST(Expressions, ATextThatCouldBeANameOrADifferenceIsRefused) {
  EXPECT_THAT(fault("t-rope.0.tension + 1"), HasSubstr("write 't-rope.0.tension'"));
  EXPECT_THAT(fault("t-rope.0.tension + 1"), HasSubstr("column 1:"));
  EXPECT_THAT(fault("1 + 2-drum.angle"), HasSubstr("column 5:"));
  EXPECT_THAT(fault("b.x -left.x"), HasSubstr("\"-left.x\" is a quantity, and could be"));
  EXPECT_THAT(fault("2 * -left.x"), HasSubstr("column 5:"));
  EXPECT_EQ(value("t - rope.0.tension / rope.0.tension * t"), 0.0) << "spaces settle it";
}

TEST(Expressions, FaultsHaveTheirColumnAndNameTheExpected) {
  EXPECT_EQ(fault("a.y"), "no \"a.y\"");
  EXPECT_EQ(fault("hoist cabel.0.tension"), "no \"hoist cabel.0.tension\"") << "of a plain name";
  EXPECT_EQ(fault("a.x + c.x"), "expression \"a.x + c.x\", column 7: no \"c.x\"");
  EXPECT_THAT(fault("c.x - a.x"), HasSubstr("column 1: no \"c.x\""));
  EXPECT_THAT(fault("2 * hoist cabel.0.tension"), HasSubstr("no \"hoist cabel.0.tension\""));
  EXPECT_THAT(fault("foo - a.x"), HasSubstr("column 1: no \"foo\""));
  EXPECT_THAT(fault("'a.x"), HasSubstr("column 1: this quote has no end"));
  EXPECT_THAT(fault("1 +"), HasSubstr("column 4: expected a quantity, a number, a function or \"(\""
                                      ", found the end"));
  EXPECT_THAT(fault("(1 + 2"), HasSubstr("column 7: expected \")\", found the end"));
  EXPECT_THAT(fault("1 + 2)"), HasSubstr("column 6: this \")\" has no \"(\""));
  EXPECT_THAT(fault("1 2"), HasSubstr("column 3: expected an operator or the end, found \"2\""));
  EXPECT_THAT(fault("\"a.x\" * 2"), HasSubstr("names are quoted with '"));
  EXPECT_THAT(fault("\xc3\xa4 + 1"), HasSubstr("found \"\xc3\xa4\""));
  EXPECT_THAT(fault("'\xc3\xa4' + !"), HasSubstr("column 1:"));
  EXPECT_THAT(fault("hypott(1, 2)"), HasSubstr("did you mean \"hypot\"?"));
  EXPECT_THAT(fault("hypot(1)"), HasSubstr("hypot has 2 or more arguments, not 1"));
  EXPECT_THAT(fault("abs()"), HasSubstr("abs has 1 argument, not 0"));
  EXPECT_THAT(fault("if(1, 2)"), HasSubstr("if has 3 arguments, not 2"));
  EXPECT_THAT(fault("sin(1, 2)"), HasSubstr("column 8: sin has 1 argument, not 2"));
  EXPECT_THAT(fault("sin + 1"), HasSubstr("write sin(...)"));
  EXPECT_THAT(fault("1 < 2 < 3"), HasSubstr("comparisons cannot follow one another"));
  EXPECT_THAT(fault("1e999"), HasSubstr("this number is too large"));
  EXPECT_EQ(fault(""), "no \"\"");
}

TEST(Expressions, UnitsFollowFromTheOperations) {
  EXPECT_EQ(unit("a.x - b.x"), "m");
  EXPECT_EQ(unit("a.x + 1"), "m") << "a plain number takes the unit";
  EXPECT_EQ(unit("1 - a.x"), "m");
  EXPECT_EQ(unit("2 * a.x"), "m");
  EXPECT_EQ(unit("a.x * b.x"), "m2");
  EXPECT_EQ(unit("a.x / t"), "m/s");
  EXPECT_EQ(unit("a.x / t ^ 2"), "m/s2");
  EXPECT_EQ(unit("rope.0.tension / my-rope.0.tension"), "");
  EXPECT_EQ(unit("rope.0.tension / a.x"), "N/m");
  EXPECT_EQ(unit("rope.0.tension * a.x"), "N m");
  EXPECT_EQ(unit("rope.0.tension * a.x / t"), "W");
  EXPECT_EQ(unit("motor.drive_torque * motor.wz"), "W") << "radians vanish beside metres";
  EXPECT_EQ(unit("a.angle * a.x - b.x"), "m") << "an arc";
  EXPECT_EQ(unit("rope.0.tension ^ 2"), "N2");
  EXPECT_EQ(unit("sqrt(a.x * b.x)"), "m");
  EXPECT_EQ(unit("sqrt(a.x)"), "m^0.5");
  EXPECT_EQ(unit("1 / t"), "1/s");
  EXPECT_EQ(unit("hypot(a.x, b.x, 1)"), "m");
  EXPECT_EQ(unit("atan2(a.x, b.x)"), "rad");
  EXPECT_EQ(unit("a.x > b.x"), "");
  EXPECT_EQ(unit("sin(a.angle) * a.x"), "m");
  EXPECT_EQ(unit("if(a.x > 1, rope.0.tension, 0)"), "N");
  EXPECT_EQ(unit("a.x + 1[m]"), "m");
  EXPECT_EQ(unit("0.5[N s/m] * a.x / t"), "N");
  EXPECT_EQ(unit("sin(2[rad/s] * t) * 3[m]"), "m");
  EXPECT_EQ(value("sin(0.25[rad/s] * t)"), value("sin(0.5)"));
  EXPECT_EQ(value("2[m] + 3[m]"), 5.0);
  EXPECT_EQ(unit("2[m] * 3[N]"), "N m");
  EXPECT_EQ(unit("winch.drive_force"), "N, N m");
  EXPECT_EQ(unit("winch.drive_force + a.x"), "m") << "an open unit agrees with all";
}

TEST(Expressions, UnitsThatDisagreeAreNamed) {
  EXPECT_THAT(fault("a.x + rope.0.tension"),
              HasSubstr("column 5: + needs one unit; \"a.x\" is in m, and \"rope.0.tension\" is in "
                        "N"));
  EXPECT_THAT(fault("a.x > t"), HasSubstr("> needs one unit"));
  EXPECT_THAT(fault("a.x - rope.wraps"), HasSubstr("\"rope.wraps\" is a pure number"));
  EXPECT_THAT(fault("max(a.x, 1, t)"), HasSubstr("max needs one unit"));
  EXPECT_THAT(fault("sin(a.x)"), HasSubstr("the argument of sin must be a pure number or an angle; "
                                           "\"a.x\" is in m"));
  EXPECT_THAT(fault("a.x + 1[N]"), HasSubstr("\"1[N]\" is in N"));
  EXPECT_THAT(fault("sin(2 * t)"), HasSubstr("\"2 * t\" is in s"));
  EXPECT_THAT(fault("1[m] + 1[N]"), HasSubstr("+ needs one unit"));
  EXPECT_THAT(fault("2[furlong]"), HasSubstr("column 3: \"furlong\" is no unit"));
  EXPECT_THAT(fault("2[m"), HasSubstr("column 2: this \"[\" has no \"]\""));
  EXPECT_THAT(fault("2 ^ a.x"), HasSubstr("an exponent must be a pure number"));
  EXPECT_THAT(fault("a.x ^ rope.wraps"), HasSubstr("the exponent must be a number"));
  EXPECT_THAT(fault("a.x ^ 13"), HasSubstr("must be between -12 and 12"));
  EXPECT_THAT(fault("if(a.x, 1, 2)"), HasSubstr("the condition of if"));
}

TEST(Expressions, FunctionsAgreeWithTheStandardLibrary) {
  // The errors of engine/math/portable.h are below 1e-15; those of an angle near its end grow with
  // 1 / sqrt(1 - x^2), which is below 10 here.
  const auto expect = [](const std::string& text, double right) {
    EXPECT_NEAR(value(text), right, 1e-14 * std::max(1.0, std::abs(right))) << text;
  };
  for (const double x : {-0.99, -0.5, -1e-9, 0.0, 0.3, 0.7, 0.995}) {
    const std::string at = fmt::format("({})", x);
    expect("sin" + at, std::sin(x));
    expect("cos" + at, std::cos(x));
    expect("tan" + at, std::tan(x));
    expect("asin" + at, std::asin(x));
    expect("acos" + at, std::acos(x));
    expect("atan" + at, std::atan(x));
    expect("exp" + at, std::exp(x));
    expect("abs" + at, std::abs(x));
    expect("atan2(" + at + ", -0.4)", std::atan2(x, -0.4));
    expect("(2 + " + at + ") ^ 2.3", std::pow(2.0 + x, 2.3));
    expect("log(2 + " + at + ")", std::log(2.0 + x));
    expect("sqrt(2 + " + at + ")", std::sqrt(2.0 + x));
  }
  expect("sin(pi / 6)", 0.5);
  expect("1.01 ^ 1000", std::pow(1.01, 1000.0));
  EXPECT_EQ(value("asin(1) * 2"), std::numbers::pi);
  EXPECT_EQ(value("0 ^ 0.3"), 0.0);
  EXPECT_EQ(value("2 ^ 0.5"), std::sqrt(2.0));
}

TEST(Expressions, AMissingOperandGivesNoNumber) {
  for (const char* text : {"nothing.x + 1", "min(nothing.x, 1)", "max(1, nothing.x)",
                           "nothing.x > 1", "nothing.x != 1", "if(nothing.x > 1, 1, 2)", "sqrt(-1)",
                           "log(-1)", "asin(2)", "(-2) ^ 0.3", "0 / 0"}) {
    const double found = value(text);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(found),
              std::bit_cast<std::uint64_t>(std::numeric_limits<double>::quiet_NaN()))
        << text << " has one NaN on all machines";
  }
  EXPECT_EQ(value("if(a.x > 1, 1, nothing.x)"), 1.0) << "the other branch does not matter";
}

// One hash of a thousand values of every function, the same with every compiler and processor.
TEST(Expressions, ValuesHaveTheSameBitsInAllBuilds) {
  const Result<Expression> expression = Expression::compile(
      "hypot(sin(x), cos(3 * x), tan(x)) + atan2(x, 2) ^ 2 - log(2 + abs(x)) * exp(-x ^ 2 / 50) + "
      "asin(sin(x)) * acos(cos(x)) / (1 + x ^ 4) ^ 0.3 + sqrt(abs(x)) - min(x, 1, x / 3) * atan(x)",
      OneName());
  ASSERT_TRUE(expression) << expression.errors().front().message;
  std::uint64_t hash = 0;
  for (int i = 0; i < 1000; ++i) {
    const double x = (i - 500) / 16.0;
    hash = hash * 1099511628211U + std::bit_cast<std::uint64_t>(expression->value({&x, 1}));
  }
  EXPECT_EQ(hash, 4787697160965708806U);
}

/// A random expression that the test evaluates itself, and writes with as few parentheses as
/// arithmetic needs, or with more.
struct Tree {
  std::string text;
  double value = 0.0;
  int level = 9;  // of its outermost operator: 1 comparison, 2 sum, 3 product, 4 sign, 5 power
};

std::string wrapped(const Tree& tree, bool needs, Random& random) {
  return needs || random.chance(0.1) ? "(" + tree.text + ")" : tree.text;
}

Tree leaf(Random& random) {
  const int choice = random.below(6);
  if (choice < 2) return {choice == 0 ? "a.x" : "hoist cable.0.tension", choice == 0 ? 3.0 : 12.0};
  const double number = random.below(1000) / 8.0;
  return {fmt::format("{}", number), number};
}

Tree tree(Random& random, int depth) {
  if (depth == 0 || random.chance(0.15)) return leaf(random);
  const std::string space = random.chance(0.5) ? " " : "";
  const int choice = random.below(9);
  const Tree a = tree(random, depth - 1);
  if (choice == 0) return {"-" + space + wrapped(a, a.level < 4, random), -a.value, 4};
  if (choice == 1) return {"abs(" + a.text + ")", std::abs(a.value)};
  const Tree b = tree(random, depth - 1);
  const auto binary = [&](const char* sign, int level, double result) {
    // Operators of one level are done from the left, so the right one needs parentheses.
    return Tree{wrapped(a, a.level < level, random) + space + sign + space +
                    wrapped(b, b.level <= level, random),
                result, level};
  };
  switch (choice) {
    case 2:
      return binary("+", 2, a.value + b.value);
    case 3:
      return binary("-", 2, a.value - b.value);
    case 4:
      return binary("*", 3, a.value * b.value);
    case 5:
      return binary("/", 3, a.value / b.value);
    case 6: {
      const int power = random.below(4);
      const double x = a.value;
      return {wrapped(a, a.level <= 5, random) + space + "^" + space + std::to_string(power),
              std::array{1.0, x, x * x, x * (x * x)}[static_cast<std::size_t>(power)], 5};
    }
    case 7:
      return {
          "max(" + a.text + "," + space + b.text + ")",
          std::isnan(a.value) || std::isnan(b.value) ? std::nan("") : std::max(a.value, b.value)};
    default:
      // The sides are sums: a comparison in a comparison needs parentheses on both sides.
      return {wrapped(a, a.level <= 1, random) + space + "<=" + space +
                  wrapped(b, b.level <= 1, random),
              std::isnan(a.value) || std::isnan(b.value) ? std::nan("")
              : a.value <= b.value                       ? 1.0
                                                         : 0.0,
              1};
  }
}

/// Names without units, so that any arithmetic is allowed.
class PureNames final : public QuantityNames {
 public:
  [[nodiscard]] std::optional<int> find(std::string_view name) const override {
    return Names().find(name);
  }
  [[nodiscard]] std::size_t longest() const override { return 40; }
  [[nodiscard]] Unit unit(int /*index*/) const override { return {}; }
  [[nodiscard]] std::string fault(std::string_view name) const override {
    return std::string(name);
  }
};

TEST(Expressions, TenThousandRandomTreesHaveTheirValuesToTheBit) {
  Random random(1);
  int finite = 0;
  for (int i = 0; i < 10000; ++i) {
    const Tree expected = tree(random, 1 + random.below(6));
    if (expected.text.size() > Expression::most_characters) continue;
    const Result<Expression> expression = Expression::compile(expected.text, PureNames());
    ASSERT_TRUE(expression) << expected.text << ": " << expression.errors().front().message;
    const double found = expression->value(all_values());
    finite += std::isfinite(found) ? 1 : 0;
    if (std::isnan(expected.value)) {
      EXPECT_TRUE(std::isnan(found)) << expected.text;
    } else {
      EXPECT_EQ(found, expected.value) << expected.text;
    }
  }
  EXPECT_GT(finite, 7000) << "most of them say something";
}

TEST(Expressions, SizeAndDepthAreBounded) {
  const auto repeated = [](const std::string& part, int count) {
    std::string text;
    for (int i = 0; i < count; ++i) text += part;
    return text;
  };
  EXPECT_THAT(fault(repeated("1+", 500) + "1"), HasSubstr("1001 characters is too long; at most "
                                                          "1000"));
  EXPECT_EQ(value(repeated("1+", 499) + "1"), 500.0) << "a long sum is not deep";
  const int most = Expression::most_nesting - 1;
  EXPECT_EQ(value(repeated("(", most) + "1" + repeated(")", most)), 1.0);
  EXPECT_THAT(fault(repeated("(", most + 1) + "1" + repeated(")", most + 1)),
              HasSubstr("column 41: nested too deeply: at most 40"));
  EXPECT_THAT(fault(repeated("-", 900) + "1"), HasSubstr("nested too deeply"));
  EXPECT_THAT(fault(repeated("2^", 400) + "1"), HasSubstr("nested too deeply"));
  EXPECT_THAT(fault(repeated("abs(", 200)), HasSubstr("nested too deeply"));
  // Every level keeps two values: the most that an evaluation has to store.
  EXPECT_EQ(value(repeated("if(rope.wraps,a.x,", most) + "1" + repeated(")", most)), 3.0);
  EXPECT_EQ(value(repeated("if(0*t/t,a.x,", most - 1) + "1" + repeated(")", most - 1)), 1.0);
  EXPECT_EQ(value(repeated("t/t+(", most / 2) + "1" + repeated(")", most / 2)), 1 + most / 2);
}

TEST(Expressions, TextsOfNoSenseAreRefusedOrHaveAValue) {
  const std::array<const char*, 34> pieces{"a.x",
                                           "b.x",
                                           "t",
                                           "t-rope.0.tension",
                                           "hoist cable.0.tension",
                                           "'",
                                           "''",
                                           ".",
                                           "..",
                                           "1",
                                           "1e",
                                           "1e-3",
                                           "0x10",
                                           "inf",
                                           "nan",
                                           "+",
                                           "-",
                                           "*",
                                           "/",
                                           "^",
                                           "<",
                                           "<=",
                                           "=",
                                           "!",
                                           "(",
                                           ")",
                                           ",",
                                           "if(",
                                           "max",
                                           "pi",
                                           " ",
                                           "\n",
                                           "\xff",
                                           "\xc3\xa4"};
  Random random(2);
  int accepted = 0;
  for (int i = 0; i < 100000; ++i) {
    std::string text;
    const int count = 1 + random.below(12);
    for (int k = 0; k < count; ++k) {
      text += pieces[static_cast<std::size_t>(random.below(static_cast<int>(pieces.size())))];
    }
    const Result<Expression> expression = Expression::compile(text, Names());
    if (!expression) {
      ASSERT_FALSE(expression.errors().front().message.empty()) << text;
      continue;
    }
    ++accepted;
    static_cast<void>(expression->value(all_values()));
    ASSERT_EQ(text.find_first_of("\n\xff\"!\\;`$"), std::string::npos) << text;
  }
  EXPECT_GT(accepted, 1000);
}

}  // namespace
}  // namespace sheave::test
