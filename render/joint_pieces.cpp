// The joints of a world in their present positions: add_joints() and extend_by_joints() of
// render/joint_view.h.

#include <algorithm>
#include <cmath>

#include "cable/slack_curve.h"
#include "engine/body_set.h"
#include "engine/joint_report.h"
#include "render/joint_view.h"

namespace sheave::render {
namespace {

constexpr Color joint_knob_color = rgb(0xc9ced6);
constexpr Color rod_color = rgb(0x8d98a5);
constexpr Color sleeve_color = rgb(0x5f6b79);
constexpr Color string_color = rgb(0x4a5563);

Vector3 placed(const World& world, BodyId body, const Vector3& local) {
  return body.is_world() ? local : world.point(body, local);
}
Quaternion turned(const World& world, BodyId body) {
  return body.is_world() ? Quaternion(Quaternion::Identity()) : world.orientation(body);
}

Tube tube_of(const std::vector<Vector3>& points, double radius, Color color) {
  Tube tube;
  tube.radius = radius;
  for (const Vector3& point : points) tube.points.push_back({point, color});
  return tube;
}

/// A string of this length [m] between two points.
std::vector<Vector3> string_line(const Vector3& start, const Vector3& end, double length,
                                 const Vector3& gravity, double tolerance) {
  const SlackCurve curve(start, end, length, gravity);
  std::vector<Vector3> line(curve.point_count(tolerance));
  curve.write(tolerance, line);
  return line;
}

void add_knob(const Vector3& at, double radius, DrawList& list) {
  Solid knob;
  knob.shape = SphereShape{radius};
  knob.position = at;
  knob.color = joint_knob_color;
  list.solids.push_back(std::move(knob));
}

/// A spring with coils about the line; its sizes follow from its relaxed length.
Tube spring_tube(const JointLine& line, const World& world, const Vector3& start,
                 const Vector3& end, double unit) {
  const double radius = std::clamp(0.09 * line.length, 1.5 * unit, 5.0 * unit);
  CoilShape coil;
  coil.radius = radius;
  coil.coils = std::clamp(static_cast<int>(0.75 * line.length / radius), 5, 14);
  const Vector3 along = (end - start).normalized();
  Vector3 side = turned(world, line.body_a) * line.side;
  if (along.cross(side).norm() < 0.05) side = any_perpendicular(along);
  return tube_of(coil_points(start, end, side, coil), std::max(0.16 * radius, 0.35 * unit),
                 rod_color);
}

void add_joint_line(const JointLine& line, const World& world, double unit, DrawList& list) {
  using Kind = JointLine::Kind;
  const Vector3 start = placed(world, line.body_a, line.start);
  const Vector3 end = placed(world, line.body_b, line.end);
  const double distance = (end - start).norm();
  if (!(distance > 1e-9 * line.length)) return;
  const Vector3 along = (end - start) / distance;
  const Vector3 sleeve_end = start + along * std::min(0.55 * line.length, 0.9 * distance);
  switch (line.kind) {
    case Kind::rod:
      list.tubes.push_back(tube_of({start, end}, unit, rod_color));
      break;
    case Kind::string:
      list.tubes.push_back(
          tube_of(string_line(start, end, line.length, world.model().gravity, 0.05 * unit),
                  0.5 * unit, string_color));
      break;
    case Kind::spring:
      list.tubes.push_back(spring_tube(line, world, start, end, unit));
      break;
    case Kind::telescope:
      list.tubes.push_back(tube_of({start, sleeve_end}, 2.0 * unit, sleeve_color));
      list.tubes.push_back(tube_of({start, end}, unit, rod_color));
      break;
    case Kind::bumper: {
      const Vector3 tip = start + along * std::min(line.length, distance);
      list.tubes.push_back(tube_of({start, sleeve_end}, 2.0 * unit, sleeve_color));
      list.tubes.push_back(tube_of({start, tip}, unit, rod_color));
      add_knob(tip, 2.0 * unit, list);
      return;
    }
  }
  const double knob = line.kind == Kind::string ? 0.9 * unit : 1.6 * unit;
  add_knob(start, knob, list);
  add_knob(end, knob, list);
}

void add_piece(const JointView::Piece& piece, const World& world, double unit, DrawList& list) {
  for (const BodyPart& part : piece.parts) {
    Solid solid;
    solid.shape = part.shape;
    solid.position = placed(world, part.body, part.position);
    solid.orientation = turned(world, part.body) * part.orientation;
    solid.color = part.color;
    list.solids.push_back(std::move(solid));
  }
  for (const BodyBar& bar : piece.bars) {
    list.tubes.push_back(
        tube_of({placed(world, bar.body, bar.start), placed(world, bar.body, bar.end)}, bar.radius,
                bar.color));
  }
  for (const JointLine& line : piece.lines) add_joint_line(line, world, unit, list);
}

}  // namespace

void add_joints(const JointView& view, const World& world, DrawList& list) {
  if (view.pieces.empty()) return;
  // Any joint may have been released since the view was made.
  const JointReader reader(world);
  for (const JointView::Piece& piece : view.pieces) {
    if (reader.report(piece.joint).broken_at) continue;
    add_piece(piece, world, view.unit, list);
  }
}

void extend_travels(const World& world, std::vector<JointTravel>& travels) {
  const auto& joints = world.model().joints;
  travels.resize(joints.size());
  const JointReader reader(world);
  for (std::size_t i = 0; i < joints.size(); ++i) {
    for (const JointCoordinateReport& c : reader.report(static_cast<int>(i)).coordinates) {
      if (c.name != "travel" || !std::isfinite(c.value)) continue;
      travels[i].lower = std::min(travels[i].lower, c.value);
      travels[i].upper = std::max(travels[i].upper, c.value);
    }
  }
}

void extend_by_joints(const World& world, Eigen::AlignedBox3d& box) {
  // The thickness of pins has no effect here.
  const JointView view = make_joint_view(world, 1e-9 * world.bodies().scale());
  for (const JointView::Piece& piece : view.pieces) {
    for (const BodyPart& part : piece.parts) box.extend(placed(world, part.body, part.position));
    for (const JointLine& line : piece.lines) {
      box.extend(placed(world, line.body_a, line.start));
      box.extend(placed(world, line.body_b, line.end));
    }
  }
}

}  // namespace sheave::render
