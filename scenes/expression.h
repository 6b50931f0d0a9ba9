#pragma once
// Arithmetic with quantities: "spreader.x - trolley.x", "hypot(a.x - b.x, a.y - b.y)".
//
//   comparison   sum [< <= > >= == != sum]      1 or 0
//   sum          product {+ - product}
//   product      signed {* / signed}
//   signed       {+ -} power
//   power        operand [^ signed]             a ^ b ^ c is a ^ (b ^ c), -a ^ 2 is -(a ^ 2)
//   operand      number, number[unit], pi, quantity, setting, function(whole, ...), (whole)
//   whole        [statistic:] whole, or comparison
//
// A statistic over time is a function of one operand, or stands before everything up to the end, the
// comma or the parenthesis: max(rope.0.tension), max:a.x - b.x. Its value is that of the run up to
// now. A setting of the scene is its pointer: /bodies/load/mass. A parameter is its name: limit.
//
// A text that is the name of a quantity always means this quantity. Within an expression the
// longest name that fits is taken: names may contain spaces and hyphens. A text that could be a
// name with a hyphen or a difference is refused. Quotes settle it: 'hoist cable'.0.tension.
//
// Operands of +, -, comparisons, min, max and hypot must have one unit. A number without a unit
// takes the unit of its partner there; elsewhere it is a pure number. With a unit: 2[rad/s] * t. All functions give the same bits on all machines
// (engine/math/portable.h).

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/result.h"
#include "scenes/statistic.h"
#include "scenes/unit.h"

namespace sheave {

/// A number with its unit.
struct ExpressionNumber {
  double value = 0.0;
  Unit unit;
};

/// The quantities that an expression may name.
class QuantityNames {
 public:
  virtual ~QuantityNames() = default;
  /// Index of the quantity with this name.
  [[nodiscard]] virtual std::optional<int> find(std::string_view name) const = 0;
  /// Length of the longest name.
  [[nodiscard]] virtual std::size_t longest() const = 0;
  [[nodiscard]] virtual Unit unit(int index) const = 0;
  /// The setting of the scene at a pointer ("/bodies/load/mass"), or the parameter with this name.
  [[nodiscard]] virtual std::optional<ExpressionNumber> setting(
      std::string_view /*pointer*/) const {
    return {};
  }
  /// The message about a name that find() does not know, with a similar name.
  [[nodiscard]] virtual std::string fault(std::string_view name) const = 0;
};

/// The operation of one step of an expression.
enum class ExpressionOp {
  number,
  quantity,
  negate,
  add,
  subtract,
  multiply,
  divide,
  power,
  less,
  less_equal,
  greater,
  greater_equal,
  equal,
  not_equal,
  absolute,
  square_root,
  exponential,
  logarithm,
  sine,
  cosine,
  tangent,
  arc_sine,
  arc_cosine,
  arc_tangent,
  angle_of,  ///< atan2
  hypotenuse,
  minimum,
  maximum,
  choice,     ///< if
  over_time,  ///< a statistic of its operand over time
};

/// One step: its operands are the last values.
struct ExpressionStep {
  ExpressionOp op = ExpressionOp::number;
  int quantity = 0;     ///< of `quantity`: where its value is; of `over_time`: where its course is
  double number = 0.0;  ///< of `number`
  Statistic statistic = Statistic::at;  ///< of `over_time`
};

/// A moment of a run, for the statistics over time.
struct ExpressionMoment {
  double time = 0.0;  ///< [s]
  /// Quantities that have no value yet at the start of a run are left out.
  bool starts = false;
  std::span<Course> courses;  ///< of the statistics; evaluation adds the value of the moment
};

/// A compiled expression. Evaluation allocates nothing.
class Expression {
 public:
  static constexpr std::size_t most_characters = 1000;
  /// Parentheses, functions, signs and powers within one another.
  static constexpr int most_nesting = 40;

  /// The error tells the column of the fault. Only the name of a quantity may be longer than
  /// most_characters.
  static Result<Expression> compile(std::string_view text, const QuantityNames& names);

  [[nodiscard]] const Unit& unit() const { return unit_; }
  /// The index of the quantity, if the expression is nothing but one.
  [[nodiscard]] std::optional<int> only_quantity() const;
  /// The indices of all quantities in it, as often as they are named.
  [[nodiscard]] std::vector<int> quantities() const;
  /// Replaces the index of each quantity by the index that `place` returns for it. For a list of
  /// the values that several expressions share.
  void place(const std::function<int(int)>& place);
  /// Number of statistics over time in it.
  [[nodiscard]] int course_count() const;
  /// Adds `first` to the places of its courses.
  void place_courses(int first);
  /// The value. `quantities` has the value of each quantity at its index. NaN if an operand is NaN
  /// or a function has no value. Statistics over time need a moment.
  [[nodiscard]] double value(std::span<const double> quantities,
                             const ExpressionMoment* moment = nullptr) const;

 private:
  Expression(std::vector<ExpressionStep> steps, Unit unit)
      : steps_(std::move(steps)), unit_(std::move(unit)) {}

  std::vector<ExpressionStep> steps_;  // operands come before their operation
  Unit unit_;
};

/// Number of operands of an operation.
[[nodiscard]] std::size_t operand_count(ExpressionOp op);
/// The value of an operation on its operands, as many as operand_count() says.
[[nodiscard]] double apply(ExpressionOp op, const double* operands);

}  // namespace sheave
