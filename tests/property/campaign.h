#pragma once
// One property over many seeds.
//
// SHEAVE_CASES says how many seeds (default: 100, fewer in slow builds), SHEAVE_SEED the first one,
// so
//   SHEAVE_SEED=4711 SHEAVE_CASES=1 build/release/tests/test_property --gtest_filter='*Mirror*'
// repeats one case. With either, a line of results is printed.

#include <cstdint>
#include <functional>
#include <string>

#include "tests/property/random_machine.h"

namespace sheave::test {

/// What a property found on one machine.
struct Finding {
  bool checked = true;  ///< false: the case says nothing about this property
  double value = 0.0;   ///< what was measured
  double limit = 0.0;   ///< and what it may be; a value that is not a number fails
  std::string what;     ///< where it was worst
  /// Comparisons of courses: the steps that were to be compared, and those of which nothing can be
  /// said (course.h).
  std::int64_t steps = 0;
  std::int64_t dropped = 0;
  [[nodiscard]] bool holds() const { return value <= limit; }
  /// Takes over a worse finding, by the share of the limit that is used.
  void worsen(double new_value, double new_limit, const std::string& where);
};

/// The largest part of the steps of a campaign of which nothing may be said.
inline constexpr double most_dropped = 0.05;

/// The same for any kind of machine; `draw` makes that of a seed, `usual_cases` is the number of
/// seeds by default. Machines listed in known_seeds.h have to break the property.
void run_campaign_on(const std::string& property, std::uint64_t usual_cases,
                     const std::function<RandomMachine(std::uint64_t seed)>& draw,
                     const std::function<Finding(const Machine&, std::uint64_t seed)>& check);
/// Runs `check` on the machines of many seeds. Every failure fails the test and names its seed and
/// its machine.
void run_campaign(const std::string& property, const Traits& traits,
                  const std::function<Finding(const Machine&, std::uint64_t seed)>& check);

}  // namespace sheave::test
