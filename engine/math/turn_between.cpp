#include "engine/math/turn_between.h"

namespace sheave {

Quaternion turn_between(const Vector3& from, const Vector3& to) {
  return Quaternion::FromTwoVectors(from, to);
}

}  // namespace sheave
