// sheave bench: measuring. The errors are measured first, scene by scene, then the times of all
// rows, interleaved.

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>

#include <sheave_version.h>

#include <fmt/format.h>

#include "command/bench/table.h"
#include "command/failure.h"
#include "command/interrupt.h"
#include "command/progress.h"
#include "command/scene_options.h"
#include "command/text/error_text.h"
#include "measure/instruction_counter.h"
#include "measure/scene_contender.h"
#include "measure/timing.h"

namespace sheave::command {
namespace {

/// A reference is good if its error is at most this share of every error measured with it.
constexpr double reference_share = 0.1;

[[noreturn]] void stop_by_signal() { throw Failure(ExitCode::interrupted, "interrupted"); }

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

BenchRow row_for(const measure::PaperRow& paper, const StepSettings& settings) {
  BenchRow row;
  row.scene = paper.scene;
  row.file = paper.file;
  row.cable_file = paper.cable_file;
  row.settings = settings;
  row.paper_joints = paper.joints;
  row.paper_source = paper.source;
  if (paper.milliseconds) row.paper_seconds = 1e-3 * *paper.milliseconds;
  return row;
}

/// The paper's settings; the direct solver's setting follows the last setting of each scene.
std::vector<BenchRow> wanted_rows(const std::string& filter) {
  std::vector<BenchRow> rows;
  const auto table = measure::paper_table();
  const measure::PaperRow* first = nullptr;
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (first == nullptr || first->scene != table[i].scene) first = &table[i];
    rows.push_back(row_for(table[i], measure::paper_settings(table[i])));
    if (i + 1 < table.size() && table[i + 1].scene == table[i].scene) continue;
    if (!table[i].cable_file.empty()) continue;
    for (const IntegratorKind kind : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
      rows.push_back(row_for(*first, measure::direct_settings(*first, kind)));
    }
  }
  std::erase_if(rows, [part = lower_case(filter)](const BenchRow& row) {
    return lower_case(row.name()).find(part) == std::string::npos;
  });
  if (rows.empty()) {
    throw Failure(ExitCode::usage, "no row contains the text of --filter; --list prints the rows");
  }
  return rows;
}

/// A row of the table and the scene that it runs.
struct Entry {
  BenchRow row;
  std::optional<measure::Contender> contender;
};

Scene scene_with(const Scene& scene, const StepSettings& settings) {
  Scene own = scene;
  own.model.step = settings;
  return own;
}

class Measurement {
 public:
  explicit Measurement(const BenchOptions& options) : options_(options) {}

  BenchTable run() {
    std::vector<BenchRow> rows = wanted_rows(options_.filter);
    if (!std::filesystem::is_directory(options_.folder)) {
      throw Failure(ExitCode::no_input, options_.folder + ": no such folder");
    }
    for (auto begin = rows.begin(); begin != rows.end();) {
      const auto end = std::find_if(begin, rows.end(),
                                    [&](const BenchRow& row) { return row.scene != begin->scene; });
      measure_errors({begin, end});
      begin = end;
    }
    measure_times();
    BenchTable table{{},
                     std::move(references_),
                     machine_info(),
                     version_string,
                     options_.repetitions,
                     measure::InstructionCounter().reason()};
    for (Entry& entry : entries_) table.rows.push_back(std::move(entry.row));
    return table;
  }

 private:
  /// A scene of the folder with the paper's frame time; on failure `fault` gets the reason.
  std::optional<Scene> loaded(const std::string& file, std::string& fault) const {
    const std::string path = options_.folder + "/" + file;
    SceneResult scene = load_scene(path);
    if (scene) {
      scene.scene->model.step.dt = measure::paper_frame;
      return std::move(scene.scene);
    }
    fault = scene.status == SceneStatus::not_found ? "missing: " + path
                                                   : to_string(scene.errors.front());
    return {};
  }

  /// All rows of one scene.
  void measure_errors(std::vector<BenchRow> rows) {
    std::string fault;
    const std::optional<Scene> scene = loaded(rows.front().file, fault);
    std::optional<Scene> truth = scene;
    if (const std::string& file = rows.front().cable_file; scene && !file.empty()) {
      truth = loaded(file, fault);
    }
    std::vector<std::optional<measure::Trajectory>> runs(rows.size());
    for (std::size_t i = 0; truth && i < rows.size(); ++i) {
      runs[i] = recorded(*scene, rows[i]);
      if (runs[i]) rows[i].joints = measure::joint_count(*scene, *runs[i]);
    }
    if (truth) fault = compare(*truth, rows, runs);
    for (BenchRow& row : rows) {
      if (row.fault.empty()) row.fault = fault;
      Entry entry{std::move(row), {}};
      if (entry.row.measured()) start(*scene, entry);
      entries_.push_back(std::move(entry));
    }
  }

  /// The trajectory of this row's run; on failure the row gets the reason.
  std::optional<measure::Trajectory> recorded(const Scene& scene, BenchRow& row) {
    Progress progress(row.name(), 0.0, static_cast<double>(measure::frame_count(scene)), false);
    Result<measure::Trajectory> run =
        measure::record(scene_with(scene, row.settings), observer(progress), interrupted);
    if (interrupted()) stop_by_signal();
    if (!run) {
      row.fault = run.errors().front().message;
      return {};
    }
    if (!run->complete()) {
      row.fault = "diverged: " + run->divergence->message;
      return {};
    }
    const auto frames = static_cast<double>(run->frames.size() - 1);
    row.stretch = run->stretch;
    row.length_error = run->length_error;
    row.row_solves = static_cast<double>(run->row_solves) / frames;
    row.rounds = static_cast<double>(run->rounds) / frames;
    row.fallbacks = run->fallbacks;
    return std::move(run).value();
  }

  /// Fills in the errors; returns the reason if there are none.
  std::string compare(const Scene& truth, std::vector<BenchRow>& rows,
                      const std::vector<std::optional<measure::Trajectory>>& runs) {
    const bool modelled_twice = !rows.front().cable_file.empty();
    measure::ReferenceOptions options;
    options.first_substeps = 2 * rows.front().settings.substeps;
    options.most_substeps = options.first_substeps << options_.reference_doublings;
    options.most_seconds = options_.reference_seconds;
    options.good_enough = [&](const measure::Reference& reference) {
      double smallest = std::numeric_limits<double>::infinity();
      for (const auto& run : runs) {
        if (!run) continue;
        const measure::RunError error = run_error(*run, reference.trajectory, modelled_twice);
        smallest = std::min(smallest, error.position);
      }
      return reference.estimate.position <= reference_share * std::max(smallest, rounding_error);
    };
    Progress progress(rows.front().scene + " reference", 0.0,
                      static_cast<double>(measure::frame_count(truth)), false);
    options.observe = observer(progress);
    options.stop = interrupted;
    const Result<measure::Reference> reference = measure::best_reference(truth, options);
    if (interrupted()) stop_by_signal();
    if (!reference) return reference.errors().front().message;
    references_.push_back({rows.front().scene, reference->substeps, reference->integrator,
                           reference->order, reference->estimate, reference->good});
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (!runs[i]) continue;
      rows[i].error = run_error(*runs[i], reference->trajectory, modelled_twice);
      rows[i].reference_error = reference->estimate;
    }
    return {};
  }

  static measure::RunError run_error(const measure::Trajectory& run,
                                     const measure::Trajectory& reference, bool modelled_twice) {
    if (!modelled_twice) return measure::error_of(run, reference);
    const auto [own, right] = measure::with_common_bodies(run, reference);
    measure::RunError error = measure::error_of(own, right);
    error.tension = std::numeric_limits<double>::quiet_NaN();
    return error;
  }

  static void start(const Scene& scene, Entry& entry) {
    Result<measure::Contender> contender = measure::scene_contender(
        entry.row.name(), scene_with(scene, entry.row.settings), interrupted);
    if (contender) {
      entry.contender = std::move(contender).value();
    } else {
      entry.row.fault = contender.errors().front().message;
    }
  }

  void measure_times() {
    std::vector<measure::Contender> contenders;
    for (const Entry& entry : entries_) {
      if (entry.contender) contenders.push_back(*entry.contender);
    }
    const auto samples = static_cast<double>(contenders.size()) * options_.repetitions;
    Progress progress("times", 0.0, samples, false);
    measure::TimingOptions timing;
    timing.repetitions = options_.repetitions;
    timing.observe = [&](std::int64_t done, std::int64_t, const std::string& name) {
      progress.update(static_cast<double>(done), name);
      return !interrupted();
    };
    const std::vector<measure::Timing> timings = measure::time_interleaved(contenders, timing);
    if (timings.size() != contenders.size() || interrupted()) stop_by_signal();
    auto next = timings.begin();
    for (Entry& entry : entries_) {
      if (!entry.contender) continue;
      entry.row.seconds = next->seconds;
      entry.row.instructions = next->instructions;
      if (next->failed) entry.row.fault = "diverged while it was timed";
      ++next;
    }
  }

  static measure::FrameObserver observer(Progress& progress) {
    return [&progress](std::int64_t done, std::int64_t) {
      if (progress.due()) progress.update(static_cast<double>(done), "errors");
      if (interrupted()) stop_by_signal();
      return true;
    };
  }

  const BenchOptions& options_;
  std::vector<Entry> entries_;
  std::vector<BenchReference> references_;
};

}  // namespace

BenchTable list_table(const BenchOptions& options) {
  BenchTable table{wanted_rows(options.filter), {}, machine_info(), version_string, 0, {}};
  for (BenchRow& row : table.rows) row.fault = "not measured";
  return table;
}

BenchTable measure_table(const BenchOptions& options) { return Measurement(options).run(); }

}  // namespace sheave::command
