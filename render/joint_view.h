#pragma once
// Appearance of the joints of a model:
//
// - distance: a rod; a string (at-most), which sags when slack; a coil spring (elastic rods); a
//   telescope of two tubes (at-least, none), which ends at its longest reach.
// - ball: a ball.
// - hinge: a pin that is visible on both sides of the bodies that it joins.
// - universal: a cross.
// - slider, cylindrical: a rail as long as the body's travel, or along the bodies if the travel is
//   unknown.
// - others: nothing, because the bodies show them.
//
// A broken joint is not drawn.

#include <limits>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "engine/world.h"
#include "render/body_view.h"
#include "render/coil.h"
#include "render/draw_list.h"

namespace sheave::render {

/// Range of the body_b of a slider along its axis in a run [m]; empty if lower > upper.
struct JointTravel {
  double lower = std::numeric_limits<double>::infinity();
  double upper = -std::numeric_limits<double>::infinity();
};

/// Extends travels, one per joint, by the present positions of the joints.
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
  /// Frame of body_a: direction in which coils begin; perpendicular to the line at first.
  Vector3 side = Vector3::UnitX();
  double length = 0.0;  ///< when relaxed [m], > 0
};

/// The drawn parts of the joints of one world, independent of its state.
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

/// Decides the appearance of a world's joints, from its model. Pins fit the bodies that they join.
/// `unit` [m], > 0, is the radius of rods and the limit of that of pins: suitable_cable_radius().
/// `travels`: ranges of the joints, by index, for rails without stops; may be shorter.
[[nodiscard]] JointView make_joint_view(const World& world, double unit,
                                        std::span<const JointTravel> travels = {});

/// Appends the joints in their present poses. `world` must have the model of the view.
void add_joints(const JointView& view, const World& world, DrawList& list);

/// Extends the box by the present anchors of the joints.
void extend_by_joints(const World& world, Eigen::AlignedBox3d& box);

}  // namespace sheave::render
