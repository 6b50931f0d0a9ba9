#pragma once
// The record of a point of contact in a state.

#include "engine/contacts/contact.h"
#include "engine/state.h"

namespace sheave {

struct ContactRecord {
  static constexpr std::size_t integers = 3;
  static constexpr std::size_t reals = 20;

  FormPair forms;
  bool sticks = false;
  Vector3 own_a = Vector3::Zero();  ///< core points, own frames [m]
  Vector3 own_b = Vector3::Zero();
  Vector3 normal = Vector3::UnitY();
  Vector3 point = Vector3::Zero();     ///< on the surface of A [m]
  Vector3 slipped = Vector3::Zero();   ///< Contact::slipped [m]
  Vector3 friction = Vector3::Zero();  ///< force on A [N]
  double force = 0.0;                  ///< along the normal [N]
  double gap = 0.0;                    ///< [m]
};

[[nodiscard]] inline std::size_t contact_count(const FeatureState& state) {
  return state.integers.size() / ContactRecord::integers;
}

[[nodiscard]] inline ContactRecord read_contact(const FeatureState& state, std::size_t index) {
  const std::int64_t* i = state.integers.data() + index * ContactRecord::integers;
  const double* r = state.reals.data() + index * ContactRecord::reals;
  const auto vector = [&](std::size_t k) { return Vector3(r[k], r[k + 1], r[k + 2]); };
  return {{static_cast<int>(i[0]), static_cast<int>(i[1])},
          i[2] != 0,
          vector(0),
          vector(3),
          vector(6),
          vector(9),
          vector(12),
          vector(15),
          r[18],
          r[19]};
}

inline void append_contact(const ContactRecord& record, FeatureState& state) {
  state.integers.push_back(record.forms.a);
  state.integers.push_back(record.forms.b);
  state.integers.push_back(record.sticks ? 1 : 0);
  for (const Vector3* v : {&record.own_a, &record.own_b, &record.normal, &record.point,
                           &record.slipped, &record.friction}) {
    state.reals.insert(state.reals.end(), v->data(), v->data() + 3);
  }
  state.reals.push_back(record.force);
  state.reals.push_back(record.gap);
}

}  // namespace sheave
