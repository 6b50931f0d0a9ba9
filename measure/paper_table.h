#pragma once
// What the paper says about the speed of its scenes: Table 1, and section 4 for what is only told
// there.
//
// On a Core i7 of 3.5 GHz, one frame of 1/60 s. Table 1 lists Hilbert3 with 10 iterations, the text
// with 100, both with 60 ms: both are here. The naive rope has no time in the paper.

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "engine/step_settings.h"
#include "measure/trajectory.h"
#include "scenes/scene.h"

namespace sheave::measure {

/// One scene with one setting of the paper's.
struct PaperRow {
  std::string_view scene;              ///< its name in the paper
  std::string_view file;               ///< ours, in scenes/paper
  int joints = 0;                      ///< cable joints as the paper counts them; 0: not told
  int substeps = 1;                    ///< per frame
  int iterations = 1;                  ///< per substep
  std::optional<double> milliseconds;  ///< per frame; nothing: not told
  std::string_view source;             ///< "Table 1" or "text"
  /// The same machine with a cable in place of a rope of segments, which is what the rope should
  /// do: the reference for the bodies that both have. Such a row is only run with the paper's
  /// setting. Empty: the scene itself is.
  std::string_view cable_file{};
};

/// All of them, in the paper's order; rows of one scene stand together.
[[nodiscard]] std::span<const PaperRow> paper_table();

inline constexpr double paper_frame = 1.0 / 60.0;  ///< [s]

/// The paper's settings of a row: its own Gauss-Seidel and integrator.
[[nodiscard]] StepSettings paper_settings(const PaperRow& row);
/// The direct solver at its default, with as many substeps as the paper takes.
[[nodiscard]] StepSettings direct_settings(const PaperRow& row, IntegratorKind integrator);

/// Free spans of the scene's cables, in the frame of its run that has the most (a cable that comes
/// to lie on a body has one more); the joints of a scene without cables.
[[nodiscard]] int joint_count(const Scene& scene, const Trajectory& run);

/// "gauss-seidel 1 x 10": solver, substeps x iterations, and the integrator if it is not the
/// paper's. Of the direct solver, which stops by itself, only the substeps.
[[nodiscard]] std::string settings_text(const StepSettings& step);

}  // namespace sheave::measure
