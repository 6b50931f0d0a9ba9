#pragma once
// Several quantities and expressions whose quantities are looked up once.

#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "scenes/expression.h"

namespace sheave {

/// Quantities and expressions in the order in which they were added.
class ExpressionList {
 public:
  /// Appends a quantity by its index.
  void add(int quantity);
  /// Adds a quantity to operands(), without an entry.
  void need(int quantity) { place_of(quantity); }
  /// Appends an expression; `text` is its text.
  void add(Expression expression, std::string text);

  [[nodiscard]] std::size_t size() const { return entries_.size(); }
  /// Indices of the quantities whose values evaluate() needs, each once.
  [[nodiscard]] const std::vector<int>& operands() const { return operands_; }
  /// Number of statistics over time.
  [[nodiscard]] std::size_t course_count() const { return static_cast<std::size_t>(courses_); }
  /// The values. `operands` has those of operands(), in their order. Statistics over time need a
  /// moment with course_count() courses.
  void evaluate(std::span<const double> operands, std::span<double> values,
                const ExpressionMoment* moment = nullptr) const;

  /// The index of the quantity at this place; -1 for an expression.
  [[nodiscard]] int quantity(std::size_t i) const {
    return entries_[i].computed < 0 ? operands_[static_cast<std::size_t>(entries_[i].operand)] : -1;
  }
  /// Text and unit of the expression at this place, where quantity() is -1.
  [[nodiscard]] const std::string& text(std::size_t i) const { return computed(i).text; }
  [[nodiscard]] const Unit& unit(std::size_t i) const { return computed(i).expression.unit(); }

 private:
  struct Entry {
    int operand = 0;    // of a quantity: its place in operands_
    int computed = -1;  // of an expression: its place in computed_
  };
  struct Computed {
    Expression expression;
    std::string text;
  };
  int place_of(int quantity);
  [[nodiscard]] const Computed& computed(std::size_t i) const {
    return computed_[static_cast<std::size_t>(entries_[i].computed)];
  }

  std::vector<Entry> entries_;
  std::vector<Computed> computed_;
  std::vector<int> operands_;
  int courses_ = 0;
  std::unordered_map<int, int> places_;  // of quantities in operands_
};

}  // namespace sheave
