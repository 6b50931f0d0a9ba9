// Parses expressions by precedence climbing, and finds the units of their parts.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scenes/expression_units.h"
#include "scenes/expression_words.h"
#include "scenes/suggestion.h"

namespace sheave {
namespace {

using Op = ExpressionOp;

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_word(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || is_digit(c) || c == '_';
}

using Part = ExpressionPart;
/// A part of the text, whose value is the last one of the steps so far.
using Parsed = std::optional<Part>;

class Parser {
 public:
  Parser(std::string_view text, const QuantityNames& names) : text_(text), names_(names) {}

  Parsed whole() {
    Parsed part = part_of_text();
    if (!part) return part;
    skip_spaces();
    if (at_ == text_.size()) return part;
    if (text_.substr(at_).starts_with(")")) return fail(at_, "this \")\" has no \"(\"");
    return fail(at_, fmt::format("expected an operator or the end, found {}", found()));
  }
  [[nodiscard]] Error error() const { return {"", message_}; }
  std::vector<ExpressionStep> steps;

 private:
  // Texts.

  void skip_spaces() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
  }
  [[nodiscard]] char next() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  bool take(char c) {
    skip_spaces();
    if (next() != c) return false;
    ++at_;
    return true;
  }
  [[nodiscard]] std::size_t word_end(std::size_t from) const {
    while (from < text_.size() && is_word(text_[from])) ++from;
    return from;
  }
  /// The character at the place, for a message.
  [[nodiscard]] std::string found() const {
    if (at_ == text_.size()) return "the end";
    std::size_t end = at_ + 1;
    while (end < text_.size() && (static_cast<unsigned char>(text_[end]) & 0xc0U) == 0x80U) ++end;
    return fmt::format("\"{}\"", text_.substr(at_, end - at_));
  }
  Parsed fail(std::size_t at, const std::string& what) {
    const auto is_first = [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U; };
    const auto column =
        1 + std::count_if(text_.begin(), text_.begin() + static_cast<long>(at), is_first);
    message_ = fmt::format("expression \"{}\", column {}: {}", text_, column, what);
    return {};
  }

  Parsed too_deep() {
    return fail(at_, fmt::format("nested too deeply: at most {} levels are allowed",
                                 Expression::most_nesting));
  }

  // Grammar.

  /// Everything up to the end, the comma or the parenthesis.
  Parsed part_of_text();
  Parsed expression(int least);
  Parsed prefix();
  Parsed operand();
  Parsed number();
  Parsed setting();
  Parsed quoted_name();
  Parsed call(const expression_words::Function& function, std::size_t begin);
  Parsed word();
  Parsed known_name();
  Parsed unknown_name();
  [[nodiscard]] std::size_t number_end(std::size_t from) const;
  [[nodiscard]] std::size_t longest_name(std::size_t most) const;
  [[nodiscard]] const expression_words::Operator* operator_here() const;
  /// The statistic of a word with a colon that begins here; nothing if there is none.
  std::optional<Statistic> take_statistic();
  /// Whether a minus is the first character of a name, which is a fault without quotes.
  bool begins_name(const expression_words::Operator& sign);

  // Units and steps.

  Parsed push(ExpressionStep step, Part part) {
    steps.push_back(step);
    return part;
  }
  Parsed quantity(int index, std::size_t begin) {
    return push({Op::quantity, index, 0.0}, {begin, at_, names_.unit(index)});
  }
  Parsed constant(double number, Part part) {
    part.constant = true;
    part.number = number;
    return push({Op::number, 0, number}, part);
  }
  /// Adds the step of an operation on the last values, whose parts are given.
  Parsed operation(const ExpressionOperation& own, std::span<const Part> parts);
  /// Adds the step of a statistic over time of the last value.
  Parsed over_time(Statistic statistic, const Part& of, std::size_t begin);

  std::string_view text_;
  const QuantityNames& names_;
  std::size_t at_ = 0;
  int nesting_ = 0;
  int courses_ = 0;
  std::string message_;
};

const expression_words::Operator* Parser::operator_here() const {
  for (const expression_words::Operator& one : expression_words::operators) {
    if (text_.substr(at_).starts_with(one.text)) return &one;
  }
  return nullptr;
}

std::optional<Statistic> Parser::take_statistic() {
  skip_spaces();
  const std::size_t end = word_end(at_);
  if (end == text_.size() || text_[end] != ':') return {};
  const auto statistic = statistic_over_time(text_.substr(at_, end - at_));
  if (statistic) at_ = end + 1;
  return statistic;
}

Parsed Parser::part_of_text() {
  const std::size_t begin = at_;
  const std::optional<Statistic> statistic = take_statistic();
  if (!statistic) return expression(expression_words::of_comparison);
  if (nesting_ == Expression::most_nesting) return too_deep();
  ++nesting_;
  Parsed part = part_of_text();
  --nesting_;
  return part ? over_time(*statistic, *part, begin) : part;
}

Parsed Parser::over_time(Statistic statistic, const Part& of, std::size_t begin) {
  Part part{begin, at_, of.unit};
  if (statistic == Statistic::rate) part.unit = of.unit.over(Unit("s"));
  if (statistic == Statistic::integral) part.unit = of.unit.times(Unit("s"));
  return push({Op::over_time, courses_++, 0.0, statistic}, part);
}

Parsed Parser::expression(int least) {
  if (nesting_ == Expression::most_nesting) return too_deep();
  ++nesting_;
  Parsed left = prefix();
  while (left) {
    skip_spaces();
    const expression_words::Operator* const sign = operator_here();
    if (sign == nullptr || sign->precedence < least) break;
    const std::size_t at = at_;
    if (left->compares && sign->precedence == expression_words::of_comparison) {
      left = fail(at, "comparisons cannot follow one another; put one of them in parentheses");
      break;
    }
    if (begins_name(*sign)) {
      left.reset();
      break;
    }
    at_ += sign->text.size();
    // Powers associate from the right.
    const Parsed right =
        expression(sign->op == Op::power ? expression_words::of_sign : sign->precedence + 1);
    if (!right) {
      left.reset();
      break;
    }
    left = operation({sign->op, sign->text, at}, std::array{*left, *right});
  }
  --nesting_;
  return left;
}

Parsed Parser::prefix() {
  skip_spaces();
  const std::size_t begin = at_;
  const char sign = next();
  if (sign != '-' && sign != '+') return operand();
  if (begins_name(*operator_here())) return {};
  ++at_;
  Parsed part = expression(expression_words::of_sign);
  if (!part) return part;
  part->begin = begin;
  return sign == '+' ? part : operation({Op::negate, "-", begin}, std::array{*part});
}

Parsed Parser::operand() {
  const std::size_t begin = at_;
  if (take('(')) {
    Parsed inner = part_of_text();
    if (!inner) return inner;
    if (!take(')')) return fail(at_, fmt::format("expected \")\", found {}", found()));
    inner->begin = begin;
    inner->end = at_;
    inner->compares = false;
    return inner;
  }
  if (next() == '\'') return quoted_name();
  if (next() == '/') return setting();
  if (Parsed name = known_name(); name || !message_.empty()) return name;
  if (number_end(at_) > at_) return number();
  if (is_word(next())) return word();
  const bool ends = at_ == text_.size();
  return fail(at_, fmt::format("expected a quantity, a number, a function or \"(\", found {}{}",
                               found(), !ends && next() == '"' ? "; names are quoted with '" : ""));
}

std::size_t Parser::number_end(std::size_t from) const {
  const auto digits = [&](std::size_t at) {
    while (at < text_.size() && is_digit(text_[at])) ++at;
    return at;
  };
  std::size_t end = digits(from);
  if (end < text_.size() && text_[end] == '.' && digits(end + 1) > end + 1) end = digits(end + 1);
  if (end == from || end == text_.size() || (text_[end] != 'e' && text_[end] != 'E')) return end;
  std::size_t exponent = end + 1;
  if (exponent < text_.size() && (text_[exponent] == '-' || text_[exponent] == '+')) ++exponent;
  return digits(exponent) > exponent ? digits(exponent) : end;
}

Parsed Parser::number() {
  const std::size_t begin = at_;
  at_ = number_end(at_);
  std::string_view digits = text_.substr(begin, at_ - begin);
  // JSON has neither 007 nor .5.
  while (digits.size() > 1 && digits[0] == '0' && is_digit(digits[1])) digits.remove_prefix(1);
  const std::string json = (is_digit(digits.front()) ? "" : "0") + std::string(digits);
  const auto value = nlohmann::json::parse(json, nullptr, false);
  if (!value.is_number() || !std::isfinite(value.get<double>())) {
    return fail(begin, "this number is too large");
  }
  if (next() != '[') return constant(value.get<double>(), {begin, at_, Unit(), true, 0.0, true});
  const std::size_t end = text_.find(']', at_);
  if (end == std::string_view::npos) return fail(at_, "this \"[\" has no \"]\"");
  const std::string_view unit = text_.substr(at_ + 1, end - at_ - 1);
  if (!unit_powers(unit)) {
    return fail(at_ + 1, fmt::format("\"{}\" is no unit; a unit is made of m, kg, s, rad, N, J, W "
                                     "and Hz, as N m, m/s2 or rad/(N m)",
                                     unit));
  }
  at_ = end + 1;
  return constant(value.get<double>(), {begin, at_, Unit(unit)});
}

Parsed Parser::setting() {
  // The longest text that is a pointer to a number; a "/" behind it divides.
  const std::size_t begin = at_;
  std::size_t end = begin;
  while (end < text_.size() &&
         (is_word(text_[end]) || text_[end] == '/' || text_[end] == '-' || text_[end] == ' ')) {
    ++end;
  }
  while (!is_word(text_[end - 1]) && end > begin + 1) --end;
  for (std::size_t last = end; last > begin + 1; --last) {
    if (!is_word(text_[last - 1]) || (last < text_.size() && is_word(text_[last]))) continue;
    const auto found = names_.setting(text_.substr(begin, last - begin));
    if (!found) continue;
    at_ = last;
    return constant(found->value, {begin, at_, found->unit});
  }
  return fail(begin, names_.fault(text_.substr(begin, end - begin)));
}

Parsed Parser::quoted_name() {
  const std::size_t begin = at_;
  std::string name;
  while (true) {
    if (next() == '\'') {
      const std::size_t end = text_.find('\'', at_ + 1);
      if (end == std::string_view::npos) return fail(at_, "this quote has no end");
      name += text_.substr(at_ + 1, end - at_ - 1);
      at_ = end + 1;
    } else {
      const std::size_t end = word_end(at_);
      name += text_.substr(at_, end - at_);
      at_ = end;
    }
    if (next() != '.') break;
    name += '.';
    ++at_;
  }
  if (name.starts_with('/')) {
    const auto found = names_.setting(name);
    return found ? constant(found->value, {begin, at_, found->unit})
                 : fail(begin, names_.fault(name));
  }
  const std::optional<int> index = names_.find(name);
  return index ? quantity(*index, begin) : fail(begin, names_.fault(name));
}

/// Length of the longest name that is at the place and has at most `most` characters; 0: none.
std::size_t Parser::longest_name(std::size_t most) const {
  const std::string_view rest = text_.substr(at_);
  for (std::size_t length = std::min(most, rest.size()); length > 0; --length) {
    // A name does not end within a word.
    if (!is_word(rest[length - 1])) continue;
    if (length < rest.size() && (is_word(rest[length]) || rest[length] == '.')) continue;
    if (names_.find(rest.substr(0, length))) return length;
  }
  return 0;
}

bool Parser::begins_name(const expression_words::Operator& sign) {
  const std::size_t length = sign.op == Op::subtract ? longest_name(names_.longest()) : 0;
  if (length == 0) return false;
  fail(at_, fmt::format("\"{0}\" is a quantity, and could be a difference, too; for the quantity "
                        "write '{0}', for the difference a space behind the minus",
                        text_.substr(at_, length)));
  return true;
}

Parsed Parser::known_name() {
  const std::size_t begin = at_;
  const std::size_t length = longest_name(names_.longest());
  if (length == 0) return {};
  const std::string_view name = text_.substr(begin, length);
  for (std::size_t dash = name.find('-'); dash != std::string_view::npos;
       dash = name.find('-', dash + 1)) {
    std::size_t end = dash;
    while (end > 0 && name[end - 1] == ' ') --end;
    const std::string_view before = name.substr(0, end);
    const bool is_operand = number_end(begin) == begin + end || before == "pi" ||
                            names_.find(before).has_value() || names_.setting(before).has_value();
    if (!is_operand) continue;
    return fail(begin, fmt::format("\"{0}\" is a quantity, and could be a difference, too; for the "
                                   "quantity write '{0}', for the difference spaces around the "
                                   "minus, or '{1}'",
                                   name, before));
  }
  at_ += length;
  return quantity(*names_.find(name), begin);
}

Parsed Parser::word() {
  const std::size_t begin = at_;
  const std::size_t end = word_end(at_);
  const std::string_view name = text_.substr(begin, end - begin);
  std::size_t open = end;
  while (open < text_.size() && text_[open] == ' ') ++open;
  const bool calls = open < text_.size() && text_[open] == '(';
  const auto function =
      std::find_if(expression_words::functions.begin(), expression_words::functions.end(),
                   [&](const expression_words::Function& one) { return one.name == name; });
  if (calls && function != expression_words::functions.end()) {
    at_ = open + 1;
    return call(*function, begin);
  }
  if (calls) {
    Suggestion suggestion(name);
    for (const expression_words::Function& one : expression_words::functions)
      suggestion.consider(one.name);
    return fail(begin,
                fmt::format("there is no function \"{}\"{}; allowed are abs, sqrt, exp, log, "
                            "sin, cos, tan, asin, acos, atan, atan2, hypot, min, max, if, and over "
                            "time max, min, mean, range, rate, drift and integral",
                            name, suggestion.question()));
  }
  const bool more = end < text_.size() && text_[end] == '.';
  if (name == "pi" && !more) {
    at_ = end;
    return constant(std::numbers::pi, {begin, at_, Unit(), true, 0.0, true});
  }
  if (function != expression_words::functions.end() && !more) {
    return fail(begin, fmt::format("\"{0}\" is a function; write {0}(...)", name));
  }
  if (const auto parameter = more ? std::nullopt : names_.setting(name)) {
    at_ = end;
    return constant(parameter->value, {begin, at_, parameter->unit});
  }
  return unknown_name();
}

Parsed Parser::unknown_name() {
  const std::size_t begin = at_;
  std::size_t end = begin;
  while (end < text_.size() && (is_word(text_[end]) || text_[end] == '.')) ++end;
  if (text_.substr(begin, end - begin).find('.') == std::string_view::npos) {
    // Names with spaces and hyphens go on to their dots, but a minus between spaces is a sign.
    while (end < text_.size() &&
           (is_word(text_[end]) || text_[end] == '.' || text_[end] == '-' || text_[end] == ' ')) {
      if (text_.substr(end).starts_with(" - ")) break;
      ++end;
    }
    while (text_[end - 1] == ' ' || text_[end - 1] == '-') --end;
  }
  const std::string_view name = text_.substr(begin, end - begin);
  if (name == text_) {
    message_ = names_.fault(name);
    return {};
  }
  return fail(begin, names_.fault(name));
}

Parsed Parser::call(const expression_words::Function& function, std::size_t begin) {
  const auto with_count = [&](std::size_t count) {
    return fmt::format("{} has {}{} argument{}, not {}", function.name, function.least,
                       function.most > function.least ? " or more" : "",
                       function.least > 1 ? "s" : "", count);
  };
  std::vector<Part> arguments;
  std::size_t count = 0;
  if (take(')')) return fail(begin, with_count(0));
  do {
    const Parsed argument = part_of_text();
    if (!argument) return argument;
    if (++count > function.most) return fail(argument->begin, with_count(count));
    arguments.push_back(*argument);
    // min(a, b, c) is min(min(a, b), c).
    if (function.most != expression_words::any_count || arguments.size() < 2) continue;
    const Parsed both = operation({function.op, function.name, begin}, arguments);
    if (!both) return both;
    arguments = {*both};
  } while (take(','));
  if (!take(')')) return fail(at_, fmt::format("expected \",\" or \")\", found {}", found()));
  if (count < function.least) return fail(begin, with_count(count));
  Parsed result = arguments.front();
  const bool extreme = function.op == Op::minimum || function.op == Op::maximum;
  if (function.op == Op::over_time || (extreme && count == 1)) {
    result = over_time(*statistic_over_time(function.name), arguments.front(), begin);
  } else if (function.most != expression_words::any_count) {
    result = operation({function.op, function.name, begin}, arguments);
  }
  if (!result) return result;
  result->begin = begin;
  result->end = at_;
  result->compares = false;
  return result;
}

Parsed Parser::operation(const ExpressionOperation& own, std::span<const Part> parts) {
  auto unit = unit_of(own, parts, text_);
  if (const auto* fault = std::get_if<ExpressionFault>(&unit))
    return fail(fault->at, fault->message);
  Part result{parts.front().begin, parts.back().end, std::move(*std::get_if<Unit>(&unit))};
  result.compares = own.op >= Op::less && own.op <= Op::not_equal;
  const auto all = [&](bool Part::*what) {
    return std::all_of(parts.begin(), parts.end(), [&](const Part& part) { return part.*what; });
  };
  result.plain = all(&Part::plain);
  result.constant = all(&Part::constant);
  if (!result.constant) return push({own.op, 0, 0.0}, result);
  // The steps of constants are numbers, one for each.
  std::array<double, 3> values{};
  for (std::size_t i = 0; i < parts.size(); ++i) values[i] = parts[i].number;
  steps.resize(steps.size() - parts.size());
  return constant(apply(own.op, values.data()), result);
}

}  // namespace

Result<Expression> Expression::compile(std::string_view text, const QuantityNames& names) {
  if (const std::optional<int> index = names.find(text)) {
    return Expression({{ExpressionOp::quantity, *index, 0.0}}, names.unit(*index));
  }
  if (text.size() > most_characters) {
    return Error{"", fmt::format("an expression of {} characters is too long; at most {} are "
                                 "allowed",
                                 text.size(), most_characters)};
  }
  if (text.empty()) return Error{"", names.fault(text)};
  Parser parser(text, names);
  const Parsed whole = parser.whole();
  if (!whole) return parser.error();
  return Expression(std::move(parser.steps), whole->unit);
}

}  // namespace sheave
