#pragma once
// The content of a model in MJCF (MuJoCo's format) as far as a scene can have it. All numbers are
// SI, angles in radians.

#include <array>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "engine/vector.h"
#include "scenes/import/mesh_file.h"
#include "scenes/import/xml.h"

namespace sheave::import::mjcf {

/// A turn by an angle [rad] about a direction of any length but 0.
[[nodiscard]] Quaternion turn_about(const Vector3& axis, double angle);
/// The smallest turn from z to the direction, of any length but 0.
[[nodiscard]] Quaternion from_z_axis(const Vector3& direction);

/// A frame in another one.
struct Frame {
  Vector3 position = Vector3::Zero();               ///< [m]
  Quaternion orientation = Quaternion::Identity();  ///< own frame to outer frame

  [[nodiscard]] Vector3 point(const Vector3& own) const { return position + orientation * own; }
  [[nodiscard]] Frame operator*(const Frame& inner) const {
    return {point(inner.position), orientation * inner.orientation};
  }
};

/// Mass, centre of mass and inertia tensor about it, in one frame.
struct Inertial {
  double mass = 0.0;                  ///< [kg]
  Vector3 center = Vector3::Zero();   ///< [m]
  Matrix3 inertia = Matrix3::Zero();  ///< about the centre, axes of the frame [kg m2]

  /// Adds another part, given in the same frame.
  void add(const Inertial& part);
  /// The same in the frame in which `frame` is given.
  [[nodiscard]] Inertial seen_from(const Frame& frame) const;
};

/// How masses follow from geoms.
enum class FromGeoms { never, always, unless_given };

/// <compiler><lengthrange>: how MuJoCo finds the lengthrange of muscles.
struct LengthRangeSettings {
  bool enabled = true;         ///< mode is not none
  bool keeps_given = true;     ///< useexisting
  bool uses_limits = false;    ///< uselimit
  double acceleration = 20.0;  ///< norm of the accelerations [rad/s2 and m/s2], > 0
  double most_force = 0.0;     ///< maxforce: norm of the forces; 0: no bound
  double time_constant = 1.0;  ///< of the decay of velocities [s], > 0
  double step = 0.01;          ///< [s], > 0
  double total_time = 10.0;    ///< [s]
  double interval = 2.0;       ///< at the end, in which lengths count [s], 0 ... total_time
  double tolerance = 0.05;     ///< of lengths in that interval, over the range
};

/// <compiler>.
struct Compiler {
  bool degrees = true;
  std::string euler_sequence = "xyz";
  bool auto_limits = true;
  FromGeoms from_geoms = FromGeoms::unless_given;
  std::array<double, 2> groups{0.0, 5.0};  ///< of geoms that have mass, first and last
  double least_mass = 0.0;                 ///< of bodies that move [kg]
  double least_inertia = 0.0;              ///< principal, of bodies that move [kg m2]
  bool balances = false;  ///< replaces moments that violate the triangle inequality
  LengthRangeSettings length_range;
  std::string mesh_folder;   ///< meshdir or assetdir; empty: that of the model
  bool strip_paths = false;  ///< files are named without their folders
  double total_mass = -1.0;  ///< [kg]; all masses are scaled to it; <= 0: they are not
};

/// <option>, with its flags.
struct Option {
  Vector3 gravity{0.0, 0.0, -9.81};  ///< [m/s2]
  double timestep = 0.002;           ///< [s]
  bool limits = true;
  bool friction = true;
  bool passive = true;  ///< springs and dampers
  bool equality = true;
  bool actuation = true;
  bool clamps_controls = true;               ///< to the ctrlrange of actuators
  std::vector<double> idle_actuator_groups;  ///< groups of actuators that do not act
};

enum class GeomType { plane, sphere, capsule, ellipsoid, cylinder, box, mesh, torus, other };

struct Geom {
  const xml::Element* element = nullptr;
  std::string name;
  GeomType type = GeomType::sphere;
  int body = 0;
  Frame frame;                     ///< in the body
  Vector3 size = Vector3::Zero();  ///< as MJCF: radius, half lengths [m]
  Inertial inertial;               ///< in the body frame; mass 0: it has none
  std::string mesh;                ///< name of its mesh, only of the type mesh
};

enum class JointType { free, ball, slide, hinge };

struct Joint {
  const xml::Element* element = nullptr;
  std::string name;
  JointType type = JointType::hinge;
  int body = 0;
  Vector3 position = Vector3::Zero();  ///< [m], body frame
  Vector3 axis = Vector3::UnitZ();     ///< unit vector, body frame
  double reference = 0.0;              ///< coordinate in the pose of the text [rad or m]
  std::optional<std::array<double, 2>> range;
  double limit_compliance = 0.0;  ///< of both ends of the range
  double stiffness = 0.0;
  double spring_reference = 0.0;
  double damping = 0.0;
  double friction = 0.0;
  double armature = 0.0;
  int qpos = 0;  ///< first place among the positions
  int qvel = 0;  ///< first place among the velocities

  [[nodiscard]] int position_count() const;
  [[nodiscard]] int velocity_count() const;
  /// Whether anything acts along its coordinate.
  [[nodiscard]] bool is_plain() const;
};

struct Site {
  const xml::Element* element = nullptr;
  std::string name;
  int body = 0;
  Frame frame;  ///< in the body
};

struct Body {
  const xml::Element* element = nullptr;
  std::string name;
  int parent = 0;
  Frame frame;  ///< in the parent, at the reference coordinates
  std::vector<int> joints;
  std::vector<int> geoms;
  std::optional<Inertial> given;  ///< <inertial>
  Inertial inertial;              ///< in the body frame
};

/// Factors of the powers 0, 1, ... of one coordinate; a coupling has as many.
using Polynomial = std::array<double, 10>;

/// A part of a spatial tendon's path.
struct PathPoint {
  const xml::Element* element = nullptr;
  int site = -1;       ///< through which the tendon passes; -1: a geom
  int geom = -1;       ///< over which the tendon wraps, between sites or further geoms
  int side_site = -1;  ///< on the side on which the tendon lies
};

/// A part of a spatial tendon behind a pulley.
struct Branch {
  std::vector<PathPoint> path;
  double divisor = 1.0;
};

/// A joint of a fixed tendon.
struct TendonJoint {
  int joint = 0;
  double factor = 0.0;  ///< of its coordinate [m/rad or 1]
};

/// A spatial tendon has a path, a fixed one joints, and one without a counterpart neither.
struct Tendon {
  const xml::Element* element = nullptr;
  std::string name;
  std::vector<PathPoint> path;
  std::vector<TendonJoint> joints;
  double divisor = 1.0;  ///< of the path, whose length / divisor counts
  /// Paths behind further pulleys, whose lengths / divisors add to that of the first.
  std::vector<Branch> branches;
  std::optional<std::array<double, 2>> range;  ///< [m]
  bool is_rigid = false;                       ///< of the length at the start
  double stiffness = 0.0;                      ///< [N/m]
  double damping = 0.0;                        ///< [N s/m]
  std::optional<double> spring_length;         ///< default: the length in the reference pose [m]
  /// Lengths between which the spring has no force [m]; only if they differ.
  std::optional<std::array<double, 2>> slack;
};

/// The law of a muscle in MuJoCo's own terms.
struct MuscleLaw {
  std::array<double, 2> range{0.75, 1.05};  ///< normalised lengths at the ends of length_range
  double force = -1.0;                      ///< peak active force [N]; below 0: scale / acc0
  double scale = 200.0;            ///< of the force that is not given [N m/s2 and the like]
  double shortest = 0.5;           ///< lmin
  double longest = 1.6;            ///< lmax
  double max_speed = 1.5;          ///< vmax
  double passive_force = 1.3;      ///< fpmax
  double lengthening_force = 1.2;  ///< fvmax
  std::array<double, 2> time_constants{0.01, 0.04};   ///< [s]
  double activation = 0.0;                            ///< at time 0, without a keyframe
  std::optional<std::array<double, 2>> length_range;  ///< of the actuator [m]
};

/// A force gain * control + bias0 + bias1 * length + bias2 * velocity, times the gear.
struct Actuator {
  const xml::Element* element = nullptr;
  std::string name;
  int joint = -1;
  int tendon = -1;
  double gear = 1.0;
  double gain = 1.0;
  std::array<double, 3> bias{};
  std::optional<MuscleLaw> muscle;  ///< in place of gain and bias
  int activation = -1;              ///< its place among the activations; -1: it has none
  std::optional<std::array<double, 2>> control_range;
  std::optional<std::array<double, 2>> force_range;
};

enum class EqualityType { connect, weld, joint };

struct Equality {
  const xml::Element* element = nullptr;
  std::string name;
  EqualityType type = EqualityType::connect;
  int joint1 = -1;
  int joint2 = -1;  ///< -1: joint1 stands still
  /// joint: coordinate 1 as a polynomial of coordinate 2, both counted from the reference pose
  Polynomial polynomial{0.0, 1.0};
  int body1 = 0;
  int body2 = 0;
  Vector3 anchor = Vector3::Zero();  ///< connect: in body1 [m]
};

struct Keyframe {
  const xml::Element* element = nullptr;
  std::string name;
  std::vector<double> positions;    ///< empty: those of the reference pose
  std::vector<double> velocities;   ///< empty: 0
  std::vector<double> controls;     ///< empty: 0
  std::vector<double> activations;  ///< empty: 0
};

/// Body 0 is the world. Bodies stand behind their parents.
struct Model {
  std::string name;
  std::string file;    ///< of the model
  std::string folder;  ///< in which its files must lie; empty: that of the model
  std::string format = "MJCF";
  Compiler compiler;
  Option option;
  std::vector<Body> bodies;
  std::vector<Joint> joints;
  std::vector<Geom> geoms;
  std::vector<Site> sites;
  std::vector<Tendon> tendons;
  std::vector<Actuator> actuators;
  std::vector<Equality> equalities;
  std::vector<Keyframe> keyframes;
  /// Where the scene starts without a keyframe; empty: in the reference pose.
  std::vector<double> start_positions;
  bool has_contacts = true;  ///< whether its geoms touch each other
  bool is_soft = true;       ///< whether limits and equalities give way, as in MuJoCo
  std::unordered_map<std::string, MeasuredMesh> meshes;  ///< by the names of geoms
  std::unordered_map<std::string, int> body_names, joint_names, geom_names, site_names,
      tendon_names;
  int position_count = 0;
  int velocity_count = 0;
  int activation_count = 0;
};

}  // namespace sheave::import::mjcf
