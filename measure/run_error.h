#pragma once
// The error of a run: its distance from another run of the same scene that serves as reference.
//
// A body's displacement from its reference combines the distance of its origin with the path of its
// surface due to a wrong rotation, d^2 = |x - x_ref|^2 + (reach x angle)^2, so a wheel at the wrong
// angle counts as much as the cable on it. The position error of a frame is the root mean square of
// d over all bodies whose motion is not a function of time, relative to the size of the scene
// (BodySet::scale(), the diagonal of the box round its bodies). The position error of a run is the
// largest of all its frames, and zero only if every body is right at every time. A relative error of
// 1e-3 means that bodies are off by a thousandth of the picture's size.
//
// A body that gets too little force in the first frames stays behind for the rest of the run, so
// late frames show the errors of early ones; no averaging over time hides them.

#include <vector>

#include "measure/trajectory.h"

namespace sheave::measure {

/// All errors are relative, >= 0, infinite for an incomplete run, and never NaN.
struct RunError {
  double position = 0.0;      ///< largest of all frames, as above
  double position_end = 0.0;  ///< at the end
  /// Root mean square of (tension - tension of the reference) over all spans and frames after time
  /// 0, relative to the root mean square of the reference's tensions. Impacts have tensions that
  /// grow as the step shrinks; in such scenes this error does not converge, which the reference's
  /// own error shows. 0 without cables.
  double tension = 0.0;
  /// Largest |energy - energy of the reference| of all frames, relative to the largest change of
  /// energy or kinetic energy in the reference: the cost of the integrator's damping, independent
  /// of drives. 0 if nothing in the reference moves.
  double energy = 0.0;
};

/// Difference between two poses of a body.
struct PoseDifference {
  Vector3 position = Vector3::Zero();  ///< [m]
  /// rotation vector [rad]; for bodies compared by angle along z, with all turns
  Vector3 turn = Vector3::Zero();
};
[[nodiscard]] PoseDifference pose_difference(const BodyPose& pose, const BodyPose& from,
                                             bool by_angle);

/// Compares frame by frame. Both runs must be of one scene with frames at the same times.
[[nodiscard]] RunError error_of(const Trajectory& run, const Trajectory& reference);

/// Largest displacement of the bodies of a run from their start, in the same measure: all frames
/// against that of time 0. An error relative to the scene's size, divided by this, is relative to
/// the motion; that says more about a large machine that moves a little.
[[nodiscard]] double motion_of(const Trajectory& run);

/// Position error of each frame, for fits of the growth of errors.
[[nodiscard]] std::vector<double> position_errors(const Trajectory& run,
                                                  const Trajectory& reference);

}  // namespace sheave::measure
