#pragma once
// The camera of a film: it rests at each keyframe and moves smoothly from one to the next.
//
// Between two keyframes at times a and b, with s = 3 u^2 - 2 u^3 and u = (t - a) / (b - a):
// the target moves along a straight line, its distance from the eye and the height or the tangent
// of half the opening angle change by equal ratios, and the axes of the picture turn about one
// fixed axis (slerp). So a camera that turns round a target keeps its distance.

#include <utility>
#include <vector>

#include "render/camera.h"

namespace sheave::render {

struct CameraKey {
  double time = 0.0;  ///< [s]
  Camera camera;      ///< valid; the same kind of projection at all keyframes
};

class CameraPath {
 public:
  /// At least one keyframe, in the order of increasing times.
  explicit CameraPath(std::vector<CameraKey> keys) : keys_(std::move(keys)) {}

  static CameraPath standing(const Camera& camera) {
    return CameraPath(std::vector<CameraKey>{{0.0, camera}});
  }

  /// The first keyframe before its time, the last one after its time.
  [[nodiscard]] Camera at(double time) const;
  [[nodiscard]] const std::vector<CameraKey>& keys() const { return keys_; }

 private:
  std::vector<CameraKey> keys_;
};

}  // namespace sheave::render
