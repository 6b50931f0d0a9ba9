// sheave_peers: the same problems in Sheave and in other engines, in one run. See bench/README.md.

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <string>
#include <string_view>

#include <sheave_version.h>

#include <fmt/format.h>

#include "bench/peers/machine.h"
#include "bench/peers/mujoco_machine.h"
#include "measure/paper_table.h"

namespace sheave::peers {
namespace {

struct Entry {
  std::string problem;
  std::string engine;
  std::string setting;
  MachineError error;
  measure::Contender contender;
  measure::Timing timing;
};

struct Arguments {
  std::string markdown;
  int repetitions = 7;
  bool trials = false;
};

int report(const Errors& errors) {
  for (const Error& error : errors) std::cerr << "sheave_peers: " << error.message << "\n";
  return 1;
}

Errors add_sheave(const Problem& problem, std::vector<Entry>& entries) {
  constexpr int sweeps = 10;
  for (const StepSettings& settings :
       {StepSettings{problem.dt, 1, sweeps, SolverKind::gauss_seidel, IntegratorKind::xpbd},
        StepSettings{problem.dt, 1, sweeps, SolverKind::direct, IntegratorKind::xpbd},
        StepSettings{problem.dt, 1, sweeps, SolverKind::direct, IntegratorKind::rattle}}) {
    const auto machine = sheave_machine(problem, settings);
    if (!machine) return machine.errors();
    const std::string name = std::string("Sheave ") + version_string;
    entries.push_back({problem.name,
                       name,
                       measure::settings_text(settings),
                       error_of(problem, **machine),
                       contender_of(name, problem, *machine),
                       {}});
  }
  return {};
}

Errors add_mujoco(const Problem& problem, bool print, std::vector<Entry>& entries) {
  const Result<std::vector<MujocoTrial>> trials = mujoco_trials(problem);
  if (!trials) return trials.errors();
  if (print) {
    for (const MujocoTrial& trial : *trials) {
      std::cout << fmt::format(
          "{}: {:9.3g} us, position {:.1e}, speed {:.1e}, stretch {:.1e}: {}\n", problem.name,
          1e6 * trial.seconds, trial.error.position, trial.error.speed, trial.error.stretch,
          trial.settings.text());
    }
  }
  const std::vector<MujocoTrial> best = best_trials(*trials);
  for (const MujocoTrial& chosen : best) {
    const auto machine = mujoco_machine(problem, chosen.settings);
    if (!machine) return machine.errors();
    entries.push_back({problem.name,
                       mujoco_version(),
                       chosen.settings.text(),
                       chosen.error,
                       contender_of(problem.name, problem, *machine),
                       {}});
  }
  if (best.empty() || best.front().error.speed > right_error) {
    std::cerr << "sheave_peers: " << problem.name << ": no setting of MuJoCo is right\n";
  }
  return {};
}

std::string markdown(const std::vector<Entry>& entries, int repetitions) {
  std::string text = fmt::format(
      "| problem | engine | setting | frame [us] | quartiles | position error | speed error | "
      "stretch |\n"
      "|---|---|---|---|---|---|---|---|\n");
  for (const Entry& entry : entries) {
    const measure::Spread& time = entry.timing.seconds;
    text +=
        fmt::format("| {} | {} | {} | {:.3g} | {:.3g} - {:.3g} | {:.1e} | {:.1e} | {:.1e} |\n",
                    entry.problem, entry.engine, entry.setting, 1e6 * time.median, 1e6 * time.lower,
                    1e6 * time.upper, entry.error.position, entry.error.speed, entry.error.stretch);
  }
  text += fmt::format(
      "\nFrame: one step of 1/60 s, median and quartiles of {} interleaved repetitions of 1 s. "
      "Errors: against the\n"
      "closed form, root mean square over weights and wheel rims; positions largest of all frames, "
      "relative to the scene's\n"
      "size; speeds largest of the second half, relative to the exact speed at the end (simple, "
      "which is in balance: to that\n"
      "of a free fall). First the fastest setting of the other engine with a speed error of at "
      "most 0.1 %, then the fastest\n"
      "among those with the smallest position errors, of {} settings tried.\n",
      repetitions, mujoco_settings().size());
  return text;
}

int run(const Arguments& arguments) {
  const Result<std::vector<Problem>> problems = all_problems(SHEAVE_SOURCE_DIR);
  if (!problems) return report(problems.errors());
  std::vector<Entry> entries;
  for (const Problem& problem : *problems) {
    std::cerr << problem.name << ": trying settings\n";
    if (const Errors errors = add_sheave(problem, entries); !errors.empty()) return report(errors);
    if (const Errors errors = add_mujoco(problem, arguments.trials, entries); !errors.empty()) {
      return report(errors);
    }
  }
  std::vector<measure::Contender> contenders;
  for (const Entry& entry : entries) contenders.push_back(entry.contender);
  measure::TimingOptions options;
  options.repetitions = arguments.repetitions;
  const std::vector<measure::Timing> timings = measure::time_interleaved(contenders, options);
  for (std::size_t i = 0; i < entries.size(); ++i) entries[i].timing = timings[i];
  const std::string table = markdown(entries, arguments.repetitions);
  std::cout << table;
  if (arguments.markdown.empty()) return 0;
  std::ofstream file(arguments.markdown);
  file << "# Beside other engines\n\nMade by `sheave_peers --markdown` (see README.md).\n\n"
       << table;
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
    } else if (word == "--trials") {
      arguments.trials = true;
    } else {
      std::cerr << "usage: sheave_peers [--markdown FILE] [--repetitions N] [--trials]\n";
      return 2;
    }
  }
  return sheave::peers::run(arguments);
}
