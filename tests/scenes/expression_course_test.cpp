// Statistics over time and settings of the scene within expressions: against sums by hand.

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/expression.h"

namespace sheave::test {
namespace {

/// The values of an expression at moments 0, 1 s, 3 s at which x is 2, 5 and -1 m, y 1, 1 and 4 m.
class OverTime : public QuantityNames {
 public:
  [[nodiscard]] std::optional<int> find(std::string_view name) const override {
    return name == "x" ? std::optional(0) : name == "y" ? std::optional(1) : std::nullopt;
  }
  [[nodiscard]] std::size_t longest() const override { return 1; }
  [[nodiscard]] Unit unit(int /*index*/) const override { return Unit("m"); }
  [[nodiscard]] std::optional<ExpressionNumber> setting(std::string_view pointer) const override {
    if (pointer == "/bodies/free weight/mass") return ExpressionNumber{4.0, Unit("kg")};
    if (pointer == "/bodies/a/size") return ExpressionNumber{8.0, Unit("m")};
    return {};
  }
  [[nodiscard]] std::string fault(std::string_view name) const override {
    return fmt::format("no \"{}\"", name);
  }
  [[nodiscard]] std::vector<double> values(const std::string& text) const {
    const Result<Expression> expression = Expression::compile(text, *this);
    EXPECT_TRUE(expression) << expression.errors().front().message;
    if (!expression) return {};
    std::vector<Course> courses(static_cast<std::size_t>(expression->course_count()));
    std::vector<double> found;
    for (const auto& [t, x, y] : {std::array{0.0, 2.0, 1.0}, {1.0, 5.0, 1.0}, {3.0, -1.0, 4.0}}) {
      const ExpressionMoment moment{t, t == 0.0, courses};
      found.push_back(expression->value(std::array{x, y}, &moment));
    }
    return found;
  }
  [[nodiscard]] std::string unit_of(const std::string& text) const {
    const Result<Expression> expression = Expression::compile(text, *this);
    return expression ? expression->unit().text() : expression.errors().front().message;
  }
};

TEST(ExpressionCourses, AreStatisticsUpToNow) {
  const OverTime of;
  using testing::ElementsAre;
  EXPECT_THAT(of.values("max(x)"), ElementsAre(2.0, 5.0, 5.0));
  EXPECT_THAT(of.values("min(x)"), ElementsAre(2.0, 2.0, -1.0));
  EXPECT_THAT(of.values("range(x)"), ElementsAre(0.0, 3.0, 6.0));
  EXPECT_THAT(of.values("mean(x)"), ElementsAre(2.0, 3.5, 2.0));
  EXPECT_THAT(of.values("drift(x)"), ElementsAre(0.0, 3.0, -3.0));
  EXPECT_THAT(of.values("rate(x)"), ElementsAre(testing::IsNan(), 3.0, -1.0));
  EXPECT_THAT(of.values("integral(x)"), ElementsAre(0.0, 3.5, 7.5)) << "3.5 + 2 (5 - 1) / 2";
  // Inside expressions, several at once, one within another.
  EXPECT_THAT(of.values("2 * max(x) - min(y)"), ElementsAre(3.0, 9.0, 9.0));
  EXPECT_THAT(of.values("max(x - min(x))"), ElementsAre(0.0, 3.0, 3.0));
  EXPECT_THAT(of.values("hypot(max(x), max(y) - 1)"),
              ElementsAre(2.0, 5.0, testing::DoubleEq(std::hypot(5.0, 3.0))));
  // Before everything up to the end, the comma and the parenthesis.
  EXPECT_THAT(of.values("max:x - y"), of.values("max(x - y)"));
  EXPECT_THAT(of.values("(max: x) - y"), of.values("max(x) - y"));
  EXPECT_THAT(of.values("max(min:x, min:y)"), ElementsAre(2.0, 2.0, 1.0));
  EXPECT_THAT(of.values("maximum:x"), of.values("max(x)"));
  EXPECT_THAT(of.values("max(x, y)"), ElementsAre(2.0, 5.0, 4.0)) << "at one moment";
  EXPECT_EQ(of.unit_of("max(x) + y"), "m");
  EXPECT_EQ(of.unit_of("rate(x)"), "m/s");
  EXPECT_EQ(of.unit_of("integral:x * y"), "m2 s");
  EXPECT_THAT(of.unit_of("mean(x, y)"), testing::HasSubstr("mean has 1 argument, not 2"));
  EXPECT_THAT(of.unit_of("max()"), testing::HasSubstr("max has 1 or more argument"));
}

TEST(ExpressionCourses, WithoutAFiniteValueHaveNoStatistic) {
  const Result<Expression> expression = Expression::compile("max(x)", OverTime());
  std::vector<Course> courses(1);
  const auto value = [&](double t, double x) {
    const ExpressionMoment moment{t, t == 0.0, courses};
    return expression->value(std::array{x, 0.0}, &moment);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(value(0.0, nan))) << "unknown at the start: left out";
  EXPECT_EQ(value(1.0, -3.0), -3.0);
  EXPECT_TRUE(std::isnan(value(2.0, nan)));
  EXPECT_TRUE(std::isnan(value(3.0, 7.0))) << "the run had a value that is no number";
  EXPECT_TRUE(std::isnan(expression->value(std::array{7.0, 0.0}))) << "no moment";
  std::array<double, Course::size> numbers{};
  courses.front().store(numbers);
  EXPECT_EQ(Course::from(numbers).last, courses.front().last);
  EXPECT_EQ(Course::from(numbers).finite, 0.0);
}

TEST(ExpressionCourses, MeetSettingsOfTheSceneAsNumbersWithUnits) {
  const OverTime of;
  EXPECT_EQ(of.values("/bodies/free weight/mass").back(), 4.0);
  EXPECT_EQ(of.values("x * '/bodies/free weight/mass'").front(), 8.0);
  EXPECT_EQ(of.values("/bodies/a/size/2 - x").front(), 2.0) << "the rest divides";
  EXPECT_EQ(of.values("x / /bodies/a/size").front(), 0.25);
  EXPECT_EQ(of.values("max(x) ^ (/bodies/a/size / 4[m])").front(), 4.0) << "a constant";
  EXPECT_EQ(of.unit_of("x * /bodies/free weight/mass"), "kg m");
  EXPECT_THAT(of.unit_of("x + /bodies/free weight/mass"), testing::HasSubstr("needs one unit"));
  EXPECT_THAT(of.unit_of("x + /bodies/b/size"), testing::HasSubstr("no \"/bodies/b/size\""));
}

}  // namespace
}  // namespace sheave::test
