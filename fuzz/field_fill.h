#pragma once
// Random values for fields, drawn from the field tables: valid values, values at the bounds, and
// invalid ones.

#include <cmath>
#include <limits>

#include "engine/field.h"
#include "tests/support/random.h"

namespace sheave::fuzz {

/// Draws a value for a slot of any type.
class FieldFill {
 public:
  /// `bodies`: number of bodies for references.
  FieldFill(test::Random& random, const Field& field, int bodies)
      : random_(random), field_(field), bodies_(bodies) {}

  void operator()(double* x) const { *x = number(); }
  void operator()(std::optional<double>* x) const {
    x->reset();
    if (!absent()) *x = number();
  }
  void operator()(int* x) const {
    const double value = number();
    constexpr double most = std::numeric_limits<int>::max();
    *x = std::abs(value) < most ? static_cast<int>(value) : std::numeric_limits<int>::min();
  }
  void operator()(bool* x) const { *x = random_.chance(0.5); }
  void operator()(std::string* x) const { *x = text(); }
  void operator()(Vector3* x) const { *x = vector(); }
  void operator()(std::optional<Vector3>* x) const {
    x->reset();
    if (!absent()) *x = vector();
  }
  void operator()(Quaternion* x) const {
    *x = random_.orientation();
    if (random_.chance(0.05)) x->w() = number();
  }
  void operator()(BodyId* x) const { *x = body(); }
  void operator()(std::optional<BodyId>* x) const {
    x->reset();
    if (!absent()) *x = body();
  }
  void operator()(std::vector<double>* x) const {
    x->clear();
    double sum = 0.0;
    const bool rising = random_.chance(0.7);
    for (int count = random_.below(5); count > 0; --count) {
      const double value = number();
      sum += std::abs(value);
      x->push_back(rising ? sum : value);
    }
  }
  void operator()(std::vector<Vector3>* x) const {
    const bool flat = random_.chance(0.5);
    x->clear();
    for (int count = random_.below(12); count > 0; --count) {
      x->push_back(vector());
      if (flat) x->back().z() = 0.0;
    }
  }
  void operator()(std::vector<std::string>* x) const {
    x->clear();
    for (int count = random_.below(3); count > 0; --count) x->push_back(text());
  }
  void operator()(const ChoiceSlot& x) const {
    x.set(x.object, random_.below(static_cast<int>(field_.choices.size())));
  }

 private:
  [[nodiscard]] bool absent() const { return random_.chance(0.2); }
  /// Mostly a number in the allowed range and of ordinary size.
  [[nodiscard]] double number() const {
    const Range& range = field_.range;
    const bool whole = std::isfinite(range.minimum) && std::isfinite(range.maximum);
    switch (random_.below(16)) {
      case 0:
        return std::isfinite(range.minimum) ? range.minimum : 0.0;
      case 1:
        return std::isfinite(range.maximum) ? range.maximum : 1.0;
      case 2:
        return std::pow(10.0, random_.between(-30.0, 30.0));
      case 3:
        return extreme();
      case 4:
        return -std::pow(10.0, random_.between(-3.0, 3.0));
      case 5:
      case 6:
        return std::round(random_.between(0.0, 10.0));
      case 7:
      case 8:
        return whole ? random_.between(range.minimum, range.maximum) : random_.between(0.0, 1e3);
      case 9:
      case 10:
        return std::pow(10.0, random_.between(-6.0, 4.0));
      case 11:
      case 12:
        return random_.between(-2.0, 2.0);
      default:
        return random_.between(0.0, 2.0);
    }
  }
  [[nodiscard]] double extreme() const {
    using Limits = std::numeric_limits<double>;
    constexpr std::array<double, 8> values{
        Limits::infinity(), -Limits::infinity(), Limits::quiet_NaN(),  Limits::max(),
        -Limits::max(),     Limits::min(),       Limits::denorm_min(), -0.0};
    return values[static_cast<std::size_t>(random_.below(values.size()))];
  }
  [[nodiscard]] Vector3 vector() const {
    if (random_.chance(0.1)) return Vector3::Zero();
    if (random_.chance(0.3)) return Vector3::Unit(random_.below(3));
    if (random_.chance(0.7)) return random_.vector(1.0);
    return {number(), number(), number()};
  }
  /// The world or a body; rarely a body that does not exist.
  [[nodiscard]] BodyId body() const {
    if (random_.chance(0.03)) return {random_.below(2) == 0 ? bodies_ : -2};
    return {random_.below(bodies_ + 1) - 1};
  }
  [[nodiscard]] std::string text() const {
    constexpr std::array<const char*, 4> texts{"", "a", "b", "world"};
    return texts[static_cast<std::size_t>(random_.below(texts.size()))];
  }

  test::Random& random_;
  const Field& field_;
  int bodies_;
};

}  // namespace sheave::fuzz
