// Tables of tensions: the curve, its integral, its derivative and its inverse, and faults.

#include "cable/tension_law.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace sheave {
namespace {

CableDef with_table(std::vector<double> strains, std::vector<double> tensions) {
  CableDef cable;
  cable.strain_table = std::move(strains);
  cable.tension_table = std::move(tensions);
  return cable;
}

/// A rope that is soft at first, stiff in the middle and soft at last.
CableDef s_shaped() {
  return with_table({0.0, 0.01, 0.02, 0.05, 0.08, 0.15},
                    {0.0, 50.0, 400.0, 3000.0, 4000.0, 5000.0});
}

constexpr std::array strains{0.001, 0.0099, 0.01, 0.013, 0.049, 0.05, 0.079, 0.14, 0.15, 0.3};

TEST(TensionLaw, PassesThroughItsPoints) {
  const CableDef cable = s_shaped();
  const TensionLaw law(cable);
  for (std::size_t i = 0; i < cable.strain_table.size(); ++i) {
    EXPECT_NEAR(law.tension(cable.strain_table[i]), cable.tension_table[i], 1e-12 * 5000.0);
  }
  EXPECT_EQ(law.tension(-0.1), 0.0);
  EXPECT_EQ(law.energy(-0.1), 0.0);
}

TEST(TensionLaw, WithTwoPointsIsAConstantStiffness) {
  const TensionLaw law(with_table({0.0, 0.1}, {0.0, 300.0}));
  for (const double e : strains) {
    EXPECT_NEAR(law.tension(e), 3000.0 * e, 1e-12 * 3000.0 * e);
    EXPECT_NEAR(law.stiffness(e), 3000.0, 1e-9);
    EXPECT_NEAR(law.energy(e), 1500.0 * e * e, 1e-12 * 1500.0 * e * e);
  }
}

TEST(TensionLaw, HasTheDerivativesOfItsIntegral) {
  // Central differences of step d have the error d^2 / 6 times the third derivative, which is below
  // 1e9 N here, and the rounding 1e-16 x 5000 N / d: 1e-6 of the stiffness of 1e5 N for d = 1e-7,
  // beside points of the table the jump of the second derivative, 1e7 N, times d / 4.
  const TensionLaw law(s_shaped());
  constexpr double d = 1e-7;
  for (const double e : strains) {
    EXPECT_NEAR((law.energy(e + d) - law.energy(e - d)) / (2.0 * d), law.tension(e), 1e-2);
    EXPECT_NEAR((law.tension(e + d) - law.tension(e - d)) / (2.0 * d), law.stiffness(e), 2.0) << e;
    for (const double from : {0.0, 0.012, 0.05, 0.2}) {
      const double slope = (law.mean(from, e + d) - law.mean(from, e - d)) / (2.0 * d);
      EXPECT_NEAR(slope, law.mean_stiffness(from, e), 2.0) << from << ' ' << e;
    }
  }
}

TEST(TensionLaw, MeansTheChangeOfTheEnergy) {
  const TensionLaw law(s_shaped());
  for (const double from : strains) {
    for (const double to : strains) {
      const double change = law.energy(to) - law.energy(from);
      EXPECT_NEAR(law.mean(from, to) * (to - from), change, 1e-12);
    }
    // Where the quotient of both would be rounding.
    EXPECT_NEAR(law.mean(from, from + 1e-14), law.tension(from), 1e-7);
    EXPECT_NEAR(law.mean_stiffness(from, from + 1e-14), 0.5 * law.stiffness(from), 1e-3);
  }
}

TEST(TensionLaw, IsInvertedToRounding) {
  const TensionLaw law(s_shaped());
  for (const double e : strains) {
    EXPECT_NEAR(law.strain(law.tension(e)), e, 1e-13) << e;
  }
  EXPECT_EQ(law.strain(0.0), 0.0);
  EXPECT_EQ(law.strain(-1.0), 0.0);
}

TEST(TensionLaw, RisesBetweenAndBeyondItsPoints) {
  const TensionLaw law(s_shaped());
  double before = 0.0;
  for (int i = 1; i <= 4000; ++i) {
    const double e = i * 5e-5;
    EXPECT_GT(law.tension(e), before) << e;
    EXPECT_GT(law.stiffness(e), 0.0) << e;
    before = law.tension(e);
  }
  // Beyond the last point the law is the tangent there.
  EXPECT_NEAR(law.tension(0.2) - law.tension(0.15), 0.05 * law.stiffness(0.15), 1e-9);
}

TEST(TensionLaw, NamesWhatIsWrongWithATable) {
  const auto fault = [](const CableDef& cable) {
    const auto found = TensionLaw::fault_of(cable);
    return found ? found->field + ": " + found->message : std::string("none");
  };
  const auto expect = [&](const CableDef& cable, const std::string& field,
                          const std::string& part) {
    EXPECT_EQ(fault(cable).find(field + ": "), 0U) << fault(cable);
    EXPECT_NE(fault(cable).find(part), std::string::npos) << fault(cable);
  };
  EXPECT_EQ(fault(s_shaped()), "none");
  EXPECT_EQ(fault(CableDef()), "none");
  expect(with_table({0.0, 0.1}, {0.0}), "/tension_table", "one tension per strain");
  expect(with_table({}, {0.0, 1.0}), "/tension_table", "one tension per strain");
  expect(with_table({0.0}, {0.0}), "/strain_table", "2 to 10000 points");
  expect(with_table({0.01, 0.1}, {0.0, 1.0}), "/strain_table/0", "begins with");
  expect(with_table({0.0, 0.1}, {5.0, 10.0}), "/tension_table/0", "begins with");
  expect(with_table({0.0, 0.1, 0.1}, {0.0, 1.0, 2.0}), "/strain_table/2", "strains must rise");
  expect(with_table({0.0, 0.1, 0.2}, {0.0, 1.0, 1.0}), "/tension_table/2", "tensions must rise");
  expect(with_table({0.0, 1000.0}, {0.0, 1.0}), "/strain_table/1", "at most 100");
  expect(with_table({0.0, 0.1, 0.2}, {0.0, 100.0, 101.0}), "/tension_table/2", "end level");
  std::vector<double> many(TensionLaw::most_points + 1);
  for (std::size_t i = 0; i < many.size(); ++i) many[i] = 1e-5 * static_cast<double>(i);
  expect(with_table(many, many), "/strain_table", "this one has 10001");
}

TEST(TensionLaw, IsTheLawOfASpan) {
  const CableDef cable = s_shaped();
  EXPECT_NEAR(*spring_tension(cable, 2.1, 2.0), 3000.0, 1e-9);
  EXPECT_EQ(*spring_tension(cable, 1.9, 2.0), 0.0);
  CableDef constant;
  constant.axial_stiffness = 1e5;
  EXPECT_NEAR(*spring_tension(constant, 2.1, 2.0), 5000.0, 1e-9);
  CableDef compliant;
  compliant.compliance = 1e-3;
  EXPECT_NEAR(*spring_tension(compliant, 2.1, 2.0), 100.0, 1e-9);
  EXPECT_FALSE(spring_tension(CableDef(), 2.1, 2.0).has_value());
}

}  // namespace
}  // namespace sheave
