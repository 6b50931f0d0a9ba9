#pragma once
// The error of a run: how far it is from another run of the same scene that is taken for the truth.
//
// A body's displacement from where it should be is the distance of its origin together with what
// its surface has turned too far, d^2 = |x - x_ref|^2 + (reach x angle)^2, so that a wheel at the
// wrong angle counts as the cable on it does. The position error of a frame is the root of the mean
// of d^2 over all bodies that move otherwise than as a function of time, relative to the size of
// the scene (BodySet::scale(), the diagonal of the box round its bodies); that of a run is the
// largest of all its frames. It is thus zero only if every body is right at every time, and a
// relative error of 1e-3 means that bodies are off by a thousandth of the picture's size.
//
// A body that a solver pulls too little in the first frames stays behind for the rest of the run,
// so late frames remember what early ones did wrong; no averaging over time hides that.

#include <vector>

#include "measure/trajectory.h"

namespace sheave::measure {

/// All relative, >= 0; infinite for a run that is not complete, NaN nowhere.
struct RunError {
  double position = 0.0;      ///< largest of all frames, as above
  double position_end = 0.0;  ///< at the end
  /// Root of the mean square of (tension - tension of the reference) over all spans and frames
  /// after time 0, relative to the same mean of the reference's tensions. Impacts have tensions
  /// that grow as the step shrinks: there it does not converge, which the reference's own error
  /// tells. 0 without cables.
  double tension = 0.0;
  /// Largest |energy - energy of the reference| of all frames, relative to the largest change of
  /// energy or kinetic energy in the reference: what damping of the integrator costs, whatever
  /// drives do. 0 if nothing in the reference ever moves.
  double energy = 0.0;
};

/// How far a body is from another place.
struct PoseDifference {
  Vector3 position = Vector3::Zero();  ///< [m]
  Vector3 turn =
      Vector3::Zero();  ///< rotation vector [rad]; compared by angles: along z, with all turns
};
[[nodiscard]] PoseDifference pose_difference(const BodyPose& pose, const BodyPose& from,
                                             bool by_angle);

/// Compares frame by frame; both runs must be of one scene and have frames at the same times.
[[nodiscard]] RunError error_of(const Trajectory& run, const Trajectory& reference);

/// How far the bodies of a run get from where they started: the same measure of all its frames
/// against that of time 0, largest of all. An error relative to the scene's size, divided by this,
/// is one relative to the motion; where a large machine moves a little, the first says little.
[[nodiscard]] double motion_of(const Trajectory& run);

/// Of each frame its position error, for fits of how errors grow.
[[nodiscard]] std::vector<double> position_errors(const Trajectory& run,
                                                  const Trajectory& reference);

}  // namespace sheave::measure
