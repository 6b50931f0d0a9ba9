#pragma once
// A scene with everything that a session can set, and sessions that hold it.

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "engine/state.h"
#include "live/session.h"
#include "scenes/control/scene_supervisor.h"
#include "scenes/scene.h"

namespace sheave::test {

inline const std::string live_scene = R"json({
  "format": "sheave-scene/1",
  "name": "Workshop",
  "gravity": [0, -10, 0],
  "duration": 10,
  "step": {"dt": 0.01, "substeps": 2},
  "bodies": [
    {"name": "drum", "mobility": "rotor", "mass": 4, "position": [-0.5, 0, 0], "drive": "speed", "drive_values": [0],
     "shape": {"type": "cylinder", "radius": 0.5, "length": 0.1}},
    {"name": "dial", "mobility": "rotor", "mass": 1, "position": [5, 0, 0], "drive": "angle", "drive_values": [0],
     "shape": {"type": "cylinder", "radius": 0.1, "length": 0.1}},
    {"name": "fan", "mobility": "rotor", "mass": 1, "position": [6, 0, 0], "drive": "torque", "drive_values": [0],
     "shape": {"type": "cylinder", "radius": 0.1, "length": 0.1}},
    {"name": "load", "mobility": "planar", "mass": 2, "position": [0, -3, 0],
     "shape": {"type": "box", "size": [0.2, 0.2, 0.2]}},
    {"name": "hand", "mobility": "kinematic", "position": [3, 0, 0], "shape": {"type": "sphere", "radius": 0.1}},
    {"name": "bar", "mass": 3, "position": [10.5, 0, 0], "shape": {"type": "box", "size": [1, 0.1, 0.1]}},
    {"name": "weight", "mass": 1, "position": [2.8, -2, 0], "shape": {"type": "sphere", "radius": 0.1}},
    {"name": "post", "mobility": "static", "position": [15, 0, 0], "shape": {"type": "cylinder", "radius": 0.2, "length": 0.4}},
    {"name": "left", "mobility": "slider", "axis": [0, 1, 0], "mass": 1, "position": [14.8, -2, 0], "shape": {"type": "sphere", "radius": 0.1}}
  ],
  "joints": [
    {"type": "hinge", "name": "hinge", "body_b": "bar", "anchor": [10, 0, 0], "axis": [0, 0, 1],
     "drive": "speed", "drive_values": [0], "drive_limit": 50, "breaking_force": 200}
  ],
  "cables": [
    {"name": "rope", "compliance": 1e-5, "damping": 1, "links": [
      {"type": "spool", "body": "drum", "winding": "clockwise", "stored_length": 5},
      {"type": "attachment", "body": "load", "point": [0, 0.1, 0]}]},
    {"name": "string", "links": [
      {"type": "attachment", "body": "hand", "point": [-0.1, 0, 0]},
      {"type": "attachment", "body": "weight"}]},
    {"name": "line", "links": [
      {"type": "attachment", "body": "left"},
      {"type": "rolling", "body": "post", "winding": "clockwise", "friction": 0.2},
      {"type": "attachment", "body": "world", "point": [15.2, -3, 0], "feed_speed": 0}]}
  ],
  "controllers": [
    {"type": "bang-bang", "name": "blower", "measures": "fan.angle", "setpoint": 1, "control": "fan.drive", "low": -0.01, "high": 0.01}
  ],
  "triggers": [
    {"name": "end", "quantity": "dial.angle", "above": 5, "action": "stop"}
  ]
})json";

inline Scene scene_of(const std::string& text) {
  SceneResult scene = load_scene_text(text, "test");
  EXPECT_TRUE(scene) << (scene ? "" : to_string(scene.errors.front()));
  return std::move(*scene.scene);
}

inline live::Session session_of(const std::string& text, live::Hooks hooks = {},
                                const live::Limits& limits = {}) {
  const Scene scene = scene_of(text);
  Result<Simulation> simulation = create_simulation(scene);
  EXPECT_TRUE(simulation.ok());
  return {scene, std::move(*simulation), std::move(hooks), limits};
}

/// The answer as JSON; it must be one line.
inline nlohmann::json ask(live::Session& session, const std::string& line) {
  const std::string answer = session.answer(line);
  EXPECT_EQ(answer.find('\n'), std::string::npos);
  return nlohmann::json::parse(answer);
}

/// A request of several lines as one.
inline std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

/// A request to edit, with these changes.
inline std::string edit_of(const std::string& changes) {
  return one_line(R"({"type":"edit","changes":[)" + changes + "]}");
}

/// An answer that must be ok.
inline nlohmann::json done(live::Session& session, const std::string& line) {
  nlohmann::json answer = ask(session, one_line(line));
  EXPECT_TRUE(answer["ok"].get<bool>()) << line << '\n' << answer;
  return answer;
}

inline std::uint64_t hash_of(const live::Session& session) { return hash(session.world().state()); }

}  // namespace sheave::test
