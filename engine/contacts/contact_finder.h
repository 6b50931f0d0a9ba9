#pragma once
// The colliders of a model, and the points at which they touch.

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/contacts/broad_phase.h"
#include "engine/contacts/manifold.h"
#include "engine/substep.h"

namespace sheave {

struct Model;

/// One shape of a collider.
struct ContactForm {
  int body = 0;
  int collider = 0;              ///< index into Model::colliders
  const Shape* shape = nullptr;  ///< identifies the form in all worlds that have it
  ConvexSolid solid;
  Vector3 position = Vector3::Zero();  ///< of the shape's origin, the body's own frame [m]
  Quaternion orientation = Quaternion::Identity();  ///< shape frame to own frame
  /// Radius of the ball about the shape's origin that contains it [m]; infinite for a half-space
  double radius = 0.0;
  /// Largest lever [m] with which a rotation of the body moves the form's surface outwards
  double turning_arm = 0.0;
  /// Edge length of the smallest cube that contains the form [m]; 0 for a half-space
  double spread = 0.0;
};

/// The combined settings of a pair of colliders.
struct ContactMaterial {
  double friction = 0.0;
  double static_friction = 0.0;
  double restitution = 0.0;
  double compliance = 0.0;     ///< [m/N]
  double damping_ratio = 0.0;  ///< of a compliant contact; 1 is critical
};

/// The damping ratio of a spring that never pulls and returns a mass with `restitution` times its
/// speed of arrival; at most 1 (engine/contacts/contact.cpp).
[[nodiscard]] double damping_ratio_of(double restitution);

/// Two forms with a manifold between them. `b` is the form with the larger index, or a half-space.
struct FormPair {
  int a = 0;
  int b = 0;
};

class ContactFinder {
 public:
  ContactFinder(const Model& model, const BodySet& bodies);

  /// Calls `use(pair, manifold)` for each pair of forms that touch or may touch within the substep,
  /// in ascending order of the pairs, until `use` returns false. `substep` must be at its start.
  /// Points may be apart by as much as the motion of the substep can close.
  template <class Use>
  void find(const Substep& substep, const Use& use) {
    place(substep);
    for (const auto& [i, j] : broad_phase_.find(bounds_)) {
      FormPair pair{i, j};
      if (!may_touch(pair)) continue;
      if (forms_[at(i)].solid.kind == ConvexSolid::Kind::half_space) std::swap(pair.a, pair.b);
      const double margin = margins_[at(i)] + margins_[at(j)];
      find_contacts(placed_[at(pair.a)], placed_[at(pair.b)], margin, manifold_,
                    motion(substep, pair.a), motion(substep, pair.b));
      if (!manifold_.points.empty() && !use(pair, manifold_)) return;
    }
  }

  [[nodiscard]] std::span<const ContactForm> forms() const { return forms_; }
  [[nodiscard]] const ContactMaterial& material(const FormPair& pair) const;
  /// Whether a pair of forms has compliant contacts.
  [[nodiscard]] bool is_compliant() const {
    return std::any_of(materials_.begin(), materials_.end(),
                       [](const ContactMaterial& pair) { return pair.compliance > 0.0; });
  }
  /// Size of the smaller of the two forms [m]; a half-space has no size.
  [[nodiscard]] double smaller_spread(const FormPair& pair) const {
    const double size = forms_[at(pair.a)].spread;
    const double other = forms_[at(pair.b)].spread;
    return other > 0.0 ? std::min(size, other) : size;
  }
  /// Acceleration [m/s2] of a body without constraints, by gravity and its constant force.
  [[nodiscard]] const Vector3& free_acceleration(int body) const {
    return accelerations_[at(body)];
  }

 private:
  void add_forms(const Model& model, const BodySet& bodies);
  void exclude_pairs(const Model& model, const BodySet& bodies);
  void combine_materials(const Model& model);
  void place(const Substep& substep);
  /// The motion of a form in the substep, if its body keeps its velocities of the start.
  [[nodiscard]] SolidMotion motion(const Substep& substep, int form) const;
  [[nodiscard]] bool may_touch(const FormPair& pair) const;
  [[nodiscard]] std::size_t pair_of_colliders(int a, int b) const {
    return at(forms_[at(a)].collider) * collider_count_ + at(forms_[at(b)].collider);
  }

  std::size_t collider_count_ = 0;
  std::vector<ContactForm> forms_;
  std::vector<char> apart_;  // per pair of colliders: whether they never touch
  std::vector<ContactMaterial> materials_;
  // Scratch.
  std::vector<Vector3> accelerations_;  // per body
  std::vector<PlacedSolid> placed_;
  std::vector<double> margins_;
  std::vector<Bounds> bounds_;
  BroadPhase broad_phase_;
  Manifold manifold_;
};

}  // namespace sheave
