#include "engine/joints/anchor.h"

namespace sheave {

Quaternion frame_along(const Vector3& axis) {
  return Quaternion(Quaternion::FromTwoVectors(Vector3::UnitZ(), axis.normalized()));
}

}  // namespace sheave
