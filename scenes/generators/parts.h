#pragma once
// Common parts of generated scenes. Numbers are rounded to 12 digits.

#include <string>

#include "scenes/scene.h"

namespace sheave::generators {

/// The number rounded to 12 digits: 0.6 instead of 0.6000000000000001, so that scenes are readable.
[[nodiscard]] double tidy(double value);
[[nodiscard]] Vector3 tidy(const Vector3& value);

/// A solid wheel about z on a fixed axle.
[[nodiscard]] BodyDef wheel(std::string name, const Vector3& center, double radius, double width,
                            double mass);
/// A box that slides along y.
[[nodiscard]] BodyDef weight(std::string name, const Vector3& center, const Vector3& size,
                             double mass);

/// Links of a cable in the plane z = 0.
[[nodiscard]] std::shared_ptr<const LinkDef> attach(BodyId body, const Vector3& point);
[[nodiscard]] std::shared_ptr<const LinkDef> roll(BodyId body, Winding winding);

/// A check over the whole duration with a tolerance of 0.1 % of `equals` or of `scale`, whichever
/// is larger.
[[nodiscard]] CheckDef check(std::string quantity, Statistic statistic, double equals, double scale,
                             std::string because);

/// Step settings as in the paper, with a fixed number of iterations.
void step_as_the_paper(Scene& scene, double dt, int substeps, int iterations);

/// A view nearly along the axles, framed automatically.
[[nodiscard]] CameraDef side_view();

}  // namespace sheave::generators
