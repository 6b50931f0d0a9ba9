#pragma once
// Ropes whose tension depends on how they were stretched before, computed independently of the solvers
// and of cable/rope_memory.h: by quadrature along the way that the strain has taken.

#include <optional>
#include <vector>

#include "cable/certificate/rope_law.h"

namespace sheave::certify {

/// The law of a rope that yields, or that is let off on another curve, as the documentation defines it.
class MemoryLaw {
 public:
  /// `cable` has_memory().
  explicit MemoryLaw(const CableDef& cable);

  /// The remembered strain after the rope has come to `strain` on one way.
  [[nodiscard]] double after(double strain, double remembered) const;
  /// Strain at which the rope becomes slack.
  [[nodiscard]] double slack(double remembered) const { return unloading_ ? 0.0 : remembered; }
  /// Tension there, by `remembered` before the way [N].
  [[nodiscard]] double tension(double strain, double remembered) const;
  /// Work of the tension on the way between two strains, per unstretched length [N].
  [[nodiscard]] double work(double from, double to, double remembered) const;
  /// Stored energy per unstretched length [N].
  [[nodiscard]] double stored(double strain, double remembered) const;
  /// Least stiffness near a strain [N].
  [[nodiscard]] double stiffness(double strain) const;

 private:
  RopeLaw loading_;
  std::optional<RopeLaw> unloading_;
  std::vector<double> strains_;  ///< of the table
  double slope_ = 0.0;           ///< of the unloading line [N]
  double width_ = 0.0;           ///< transition strain
};

}  // namespace sheave::certify
