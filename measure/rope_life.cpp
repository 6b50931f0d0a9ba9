#include "measure/rope_life.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include <fmt/format.h>

#include "scenes/suggestion.h"

namespace sheave::measure {
namespace {

constexpr std::size_t tension_place = 0;
constexpr std::size_t sheave_place = 1;

/// The names that a formula may use, in the order of their values.
class LifeNames final : public QuantityNames {
 public:
  LifeNames() {
    add("tension", Unit("N"));
    add("sheave_diameter", Unit("m"));
    add("rope_diameter", Unit("m"));
  }
  void add(std::string name, Unit unit) {
    longest_ = std::max(longest_, name.size());
    names_.push_back({std::move(name), std::move(unit)});
  }

  [[nodiscard]] std::optional<int> find(std::string_view name) const override {
    for (std::size_t i = 0; i < names_.size(); ++i) {
      if (names_[i].name == name) return static_cast<int>(i);
    }
    return {};
  }
  [[nodiscard]] std::size_t longest() const override { return longest_; }
  [[nodiscard]] Unit unit(int index) const override {
    return names_[static_cast<std::size_t>(index)].unit;
  }
  [[nodiscard]] std::string fault(std::string_view name) const override {
    Suggestion suggestion(name);
    for (const Named& one : names_) suggestion.consider(one.name);
    return fmt::format(
        "there is no \"{}\"{}; a formula may name tension, sheave_diameter, rope_diameter, the "
        "constants and the definitions before it",
        name, suggestion.question());
  }

 private:
  struct Named {
    std::string name;
    Unit unit;
  };
  std::vector<Named> names_;
  std::size_t longest_ = 0;
};

bool is_formula_name(std::string_view name) {
  constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_";
  constexpr std::string_view digits = "0123456789";
  if (name.empty() || letters.find(name.front()) == std::string_view::npos) return false;
  return std::all_of(name.begin(), name.end(), [&](char c) {
    return letters.find(c) != std::string_view::npos || digits.find(c) != std::string_view::npos;
  });
}

/// Words of the language of expressions, and names with a meaning of their own.
constexpr std::array<std::string_view, 23> taken_names{
    "abs",   "sqrt", "exp",   "log",      "sin", "cos",          "tan",          "asin",
    "acos",  "atan", "atan2", "hypot",    "min", "max",          "if",           "mean",
    "range", "rate", "drift", "integral", "pi",  "simple_bends", "reverse_bends"};

/// Collects the parts of a RopeLife, and their faults.
class LifeCompiler {
 public:
  Errors errors;
  LifeNames names;

  void declare(const std::string& path, const std::string& name, const Unit& unit) {
    if (!is_formula_name(name)) {
      errors.push_back({path, fmt::format("the name \"{}\" must be a letter or _, followed by "
                                          "letters, digits and _",
                                          name)});
    } else if (names.find(name) ||
               std::find(taken_names.begin(), taken_names.end(), name) != taken_names.end()) {
      errors.push_back(
          {path, fmt::format("the name \"{}\" has a meaning already; choose another", name)});
    } else {
      names.add(name, unit);
    }
  }

  std::optional<Expression> compile(const std::string& path, const std::string& text) {
    const Result<Expression> found = Expression::compile(text, names);
    if (!found) {
      for (const Error& error : found.errors()) errors.push_back({path, error.message});
      return {};
    }
    if (found->course_count() > 0) {
      errors.push_back({path,
                        "a formula of one bend has no statistics over time; min and max need two "
                        "values or more"});
      return {};
    }
    return *found;
  }

  /// A formula of a number of bends.
  std::optional<Expression> count(const std::string& path, const std::string& text) {
    std::optional<Expression> found = compile(path, text);
    if (found && !found->unit().is_pure()) {
      errors.push_back({path, fmt::format("the number of bends must be a pure number, and \"{}\" "
                                          "is in {}; divide by units, as in tension / 1[N]",
                                          text, found->unit().text())});
    }
    return found;
  }
};

}  // namespace

Result<RopeLife> RopeLife::create(const RopeLifeFormulas& formulas, double rope_diameter) {
  RopeLife life;
  life.known_ = {0.0, 0.0, rope_diameter};
  LifeCompiler compiler;
  for (const auto& [name, value] : formulas.constants) {
    compiler.declare("/constants/" + name, name, Unit());
    life.known_.push_back(value);
  }
  for (const auto& [name, text] : formulas.definitions) {
    const std::string path = "/definitions/" + name;
    const std::optional<Expression> found = compiler.compile(path, text);
    // A faulty definition still has its name, so that its users have no faults of their own.
    compiler.declare(path, name, found ? found->unit() : Unit("unknown").times(Unit()));
    if (found) life.definitions_.push_back(*found);
  }
  life.simple_ = compiler.count("/simple_bends", formulas.simple_bends);
  compiler.names.add("simple_bends", Unit());
  if (!formulas.reverse_bends.empty()) {
    life.reverse_ = compiler.count("/reverse_bends", formulas.reverse_bends);
  }
  if (!compiler.errors.empty()) return compiler.errors;
  return life;
}

double RopeLife::damage(double tension, double sheave_diameter, bool reverse) const {
  if (tension <= 0.0) return 0.0;
  std::vector<double> values = known_;
  values[tension_place] = tension;
  values[sheave_place] = sheave_diameter;
  for (const Expression& one : definitions_) values.push_back(one.value(values));
  double bends = simple_->value(values);
  if (reverse && reverse_) {
    values.push_back(bends);
    bends = reverse_->value(values);
  }
  return bends > 0.0 ? 1.0 / bends : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace sheave::measure
