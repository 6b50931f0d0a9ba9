// Loops over slices against the sums that they stand for, written out: in all widths, in numbers of
// rows that fill no whole pack, to the last bit, since both add in the same order.

#include "engine/solvers/affine_kernels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "engine/solvers/affine_terms.h"
#include "tests/support/random.h"

namespace sheave {
namespace {

struct Term {
  int number = 0;
  double gradient = 0.0;
};

struct RandomRows {
  std::size_t numbers = 1;
  std::vector<std::vector<Term>> rows;
  std::vector<double> inverse_masses;
  AffineTerms terms;
};

/// Rows of at most `width` terms; `crowd` of them, at least, are on number 1.
RandomRows random_machine(test::Random& random, std::size_t count, int width, std::size_t crowd) {
  RandomRows machine;
  machine.numbers = count + 2;
  machine.inverse_masses.push_back(0.0);
  for (std::size_t d = 1; d < machine.numbers; ++d) {
    machine.inverse_masses.push_back(random.between(0.1, 2.0));
  }
  AffineRows rows;
  for (std::size_t i = 0; i < count; ++i) {
    rows.add_row(0.0, 0.0, static_cast<int>(i));
    std::vector<Term>& row = machine.rows.emplace_back();
    for (int p = 0; p < width; ++p) {
      // Neighbours, so that no number has many; each number at most once per row.
      int number = static_cast<int>(i) + p;
      if (p == 0 && i < crowd) number = 1;
      if (number == 0 || number >= static_cast<int>(machine.numbers)) continue;
      const bool there =
          std::any_of(row.begin(), row.end(), [&](const Term& t) { return t.number == number; });
      if (!there) row.push_back({number, random.between(-1.0, 1.0)});
    }
    for (const Term& term : row) rows.add_term(term.number, term.gradient);
  }
  EXPECT_TRUE(machine.terms.take(rows, machine.numbers));
  machine.terms.weigh(machine.inverse_masses);
  return machine;
}

std::vector<double> random_values(test::Random& random, std::size_t count) {
  std::vector<double> values(count);
  for (double& value : values) value = random.between(-3.0, 3.0);
  return values;
}

double along(const std::vector<Term>& row, const std::vector<double>& x) {
  double sum = 0.0;
  for (const Term& term : row) sum += term.gradient * x[at(term.number)];
  return sum;
}

class AffineKernels : public testing::TestWithParam<std::tuple<std::size_t, int, std::size_t>> {
 protected:
  test::Random random{std::get<0>(GetParam())};
  RandomRows machine = random_machine(random, std::get<0>(GetParam()), std::get<1>(GetParam()),
                                      std::get<2>(GetParam()));
  std::size_t count = machine.rows.size();
};

TEST_P(AffineKernels, RatesAndShortfallsAreSumsOverTheRows) {
  std::vector<double> x = random_values(random, machine.numbers);
  x[0] = 0.0;
  const std::vector<double> constants = random_values(random, count);
  std::vector<double> rates(count);
  std::vector<double> shortfalls(count);
  find_rates(machine.terms.gradients(), x.data(), rates.data());
  find_shortfalls(machine.terms.gradients(), constants.data(), x.data(), shortfalls.data());
  for (std::size_t i = 0; i < count; ++i) {
    EXPECT_EQ(rates[i], along(machine.rows[i], x)) << i;
    EXPECT_EQ(shortfalls[i], -(constants[i] + along(machine.rows[i], x))) << i;
  }
}

TEST_P(AffineKernels, NumbersAddTheirRowsInOrder) {
  std::vector<double> x = random_values(random, machine.numbers);
  x[0] = 0.0;
  const std::vector<double> multipliers = random_values(random, count);
  std::vector<double> expected = x;
  for (std::size_t i = 0; i < count; ++i) {
    for (const Term& term : machine.rows[i]) {
      const double response = machine.inverse_masses[at(term.number)] * term.gradient;
      expected[at(term.number)] += response * multipliers[i];
    }
  }
  machine.terms.respond_to(multipliers.data(), x.data());
  EXPECT_EQ(x, expected);
}

TEST_P(AffineKernels, FindsTheLargestResidualAtAnyPlace) {
  std::vector<double> x = random_values(random, machine.numbers);
  x[0] = 0.0;
  const std::vector<double> softness = random_values(random, count);
  const std::vector<double> multipliers = random_values(random, count);
  std::vector<double> constants(count);
  for (std::size_t i = 0; i < count; ++i) {
    constants[i] = -along(machine.rows[i], x) - softness[i] * multipliers[i];
  }
  std::vector<double> scratch(count);
  for (std::size_t worst = 0; worst < count; ++worst) {
    std::vector<double> off = constants;
    off[worst] += worst % 2 == 0 ? 0.5 : -0.5;
    const double most = largest_residual(machine.terms.gradients(), off.data(), softness.data(),
                                         multipliers.data(), x.data(), scratch.data());
    // Some sums of numbers of at most 10 that round by 1e-16 of them each.
    EXPECT_NEAR(most, 0.5, 1e-14) << worst;
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, AffineKernels,
                         testing::Combine(testing::Values(1U, 2U, 7U, 8U, 21U),
                                          testing::Values(2, 4), testing::Values(0U, 6U, 12U)));

TEST(AffineKernels, TakesPositiveValuesAndReturnsTheLeast) {
  for (const std::size_t count : {1U, 7U, 8U, 9U, 20U}) {
    for (std::size_t least = 0; least < count; ++least) {
      std::vector<double> unknowns(count, 2.0);
      unknowns[least] = -1.5;
      std::vector<double> multipliers(count, 9.0);
      EXPECT_EQ(take_positive(count, unknowns.data(), multipliers.data()), -1.5);
      for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(multipliers[i], i == least ? 0.0 : 2.0);
    }
    const std::vector<double> positive(count, 1.0);
    std::vector<double> multipliers(count);
    EXPECT_EQ(take_positive(count, positive.data(), multipliers.data()), 0.0);
  }
}

TEST(AffineKernels, KeepsNan) {
  const std::vector<double> unknowns(9, std::numeric_limits<double>::quiet_NaN());
  std::vector<double> multipliers(9);
  static_cast<void>(take_positive(9, unknowns.data(), multipliers.data()));
  for (const double multiplier : multipliers) EXPECT_TRUE(std::isnan(multiplier));
}

}  // namespace
}  // namespace sheave
