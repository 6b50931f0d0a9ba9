#include "scenes/unit.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "engine/number_text.h"

namespace sheave {
namespace {

/// A unit with a name of its own, and its powers of metre, kilogram, second and radian.
struct NamedUnit {
  std::string_view name;
  std::array<double, 4> powers;
};
/// The names in texts of units.
constexpr std::array<NamedUnit, 8> named_units{{{"m", {1, 0, 0, 0}},
                                                {"kg", {0, 1, 0, 0}},
                                                {"s", {0, 0, 1, 0}},
                                                {"rad", {0, 0, 0, 1}},
                                                {"N", {1, 1, -2, 0}},
                                                {"J", {2, 1, -2, 0}},
                                                {"W", {2, 1, -3, 0}},
                                                {"Hz", {0, 0, -1, 0}}}};
/// Names that may stand for kilograms in a composed unit.
constexpr std::array<std::string_view, 3> mass_units{"kg", "N", "W"};
/// Units that have this form although another one is as short.
constexpr std::array<std::string_view, 5> usual_units{"kg m/s", "kg m2/s", "N m", "N/m", "N s/m"};

std::optional<std::array<double, 4>> named_powers(std::string_view name) {
  for (const NamedUnit& unit : named_units) {
    if (unit.name == name) return unit.powers;
  }
  return std::nullopt;
}

/// Splits at any of the characters; no empty parts.
std::vector<std::string_view> parts_of(std::string_view text, std::string_view separators) {
  std::vector<std::string_view> parts;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of(separators), text.size());
    if (end > 0) parts.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return parts;
}

/// Powers of one factor of a unit: "m", "m2", "N".
std::optional<std::array<double, 4>> factor_powers(std::string_view factor) {
  double power = 1.0;
  if (!factor.empty() && factor.back() >= '2' && factor.back() <= '9') {
    power = factor.back() - '0';
    factor.remove_suffix(1);
  }
  if (factor == "1") return std::array<double, 4>{};
  std::optional<std::array<double, 4>> powers = named_powers(factor);
  if (powers) {
    for (double& one : *powers) one *= power;
  }
  return powers;
}

std::optional<std::array<double, 4>> powers_of(std::string_view unit) {
  std::array<double, 4> sum{};
  const std::size_t slash = std::min(unit.find('/'), unit.size());
  for (const double sign : {1.0, -1.0}) {
    const std::string_view side =
        sign > 0.0 ? unit.substr(0, slash) : unit.substr(std::min(slash + 1, unit.size()));
    for (const std::string_view factor : parts_of(side, " ()")) {
      const auto powers = factor_powers(factor);
      if (!powers) return std::nullopt;
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += sign * (*powers)[i];
    }
  }
  return sum;
}

struct Factor {
  std::string_view name;
  double power = 0.0;
};

/// The factors of a unit in which `mass_unit` stands for kilograms.
std::vector<Factor> factors_of(std::array<double, 4> powers, std::string_view mass_unit) {
  const std::array<double, 4> own = *named_powers(mass_unit);
  const double mass = powers[1];
  for (std::size_t i = 0; i < powers.size(); ++i) powers[i] -= mass * own[i];
  std::vector<Factor> factors;
  const auto add = [&](std::string_view name, double power) {
    if (power != 0.0) factors.push_back({name, power});
  };
  add(mass_unit, mass);
  add("m", powers[0]);
  add("rad", powers[3]);
  add("s", powers[2]);
  return factors;
}

std::string text_of(std::span<const Factor> factors) {
  std::string above;
  std::string below;
  int count_below = 0;
  for (const Factor& factor : factors) {
    std::string& side = factor.power > 0.0 ? above : below;
    if (!side.empty()) side += " ";
    side += factor.name;
    const double size = std::abs(factor.power);
    if (size != 1.0) side += (size == std::floor(size) ? "" : "^") + number_text(size);
    count_below += factor.power < 0.0 ? 1 : 0;
  }
  if (below.empty()) return above;
  if (count_below > 1) below = "(" + below + ")";
  return (above.empty() ? "1" : above) + "/" + below;
}

}  // namespace

std::optional<UnitPowers> unit_powers(std::string_view unit) {
  const auto powers = powers_of(unit);
  if (!powers) return std::nullopt;
  const auto whole = [&](std::size_t i) { return static_cast<int>((*powers)[i]); };
  return UnitPowers{whole(0), whole(1), whole(2), whole(3)};
}

Unit::Unit(std::string_view text) : text_(text) {
  const auto powers = powers_of(text);
  open_ = !powers.has_value();
  if (powers) powers_ = *powers;
}

bool Unit::is_pure() const {
  return open_ || (powers_[metre] == 0.0 && powers_[kilogram] == 0.0 && powers_[second] == 0.0);
}

bool Unit::agrees_with(const Unit& other) const {
  return open_ || other.open_ ||
         std::equal(powers_.begin(), powers_.begin() + radian, other.powers_.begin());
}

Unit Unit::combined(const Unit& other, double sign) const {
  Unit result;
  result.open_ = open_ || other.open_;
  if (result.open_) return result;
  for (std::size_t i = 0; i < powers_.size(); ++i) {
    result.powers_[i] = powers_[i] + sign * other.powers_[i];
  }
  const bool has_matter = result.powers_[metre] != 0.0 || result.powers_[kilogram] != 0.0;
  if (has_matter) result.powers_[radian] = std::min(result.powers_[radian], 0.0);
  // A factor without a unit leaves the name: J stays J.
  if (result.powers_ == powers_) result.text_ = text_;
  return result;
}

Unit Unit::times(const Unit& other) const {
  if (!other.open_ && !open_ && other.powers_ != decltype(powers_){} &&
      powers_ == decltype(powers_){}) {
    return other;
  }
  return combined(other, 1.0);
}

Unit Unit::over(const Unit& other) const { return combined(other, -1.0); }

Unit Unit::to_the(double power) const {
  if (power == 1.0) return *this;
  Unit result;
  result.open_ = open_ && power != 0.0;
  for (std::size_t i = 0; !open_ && i < powers_.size(); ++i) {
    result.powers_[i] = power * powers_[i] + 0.0;  // no -0
  }
  return result;
}

double Unit::largest_power() const {
  double largest = 0.0;
  for (const double power : powers_) largest = std::max(largest, std::abs(power));
  return largest;
}

std::string Unit::text() const {
  if (!text_.empty() || open_) return text_;
  for (const std::string_view usual : usual_units) {
    if (powers_of(usual) == powers_) return std::string(usual);
  }
  std::vector<Factor> best = factors_of(powers_, mass_units.front());
  for (const std::string_view mass_unit : mass_units) {
    const std::vector<Factor> other = factors_of(powers_, mass_unit);
    if (other.size() < best.size()) best = other;
  }
  return text_of(best);
}

}  // namespace sheave
