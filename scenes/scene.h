#pragma once
// A scene: what a scene file says, as C++ values.
//
//   sheave::SceneResult scene = sheave::load_scene("scenes/analytic/atwood.json");
//   if (!scene) for (const auto& error : scene.errors) puts(to_string(error).c_str());
//   auto simulation = sheave::create_simulation(*scene);  // scenes/control/scene_supervisor.h

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cable/cable.h"
#include "engine/model.h"
#include "scenes/control/controller.h"
#include "scenes/control/trigger.h"
#include "scenes/fault_code.h"

namespace sheave {

/// Version of the format, the value of the key "format".
enum class SceneFormat { v1 };
inline constexpr std::array<std::string_view, 1> scene_format_names{"sheave-scene/1"};

/// How a camera maps the world to the picture.
enum class Projection { perspective, orthographic };
inline constexpr std::array<std::string_view, 2> projection_names{"perspective", "orthographic"};

/// Where pictures of a scene are taken from. All of it is optional: what is missing is chosen so
/// that the whole scene is in the picture.
struct CameraDef {
  Projection projection = Projection::perspective;
  std::optional<Vector3> position;     ///< of the eye [m]; needs target, excludes direction
  std::optional<Vector3> target;       ///< in the middle of the picture [m]; needs position
  std::optional<Vector3> direction;    ///< to look along; the distance is chosen automatically
  std::optional<Vector3> up;           ///< up in the picture; default: against gravity
  std::optional<double> vertical_fov;  ///< perspective: full vertical angle [rad], in (0, pi)
  std::optional<double> height;        ///< orthographic: height of the picture [m]; needs position
  bool labels = false;                 ///< write the tensions [N] beside the cables
  bool joints = true;                  ///< draw pins, rods and rails of the joints
  std::optional<double> cable_radius;  ///< that cables are drawn with [m]; default: suits the scene
  std::optional<double> tension_max;   ///< at the top of the colour scale [N]; default: of the run

  static std::span<const Field> field_table();
};

/// The colour of a body in pictures. Bodies without one have a colour by what they are.
struct PaintDef {
  BodyId body;
  Vector3 color{1.0, 1.0, 1.0};  ///< red, green, blue as on a screen (sRGB), each in [0, 1]

  static std::span<const Field> field_table();
};

/// A number that is made from the course of an observable.
enum class Statistic {
  at,    ///< value at the step nearest to the time `at`
  mean,  ///< mean of the values in the window
  rate,  ///< (last - first value) / (their times' difference)
  minimum,
  maximum,
  range,  ///< maximum - minimum
  drift,  ///< last - first value
  /// Over the time in the window; the first value stands for the time before it, too, where there
  /// is none at the start.
  integral,
};
inline constexpr std::array<std::string_view, 8> statistic_names{
    "at", "mean", "rate", "minimum", "maximum", "range", "drift", "integral"};

/// What a scene should show: a closed-form value with a tolerance.
struct CheckDef {
  std::string quantity;  ///< name of an observable (scenes/observables.h)
  Statistic statistic = Statistic::at;
  std::optional<double> at;    ///< [s]; default: the end. Only with the statistic `at`
  std::optional<double> from;  ///< begin of the window [s]; default: 0. Not with `at`
  std::optional<double> to;    ///< end of the window [s]; default: the end. Not with `at`
  double equals =
      0.0;  ///< in the observable's unit; per second for a rate, times s for an integral
  std::optional<double> tolerance;           ///< absolute, same unit
  std::optional<double> relative_tolerance;  ///< of |equals|; the larger of the two counts
  std::string because;                       ///< the closed form, for people

  static std::span<const Field> field_table();
  /// Largest error that passes; NaN without any tolerance.
  [[nodiscard]] double allowed_error() const;
};

/// How a scene names its step settings.
struct StepPresetDef {
  StepPreset preset = StepPreset::standard;  ///< gives the settings that "step" does not

  static std::span<const Field> field_table();
};

/// A model with everything that is told beside it.
struct Scene {
  SceneFormat format = SceneFormat::v1;
  std::string name;
  std::string description;
  double duration = 0.0;  ///< of the simulation [s], > 0
  /// Tells the loader and the writer which settings need no mention; what counts is model.step.
  StepPresetDef step_preset;
  Model model;
  std::vector<CableDef> cables;
  std::vector<std::shared_ptr<const ControllerDef>> controllers;
  std::vector<TriggerDef> triggers;
  std::optional<CameraDef> camera;
  std::vector<PaintDef> paint;
  std::vector<CheckDef> checks;

  /// Top-level values that are no object or list.
  static std::span<const Field> field_table();
};

/// One fault of a scene.
struct SceneError {
  std::string file;     ///< or the origin of an override
  int line = 0;         ///< from 1; 0 if the fault has no place in a text
  int column = 0;       ///< from 1, in characters
  std::string pointer;  ///< JSON pointer of the setting, which may be missing
  std::string message;
  std::string value;    ///< as it stands in the text, shortened; empty if there is none
  std::string allowed;  ///< what would be right; empty if the message says it
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

/// A scene, or all faults found in the order of the text (at least one).
struct SceneResult {
  std::optional<Scene> scene;
  std::vector<SceneError> errors;
  SceneStatus status = SceneStatus::ok;

  explicit operator bool() const { return scene.has_value(); }
  const Scene* operator->() const { return &*scene; }
  const Scene& operator*() const { return *scene; }
};

/// A setting that replaces or adds to what the text says, before anything is checked.
struct Override {
  /// JSON pointer; its parent must exist ("/step" always does). Names stand for places:
  /// /bodies/drum/mass. A drive that is set to another kind, or to none, loses what it cannot have
  /// any more.
  std::string pointer;
  std::string value;   ///< JSON; a bare word is a string
  std::string origin;  ///< what errors call the source; default "--set POINTER"
};

/// A value for a parameter of a scene in Jsonnet, which is then a function.
struct SceneParameter {
  std::string name;
  std::string value;  ///< JSON; anything else is a text
};
/// What an evaluation of Jsonnet may take from outside.
struct JsonnetOptions {
  std::vector<SceneParameter> parameters;
  /// From where, besides the scene's own folder, files may be imported.
  std::vector<std::string> import_folders;
};

/// The bytes of a scene file, or why there are none.
struct SceneText {
  std::string text;     ///< at most one byte more than a scene may have
  SceneResult failure;  ///< its errors are empty if the file was read
};
/// Reads a scene file once; a pipe cannot be read again.
[[nodiscard]] SceneText read_scene_text(const std::string& path);
/// Reads and checks a scene. A scene that loads also builds: create_simulation() accepts it. A file
/// whose name ends in .jsonnet is evaluated first; overrides then change the scene that it made.
[[nodiscard]] SceneResult load_scene(const std::string& path,
                                     const std::vector<Override>& overrides = {},
                                     const JsonnetOptions& jsonnet = {});
[[nodiscard]] SceneResult load_scene_text(std::string_view text, const std::string& file_name,
                                          const std::vector<Override>& overrides = {},
                                          const JsonnetOptions& jsonnet = {});

/// Faults of a scene that was made in C++: camera, checks and all that Simulation::create checks.
[[nodiscard]] Errors validate_scene(const Scene& scene);

/// The scene as JSON text: loading it gives exactly this scene. Defaults are left out. Numbers that
/// are not finite, which no valid scene has, become null.
[[nodiscard]] std::string write_scene(const Scene& scene);

/// JSON Schema (draft-07) of the format.
[[nodiscard]] std::string scene_schema();
/// Reference of the format in Markdown.
[[nodiscard]] std::string scene_reference();

}  // namespace sheave
