#include "scenes/expression_list.h"

namespace sheave {

int ExpressionList::place_of(int quantity) {
  const auto [place, is_new] = places_.emplace(quantity, static_cast<int>(operands_.size()));
  if (is_new) operands_.push_back(quantity);
  return place->second;
}

void ExpressionList::add(int quantity) { entries_.push_back({place_of(quantity), -1}); }

void ExpressionList::add(Expression expression, std::string text) {
  expression.place([&](int quantity) { return place_of(quantity); });
  expression.place_courses(courses_);
  courses_ += expression.course_count();
  entries_.push_back({0, static_cast<int>(computed_.size())});
  computed_.push_back({std::move(expression), std::move(text)});
}

void ExpressionList::evaluate(std::span<const double> operands, std::span<double> values,
                              const ExpressionMoment* moment) const {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    values[i] = entries_[i].computed < 0 ? operands[static_cast<std::size_t>(entries_[i].operand)]
                                         : computed(i).expression.value(operands, moment);
  }
}

}  // namespace sheave
