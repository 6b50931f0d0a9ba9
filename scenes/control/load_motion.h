#pragma once

#include "scenes/control/load.h"

namespace sheave {

/// The motion of a kinematic body in six degrees of freedom, relative to its pose in the scene: a
/// sum of sines and a table. Displacement d and rotation vector r (world axes) at the time t are
///
///   sum of translations[k] s_k + positions(t) - positions(0),   s_k = sin(2 pi f_k t + p_k) - sin p_k
///   sum of rotations[k] s_k + turns(t) - turns(0)
///
/// so both are 0 at time 0. The pose and its rates are exact at the ends of substeps, with cubics
/// between them.
class MotionLoad final : public LoadDef {
 public:
  std::vector<double> frequencies;    ///< f [Hz], >= 0, one per sine
  std::vector<double> phases;         ///< p [rad], one per sine, or none: 0
  std::vector<Vector3> translations;  ///< [m], one per sine, or none: surge, heave, sway
  std::vector<Vector3> rotations;     ///< [rad], one per sine, or none: roll, yaw, pitch
  std::vector<double> times;          ///< [s], increasing
  std::vector<Vector3> positions;     ///< [m], one per time, or none
  std::vector<Vector3> turns;         ///< rotation vectors [rad], one per time, or none
  Interpolation interpolation = Interpolation::cubic;

  static constexpr std::string_view type_name = "motion";
  static constexpr std::string_view type_meaning =
      "moves a kinematic body in six degrees of freedom: sums of sines, and a table";
  static std::span<const Field> field_table();

  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] bool is_motion() const override { return true; }
  [[nodiscard]] Errors validate(const LoadScope& scope, const std::string& path) const override;
  [[nodiscard]] std::shared_ptr<const ActingLoad> prepare(const LoadScope& scope) const override;
};

}  // namespace sheave
