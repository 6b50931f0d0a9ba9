#pragma once
// Options that all simulating subcommands share: the scene, and changes to it.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "command/failure.h"
#include "scenes/scene.h"

namespace CLI {
class App;
}

namespace sheave::command {

/// A tolerance of substeps as the user gave it.
struct GivenTolerance {
  double value = 0.0;
  bool share = false;  ///< of the machine's size; otherwise [m]

  [[nodiscard]] bool operator==(const GivenTolerance&) const = default;
};

/// "0.1mm", "0.01%", "1e-4" [m]; a Failure (2) for anything else.
[[nodiscard]] GivenTolerance parse_tolerance(const std::string& text);
/// The tolerance of a scene [m]. A Failure (65) if a share needs the size of a scene that does not
/// build.
[[nodiscard]] double tolerance_of(const GivenTolerance& given, const Scene& scene);

/// Options as given by the user; an empty value means not given.
struct SceneOptions {
  std::string path;  ///< "-" is standard input
  std::string dt, substeps, iterations, solver, integrator, duration;
  std::string tolerance;                    ///< of --tolerance, with its unit
  std::vector<std::string> settings;        ///< of --set: "/json/pointer=value"
  std::vector<std::string> parameters;      ///< of --param: "name=value"
  std::vector<std::string> import_folders;  ///< of --import-from
  std::optional<std::string> text{};        ///< the text of the file, if it has been read already
  bool from_rest = false;                   ///< of --from-rest
  std::string load_state{};                 ///< of --load-state: a file with a state
  bool warns = true;                        ///< prints warnings about that state
  bool tells_strains = true;                ///< prints strain_warnings() of the scene
};

/// Adds the scene and its overrides to a subcommand. `options` must live as long as `app`.
void add_scene_options(CLI::App& app, SceneOptions& options);

/// Adds the overrides without the scene.
void add_scene_changes(CLI::App& app, SceneOptions& options);

/// Adds the two other places to start; add_scene_changes() includes them.
void add_start_options(CLI::App& app, SceneOptions& options);

/// Adds parameters and imports for scenes in Jsonnet; add_scene_changes() includes them.
void add_jsonnet_options(CLI::App& app, SceneOptions& options);

/// Adds --case for one load case, unless the command has a --case of its own; add_scene_changes()
/// includes it. To be called after the other settings of the scene, which the case replaces.
void add_case_option(CLI::App& app, SceneOptions& options);

/// The Jsonnet options; a Failure (2) if a parameter is not NAME=VALUE.
[[nodiscard]] JsonnetOptions jsonnet_options(const SceneOptions& options);

/// Loads and checks the scene, with the state of --load-state. A Failure lists all errors: 2 if all lie in the command line, 65 if
/// one lies in the scene, 66 if there is no such file, 74 if the file cannot be read; for the state
/// as read_state().
[[nodiscard]] Scene load(const SceneOptions& options);

/// Warns that statics and modes leave out the `loads` of the scene, if it has any.
void warn_of_loads_left_out(const Scene& scene);

/// Loads a scene without overrides; "-" is standard input.
[[nodiscard]] SceneResult load_file_or_stdin(const std::string& path,
                                             const std::vector<Override>& overrides = {},
                                             const JsonnetOptions& jsonnet = {});

/// The bytes of standard input, up to somewhat more than a scene may have; a Failure (74, 130) if
/// it cannot be read.
[[nodiscard]] std::string read_standard_input();

/// The exit code for a scene that did not load.
[[nodiscard]] ExitCode exit_code(const SceneResult& result);
/// All errors of a scene that did not load, one per line.
[[nodiscard]] std::string to_text(const SceneResult& result);

/// The time at which simulations of the scene start [s].
[[nodiscard]] double start_time(const Scene& scene);

/// The number of steps nearest to the duration, at least 1.
[[nodiscard]] std::int64_t step_count(const Scene& scene);

}  // namespace sheave::command
