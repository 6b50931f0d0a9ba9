#pragma once
// What a run did, frame by frame, in the quantities by which two runs of one scene are compared.
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

/// Where one body is at the end of a frame.
struct BodyPose {
  Vector3 position = Vector3::Zero();  ///< of its frame's origin [m], world frame
  Quaternion orientation = Quaternion::Identity();
  double angle = 0.0;  ///< planar bodies and rotors: turned since time 0 [rad], unwrapped
};

/// The end of one frame (a step of dt), or time 0.
struct Frame {
  std::vector<BodyPose> poses;   ///< in the order of Trajectory::bodies
  std::vector<double> tensions;  ///< of the spans that the scene lists, cable by cable [N]
  double energy = 0.0;           ///< kinetic, potential and elastic [J]
  double kinetic_energy = 0.0;   ///< [J]
};

/// A body that is compared: one that moves otherwise than as a function of time.
struct TrackedBody {
  BodyId id;
  std::string name;
  /// How far from the body's origin its surface reaches [m]: what turns by an angle is displaced by
  /// angle x reach. Of wheels their radius; of bodies without a shape 0.
  double reach = 0.0;
  bool turns_by_angle =
      false;  ///< planar bodies and rotors: compared by `angle`, not by `orientation`
};

/// A run of a scene from time 0.
struct Trajectory {
  double scale = 1.0;  ///< size of the scene [m]: BodySet::scale()
  std::vector<TrackedBody> bodies;
  std::vector<Frame> frames;  ///< [0] is time 0
  /// Largest violation of the cables' lengths in any frame: the sum of what each span of a rigid
  /// cable is longer than its rest length, relative to that cable's whole length. 0 if there is no
  /// rigid cable.
  double stretch = 0.0;
  double length_error = 0.0;  ///< largest |CableReport::length_error| in any frame
  int most_spans =
      0;  ///< free spans of all cables, wraps among them, in the frame that has the most
  std::int64_t row_solves = 0;
  std::int64_t rounds = 0;     ///< of the direct solver
  std::int64_t fallbacks = 0;  ///< substeps left to Gauss-Seidel or to `xpbd`, or not converged
  std::optional<Divergence> divergence;  ///< if set, the frames end early

  [[nodiscard]] bool complete() const { return !divergence.has_value(); }
};

/// The same run with only the bodies that `other` has too, in that order, by their names, and
/// without tensions: for scenes that are the same machine modelled in two ways. Bodies of the other
/// that it lacks are dropped from both.
[[nodiscard]] std::array<Trajectory, 2> with_common_bodies(const Trajectory& run,
                                                           const Trajectory& other);

/// The bodies of a scene that are compared, in the order of the model.
[[nodiscard]] std::vector<TrackedBody> tracked_bodies(const BodySet& bodies);
/// What those bodies and all cables do at this moment.
[[nodiscard]] Frame frame_of(const Simulation& simulation, const std::vector<TrackedBody>& bodies);

/// Called after each frame with the frames done and their number; false ends the run, which is then
/// no trajectory.
using FrameObserver = std::function<bool(std::int64_t done, std::int64_t of)>;

/// Frames in the duration of a scene, rounded to the nearest, at least 1.
[[nodiscard]] std::int64_t frame_count(const Scene& scene);

/// Runs the scene with its own settings to its duration. An error if it does not build, or if the
/// observer or, within a step, `stop` ended it (then with an empty path and the message
/// "interrupted"). A run that diverges is no error.
[[nodiscard]] Result<Trajectory> record(const Scene& scene, const FrameObserver& observe = {},
                                        const StopRequest& stop = {});

}  // namespace sheave::measure
