#pragma once
// A scene: the content of a scene file as C++ values.
//
//   sheave::SceneResult scene = sheave::load_scene("scenes/analytic/atwood.json");
//   if (!scene) for (const auto& error : scene.errors) puts(to_string(error).c_str());
//   auto simulation = sheave::create_simulation(*scene);  // scenes/control/scene_supervisor.h

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cable/cable.h"
#include "engine/model.h"
#include "engine/state.h"
#include "scenes/annotation.h"
#include "scenes/camera_key.h"
#include "scenes/control/controller.h"
#include "scenes/control/load.h"
#include "scenes/control/trigger.h"
#include "scenes/fault_code.h"
#include "scenes/statistic.h"

namespace sheave {

/// Version of the format, the value of the key "format".
enum class SceneFormat { v1 };
inline constexpr std::array<std::string_view, 1> scene_format_names{"sheave-scene/1"};

/// Where a simulation of a scene starts.
enum class Start {
  pose,  ///< in the pose and with the velocities of the settings
  rest,  ///< in the equilibrium near that pose, with drives in their places
};
inline constexpr std::array<std::string_view, 2> start_names{"pose", "rest"};

/// How a camera maps the world to the picture.
enum class Projection { perspective, orthographic };
inline constexpr std::array<std::string_view, 2> projection_names{"perspective", "orthographic"};

/// Camera for pictures of a scene. All settings are optional; missing ones are chosen so that the
/// whole scene is in the picture.
struct CameraDef {
  Projection projection = Projection::perspective;
  std::optional<Vector3> position;     ///< of the eye [m]; needs target, excludes direction
  std::optional<Vector3> target;       ///< in the middle of the picture [m]; needs position
  std::optional<Vector3> direction;    ///< viewing direction; the distance is chosen automatically
  std::optional<Vector3> up;           ///< up in the picture; default: against gravity
  std::optional<double> vertical_fov;  ///< perspective: full vertical angle [rad], in (0, pi)
  std::optional<double> height;        ///< orthographic: height of the picture [m]; needs position
  bool labels = false;                 ///< write the tensions [N] beside the cables
  bool joints = true;                  ///< draw pins, rods and rails of the joints
  bool axes = false;       ///< draw the directions of x, y and z in the lower right corner
  bool time_line = false;  ///< write the duration beside the time, with a line and its mark
  std::optional<double> cable_radius;  ///< radius of drawn cables [m]; default: suits the scene
  /// tension at the top of the colour scale [N]; default: from the run
  std::optional<double> tension_max;

  static std::span<const Field> field_table();
};

/// The colour of a body in pictures. The default colour depends on the kind of body.
struct PaintDef {
  BodyId body;
  Vector3 color{1.0, 1.0, 1.0};  ///< red, green, blue as on a screen (sRGB), each in [0, 1]

  static std::span<const Field> field_table();
};

/// An expected result of a scene: a closed-form value with a tolerance.
struct CheckDef {
  /// name of an observable (scenes/observables.h) or an expression (scenes/expression.h)
  std::string quantity;
  Statistic statistic = Statistic::at;
  std::optional<double> at;    ///< [s]; default: the end. Only with the statistic `at`
  std::optional<double> from;  ///< begin of the window [s]; default: 0. Not with `at`
  std::optional<double> to;    ///< end of the window [s]; default: the end. Not with `at`
  /// in the observable's unit; per second for a rate, times s for an integral
  double equals = 0.0;
  std::optional<double> tolerance;  ///< absolute, same unit
  /// relative to |equals|; the larger of the two tolerances counts
  std::optional<double> relative_tolerance;
  std::string because;  ///< the closed form, for readers

  static std::span<const Field> field_table();
  /// Largest error that passes; NaN without any tolerance.
  [[nodiscard]] double allowed_error() const;
};

/// The preset of a scene's step settings.
struct StepPresetDef {
  StepPreset preset = StepPreset::standard;  ///< supplies the settings that "step" does not have

  static std::span<const Field> field_table();
};

/// A model with cables, controllers, triggers, loads, settings of pictures and checks.
struct Scene {
  SceneFormat format = SceneFormat::v1;
  std::string name;
  std::string description;
  double duration = 0.0;  ///< of the simulation [s], > 0
  /// Default: the pose. Whoever gives the pose explicitly means the motion with which it begins
  /// (statics/start_at_rest.h).
  std::optional<Start> start;
  /// A state in which simulations start instead, for example from a file. The text of a scene has
  /// no such state.
  std::shared_ptr<const State> start_state;
  /// Tells the loader and the writer which settings may be omitted; model.step has the values.
  StepPresetDef step_preset;
  Model model;
  std::vector<CableDef> cables;
  std::vector<std::shared_ptr<const ControllerDef>> controllers;
  std::vector<TriggerDef> triggers;
  std::vector<std::shared_ptr<const LoadDef>> loads;
  std::optional<CameraDef> camera;
  std::vector<CameraKeyDef> camera_path;  ///< in the order of time; empty: the camera stands
  std::vector<AnnotationDef> annotations;
  std::vector<PaintDef> paint;
  std::vector<CheckDef> checks;

  /// The top-level values that are neither objects nor lists.
  static std::span<const Field> field_table();
};

/// A fault of a scene.
struct SceneError {
  std::string file;     ///< the file, or the origin of an override
  int line = 0;         ///< from 1; 0 if the fault has no place in a text
  int column = 0;       ///< from 1, in characters
  std::string pointer;  ///< JSON pointer of the setting, which may be missing
  std::string message;
  std::string value;    ///< the text of the value, shortened; empty if there is none
  std::string allowed;  ///< the allowed values; empty if the message contains them
  FaultCode code = FaultCode::meaning;
};
/// One line: "file:line:column: /bodies/3/mass: value -1: must be > 0 [kg]".
[[nodiscard]] std::string to_string(const SceneError& error);

enum class SceneStatus {
  ok,
  not_found,   ///< no such file
  unreadable,  ///< the file exists but cannot be read
  invalid,     ///< the text is not a valid scene
};

/// A scene, or all its faults in the order of the text (at least one).
struct SceneResult {
  std::optional<Scene> scene;
  std::vector<SceneError> errors;
  SceneStatus status = SceneStatus::ok;
  /// One sentence about elements of an imported model that the scene lacks; empty: none.
  std::string notice{};

  explicit operator bool() const { return scene.has_value(); }
  const Scene* operator->() const { return &*scene; }
  const Scene& operator*() const { return *scene; }
};

/// A setting that replaces or extends the text, applied before any check.
struct Override {
  /// JSON pointer; its parent must exist ("/step" always does). Names can replace indices:
  /// /bodies/drum/mass. If a drive is set to another kind, or to none, settings that it can no
  /// longer have are removed.
  std::string pointer;
  std::string value;   ///< JSON; a bare word is a string
  std::string origin;  ///< source in error messages; default "--set POINTER"
};

/// A value for a parameter: of a scene in Jsonnet, which is then a function, or in the list
/// "parameters" of a scene in JSON.
struct SceneParameter {
  std::string name;
  std::string value;  ///< JSON; any other text is a string
};
/// Inputs of a Jsonnet evaluation.
struct JsonnetOptions {
  std::vector<SceneParameter> parameters;
  /// Folders for imports, in addition to the scene's own folder.
  std::vector<std::string> import_folders;
};

/// The bytes of a scene file, or the errors of reading it.
struct SceneText {
  std::string text;     ///< at most one byte more than a scene may have
  SceneResult failure;  ///< its errors are empty if the file was read
};
/// Reads a scene file once, since a pipe cannot be read twice.
[[nodiscard]] SceneText read_scene_text(const std::string& path);
/// Reads and checks a scene. create_simulation() accepts every scene that loads, unless the scene
/// starts at rest and has no rest. A file whose name
/// ends in .jsonnet is evaluated first, and a model in XML becomes a scene first
/// (scenes/import/import.h); overrides then change the resulting scene.
[[nodiscard]] SceneResult load_scene(const std::string& path,
                                     const std::vector<Override>& overrides = {},
                                     const JsonnetOptions& jsonnet = {});
[[nodiscard]] SceneResult load_scene_text(std::string_view text, const std::string& file_name,
                                          const std::vector<Override>& overrides = {},
                                          const JsonnetOptions& jsonnet = {});

/// Faults of a scene that was built in C++: camera, checks and everything that Simulation::create
/// checks.
[[nodiscard]] Errors validate_scene(const Scene& scene);

/// The scene as JSON text. Loading the text gives exactly this scene. Defaults are omitted. Numbers
/// that are not finite, which no valid scene has, become null.
[[nodiscard]] std::string write_scene(const Scene& scene);

/// JSON Schema (draft-07) of the format.
[[nodiscard]] std::string scene_schema();
/// Reference of the format in Markdown.
[[nodiscard]] std::string scene_reference();

}  // namespace sheave
