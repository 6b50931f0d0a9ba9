#pragma once
// Units as powers of metre, kilogram, second and radian: of settings and of expressions.

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace sheave {

/// Powers in a unit of the field tables.
struct UnitPowers {
  int length = 0;
  int mass = 0;
  int time = 0;
  int angle = 0;
  [[nodiscard]] bool operator==(const UnitPowers&) const = default;
};

/// The powers in a unit of the field tables and of quantities ("N s/m", "rad/(N m)", "J", "");
/// nothing if it is not such a unit.
[[nodiscard]] std::optional<UnitPowers> unit_powers(std::string_view unit);

/// The unit of a number that is computed from quantities.
///
/// Radians are a ratio of lengths: they agree with pure numbers, and vanish from products with
/// metres, kilograms or their powers (arc = radius x angle, power = torque x speed).
class Unit {
 public:
  /// A pure number.
  Unit() = default;
  /// The unit of a quantity, from its text. A text with several units ("N, N m") is an open unit.
  explicit Unit(std::string_view text);

  /// Not determined: the unit of a quantity that has one of several units, and of its products.
  /// The open unit agrees with all units.
  [[nodiscard]] bool is_open() const { return open_; }
  /// Whether it is open, a pure number, or a power of radians.
  [[nodiscard]] bool is_pure() const;
  /// Whether values of both units can be added and compared.
  [[nodiscard]] bool agrees_with(const Unit& other) const;

  [[nodiscard]] Unit times(const Unit& other) const;
  [[nodiscard]] Unit over(const Unit& other) const;
  /// `power` must be finite.
  [[nodiscard]] Unit to_the(double power) const;
  /// The largest size of a power in it.
  [[nodiscard]] double largest_power() const;

  /// "N", "m/s", "kg m2/s", "m^0.5"; empty for a pure number. An open unit is empty, too, unless it
  /// is that of a quantity ("N, N m").
  [[nodiscard]] std::string text() const;

 private:
  static constexpr std::size_t metre = 0, kilogram = 1, second = 2, radian = 3;
  [[nodiscard]] Unit combined(const Unit& other, double sign) const;

  std::array<double, 4> powers_{};
  bool open_ = false;
  std::string text_;  // if it is the unit of a quantity
};

}  // namespace sheave
