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

/// How states are carried forward in time.
enum class IntegratorKind {
  xpbd,    ///< as in the paper, of first order: engine/integrators/xpbd.cpp
  rattle,  ///< of second order, conserving energy: engine/integrators/rattle.h
};
inline constexpr std::array<std::string_view, 2> integrator_names{"xpbd", "rattle"};

/// Where the step settings that are not given come from.
enum class StepPreset {
  standard,  ///< StepSettings{}
  paper,     ///< StepSettings::paper()
};
inline constexpr std::array<std::string_view, 2> step_preset_names{"standard", "paper"};

/// Accuracy against cost, chosen per scene. The defaults are those with which machines of all kinds
/// come out right (bench/DEFAULTS.md).
struct StepSettings {
  double dt = 1.0 / 60.0;  ///< time per step, one frame [s], > 0
  int substeps = 4;        ///< substeps per step, 1 ... 100 000; h = dt / substeps
  int iterations = 50;     ///< sweeps over all rows per substep, or rounds at most; 1 ... 1 000 000
  SolverKind solver = SolverKind::direct;
  IntegratorKind integrator = IntegratorKind::rattle;

  /// What "Cable Joints" (2018) steps with unless it says otherwise: Gauss-Seidel, XPBD, one
  /// substep of a frame of 1/60 s, 10 iterations.
  [[nodiscard]] static StepSettings paper();
  /// The settings that the preset stands for.
  [[nodiscard]] static StepSettings of(StepPreset preset);

  [[nodiscard]] bool operator==(const StepSettings&) const = default;

  static std::span<const Field> field_table();
};

}  // namespace sheave
