#pragma once
// How the joints of a model look.
//
//   distance               a rod; a string (at-most), slack when it is; a coil
//   spring (elastic rods); a telescope of two
//                          tubes (at-least, none), which ends where it reaches
//                          to
//   ball, hinge            a ball, a pin that shows on both sides of what it
//   goes through universal              a cross slider, cylindrical    a rail
//   as far as the body can travel, or along the bodies if nothing says how far
//   others                 nothing: what they join shows it
//
// A broken joint is not drawn any more.

#include <limits>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "engine/world.h"
#include "render/body_view.h"
#include "render/coil.h"
#include "render/draw_list.h"

namespace sheave::render {

/// How far the body_b of a slider went along its axis in a run [m]; empty if lower > upper.
struct JointTravel {
  double lower = std::numeric_limits<double>::infinity();
  double upper = -std::numeric_limits<double>::infinity();
};

/// Extends travels, one for each joint, by where the joints of a world are now.
void extend_travels(const World& world, std::vector<JointTravel>& travels);

/// A line between a point of one body and one of another.
struct JointLine {
  enum class Kind {
    rod,
    string,
    spring,
    telescope,
    bumper,  ///< a telescope that does not stretch beyond its length
  };
  Kind kind = Kind::rod;
  BodyId body_a;
  BodyId body_b;
  Vector3 start = Vector3::Zero();  ///< [m], frame of body_a
  Vector3 end = Vector3::Zero();    ///< [m], frame of body_b
  Vector3 side = Vector3::UnitX();  ///< frame of body_a: where coils begin;
                                    ///< across the line at first
  double length = 0.0;              ///< when relaxed [m], > 0
};

/// What is drawn for the joints of one world, whatever they do.
struct JointView {
  /// Of one joint; parts and bars are fixed to one body.
  struct Piece {
    int joint = 0;  ///< index in Model::joints
    std::vector<BodyPart> parts;
    std::vector<BodyBar> bars;
    std::vector<JointLine> lines;
  };
  std::vector<Piece> pieces;
  double unit = 0.01;  ///< the radius of rods [m], > 0
};

/// Decides how the joints of a world look, from its model. Pins suit the bodies
/// that they go through; `unit` [m], > 0, is the radius of rods and limits that
/// of pins: suitable_cable_radius().
/// `travels`: how far the joints went, by their index, for rails without stops; may be shorter.
[[nodiscard]] JointView make_joint_view(const World& world, double unit,
                                        std::span<const JointTravel> travels = {});

/// Appends what the joints look like now. `world` must be of the model that the
/// view was made for.
void add_joints(const JointView& view, const World& world, DrawList& list);

/// Extends the box by what joints reach to now: their anchors.
void extend_by_joints(const World& world, Eigen::AlignedBox3d& box);

}  // namespace sheave::render
