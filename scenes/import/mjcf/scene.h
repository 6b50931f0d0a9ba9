#pragma once
// Writes a Model as the JSON of a scene. One file per kind of part.

#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include <nlohmann/json.hpp>

#include "scenes/import/log.h"
#include "scenes/import/mjcf/pose.h"

namespace sheave::import::mjcf {

using Json = nlohmann::ordered_json;

/// Names that a scene allows, each once.
class Names {
 public:
  /// The name nearest to `wanted`, or to `otherwise` if that is empty.
  [[nodiscard]] std::string take(const std::string& wanted, const std::string& otherwise);

 private:
  std::set<std::string> taken_{"world"};
  std::unordered_map<std::string, int> last_;  // number of each name that was wanted again
};

/// The drive of a coordinate that an actuator asks for.
struct Drive {
  bool to_position = false;  ///< else a force
  double value = 0.0;        ///< target in the joint's own coordinate, or force
  double compliance = 0.0;   ///< of a drive to a position
  double damping = 0.0;      ///< in addition to the joint's
  std::optional<double> limit;
};

/// A coordinate of the scene that is one of the model, times `sense`, counted from the start.
struct SceneCoordinate {
  std::string joint;
  std::string name;
  double sense = 1.0;
};

/// The body of the scene of which a body of the model is a part.
struct Carrier {
  int body = 0;  ///< number in the model; 0: the world
  Frame frame;   ///< of the part in the carrier
  bool moves = false;
};

/// The scene being written, and the model at its start; the writers of all parts share it.
struct Writer {
  const Model& model;
  Log& log;
  Pose reference;  ///< in the coordinates of the text
  Pose start;      ///< at time 0
  std::vector<double> velocities;
  std::vector<double> controls;         ///< one per actuator
  std::vector<double> activations;      ///< one per actuator; 0 of one without
  std::vector<Carrier> carriers;        ///< one per body of the model
  std::vector<Inertial> inertials;      ///< of carriers with all their parts, in their frames
  std::vector<std::string> body_names;  ///< in the scene, one per body of the model
  std::vector<std::vector<int>> geoms;  ///< of each carrier with all its parts
  std::vector<int> shapes;              ///< index of each geom's shape in its carrier; -1: none
  std::vector<std::optional<Drive>> drives;         ///< one per joint
  std::vector<std::optional<Drive>> tendon_drives;  ///< one per tendon; only of fixed ones
  /// One per joint; none for balls, free joints and slides of a plane.
  std::vector<std::optional<SceneCoordinate>> coordinates;
  Json scene;
  Names load_names{};

  /// The frame of a carrier at time 0.
  [[nodiscard]] const Frame& at_start(int body) const {
    return start.bodies[static_cast<std::size_t>(body)].frame;
  }
};

/// Sets carriers, names and masses.
void merge_bodies(Writer& writer);
void write_bodies(Writer& writer);
/// Turns actuators on joints and on fixed tendons into drives.
void find_drives(Writer& writer);
void write_joints(Writer& writer);
void write_equalities(Writer& writer);
/// Writes fixed tendons, equalities of joints and armatures as couplings of joints.
void write_couplings(Writer& writer);
/// Whether the armature of a joint is part of its body's inertia, because its axis stands still.
[[nodiscard]] bool is_armature_of_body(const Writer& writer, const Joint& joint);
void write_cables(Writer& writer);
/// Writes actuator `number`, a muscle, along a cable of the length of its tendon times `divisor`.
void write_muscle(Writer& writer, const Actuator& actuator, std::size_t number,
                  const std::string& cable, double divisor);

/// The scene of a model in a keyframe; check log.failed().
[[nodiscard]] Json scene_of(Model model, const Options& options, const std::string& file_name,
                            Log& log);

[[nodiscard]] Json json_of(const Vector3& vector);
[[nodiscard]] Json json_of(const Quaternion& orientation);

}  // namespace sheave::import::mjcf
