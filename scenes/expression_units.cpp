#include "scenes/expression_units.h"

#include <cmath>

#include <fmt/format.h>

namespace sheave {
namespace {

using Op = ExpressionOp;
using Part = ExpressionPart;
using Found = std::variant<Unit, ExpressionFault>;

/// The units of operations in one text.
class UnitRules {
 public:
  UnitRules(const ExpressionOperation& own, std::string_view text) : own_(own), text_(text) {}

  [[nodiscard]] Found of(std::span<const Part> parts) const {
    const Part& a = parts.front();
    switch (own_.op) {
      case Op::negate:
      case Op::absolute:
        return a.unit;
      case Op::multiply:
        return a.unit.times(parts[1].unit);
      case Op::divide:
        return a.unit.over(parts[1].unit);
      case Op::power:
        return of_power(a, parts[1]);
      case Op::square_root:
        return a.unit.to_the(0.5);
      case Op::choice:
        if (!a.unit.is_pure()) return impure("the condition of if", a);
        return common(parts[1], parts[2]);
      default:
        return parts.size() == 1 ? of_function(a) : of_two(a, parts[1]);
    }
  }

 private:
  [[nodiscard]] std::string quoted(const Part& part) const {
    return fmt::format("\"{}\"", text_.substr(part.begin, part.end - part.begin));
  }
  [[nodiscard]] static std::string words(const Unit& unit) {
    const std::string text = unit.text();
    return text.empty() ? "a pure number" : "in " + text;
  }
  [[nodiscard]] Found impure(std::string_view what, const Part& part) const {
    return ExpressionFault{part.begin, fmt::format("{} must be a pure number or an angle; {} is {}",
                                                   what, quoted(part), words(part.unit))};
  }

  /// Of exp(), sin() and alike.
  [[nodiscard]] Found of_function(const Part& a) const {
    if (!a.unit.is_pure()) return impure(fmt::format("the argument of {}", own_.name), a);
    const bool is_angle =
        own_.op == Op::arc_sine || own_.op == Op::arc_cosine || own_.op == Op::arc_tangent;
    return is_angle ? Unit("rad") : Unit();
  }

  /// Of operations that need operands in one unit.
  [[nodiscard]] Found of_two(const Part& a, const Part& b) const {
    Found unit = common(a, b);
    if (std::holds_alternative<ExpressionFault>(unit)) return unit;
    switch (own_.op) {
      case Op::add:
      case Op::subtract:
      case Op::minimum:
      case Op::maximum:
      case Op::hypotenuse:
        return unit;
      case Op::angle_of:
        return Unit("rad");
      default:
        return Unit();  // comparisons
    }
  }

  [[nodiscard]] Found common(const Part& a, const Part& b) const {
    if (a.plain) return b.unit;
    if (b.plain) return a.unit;
    if (a.unit.agrees_with(b.unit)) return a.unit.is_open() ? b.unit : a.unit;
    return ExpressionFault{
        own_.at, fmt::format("{} needs one unit; {} is {}, and {} is {}", own_.name, quoted(a),
                             words(a.unit), quoted(b), words(b.unit))};
  }

  [[nodiscard]] Found of_power(const Part& base, const Part& exponent) const {
    if (!exponent.unit.is_pure()) return impure("an exponent", exponent);
    if (!exponent.constant) {
      if (base.unit.is_pure()) return Unit();
      return ExpressionFault{exponent.begin,
                             fmt::format("the exponent must be a number, because {} is {}",
                                         quoted(base), words(base.unit))};
    }
    constexpr double most = 12.0;
    const double power = exponent.number;
    if (std::abs(power) <= most) return base.unit.to_the(power);
    if (base.unit.is_pure()) return Unit();
    return ExpressionFault{
        exponent.begin, fmt::format("the exponent of {}, which is {}, must be between -{} and {}",
                                    quoted(base), words(base.unit), most, most)};
  }

  const ExpressionOperation& own_;
  std::string_view text_;
};

}  // namespace

Found unit_of(const ExpressionOperation& operation, std::span<const Part> parts,
              std::string_view text) {
  return UnitRules(operation, text).of(parts);
}

}  // namespace sheave
