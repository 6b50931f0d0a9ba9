#pragma once
// Change of energy by bounces in a substep.

#include <array>
#include <vector>

#include "cable/certificate/evidence.h"

namespace sheave::certify {

/// Whether the contact has a restitution. Elastic contacts rebound without one.
[[nodiscard]] bool bounces(const ContactEvidence& contact);

/// Energy that impacts have added, and energy that passed through them [J].
struct Bounced {
  double energy = 0.0;
  double flow = 0.0;
};

/// Sums over all contacts of a substep in which some bounce. The impulses of all contacts of a body
/// act together.
class BounceCheck {
 public:
  explicit BounceCheck(const Evidence& evidence);
  /// Zero if no contact bounces.
  [[nodiscard]] Bounced sum() const;

 private:
  /// Change of a body's velocities by all contacts, and a basis of its contact normals.
  struct Change {
    Vector3 linear = Vector3::Zero();
    Vector3 angular = Vector3::Zero();
    std::array<Vector3, 3> normals;
    int normal_count = 0;
  };
  /// The body itself, or the carrier of a mounted rotor.
  [[nodiscard]] int leader(int body) const;
  void push(int body, const Vector3& point, const Vector3& impulse);
  void span(int body, const Vector3& normal);
  /// Turns the sum of impulses into changes of velocities.
  void yield(int body);
  /// The velocity that a point would have without contact impulses.
  [[nodiscard]] Vector3 without(int body, const Vector3& point) const;
  [[nodiscard]] Vector3 acceleration(int body) const;
  [[nodiscard]] double fallen_beside(int body, bool means) const;

  const Evidence& e_;
  std::vector<Change> changes_;  // empty: no contact bounces
};

}  // namespace sheave::certify
