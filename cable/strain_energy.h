#pragma once
// The energy of strained cable as its stored pieces count it; internal to the cable library.

#include "cable/tension_law.h"

namespace sheave {

/// Twice the energy per unstretched length over EA, u(e): the square of the strain. With a table of
/// tensions EA is the scale of the law.
class StrainEnergy {
 public:
  /// Of a constant EA.
  StrainEnergy() = default;
  /// `yield`: 1 / scale of the law [1/N].
  StrainEnergy(const TensionLaw& law, double yield) : law_(&law), twice_yield_(2.0 * yield) {}

  [[nodiscard]] double of(double strain) const {
    return law_ == nullptr ? strain * strain : twice_yield_ * law_->energy(strain);
  }
  /// u'(e)
  [[nodiscard]] double slope(double strain) const {
    return law_ == nullptr ? 2.0 * strain : twice_yield_ * law_->tension(strain);
  }
  /// u''(e)
  [[nodiscard]] double curve(double strain) const {
    return law_ == nullptr ? 2.0 : twice_yield_ * law_->stiffness(strain);
  }

 private:
  const TensionLaw* law_ = nullptr;
  double twice_yield_ = 0.0;
};

}  // namespace sheave
