#pragma once

#include "scenes/control/load.h"
#include "scenes/control/muscle_curves.h"

namespace sheave {

/// The fibres of a muscle at one moment.
struct MuscleFibre {
  double length = 0.0;    ///< L, in optimal lengths
  double velocity = 0.0;  ///< V, in fastest speeds; above 0 while the muscle lengthens
};

/// A muscle along the path of a cable: it pulls the bodies at the ends and bends of the path
/// together (scenes/control/muscle_curves.h). With the cable's length l and its rate l',
///
///   L = (l - tendon_length) / optimal_length,   V = l' / (optimal_length max_speed).
///
/// The cable gives the path alone; its own tension, if it has one, acts beside the muscle. Over a
/// substep the muscle has the force and the directions of its middle, extrapolated from the last
/// two substeps, so the error is of second order.
class MuscleLoad final : public LoadDef, public MuscleCurves, public MuscleActivation {
 public:
  std::string cable;                ///< name of the cable along which the muscle lies
  double force = 0.0;               ///< peak active force [N], > 0
  double optimal_length = 0.0;      ///< of the fibres, where they have that force [m], > 0
  double tendon_length = 0.0;       ///< part of the path that is rigid tendon [m]
  double max_speed = 1.5;           ///< fastest shortening [optimal lengths per s], > 0
  double activation = 0.0;          ///< at time 0, 0 ... 1
  std::vector<double> times;        ///< [s], increasing; as many as values, or none for a constant
  std::vector<double> excitations;  ///< 0 ... 1; none: 0
  Interpolation interpolation = Interpolation::linear;

  static constexpr std::string_view type_name = "muscle";
  static constexpr std::string_view type_meaning =
      "a muscle along a cable: force by length, velocity and activation";
  static std::span<const Field> field_table();

  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] bool is_muscle() const override { return true; }
  [[nodiscard]] std::vector<int> bodies(const LoadScope& scope) const override;
  [[nodiscard]] Errors validate(const LoadScope& scope, const std::string& path) const override;
  [[nodiscard]] std::shared_ptr<const ActingLoad> prepare(const LoadScope& scope) const override;
  /// The fibres in the present state; `cables` are the reports of it. Nothing if the cable of the
  /// muscle is cut or is not among them.
  [[nodiscard]] std::optional<MuscleFibre> fibre(const World& world,
                                                 std::span<const CableReport> cables) const;

 private:
  void check_cable(const LoadScope& scope, const std::string& path, Errors& errors) const;
};

}  // namespace sheave
