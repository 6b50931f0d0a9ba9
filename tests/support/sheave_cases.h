#pragma once
// Cases of sheaves with losses: a solver, an integrator and a number of substeps, and cables counted
// from either end.

#include <algorithm>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "cable/links/spool.h"
#include "tests/support/builders.h"
#include "tests/support/combinations.h"

namespace sheave::test {

using SheaveCase = std::tuple<Combination, int>;

/// Steps of 0.05 s by the solver, the integrator and the substeps of the case.
class SheaveCases : public testing::TestWithParam<SheaveCase> {
 protected:
  static constexpr double dt = 0.05;
  [[nodiscard]] static const Combination& combination() { return std::get<0>(GetParam()); }
  [[nodiscard]] static int substeps() { return std::get<1>(GetParam()); }
  [[nodiscard]] static bool rattle() { return combination().rattle(); }
  [[nodiscard]] static bool direct() { return combination().solver == SolverKind::direct; }
  [[nodiscard]] static double h() { return dt / substeps(); }
  /// An empty machine with gravity; `sweeps`: of Gauss-Seidel.
  [[nodiscard]] static Machine machine(int sweeps) {
    Machine m;
    m.model.gravity = down;
    m.model.step = settings(dt, substeps(), direct() ? 60 : sweeps);
    m.model.step.solver = combination().solver;
    m.model.step.integrator = combination().integrator;
    return m;
  }
  static void expect_clean(const Simulation& s) {
    const auto certificate = s.certificate();
    ASSERT_TRUE(certificate.has_value());
    EXPECT_TRUE(certificate->clean(1e-6)) << certificate->worst()->sentence();
  }
};

inline std::string sheave_case_name(const testing::TestParamInfo<SheaveCase>& info) {
  const auto& [combination, substeps] = info.param;
  return combination_name({combination, 0}) + "_" + std::to_string(substeps);
}

/// The cable counted from its other end.
inline void count_from_the_other_end(CableDef& rope) {
  const auto turned = [](const auto& wheel) {
    auto other = std::make_shared<std::decay_t<decltype(wheel)>>(wheel);
    other->winding = *wheel.winding == left ? right : left;
    return other;
  };
  for (auto& link : rope.links) {
    if (const auto* wheel = dynamic_cast<const RollingLink*>(link.get())) {
      link = turned(*wheel);
    } else if (const auto* drum = dynamic_cast<const SpoolLink*>(link.get())) {
      link = turned(*drum);
    }
  }
  std::reverse(rope.links.begin(), rope.links.end());
}

}  // namespace sheave::test
