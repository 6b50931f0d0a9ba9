// sheave view: simulate a scene and write a page that shows it.

#include <CLI/CLI.hpp>

#include "command/registry.h"

#if SHEAVE_HAS_RENDER

#include <filesystem>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "command/camera_side.h"
#include "command/command_line.h"
#include "command/input/file.h"
#include "command/interrupt.h"
#include "command/output/file.h"
#include "command/output/paths.h"
#include "command/scene_options.h"
#include "command/terminal.h"
#include "command/view/page_file.h"
#include "command/view/recording.h"
#include "engine/field_check.h"
#include "scenes/json/document.h"
#include "view/recording_pack.h"

namespace sheave::command {
namespace {

struct ViewOptions {
  SceneOptions scene;
  std::string view;
  std::string out;
  std::optional<std::int64_t> every;
  double size = 5.0;  // [MB]
  bool open = false;
  bool live = false;  // the page contains the engine instead of a recording
  bool quiet = false;
};

/// The file name of the scene with another ending, in the current folder.
std::string default_out(const std::string& scene) {
  if (scene == "-") return "scene.html";
  return std::filesystem::path(scene).filename().replace_extension(".html").string();
}

/// The recording as text of at most `most` bytes, with as many frames as fit.
std::string packed(const view::Json& machine, RecordedRun& run, double most) {
  constexpr std::size_t fewest_frames = 100;
  int halved = 0;
  double error = 0.0;
  std::string text = view::base64(view::pack(machine, run.recording));
  while (static_cast<double>(text.size()) > most && run.recording.times().size() > fewest_frames) {
    error = std::max(error, run.recording.halving_error());
    run.recording.halve();
    ++halved;
    text = view::base64(view::pack(machine, run.recording));
  }
  if (halved > 0) {
    print_note(
        fmt::format("one of {} frames is kept, so that the page stays below {} MB; between frames, "
                    "positions have an error of up to {:.2g} m (--size allows more)",
                    1 << halved, number_text(most / 1e6), error));
  }
  return text;
}

/// The text of the scene's file with its comments; if settings were overridden, the text of the
/// resulting scene.
std::string text_of(const Scene& scene, const SceneOptions& options) {
  const bool as_it_is = options.path != "-" && options.dt.empty() && options.substeps.empty() &&
                        options.iterations.empty() && options.solver.empty() &&
                        options.integrator.empty() && options.tolerance.empty() &&
                        options.duration.empty() && options.settings.empty() && !options.from_rest;
  return as_it_is ? read_input(options.path, json::Limits{}.bytes) : write_scene(scene);
}

ExitCode view_live(const ViewOptions& options) {
  const std::string out = options.out.empty() ? default_out(options.scene.path) : options.out;
  check_paths({{"the scene", options.scene.path}}, {{"--out", out}}, false);
  const std::string page = read_live_page();
  const Scene scene = load(options.scene);
  write_file(out, filled_live_page(page, text_of(scene, options.scene)));
  if (!options.quiet) print(printable(fmt::format("{}: the scene and the engine\n", out)));
  if (options.open) open_in_browser(out);
  return ExitCode::done;
}

ExitCode view_scene(const ViewOptions& options) {
  if (options.live) return view_live(options);
  const std::string out = options.out.empty() ? default_out(options.scene.path) : options.out;
  check_paths({{"the scene", options.scene.path}, {"--load-state", options.scene.load_state}},
              {{"--out", out}}, false);
  const std::string page = read_page();
  Scene scene = load(options.scene);
  look_from(options.view, scene);
  catch_interrupts();
  const std::int64_t interval = options.every.value_or(suitable_interval(scene));
  Progress progress("run", 0.0, static_cast<double>(step_count(scene)), options.quiet);
  RecordedRun run = record_run(scene, interval, progress);
  progress.clear();
  const std::string text =
      packed(machine_of(scene, run), run, 1e6 * options.size - static_cast<double>(page.size()));
  write_file(out, filled_page(page, text));
  if (!options.quiet) {
    print(printable(fmt::format("{}: {} frames, {:.2f} MB\n", out, run.recording.times().size(),
                                1e-6 * static_cast<double>(page.size() + text.size()))));
  }
  const ExitCode code = report_run(run.outcome);
  if (options.open) open_in_browser(out);
  return code;
}

}  // namespace

Action declare_view(CLI::App& app) {
  auto options = std::make_shared<ViewOptions>();
  add_scene_options(app, options->scene);
  app.add_option("-o,--out", options->out,
                 "the page to write; default: the scene's name with .html, in this folder")
      ->option_text("FILE");
  app.add_flag("--open", options->open, "open the page in the browser");
  CLI::Option* live =
      app.add_flag("--live", options->live,
                   "put the engine into the page instead of a recording: the machine runs in the "
                   "browser, where it can be pulled and changed");
  app.add_option("--every", options->every,
                 "steps per frame; default 1, more for runs of more than 12000 steps")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1'000'000'000}))
      ->option_text("N");
  app.add_option("--size", options->size,
                 "largest size of the page [MB]; a larger page leaves out frames; "
                 "default 5")
      ->check(number_between(1.0, 1000.0))
      ->option_text("X");
  live->excludes(app.get_option("--load-state"));
  add_view_option(app, options->view);
  live->excludes(app.get_option("--view"));
  app.add_flag("-q,--quiet", options->quiet, "print nothing but warnings and errors");
  app.footer(R"(Examples:
  sheave view crane.json --open
  sheave view crane.json --out crane.html --dt 0.001 --every 5
  sheave view crane.json --live --open

The page is one file that needs no network. It has the machine in three dimensions, a time line with
events, the numbers of a tapped part, and curves of all quantities of sheave run --out, within 1e-6
of that table. Exit codes as for sheave run; after a divergence or Ctrl-C the page has the run up to
then.)");
  return [options] { return view_scene(*options); };
}

}  // namespace sheave::command

#else

namespace sheave::command {

Action declare_view(CLI::App& app) { return declare_without_renderer(app); }

}  // namespace sheave::command

#endif  // SHEAVE_HAS_RENDER
