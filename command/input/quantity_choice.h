#pragma once
// Quantities that options name: names, patterns and expressions.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/expression.h"

namespace sheave::command {

/// The parts of a list "a.x,hypot(a.x, b.x)": commas in parentheses, brackets and quotes separate
/// nothing. An unclosed parenthesis reaches to the end. Spaces around a part are no part of it.
[[nodiscard]] std::vector<std::string> split_quantities(std::string_view list);
/// The parts of several lists, one after another.
[[nodiscard]] std::vector<std::string> split_quantities(const std::vector<std::string>& lists);

/// Quantities by their indices, or an expression.
struct ChosenQuantities {
  std::vector<int> indices;  ///< empty: the expression
  std::optional<Expression> expression;
};

/// The quantity with this name; or all whose names match the text, which is a pattern with * ?
/// [...]; or the expression. `names` are those of `index`, in the order of their indices.
[[nodiscard]] Result<ChosenQuantities> chosen_quantities(const std::string& text,
                                                         const std::vector<std::string>& names,
                                                         const QuantityNames& index);

}  // namespace sheave::command
