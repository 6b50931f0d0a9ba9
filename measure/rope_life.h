#pragma once
// Fatigue of ropes by bending: formulas of the user, and the sum of damages.
//
// A formula tells how many bends of one kind a rope bears, from its tension S at the bend, the
// diameter D of the sheave and its own diameter d. By Palmgren and Miner each bend takes the share
// 1 / N of the life of its section, and the section is worn out where the shares add up to 1:
//
//   damage = sum over simple bends of 1 / N(S, D) + sum over reverse bends of 1 / N_reverse(S, D)
//
// (K. Feyrer, Wire Ropes, 2nd edition, Springer 2015, equations 3.70 and 3.92). A run that repeats
// can be repeated 1 / damage times. Sheave has no formula and no constant of its own.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/result.h"
#include "scenes/expression.h"

namespace sheave::measure {

/// Formulas as texts (scenes/expression.h). Each may name `tension` [N], `sheave_diameter` [m],
/// `rope_diameter` [m], the constants, and the definitions before it.
struct RopeLifeFormulas {
  std::vector<std::pair<std::string, double>> constants{};  ///< pure numbers
  std::vector<std::pair<std::string, std::string>> definitions{};
  std::string simple_bends{};  ///< number of simple bends that the rope bears
  /// Number of reverse bends; may also name `simple_bends`. Empty: the rope bears as many reverse
  /// bends as simple ones.
  std::string reverse_bends{};
};

class RopeLife {
 public:
  /// Errors have the path of the formula in the file: "/definitions/x", "/simple_bends".
  static Result<RopeLife> create(const RopeLifeFormulas& formulas, double rope_diameter);

  /// The share of the life that one bend takes. 0 if the rope is slack; NaN if the formula has no
  /// positive value.
  [[nodiscard]] double damage(double tension, double sheave_diameter, bool reverse) const;

 private:
  RopeLife() = default;

  std::vector<double> known_;            ///< tension, diameters, constants
  std::vector<Expression> definitions_;  ///< each with the values before it
  std::optional<Expression> simple_;
  std::optional<Expression> reverse_;
};

}  // namespace sheave::measure
