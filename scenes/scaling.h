#pragma once
// Similar scenes: the same machine with all lengths times a factor L and all masses times a factor
// M.
//
// If every setting is multiplied by the powers of L and M in its unit (a force by M L, a compliance
// [m/N] by 1/M, gravity by L), Newton's equations are the same in units of L and M, at the same
// times. Every scene therefore has a known result: the run of the original with its lengths times L
// and its forces times M L.

#include <string>
#include <string_view>
#include <vector>

#include "scenes/scene.h"
#include "scenes/unit.h"

namespace sheave {

/// A number, vector or list in the text of a scene whose unit has powers of length or mass.
struct ScalableSetting {
  std::string pointer;  ///< JSON pointer
  std::string value;    ///< as JSON
  UnitPowers powers;    ///< its factor is L^length M^mass
};

/// All scalable settings except parameters and those of pictures and checks, in the order of the text. The
/// text must be a valid scene.
[[nodiscard]] std::vector<ScalableSetting> scalable_settings(std::string_view text);
/// The setting with all its numbers multiplied by `factor`.
[[nodiscard]] Override scaled(const ScalableSetting& setting, double factor);
/// The overrides that make the scene similar to its original.
[[nodiscard]] std::vector<Override> similar_scene(const std::vector<ScalableSetting>& settings,
                                                  double length_factor, double mass_factor);

}  // namespace sheave
