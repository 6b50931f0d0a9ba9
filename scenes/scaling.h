#pragma once
// Scenes that must behave alike: the same machine with all lengths times a factor L and all masses
// times a factor M.
//
// Where every setting is multiplied by the power of L and M that its unit says (a force by M L, a
// compliance [m/N] by 1/M, gravity by L), Newton's equations are the same in units of L and M, at
// the same times. So for any scene, whatever it is, there is a right answer: the run of the
// original, with its lengths times L and its forces times M L.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/scene.h"

namespace sheave {

/// What a setting is multiplied by: L^length M^mass T^time.
struct UnitPowers {
  int length = 0;
  int mass = 0;
  int time = 0;
  [[nodiscard]] bool operator==(const UnitPowers&) const = default;
};

/// The powers in a unit as field tables have it ("N s/m", "rad/(N m)", ""); nothing if it is no
/// such unit.
[[nodiscard]] std::optional<UnitPowers> unit_powers(std::string_view unit);

/// A number, vector or list in the text of a scene that has powers of length or mass in its unit.
struct ScalableSetting {
  std::string pointer;  ///< JSON pointer
  std::string value;    ///< as JSON
  UnitPowers powers;
};

/// All of them but those of camera, paint and checks, in the order of the text, which must be that
/// of a valid scene.
[[nodiscard]] std::vector<ScalableSetting> scalable_settings(std::string_view text);
/// The setting with all its numbers times `factor`.
[[nodiscard]] Override scaled(const ScalableSetting& setting, double factor);
/// The overrides that make the scene of `text` similar to itself.
[[nodiscard]] std::vector<Override> similar_scene(const std::vector<ScalableSetting>& settings,
                                                  double length_factor, double mass_factor);

}  // namespace sheave
