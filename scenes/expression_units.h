#pragma once
// Units of the parts of an expression, and the parts that do not fit together.

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "scenes/expression.h"

namespace sheave {

/// A part of the text of an expression.
struct ExpressionPart {
  std::size_t begin = 0;  ///< its characters are [begin, end)
  std::size_t end = 0;
  Unit unit{};
  bool constant = false;  ///< computed from numbers alone
  double number = 0.0;    ///< value of a constant
  bool plain = false;     ///< computed from numbers without units: takes any unit in sums
  bool compares = false;  ///< a comparison without parentheses
};

/// An operation in the text.
struct ExpressionOperation {
  ExpressionOp op = ExpressionOp::add;
  std::string_view name;  ///< "+", "hypot"
  std::size_t at = 0;     ///< its place in the text
};

struct ExpressionFault {
  std::size_t at = 0;  ///< place in the text
  std::string message;
};

/// The unit of the value of an operation on `parts`, as many as operand_count() says.
[[nodiscard]] std::variant<Unit, ExpressionFault> unit_of(const ExpressionOperation& operation,
                                                          std::span<const ExpressionPart> parts,
                                                          std::string_view text);

}  // namespace sheave
