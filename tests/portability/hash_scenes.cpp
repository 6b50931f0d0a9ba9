// Runs scenes and prints the hash of the state that each ends in, so that programs made by different
// compilers for different machines can be compared.
//   sheave_hashes STEPS [--save FOLDER | --load FOLDER | --rattle] SCENE...
// One line per scene: its file, the steps done in all, the hash. STEPS is a number of steps, or a time such as 0.1s. With --save
// the final states are written to FOLDER, with --load the runs start from states that were written so. With --rattle the
// solver is `direct` and the integrator `rattle`, whichever the scene names.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "engine/result.h"
#include "engine/state.h"
#include "scenes/control/scene_supervisor.h"
#include "scenes/scene.h"

namespace {

struct Request {
  double amount = 0.0;
  bool seconds = false;  ///< whether `amount` is a time [s], not a number of steps
  bool rattle = false;
  std::string save;
  std::string load;
  std::vector<std::string> scenes;
};

/// False, with a message, if the words cannot be understood.
bool read_words(const std::vector<std::string>& words, Request& request) {
  char* end = nullptr;
  if (!words.empty()) request.amount = std::strtod(words[0].c_str(), &end);
  if (words.size() < 2 || end == words[0].c_str()) {
    std::fputs("usage: sheave_hashes STEPS [--save FOLDER | --load FOLDER | --rattle] SCENE...\n",
               stderr);
    return false;
  }
  request.seconds = *end == 's';
  for (std::size_t i = 1; i < words.size(); ++i) {
    const bool folder = words[i] == "--save" || words[i] == "--load";
    if (words[i] == "--rattle") {
      request.rattle = true;
    } else if (!folder) {
      request.scenes.push_back(words[i]);
    } else if (i + 1 < words.size()) {
      (words[i] == "--save" ? request.save : request.load) = words[i + 1];
      ++i;
    }
  }
  return true;
}

std::string message(const sheave::Error& error) { return error.message; }
std::string message(const sheave::SceneError& error) { return to_string(error); }

/// Prints the errors of a scene.
template <typename Faults>
int fail(const std::string& scene, const Faults& errors) {
  for (const auto& error : errors) {
    std::fprintf(stderr, "%s: %s\n", scene.c_str(), message(error).c_str());
  }
  return 1;
}

std::string state_file(const std::string& folder, const std::string& scene) {
  return (std::filesystem::path(folder) / std::filesystem::path(scene).stem()).string() + ".state";
}

int run(const std::string& scene, const Request& request) {
  const sheave::SceneResult loaded = sheave::load_scene(scene);
  if (!loaded) return fail(scene, loaded.errors);
  sheave::Scene content = *loaded;
  sheave::StepSettings& settings = content.model.step;
  if (request.rattle) {
    settings.solver = sheave::SolverKind::direct;
    settings.integrator = sheave::IntegratorKind::rattle;
  }
  auto simulation = sheave::create_simulation(content);
  if (!simulation) return fail(scene, simulation.errors());
  sheave::World& world = simulation->world;
  if (!request.load.empty()) {
    std::ifstream file(state_file(request.load, scene), std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    const auto state = sheave::state_from_bytes(bytes);
    if (!state) return fail(scene, state.errors());
    if (const auto errors = world.restore(*state); !errors.empty()) return fail(scene, errors);
  }
  const long steps = std::lround(request.seconds ? request.amount / settings.dt : request.amount);
  for (long i = 0; i < steps && simulation->step().ok(); ++i) {
  }
  if (!request.save.empty()) {
    std::ofstream file(state_file(request.save, scene), std::ios::binary);
    file << sheave::to_bytes(world.state());
  }
  std::printf("%s %lld %016llx\n", scene.c_str(), static_cast<long long>(world.state().steps),
              static_cast<unsigned long long>(sheave::hash(world.state())));
  std::fflush(stdout);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Request request;
  if (!read_words({argv + 1, argv + argc}, request)) return 2;
  int failed = 0;
  for (const std::string& scene : request.scenes) failed |= run(scene, request);
  return failed;
}
