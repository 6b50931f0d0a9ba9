#pragma once

#include "cable/links/wheel_link.h"

namespace sheave {

/// A cable end that is wound onto a drum. The drum pays cable out and takes it in as it turns, any
/// number of turns. With a layer pitch p each turn lies on the one before, so the radius grows: r =
/// r0 + p turns. The stored length s is the integral of r over the angle, hence r^2 = r0^2 + p s /
/// pi.
class SpoolLink final : public WheelLink {
 public:
  double stored_length = 0.0;  ///< cable on the drum at time 0 [m], >= 0
  double layer_pitch = 0.0;    ///< growth of the radius per turn [m], >= 0

  static constexpr std::string_view type_name = "spool";
  static constexpr std::string_view type_meaning =
      "an end of the cable is wound onto a drum, in layers if it has a pitch";
  static std::span<const Field> field_table();

  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Result<LinkGeometry> compile(const BodySet& bodies,
                                             const std::string& path) const override;
};

}  // namespace sheave
