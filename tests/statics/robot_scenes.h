#pragma once
// Machines in the coordinates of their joints, for tests.

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "cable/live_world.h"
#include "statics/joint_space.h"
#include "statics/place_joints.h"
#include "tests/statics/scene_at_rest.h"

namespace sheave::testing {

inline LiveWorld robot(const std::string& parts, const std::string& gravity = "[0,-10,0]") {
  return LiveWorld::of(simulation_of(parts, gravity));
}

/// The answer of a question to the joint space of a world.
template <class Answer>
Answer ask(LiveWorld& world, const std::function<Answer(JointSpace&)>& question) {
  Answer answer{};
  const Errors errors = world.examine([&](Simulation& simulation) {
    Result<JointSpace> space = JointSpace::create(simulation);
    ASSERT_TRUE(space) << space.errors().front().message;
    answer = question(*space);
  });
  EXPECT_TRUE(errors.empty());
  return answer;
}

inline void place(LiveWorld& world, const std::vector<CoordinateTarget>& targets,
                  Keep keep = Keep::tension) {
  const Result<Placement> placed = place_joints(world, targets, keep);
  ASSERT_TRUE(placed) << placed.errors().front().message;
}

inline void turn(LiveWorld& world, const std::vector<CoordinateTarget>& rates) {
  const Errors errors = set_joint_rates(world, rates);
  ASSERT_TRUE(errors.empty()) << errors.front().message;
}

inline std::vector<std::string> names(LiveWorld& world) {
  return ask<std::vector<std::string>>(world, [](JointSpace& space) {
    std::vector<std::string> all;
    for (const MachineCoordinate& own : space.coordinates()) all.push_back(own.name);
    return all;
  });
}

inline ModalVector positions(LiveWorld& world) {
  return ask<ModalVector>(world, [](JointSpace& space) { return space.positions(); });
}

inline ModalVector rates(LiveWorld& world) {
  return ask<ModalVector>(world, [](JointSpace& space) { return space.rates(); });
}

/// Two links in a plane, whose lengths are 1 and 0.8 m: with the mobility "planar" or "free".
inline std::string two_links(const std::string& mobility, const std::string& joint_settings = "") {
  const std::string axis = mobility == "planar" ? R"("axis": [0, 0, 1], )" : "";
  return R"("step": {"dt": 0.001, "substeps": 1}, "bodies": [
    {"name": "upper", "mobility": ")" +
         mobility + R"(", )" + axis +
         R"("mass": 2, "inertia": [0.1, 0.2, 0.3], "position": [0.5, 0, 0]},
    {"name": "lower", "mobility": ")" +
         mobility + R"(", )" + axis +
         R"("mass": 1.5, "inertia": [0.05, 0.06, 0.07], "position": [1.3, 0, 0]}],
    "joints": [
    {"type": "hinge", "name": "shoulder", "body_b": "upper", "anchor": [0, 0, 0], "axis": [0, 0, 1])" +
         joint_settings + R"(},
    {"type": "hinge", "name": "elbow", "body_a": "upper", "body_b": "lower", "anchor": [1, 0, 0], "axis": [0, 0, 1])" +
         joint_settings + "}]";
}

/// A four-bar linkage; the crank of 0.4 m turns fully.
inline constexpr const char* four_bar = R"("bodies": [
  {"name": "crank", "mobility": "planar", "mass": 1, "inertia": [1, 1, 0.02], "position": [0, 0.2, 0]},
  {"name": "coupler", "mobility": "planar", "mass": 2, "inertia": [1, 1, 0.2], "position": [0.5, 0.7, 0]},
  {"name": "rocker", "mobility": "planar", "mass": 1.5, "inertia": [1, 1, 0.1], "position": [1, 0.5, 0]}],
  "joints": [
  {"type": "hinge", "name": "a", "body_b": "crank", "anchor": [0, 0, 0], "axis": [0, 0, 1]},
  {"type": "hinge", "name": "b", "body_a": "crank", "body_b": "coupler", "anchor": [0, 0.4, 0], "axis": [0, 0, 1]},
  {"type": "hinge", "name": "c", "body_a": "coupler", "body_b": "rocker", "anchor": [1, 1, 0], "axis": [0, 0, 1]},
  {"type": "hinge", "name": "d", "body_b": "rocker", "anchor": [1, 0, 0], "axis": [0, 0, 1]}])";

}  // namespace sheave::testing
