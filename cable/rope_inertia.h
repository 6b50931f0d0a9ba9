#pragma once
// Ropes with axial inertia: the feature "rope inertia" of a world. The derivation is in
// cable/rope_inertia.cpp.

#include <array>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cable/cable_system.h"

namespace sheave {

/// Kinetic energy of the ropes with CableDef::axial_inertia, as a sum of m (g v)^2 / 2 over rows with
/// the gradient g. Each row acts on bodies with the force -m d(g v)/dt. No motion depends on the
/// feature's own state, which keeps the forces of the last substep for reports: one real per row [N;
/// N m for the rotation of a wheel].
class RopeInertia final : public ConstraintBatch {
 public:
  static constexpr std::string_view feature_name = "rope inertia";
  static constexpr int rows_per_span = 6;   ///< mean and difference of its ends' velocities
  static constexpr int rows_per_wheel = 4;  ///< velocity of its rope's centre of mass, and rotation

  /// The feature for these cables, which must outlive it; null if no rope has inertia.
  [[nodiscard]] static std::unique_ptr<RopeInertia> create(const CableSystem& cables);

  /// A row of the kinetic energy in one pose.
  struct Element {
    Row row;            ///< only its gradient g
    double mass = 0.0;  ///< m [kg; kg m2 for the rotation of a wheel]
    /// The part of g whose turning is an acceleration of the rope.
    Row frame;
    /// Of a wheel: from its centre to the centre of mass of its rope, along the row [m].
    double arm = 0.0;
  };
  /// All rows of the kinetic energy in the present pose of `now`; `own` is the state of the cables
  /// there.
  [[nodiscard]] std::vector<Element> elements(const Substep& now, const FeatureState& own) const;
  /// Forces of the rope's inertia on both ends of a span, counted over all cables, in the mean over
  /// the last substep [N]. Zero for ropes without inertia.
  [[nodiscard]] static std::array<Vector3, 2> end_forces(const CableSystem& cables,
                                                         const State& state, int span);

  [[nodiscard]] std::string_view name() const override { return feature_name; }
  [[nodiscard]] FeatureState initial_state() const override;
  void adopt(const ConstraintBatch& before, const FeatureState& from,
             FeatureState& own) const override;
  [[nodiscard]] int row_count() const override { return static_cast<int>(multipliers_.size()); }
  void begin(const Substep& substep, const FeatureState& state) override;
  double sweep(Substep& substep) override;
  void linearise(Substep& substep, RowList& rows) override;
  [[nodiscard]] bool has_all_rows() const override { return true; }
  [[nodiscard]] bool is_stiff() const override { return true; }
  [[nodiscard]] std::span<double> multipliers() override { return multipliers_; }
  void finish(Substep& substep, FeatureState& next) override;
  /// A feature for the same cables, of which it reads definitions only.
  [[nodiscard]] std::unique_ptr<ConstraintBatch> copy() const override;
  [[nodiscard]] std::string dead_end(const Substep& substep) const override;
  [[nodiscard]] double elastic_energy(const BodySet&, const State&,
                                      const FeatureState&) const override {
    return 0.0;
  }
  [[nodiscard]] double kinetic_energy(const BodySet& bodies, const State& state) const override;

 private:
  explicit RopeInertia(const CableSystem& cables) : cables_(cables) {}
  RopeInertia(const RopeInertia&) = default;
  struct Wheel {
    int link = 0;
    int before = -1;  ///< place in spans_ of the span that ends there; -1: none
    int after = -1;   ///< of the span that begins there; -1: none
  };
  struct Course {
    std::vector<LinkGeometry> links;  ///< of all cables
    std::vector<SpanSetup> spans;     ///< of all cables
  };
  /// A span in one pose.
  struct Span {
    SpanGeometry geometry;
    double rest_length = 0.0;        ///< [m]
    std::array<double, 2> gained{};  ///< rest length gained at its ends since the start [m]
  };
  struct Pose {
    std::vector<Span> spans;
    std::vector<Element> elements;
  };
  [[nodiscard]] Course course_of(const Substep& substep, const FeatureState& own) const;
  /// Finds the spans and rows in the present pose. `moved`: counted from the start of the substep.
  void find_pose(const Substep& substep, const Course& course, const FeatureState& own, bool moved,
                 Pose& pose) const;
  void find_span(const Substep& substep, const Course& course, const FeatureState& own, bool moved,
                 std::size_t place, Pose& pose) const;
  void find_wheel(const Substep& substep, const Course& course, const FeatureState& own,
                  std::size_t place, Pose& pose) const;
  [[nodiscard]] std::array<double, 2> gained(const FeatureState& own, std::size_t place,
                                             const SpanTransport& arcs) const;
  void find_motion(const Substep& substep);
  void fill_row(const Substep& substep, std::size_t index, Row& row) const;
  /// Index of the first row of a wheel.
  [[nodiscard]] std::size_t wheel_row(std::size_t place) const {
    return static_cast<std::size_t>(rows_per_span) * spans_.size() +
           static_cast<std::size_t>(rows_per_wheel) * place;
  }

  const CableSystem& cables_;
  std::vector<int> spans_;  ///< spans with inertia, among those of all cables
  std::vector<Wheel> wheels_;
  std::vector<double> multipliers_;
  // Scratch of a substep.
  bool at_rest_ = false;
  const FeatureState* cable_state_ = nullptr;  ///< at the start of the substep
  Course course_;
  std::vector<SpanReference> references_;  ///< per span with inertia
  std::vector<double> strains_;            ///< the same, at the start
  Pose start_;
  Pose now_;
  std::vector<double> accelerations_;  ///< per row: those that its gradient does not tell [m/s2]
};

}  // namespace sheave
