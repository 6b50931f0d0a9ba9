#pragma once

#include <optional>

#include "cable/links/wheel_link.h"

namespace sheave {

/// A cable end that is wound onto a drum. The drum pays cable out and takes it in as it turns, any
/// number of turns. With a layer pitch p each turn lies on the one before, so the radius grows: r =
/// r0 + p turns. The stored length s is the integral of r over the angle, hence r^2 = r0^2 + p s /
/// pi. With a lead the drum has a helical groove (cable/drum_groove.h).
class SpoolLink final : public WheelLink {
 public:
  double stored_length = 0.0;  ///< cable on the drum at time 0 [m], >= 0
  double layer_pitch = 0.0;    ///< growth of the radius per turn [m], >= 0; excludes the others
  /// Way of the rope along the normal per turn that is wound on [m], any sign; layers with an odd
  /// number go back.
  std::optional<double> lead;
  std::optional<double> turns_per_layer;  ///< >= 1; default: one layer without end
  std::optional<double> layer_height;     ///< growth of the radius per layer [m], > 0
  int layers = 0;                         ///< that fit between the flanges; 0: any number
  /// Place of the rope along the normal, from the centre, when nothing is stored [m]; default: half
  /// of a layer's way before the centre, and the centre without `turns_per_layer`.
  std::optional<double> groove_start;
  std::optional<double> most_fleet_angle;  ///< above which the run warns [rad], > 0

  static constexpr std::string_view type_name = "spool";
  static constexpr std::string_view type_meaning =
      "an end of the cable is wound onto a drum, in layers if it has a pitch, in a helical groove "
      "if it has a lead";
  static std::span<const Field> field_table();

  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Result<LinkGeometry> compile(const BodySet& bodies,
                                             const std::string& path) const override;
  [[nodiscard]] bool has_groove() const { return lead || turns_per_layer; }

 private:
  /// Why these settings do not fit together, with the field; empty if they do.
  [[nodiscard]] Errors groove_faults(bool round, const std::string& path) const;
};

}  // namespace sheave
