// Runs scenes and prints the hash of the state that each ends in, so that programs made by different
// compilers for different machines can be compared.
//   sheave_hashes STEPS [--save FOLDER | --load FOLDER] SCENE...
// One line per scene: its file, the steps done in all, the hash. With --save the final states are
// written to FOLDER, with --load the runs start from states that were written so.

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "engine/result.h"
#include "engine/state.h"
#include "scenes/load_world.h"

namespace {

struct Request {
  long steps = 0;
  std::string save;
  std::string load;
  std::vector<std::string> scenes;
};

/// False, with a message, if the words cannot be understood.
bool read_words(const std::vector<std::string>& words, Request& request) {
  if (words.size() < 2) {
    std::fputs("usage: sheave_hashes STEPS [--save FOLDER | --load FOLDER] SCENE...\n", stderr);
    return false;
  }
  request.steps = std::strtol(words[0].c_str(), nullptr, 10);
  for (std::size_t i = 1; i < words.size(); ++i) {
    const bool folder = words[i] == "--save" || words[i] == "--load";
    if (!folder) {
      request.scenes.push_back(words[i]);
    } else if (i + 1 < words.size()) {
      (words[i] == "--save" ? request.save : request.load) = words[i + 1];
      ++i;
    }
  }
  return true;
}

int fail(const std::string& scene, const sheave::Errors& errors) {
  for (const sheave::Error& error : errors) {
    std::fprintf(stderr, "%s: %s\n", scene.c_str(), error.message.c_str());
  }
  return 1;
}

std::string state_file(const std::string& folder, const std::string& scene) {
  return (std::filesystem::path(folder) / std::filesystem::path(scene).stem()).string() + ".state";
}

int run(const std::string& scene, const Request& request) {
  auto world = sheave::load(scene);
  if (!world) return fail(scene, world.errors());
  if (!request.load.empty()) {
    std::ifstream file(state_file(request.load, scene), std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    const auto state = sheave::state_from_bytes(bytes);
    if (!state) return fail(scene, state.errors());
    if (const auto errors = world->restore(*state); !errors.empty()) return fail(scene, errors);
  }
  for (long i = 0; i < request.steps && world->step().ok(); ++i) {
  }
  if (!request.save.empty()) {
    std::ofstream file(state_file(request.save, scene), std::ios::binary);
    file << sheave::to_bytes(world->state());
  }
  std::printf("%s %lld %016llx\n", scene.c_str(), static_cast<long long>(world->state().steps),
              static_cast<unsigned long long>(sheave::hash(world->state())));
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
