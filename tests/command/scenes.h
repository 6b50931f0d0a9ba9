#pragma once
// Small scenes for the tests of the command.

#include <string>

namespace sheave::test {

/// The block and tackle with parameters.
inline const std::string tackle_template = SHEAVE_SOURCE_DIR "/scenes/templates/tackle.jsonnet";

/// Two weights on one cable over a wheel, for one second of 100 steps, with checks that hold.
inline const std::string atwood_scene = R"json({
  "format": "sheave-scene/1",
  "name": "Two weights",
  "gravity": [0, -10, 0],
  "duration": 1,
  "step": {"dt": 0.01, "substeps": 1, "iterations": 20},
  "bodies": [
    {"name": "wheel", "mobility": "rotor", "mass": 4,
     "shape": {"type": "cylinder", "radius": 0.5, "length": 0.15}},
    {"name": "light", "mobility": "slider", "axis": [0, 1, 0], "position": [-0.5, -3.5, 0],
     "mass": 1, "shape": {"type": "box", "size": [0.3, 0.3, 0.3]}},
    {"name": "heavy", "mobility": "slider", "axis": [0, 1, 0], "position": [0.5, -1.5, 0],
     "mass": 2, "shape": {"type": "box", "size": [0.3, 0.3, 0.3]}}
  ],
  "cables": [
    {"name": "rope", "links": [
      {"type": "attachment", "body": "light"},
      {"type": "rolling", "body": "wheel", "winding": "clockwise"},
      {"type": "attachment", "body": "heavy"}
    ]}
  ],
  "checks": [
    {"quantity": "light.vy", "statistic": "rate", "equals": 2, "relative_tolerance": 0.01,
     "because": "(m2 - m1) g / (m1 + m2 + I/r^2)"
},
    {"quantity": "rope.0.tension", "statistic": "mean", "equals": 12, "relative_tolerance": 0.01}
  ]
}
)json";

/// A bar on a hinge with a spring, and a weight on a string that breaks when it is pulled taut.
inline const std::string jointed_scene = R"json({
  "format": "sheave-scene/1",
  "gravity": [0, -10, 0],
  "duration": 1,
  "step": {"dt": 0.01, "iterations": 50},
  "bodies": [
    {"name": "bar", "mass": 3, "position": [0.5, 0, 0], "shape": {"type": "box", "size": [1, 0.1, 0.1]}},
    {"name": "stone", "mass": 2, "position": [3, -1, 0], "shape": {"type": "sphere", "radius": 0.1}}
  ],
  "joints": [
    {"type": "distance", "name": "string", "body_b": "stone", "anchor_a": [3, 0, 0], "anchor_b": [3, -1, 0],
     "length": 2, "limit": "at-most", "breaking_force": 50},
    {"type": "hinge", "name": "bearing", "body_b": "bar", "anchor": [0, 0, 0], "axis": [0, 0, 1],
     "drive": "angle", "drive_times": [0, 0.5], "drive_values": [0, 0.25]}
  ]
}
)json";

/// A body that such a force throws out of the world within a few steps.
inline const std::string runaway_scene = R"json({
  "format": "sheave-scene/1",
  "gravity": [0, 0, 0],
  "duration": 10,
  "step": {"dt": 0.01},
  "bodies": [
    {"name": "calm", "mass": 1, "shape": {"type": "sphere", "radius": 1}},
    {"name": "rocket", "mass": 1, "force": [1e12, 0, 0], "shape": {"type": "sphere", "radius": 1}}
  ]
}
)json";

/// Falls for longer than anybody waits.
inline const std::string endless_scene = R"json({
  "format": "sheave-scene/1",
  "gravity": [0, 0, 0],
  "duration": 1e9,
  "step": {"dt": 0.01},
  "bodies": [
    {"name": "stone", "mass": 1, "angular_velocity": [0, 0, 1],
     "shape": {"type": "sphere", "radius": 1}}
  ]
}
)json";

/// A wheel moves into another, so that after half a second the crossing span "rope.1" between them
/// has no tangent.
inline const std::string overlap_scene = R"json({
  "format": "sheave-scene/1",
  "gravity": [0, 0, 0],
  "duration": 1,
  "step": {"dt": 0.01},
  "bodies": [
    {"name": "still", "mobility": "rotor", "mass": 1,
     "shape": {"type": "cylinder", "radius": 0.5, "length": 0.1}},
    {"name": "coming", "mobility": "slider", "axis": [1, 0, 0], "position": [1.5, 0, 0],
     "velocity": [-1, 0, 0], "mass": 1, "shape": {"type": "cylinder", "radius": 0.5, "length": 0.1}}
  ],
  "cables": [
    {"name": "rope", "rest_lengths": [2, 3, 3.5], "links": [
      {"type": "attachment", "body": "world", "point": [-0.5, -2, 0]},
      {"type": "rolling", "body": "still", "winding": "clockwise"},
      {"type": "rolling", "body": "coming", "winding": "counter-clockwise"},
      {"type": "attachment", "body": "world", "point": [2, 3, 0]}
    ]}
  ]
}
)json";

/// A cable whose ends go up and down 4 times a second, and each time wind it round a post above it
/// for a moment.
inline const std::string wrap_scene = R"json({
  "format": "sheave-scene/1",
  "gravity": [0, 0, 0],
  "duration": 2.1,
  "step": {"dt": 0.01, "solver": "direct"},
  "bodies": [
    {"name": "left", "mobility": "kinematic", "position": [-1, 0, 0], "oscillation": [0, 0.3, 0],
     "oscillation_frequency": 4},
    {"name": "right", "mobility": "kinematic", "position": [1, 0, 0], "oscillation": [0, 0.3, 0],
     "oscillation_frequency": 4},
    {"name": "post", "mobility": "static", "wrappable": true, "position": [0, 0.3, 0],
     "shape": {"type": "cylinder", "radius": 0.2, "length": 0.2}}
  ],
  "cables": [
    {"name": "rope", "axial_stiffness": 1000, "links": [
      {"type": "attachment", "body": "left"},
      {"type": "attachment", "body": "right"}
    ]}
  ]
}
)json";

/// A cable that slides over a post with friction makes the direct solver's matrix asymmetric, and a
/// crate that lands on four corners makes it singular.
inline const std::string redundant_scene = R"json({
  "format": "sheave-scene/1",
  "gravity": [0, -10, 0],
  "duration": 0.5,
  "step": {"dt": 0.01, "solver": "direct"},
  "ground": {"point": [0, -10, 0]},
  "bodies": [
    {"name": "post", "mobility": "static", "shape": {"type": "cylinder", "radius": 0.5, "length": 0.1}},
    {"name": "light", "mobility": "slider", "axis": [0, 1, 0], "position": [-0.5, -2, 0], "mass": 1},
    {"name": "heavy", "mobility": "slider", "axis": [0, 1, 0], "position": [0.5, -2, 0], "mass": 3},
    {"name": "crate", "position": [3, -9.5, 0.1], "mass": 1, "shape": {"type": "box", "size": [0.7, 0.6, 0.9]}}
  ],
  "cables": [
    {"name": "rope", "links": [
      {"type": "attachment", "body": "light"},
      {"type": "rolling", "body": "post", "winding": "clockwise", "friction": 0.1},
      {"type": "attachment", "body": "heavy"}
    ]}
  ]
}
)json";

}  // namespace sheave::test
