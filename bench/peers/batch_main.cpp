// sheave_batch: many worlds at once, on one core and on two, beside another engine in the same run.
// See bench/README.md.

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iostream>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <sheave_version.h>

#include <fmt/format.h>

#include "bench/peers/fleet.h"
#include "measure/clock.h"
#include "measure/paper_table.h"
#include "measure/reference_run.h"
#include "measure/spread.h"

namespace sheave::peers {
namespace {

/// One machine in one engine with one setting: a fleet for each number of threads.
struct Entry {
  std::string machine{};
  std::string engine{};
  std::string setting{};
  int frames = 0;    ///< of a sample
  int substeps = 1;  ///< of a frame
  std::string error{};
  bool other = false;  ///< another engine than ours
  std::vector<std::shared_ptr<Fleet>> fleets{};

  struct Sample {
    double wall = 0.0, cpu = 0.0;  ///< per world and frame [s]
  };
  std::vector<std::vector<Sample>> samples{};  ///< by fleet, then repetition
};

struct Arguments {
  std::string markdown;
  int repetitions = 7;
  std::size_t many = 1000;  ///< worlds of small machines; a tenth of it of large ones
  std::vector<std::size_t> threads{1, std::max(2U, std::thread::hardware_concurrency())};
};

std::string error_text(const MachineError& error) {
  return fmt::format("position {:.1e}, speed {:.1e}", error.position, error.speed);
}

Errors add_problem(const Problem& problem, std::size_t count, const Arguments& arguments,
                   std::vector<Entry>& entries) {
  const std::string name = fmt::format("{} x {}", count, problem.name);
  const auto finish = [&](Entry entry, const auto& make) -> Errors {
    for (const std::size_t threads : arguments.threads) {
      Result<std::shared_ptr<Fleet>> fleet = make(threads);
      if (!fleet) return fleet.errors();
      entry.fleets.push_back(std::move(fleet).value());
    }
    entry.error = error_text(error_of(problem, entry.fleets.back()));
    entries.push_back(std::move(entry));
    return {};
  };
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    Scene scene = problem.scene;
    scene.model.step = {problem.dt, 1, 10, SolverKind::direct, integrator};
    Errors errors = finish({name, std::string("Sheave ") + version_string,
                            measure::settings_text(scene.model.step), problem.frames},
                           [&](std::size_t threads) {
                             return sheave_fleet(scene, count, threads, problem.coordinates);
                           });
    if (!errors.empty()) return errors;
  }
  std::cerr << problem.name << ": trying settings\n";
  const Result<std::vector<MujocoTrial>> trials = mujoco_trials(problem);
  if (!trials) return trials.errors();
  for (const MujocoTrial& trial : best_trials(*trials)) {
    Entry entry{name, mujoco_version(), trial.settings.text(), problem.frames};
    entry.other = true;
    Errors errors = finish(std::move(entry), [&](std::size_t threads) {
      return mujoco_fleet(problem, trial.settings, count, threads);
    });
    if (!errors.empty()) return errors;
  }
  return {};
}

/// A scene that has no closed form: errors against a converged reference.
Errors add_scene(const std::string& file, std::size_t count, int frames, const Arguments& arguments,
                 std::vector<Entry>& entries) {
  SceneResult loaded = load_scene(SHEAVE_SOURCE_DIR "/scenes/paper/" + file + ".json");
  if (!loaded) return {{"", to_string(loaded.errors.front())}};
  Scene& scene = *loaded.scene;
  scene.duration = frames * scene.model.step.dt;
  scene.checks.clear();  // of times that are later
  std::cerr << file << ": reference\n";
  const Result<measure::Trajectory> run = measure::record(scene);
  if (!run) return run.errors();
  measure::ReferenceOptions options;
  options.most_seconds = 20.0;
  const Result<measure::Reference> reference = measure::best_reference(scene, options);
  if (!reference) return reference.errors();
  const measure::RunError error = measure::error_of(*run, reference->trajectory);
  Entry entry{fmt::format("{} x {}", count, file), std::string("Sheave ") + version_string,
              measure::settings_text(scene.model.step), frames, scene.model.step.substeps};
  entry.error = fmt::format("position {:.1e} (reference {:.0e}), tension {:.1e}", error.position,
                            reference->estimate.position, error.tension);
  for (const std::size_t threads : arguments.threads) {
    Result<std::shared_ptr<Fleet>> fleet = sheave_fleet(scene, count, threads);
    if (!fleet) return fleet.errors();
    entry.fleets.push_back(std::move(fleet).value());
  }
  entries.push_back(std::move(entry));
  return {};
}

/// CPU time of all threads of this process [s].
double process_time() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// One sample of every fleet in turn, so that whatever else the machine does falls upon all alike.
/// Samples are as long as 0.1 s at least: several runs from the start, of which putting the start
/// back is not timed.
bool measure_all(std::vector<Entry>& entries, int repetitions) {
  constexpr double least = 0.1;
  for (Entry& entry : entries) entry.samples.resize(entry.fleets.size());
  for (int repetition = -1; repetition < repetitions; ++repetition) {  // the first warms up
    for (Entry& entry : entries) {
      for (std::size_t k = 0; k < entry.fleets.size(); ++k) {
        Fleet& fleet = *entry.fleets[k];
        Entry::Sample sum;
        double runs = 0.0;
        do {
          if (!fleet.restart()) return false;
          const double cpu = process_time();
          const double wall = measure::wall_time();
          if (!fleet.step(entry.frames)) return false;
          sum.wall += measure::wall_time() - wall;
          sum.cpu += process_time() - cpu;
          runs += 1.0;
        } while (sum.wall < least);
        const double steps = runs * static_cast<double>(fleet.size()) * entry.frames;
        if (repetition >= 0) entry.samples[k].push_back({sum.wall / steps, sum.cpu / steps});
      }
    }
    std::cerr << fmt::format("repetition {} of {}\n", repetition + 1, repetitions);
  }
  return true;
}

template <class Value>
measure::Spread spread(const std::vector<Entry::Sample>& samples, const Value& value) {
  std::vector<double> values;
  for (std::size_t i = 0; i < samples.size(); ++i) values.push_back(value(samples[i], i));
  return measure::spread_of(values);
}

std::string steps_text(double value) {
  return value >= 1e6 ? fmt::format("{:.3g} M", 1e-6 * value)
                      : fmt::format("{:.3g} k", 1e-3 * value);
}

std::string table(const std::vector<Entry>& entries, const Arguments& arguments) {
  std::string text = "| machines | engine | setting |";
  for (const std::size_t threads : arguments.threads) {
    text += fmt::format(" steps/s, {} thread{} | quartiles |", threads, threads == 1 ? "" : "s");
  }
  text += " gain | CPU time of a step [us] | error |\n|---|---|---|";
  for (std::size_t k = 0; k < arguments.threads.size(); ++k) text += "---|---|";
  text += "---|---|---|\n";
  for (const Entry& entry : entries) {
    text += fmt::format("| {} | {} | {} |", entry.machine, entry.engine, entry.setting);
    for (const auto& samples : entry.samples) {
      const auto rate = spread(
          samples, [](const Entry::Sample& sample, std::size_t) { return 1.0 / sample.wall; });
      text += fmt::format(" {} | {} - {} |", steps_text(rate.median), steps_text(rate.lower),
                          steps_text(rate.upper));
    }
    const auto gain = spread(entry.samples.back(), [&](const Entry::Sample& sample, std::size_t i) {
      return entry.samples.front()[i].wall / sample.wall;
    });
    const auto cpu = spread(entry.samples.front(), [](const Entry::Sample& sample, std::size_t) {
      return 1e6 * sample.cpu;
    });
    text += fmt::format(" {:.2f} | {:.3g} | {} |\n", gain.median, cpu.median, entry.error);
  }
  return text;
}

/// How many times the throughput of each setting of the other engine ours have.
std::string ratios(const std::vector<Entry>& entries) {
  std::string text =
      "| machines | setting | beside | times the throughput, all threads | quartiles | by CPU "
      "time |\n|---|---|---|---|---|---|\n";
  for (const Entry& ours : entries) {
    for (const Entry& theirs : entries) {
      if (ours.other || !theirs.other || ours.machine != theirs.machine) continue;
      const auto wall =
          spread(ours.samples.back(), [&](const Entry::Sample& sample, std::size_t i) {
            return theirs.samples.back()[i].wall / sample.wall;
          });
      const auto cpu =
          spread(ours.samples.front(), [&](const Entry::Sample& sample, std::size_t i) {
            return theirs.samples.front()[i].cpu / sample.cpu;
          });
      text += fmt::format("| {} | {} | {} | {:.2f} | {:.2f} - {:.2f} | {:.2f} |\n", ours.machine,
                          ours.setting, theirs.setting, wall.median, wall.lower, wall.upper,
                          cpu.median);
    }
  }
  return text;
}

int report(const Errors& errors) {
  for (const Error& error : errors) std::cerr << "sheave_batch: " << error.message << "\n";
  return 1;
}

int run(const Arguments& arguments) {
  const Result<std::vector<Problem>> problems = all_problems(SHEAVE_SOURCE_DIR);
  if (!problems) return report(problems.errors());
  const std::size_t few = std::max<std::size_t>(1, arguments.many / 10);
  std::vector<Entry> entries;
  for (const Errors& errors : {add_problem((*problems)[0], arguments.many, arguments, entries),
                               add_problem((*problems)[2], few, arguments, entries),
                               // The gym machine's first pull; the hand closes its fingers.
                               add_scene("gym", arguments.many, 120, arguments, entries),
                               add_scene("hand", few, 60, arguments, entries)}) {
    if (!errors.empty()) return report(errors);
  }
  if (!measure_all(entries, arguments.repetitions)) {
    return report({{"", "a world's state means nothing any more"}});
  }
  const std::string text = table(entries, arguments) + "\n" + ratios(entries);
  std::cout << text;
  if (arguments.markdown.empty()) return 0;
  std::ofstream file(arguments.markdown);
  file << text;
  return file.flush() ? 0 : 74;
}

}  // namespace
}  // namespace sheave::peers

int main(int argc, char** argv) {
  sheave::peers::Arguments arguments;
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word == "--markdown" && i + 1 < argc) {
      arguments.markdown = argv[++i];
    } else if (word == "--repetitions" && i + 1 < argc) {
      arguments.repetitions = std::max(1, std::atoi(argv[++i]));
    } else if (word == "--worlds" && i + 1 < argc) {
      arguments.many = static_cast<std::size_t>(std::max(1, std::atoi(argv[++i])));
    } else {
      std::cerr << "usage: sheave_batch [--markdown FILE] [--repetitions N] [--worlds N]\n";
      return 2;
    }
  }
  return sheave::peers::run(arguments);
}
