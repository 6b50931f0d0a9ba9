#pragma once
// The operators and functions of expressions; internal to the parser.

#include <array>
#include <cstddef>
#include <string_view>

#include "scenes/expression.h"

namespace sheave::expression_words {

// Levels of precedence.
inline constexpr int of_comparison = 1;
inline constexpr int of_sum = 2;
inline constexpr int of_product = 3;
inline constexpr int of_sign = 4;
inline constexpr int of_power = 5;

/// An operator between two operands.
struct Operator {
  std::string_view text;
  ExpressionOp op;
  int precedence;
};
/// Longer ones come before those with which they begin.
inline constexpr std::array<Operator, 11> operators{
    {{"<=", ExpressionOp::less_equal, of_comparison},
     {">=", ExpressionOp::greater_equal, of_comparison},
     {"==", ExpressionOp::equal, of_comparison},
     {"!=", ExpressionOp::not_equal, of_comparison},
     {"<", ExpressionOp::less, of_comparison},
     {">", ExpressionOp::greater, of_comparison},
     {"+", ExpressionOp::add, of_sum},
     {"-", ExpressionOp::subtract, of_sum},
     {"*", ExpressionOp::multiply, of_product},
     {"/", ExpressionOp::divide, of_product},
     {"^", ExpressionOp::power, of_power}}};

/// A function of an expression.
struct Function {
  std::string_view name;
  ExpressionOp op;
  std::size_t least;  // number of arguments
  std::size_t most;
};
inline constexpr std::size_t any_count = 100;
inline constexpr std::array<Function, 20> functions{
    {{"abs", ExpressionOp::absolute, 1, 1},
     {"sqrt", ExpressionOp::square_root, 1, 1},
     {"exp", ExpressionOp::exponential, 1, 1},
     {"log", ExpressionOp::logarithm, 1, 1},
     {"sin", ExpressionOp::sine, 1, 1},
     {"cos", ExpressionOp::cosine, 1, 1},
     {"tan", ExpressionOp::tangent, 1, 1},
     {"asin", ExpressionOp::arc_sine, 1, 1},
     {"acos", ExpressionOp::arc_cosine, 1, 1},
     {"atan", ExpressionOp::arc_tangent, 1, 1},
     {"atan2", ExpressionOp::angle_of, 2, 2},
     {"hypot", ExpressionOp::hypotenuse, 2, any_count},
     {"min", ExpressionOp::minimum, 1, any_count},
     {"max", ExpressionOp::maximum, 1, any_count},
     {"if", ExpressionOp::choice, 3, 3},
     {"mean", ExpressionOp::over_time, 1, 1},
     {"range", ExpressionOp::over_time, 1, 1},
     {"rate", ExpressionOp::over_time, 1, 1},
     {"drift", ExpressionOp::over_time, 1, 1},
     {"integral", ExpressionOp::over_time, 1, 1}}};

}  // namespace sheave::expression_words
