#pragma once
// What bounces make of the energy of a substep.

#include <array>
#include <vector>

#include "cable/certificate/evidence.h"

namespace sheave::certify {

/// Whether bodies rebound there. Elastic contacts do by themselves.
[[nodiscard]] bool bounces(const ContactEvidence& contact);

/// Energy that impacts have added, and what passed through them [J].
struct Bounced {
  double energy = 0.0;
  double flow = 0.0;
};

/// The account of all contacts of a substep in which some bounce: each body meets all of its own at
/// once.
class BounceCheck {
 public:
  explicit BounceCheck(const Evidence& evidence);
  /// Nothing if no contact bounces.
  [[nodiscard]] Bounced sum() const;

 private:
  /// Of a body's velocities by all contacts; and what its normals span.
  struct Change {
    Vector3 linear = Vector3::Zero();
    Vector3 angular = Vector3::Zero();
    std::array<Vector3, 3> normals;
    int normal_count = 0;
  };
  /// The body itself, or the one that carries it.
  [[nodiscard]] int leader(int body) const;
  void push(int body, const Vector3& point, const Vector3& impulse);
  void span(int body, const Vector3& normal);
  /// Makes impulses changes of velocities.
  void yield(int body);
  /// The velocity that a point would have without contacts.
  [[nodiscard]] Vector3 without(int body, const Vector3& point) const;
  [[nodiscard]] Vector3 acceleration(int body) const;
  [[nodiscard]] double fallen_beside(int body, bool means) const;

  const Evidence& e_;
  std::vector<Change> changes_;  // empty: nothing bounces
};

}  // namespace sheave::certify
