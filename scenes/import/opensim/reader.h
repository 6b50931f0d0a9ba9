#pragma once
// Reads the tree of an OpenSim text, versions 2 to 4 of the format, into the Model of MJCF.
//
// A body has the frame that OpenSim gives it. A joint of OpenSim moves along three directions and
// then turns about three, each by a function of one coordinate. Displacements that are linear in a
// coordinate are slides and hinges of the body. Where a coordinate moves further ones by another
// function, each has a small body of its own, and an equality of joints with a polynomial.

#include <map>
#include <string>
#include <vector>

#include "scenes/import/mjcf/pose.h"
#include "scenes/import/opensim/function.h"
#include "scenes/import/opensim/properties.h"

namespace sheave::import::opensim {

/// A frame that is fixed to a body.
struct FixedFrame {
  int body = -1;      ///< number of the body in OpenSim's order, 0: ground; -1: there is none
  mjcf::Frame frame;  ///< in the body
};

/// A coordinate of OpenSim.
struct Coordinate {
  const xml::Element* element = nullptr;
  std::string name;
  double start = 0.0;  ///< default_value [rad or m]
  std::array<double, 2> range{-pi, pi};
  bool clamped = false;
  bool locked = false;
  bool is_named = false;  ///< by a force or a constraint, which need a joint that moves by it alone
  bool has_stops = true;  ///< whether its joint can have stops
  int joint = -1;         ///< of the model, that moves by it alone; -1: none
  double factor = 1.0;    ///< d position of that joint / d coordinate
  double offset = 0.0;    ///< position of that joint where the coordinate is 0
};

/// The position of a joint of the model as a polynomial of a coordinate.
struct Driven {
  int coordinate = -1;  ///< -1: none, the joint starts where the model has it
  mjcf::Polynomial factors{};
};

/// A coordinate that a constraint makes a function of another one.
struct Coupler {
  const xml::Element* element = nullptr;
  int leader = -1;
  Function function;
  bool is_replaced = false;  ///< displacements follow the leader in place of the coordinate
};

/// A joint of the model that follows a coordinate.
struct Follower {
  const xml::Element* element = nullptr;
  int joint = 0;
  int coordinate = 0;
  mjcf::Polynomial factors{};  ///< of the coordinate
};

/// A surface over which paths can wrap.
struct WrapSurface {
  const xml::Element* element = nullptr;
  int geom = -1;       ///< of the model; -1: none, because it has no counterpart
  int side_site = -1;  ///< on the side of its quadrant
  bool active = true;
};

/// A body of OpenSim.
struct RawBody {
  const xml::Element* element = nullptr;
  std::string name;
  mjcf::Inertial inertial;
  int number = -1;  ///< in the model; -1: not there yet
};

/// A joint of OpenSim between two frames.
struct RawJoint {
  const xml::Element* element = nullptr;
  FixedFrame parent;
  FixedFrame child;
  std::vector<int> coordinates{};
};

/// The model being read; all readers of elements share it.
struct Reader {
  const xml::Element& root;  ///< <Model>
  mjcf::Model& model;
  Properties& properties;
  Log& log;
  std::vector<RawBody> bodies{};
  std::map<std::string, int, std::less<>> body_names{};
  std::vector<RawJoint> joints{};
  std::vector<Coordinate> coordinates{};
  std::map<std::string, int, std::less<>> coordinate_names{};
  std::map<std::string, WrapSurface, std::less<>> wraps{};
  std::map<int, Coupler> couplers{};  ///< by the coordinate that depends
  std::vector<Follower> followers{};
  std::vector<Driven> driven{};                           ///< one per joint of the model
  std::vector<std::pair<int, Quaternion>> ball_starts{};  ///< joints of the model
  std::vector<mjcf::Frame> start_frames{};                ///< of the model's bodies, in the world
  std::vector<int> carriers{};        ///< of the model's bodies: the body of which each is a part
  std::vector<mjcf::Pose> sampled{};  ///< poses in which paths are looked at; the start first
  std::map<const xml::Element*, int> moving_points{};  ///< bodies of the model that are the points
  std::map<std::string, const xml::Element*, std::less<>> frames{};  ///< offset frames by path
  std::map<std::string, std::string, std::less<>> frame_names{};  ///< path of the first of a name

  /// The number of a coordinate; -1 if there is none of this name.
  [[nodiscard]] int coordinate(std::string_view name) const;
};

/// The model of a tree whose root is <OpenSimDocument>; check log.failed().
[[nodiscard]] mjcf::Model read_model(const xml::Element& root, Log& log);

/// Angles about x, then the turned y, then the turned z [rad].
[[nodiscard]] Quaternion from_xyz(const Vector3& angles);
/// Enters the offset frames of all components.
void find_frames(Reader& reader);
/// The frame that a socket of an object names, such as parent_frame; `inside` is the path of the
/// component around the object, such as /jointset/elbow. An error if there is none.
[[nodiscard]] FixedFrame frame_of(const xml::Element& object, std::string_view socket,
                                  const std::string& inside, Reader& reader);
/// Reads ground and bodies, without their wrap objects.
void read_bodies(Reader& reader);
/// Reads joints and coordinates.
void read_joints(Reader& reader);
/// Reads which coordinates forces and constraints name, and constraints of coordinates.
void read_couplers(Reader& reader);
/// Gives the joints of coordinates their stops, and followers their equalities.
void finish_joints(Reader& reader);
/// Adds the body to the model, with the slides and hinges of its joint.
void build_joint(int body, const RawJoint& joint, Reader& reader);
/// Adds the body to the model, with the joint that leads to it; null: the body is free.
void add_body(int body, const RawJoint* joint, Reader& reader);
/// Adds a joint to the body with this number.
int add_joint(mjcf::JointType type, const Vector3& axis, const Vector3& position,
              const xml::Element& element, int body, Reader& reader);
/// Reads the wrap objects of all bodies.
void read_wraps(Reader& reader);
/// The pose of the start, with poses for paths behind it in `sampled`; after all couplings.
[[nodiscard]] const mjcf::Pose& start_pose(Reader& reader);
/// Adds the bodies of points that move by coordinates; before finish_joints().
void read_moving_points(Reader& reader);
/// The frame of the body of a path point; an error if there is none.
[[nodiscard]] FixedFrame frame_of_point(const xml::Element& element, Reader& reader);
/// The coordinate of a path point, or that of its component "x", "y" or "z": in a property, or at
/// the end of the path of a socket; -1 if there is none.
[[nodiscard]] int coordinate_of_point(const xml::Element& element, const std::string& axis,
                                      Reader& reader);
/// Reads a path as a tendon; false if there is none, which the log tells.
bool read_path(const xml::Element& object, mjcf::Tendon& tendon, Reader& reader);
void read_forces(Reader& reader);
void read_constraints(Reader& reader);
/// The coordinates of the model where each OpenSim coordinate has its value.
[[nodiscard]] std::vector<double> positions_at(const std::vector<double>& values,
                                               const Reader& reader);

/// Reads the coordinates of a joint; their numbers.
[[nodiscard]] std::vector<int> read_coordinates(const xml::Element& joint, Reader& reader);

/// One displacement of a joint.
struct Axis {
  const xml::Element* element = nullptr;
  Vector3 direction = Vector3::UnitX();  ///< unit vector, in the parent's frame of the joint
  bool turns = false;
  int coordinate = -1;  ///< -1: none
  Function function;    ///< of the coordinate [rad or m]
};
/// The displacements of a joint, those along directions first; empty with an error if its type has
/// no counterpart.
[[nodiscard]] std::vector<Axis> axes_of(const RawJoint& joint, Reader& reader);

}  // namespace sheave::import::opensim
