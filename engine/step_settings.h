#pragma once

#include <array>
#include <string_view>

#include "engine/field.h"

namespace sheave {

/// How the constraint rows of a substep are solved.
enum class SolverKind {
  gauss_seidel,  ///< row after row, as in the paper: engine/solvers/gauss_seidel.h
  direct,        ///< all rows at once: engine/solvers/direct.h
};
inline constexpr std::array<std::string_view, 2> solver_names{"gauss-seidel", "direct"};

/// The integration scheme.
enum class IntegratorKind {
  xpbd,    ///< first order, as in the paper: engine/integrators/xpbd.cpp
  rattle,  ///< second order, conserves energy: engine/integrators/rattle.h
};
inline constexpr std::array<std::string_view, 2> integrator_names{"xpbd", "rattle"};

/// The source of step settings that a scene does not give.
enum class StepPreset {
  standard,  ///< StepSettings{}
  paper,     ///< StepSettings::paper()
};
inline constexpr std::array<std::string_view, 2> step_preset_names{"standard", "paper"};

/// Accuracy against cost, chosen per scene. The defaults are the cheapest settings that give right
/// results on machines of all kinds (bench/DEFAULTS.md).
struct StepSettings {
  double dt = 1.0 / 60.0;  ///< time per step, one frame [s], > 0
  int substeps = 4;        ///< substeps per step, 1 ... 100 000; h = dt / substeps
  /// sweeps over all rows per substep, or the most rounds of Newton's method; 1 ... 1 000 000
  int iterations = 50;
  SolverKind solver = SolverKind::direct;
  IntegratorKind integrator = IntegratorKind::rattle;
  /// Error of positions that one second of motion may add [m], >= 0. Above 0 the lengths of substeps
  /// follow from it (engine/step_size.h), which needs `direct` and `rattle`. `substeps` is then the
  /// number of times per step at which controllers without a sample time act. 0: fixed substeps
  double tolerance = 0.0;
  /// With a tolerance: substeps are no longer than dt / 2^coarsest_level, 0 ... 15. Runs that measure
  /// the error of another one need shorter substeps even where dt limits them. No setting of scenes
  int coarsest_level = 0;

  /// The settings of "Cable Joints" (2018) where the paper states no others: Gauss-Seidel, XPBD,
  /// one substep per frame of 1/60 s, 10 iterations.
  [[nodiscard]] static StepSettings paper();
  /// The settings of a preset.
  [[nodiscard]] static StepSettings of(StepPreset preset);

  [[nodiscard]] bool operator==(const StepSettings&) const = default;

  static std::span<const Field> field_table();
};

}  // namespace sheave
