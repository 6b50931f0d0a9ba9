// Evaluation of expressions.

#include "scenes/expression.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "engine/math/portable.h"

namespace sheave {
namespace {

constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

/// Each level of nesting keeps at most two values while the next level is evaluated: the left
/// operand of a sum, or the first two of if().
constexpr std::size_t most_values = 2 * Expression::most_nesting + 3;

/// A power by repeated squares, for small whole exponents: exact where the result is.
double whole_power(double base, int exponent) {
  double result = 1.0;
  for (auto left = static_cast<unsigned>(std::abs(exponent)); left > 0; left /= 2) {
    if (left % 2 == 1) result *= base;
    base *= base;
  }
  return exponent < 0 ? 1.0 / result : result;
}

double power(double base, double exponent) {
  constexpr double most_whole = 1024.0;
  if (std::abs(exponent) <= most_whole && exponent == std::floor(exponent)) {
    return whole_power(base, static_cast<int>(exponent));
  }
  if (exponent == 0.5) return std::sqrt(base);
  if (base == 0.0 && !std::isnan(exponent)) {
    return exponent > 0.0 ? 0.0 : std::numeric_limits<double>::infinity();
  }
  return portable::exp(exponent * portable::log(base));
}

/// cos(asin(x)), exactly 0 for 1 and -1; NaN beyond.
double other_leg(double x) { return std::sqrt((1.0 - x) * (1.0 + x)); }

double smaller(double a, double b) {
  if (std::isnan(a) || std::isnan(b)) return undefined;
  return b < a ? b : a;
}

double larger(double a, double b) {
  if (std::isnan(a) || std::isnan(b)) return undefined;
  return b > a ? b : a;
}

double truth(bool is_so, double a, double b) {
  if (std::isnan(a) || std::isnan(b)) return undefined;
  return is_so ? 1.0 : 0.0;
}

double compared(ExpressionOp op, double a, double b) {
  switch (op) {
    case ExpressionOp::less:
      return truth(a < b, a, b);
    case ExpressionOp::less_equal:
      return truth(a <= b, a, b);
    case ExpressionOp::greater:
      return truth(a > b, a, b);
    case ExpressionOp::greater_equal:
      return truth(a >= b, a, b);
    case ExpressionOp::equal:
      return truth(a == b, a, b);
    default:
      return truth(a != b, a, b);
  }
}

/// Functions of one number.
double function(ExpressionOp op, double x) {
  switch (op) {
    case ExpressionOp::absolute:
      return std::abs(x);
    case ExpressionOp::square_root:
      return std::sqrt(x);
    case ExpressionOp::exponential:
      return portable::exp(x);
    case ExpressionOp::logarithm:
      return portable::log(x);
    case ExpressionOp::sine:
      return portable::sin(x);
    case ExpressionOp::cosine:
      return portable::cos(x);
    case ExpressionOp::tangent:
      return portable::sin(x) / portable::cos(x);
    case ExpressionOp::arc_sine:
      return portable::atan2(x, other_leg(x));
    case ExpressionOp::arc_cosine:
      return portable::atan2(other_leg(x), x);
    default:
      return portable::atan2(x, 1.0);
  }
}

/// A statistic up to this moment, with the value that the operand has now.
double over_time(const ExpressionStep& step, double now, const ExpressionMoment* moment) {
  if (moment == nullptr) return undefined;
  Course& course = moment->courses[static_cast<std::size_t>(step.quantity)];
  if (course.begin < 0.0) course.begin = moment->time;
  if (!moment->starts || !std::isnan(now)) course.add(moment->time, now);
  return course.value(step.statistic);
}

}  // namespace

std::size_t operand_count(ExpressionOp op) {
  switch (op) {
    case ExpressionOp::number:
    case ExpressionOp::quantity:
      return 0;
    case ExpressionOp::negate:
    case ExpressionOp::absolute:
    case ExpressionOp::square_root:
    case ExpressionOp::exponential:
    case ExpressionOp::logarithm:
    case ExpressionOp::sine:
    case ExpressionOp::cosine:
    case ExpressionOp::tangent:
    case ExpressionOp::arc_sine:
    case ExpressionOp::arc_cosine:
    case ExpressionOp::arc_tangent:
    case ExpressionOp::over_time:
      return 1;
    case ExpressionOp::choice:
      return 3;
    default:
      return 2;
  }
}

double apply(ExpressionOp op, const double* operands) {
  const double a = operands[0];
  if (op == ExpressionOp::negate) return -a;
  if (operand_count(op) == 1) return function(op, a);
  const double b = operands[1];
  switch (op) {
    case ExpressionOp::add:
      return a + b;
    case ExpressionOp::subtract:
      return a - b;
    case ExpressionOp::multiply:
      return a * b;
    case ExpressionOp::divide:
      return a / b;
    case ExpressionOp::power:
      return power(a, b);
    case ExpressionOp::angle_of:
      return portable::atan2(a, b);
    case ExpressionOp::hypotenuse:
      return portable::hypot(a, b);
    case ExpressionOp::minimum:
      return smaller(a, b);
    case ExpressionOp::maximum:
      return larger(a, b);
    case ExpressionOp::choice:
      if (std::isnan(a)) return undefined;
      return a != 0.0 ? b : operands[2];
    default:
      return compared(op, a, b);
  }
}

std::optional<int> Expression::only_quantity() const {
  if (steps_.size() != 1 || steps_.front().op != ExpressionOp::quantity) return {};
  return steps_.front().quantity;
}

std::vector<int> Expression::quantities() const {
  std::vector<int> indices;
  for (const ExpressionStep& step : steps_) {
    if (step.op == ExpressionOp::quantity) indices.push_back(step.quantity);
  }
  return indices;
}

void Expression::place(const std::function<int(int)>& place) {
  for (ExpressionStep& step : steps_) {
    if (step.op == ExpressionOp::quantity) step.quantity = place(step.quantity);
  }
}

int Expression::course_count() const {
  return static_cast<int>(
      std::count_if(steps_.begin(), steps_.end(),
                    [](const ExpressionStep& step) { return step.op == ExpressionOp::over_time; }));
}

void Expression::place_courses(int first) {
  for (ExpressionStep& step : steps_) {
    if (step.op == ExpressionOp::over_time) step.quantity += first;
  }
}

double Expression::value(std::span<const double> quantities, const ExpressionMoment* moment) const {
  std::array<double, most_values> values;  // NOLINT(*-member-init): each is set before it is read
  std::size_t count = 0;
  for (const ExpressionStep& step : steps_) {
    if (step.op == ExpressionOp::number) {
      values[count++] = step.number;
    } else if (step.op == ExpressionOp::quantity) {
      values[count++] = quantities[static_cast<std::size_t>(step.quantity)];
    } else if (step.op == ExpressionOp::over_time) {
      values[count - 1] = over_time(step, values[count - 1], moment);
    } else {
      count -= operand_count(step.op);
      values[count] = apply(step.op, &values[count]);
      ++count;
    }
  }
  // The sign of a computed NaN depends on the machine.
  return std::isnan(values[0]) ? undefined : values[0];
}

}  // namespace sheave
