#pragma once
// A run, frame by frame, in the quantities by which two runs of one scene are compared.
//
//   sheave::measure::Trajectory run = *sheave::measure::record(scene);

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "cable/simulation.h"
#include "engine/result.h"
#include "scenes/scene.h"

namespace sheave {
class BodySet;
}

namespace sheave::measure {

/// Pose of one body at the end of a frame.
struct BodyPose {
  Vector3 position = Vector3::Zero();  ///< of its frame's origin [m], world frame
  Quaternion orientation = Quaternion::Identity();
  double angle = 0.0;  ///< planar bodies and rotors: rotation since time 0 [rad], unwrapped
};

/// The end of one frame (a step of dt), or the start.
struct Frame {
  std::vector<BodyPose> poses;   ///< in the order of Trajectory::bodies
  std::vector<double> tensions;  ///< of the spans that the scene lists, cable by cable [N]
  double energy = 0.0;           ///< kinetic, potential and elastic [J]
  double kinetic_energy = 0.0;   ///< [J]
};

/// A body that is compared: its motion is not a function of time.
struct TrackedBody {
  BodyId id;
  std::string name;
  /// Distance of the body's surface from its origin [m]: a rotation by an angle displaces the
  /// surface by angle x reach. For wheels the radius; for bodies without a shape 0.
  double reach = 0.0;
  bool turns_by_angle =
      false;  ///< planar bodies and rotors: compared by `angle`, not by `orientation`
};

/// A run of a scene from its start.
struct Trajectory {
  double scale = 1.0;  ///< size of the scene [m]: BodySet::scale()
  std::vector<TrackedBody> bodies;
  std::vector<Frame> frames;  ///< [0] is the start
  /// Largest violation of the cables' lengths in any frame: the sum of length - rest length over
  /// the spans of a rigid cable that are too long, relative to that cable's whole length. 0 without
  /// rigid cables.
  double stretch = 0.0;
  double length_error = 0.0;  ///< largest |CableReport::length_error| in any frame
  int most_spans = 0;  ///< largest number of free spans of all cables in any frame, wraps included
  std::int64_t row_solves = 0;
  std::int64_t rounds = 0;  ///< of the direct solver
  /// substeps that fell back to Gauss-Seidel or to `xpbd`, or did not converge
  std::int64_t fallbacks = 0;
  std::optional<Divergence> divergence;  ///< if set, the run ended early

  [[nodiscard]] bool complete() const { return !divergence.has_value(); }
};

/// Both runs with only the bodies that both have, in the order of `other`, by name, and without
/// tensions: for two models of the same machine.
[[nodiscard]] std::array<Trajectory, 2> with_common_bodies(const Trajectory& run,
                                                           const Trajectory& other);

/// The compared bodies of a scene, in the order of the model.
[[nodiscard]] std::vector<TrackedBody> tracked_bodies(const BodySet& bodies);
/// Poses, tensions and energies at this moment.
[[nodiscard]] Frame frame_of(const Simulation& simulation, const std::vector<TrackedBody>& bodies);

/// Called after each frame with the number of frames done and their total; false ends the run,
/// which then gives no trajectory.
using FrameObserver = std::function<bool(std::int64_t done, std::int64_t of)>;

/// Number of frames from the start of a scene to its duration, rounded to the nearest, at least 1.
[[nodiscard]] std::int64_t frame_count(const Scene& scene);

/// Runs the scene with its own settings to its duration. An error if it does not build, or if the
/// observer or, within a step, `stop` ended it (then with an empty path and the message
/// "interrupted"). Divergence is not an error.
[[nodiscard]] Result<Trajectory> record(const Scene& scene, const FrameObserver& observe = {},
                                        const StopRequest& stop = {});

}  // namespace sheave::measure
