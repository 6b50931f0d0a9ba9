#pragma once
// Times of the paper's scenes: Table 1, and section 4 for times that only the text contains.
//
// On a Core i7 of 3.5 GHz, for one frame of 1/60 s. Table 1 lists Hilbert3 with 10 iterations, the
// text with 100, both with 60 ms: both are here. The paper gives no time for the naive rope.

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
  std::string_view file;               ///< our file, in scenes/paper
  int joints = 0;                      ///< cable joints as the paper counts them; 0: not given
  int substeps = 1;                    ///< per frame
  int iterations = 1;                  ///< per substep
  std::optional<double> milliseconds;  ///< per frame; nothing: not given
  std::string_view source;             ///< "Table 1" or "text"
  /// The same machine with a cable in place of a rope of segments: the reference for the bodies
  /// that both have. Such a row runs only with the paper's setting. Empty: the reference is the
  /// scene itself.
  std::string_view cable_file{};
};

/// All rows, in the paper's order; rows of one scene are adjacent.
[[nodiscard]] std::span<const PaperRow> paper_table();

inline constexpr double paper_frame = 1.0 / 60.0;  ///< [s]

/// The paper's settings of a row: its own Gauss-Seidel and integrator.
[[nodiscard]] StepSettings paper_settings(const PaperRow& row);
/// The direct solver at its default, with the paper's number of substeps.
[[nodiscard]] StepSettings direct_settings(const PaperRow& row, IntegratorKind integrator);

/// Largest number of free spans of the scene's cables in any frame of its run (a cable that comes
/// to lie on a body has one more); for a scene without cables the number of joints.
[[nodiscard]] int joint_count(const Scene& scene, const Trajectory& run);

/// "gauss-seidel 1 x 10": solver, substeps x iterations, and the integrator if it is not the
/// paper's. For the direct solver, which stops by itself, only the substeps.
[[nodiscard]] std::string settings_text(const StepSettings& step);

}  // namespace sheave::measure
