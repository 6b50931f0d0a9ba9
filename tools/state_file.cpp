#include "tools/state_file.h"

#include <filesystem>
#include <fstream>
#include <iterator>

#include "tools/failure.h"

namespace sheave::tools {
namespace {

std::string read_file(const std::string& path) {
  std::error_code code;
  if (!std::filesystem::exists(path, code)) {
    throw Failure(ExitCode::no_input, path + ": there is no such file");
  }
  std::ifstream file(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  // A folder opens, but does not read.
  if (!file || std::filesystem::is_directory(path, code)) {
    throw Failure(ExitCode::io, path + ": cannot be read");
  }
  return bytes;
}

}  // namespace

void load_state(World& world, const std::string& path) {
  const Result<State> state = state_from_bytes(read_file(path));
  if (!state) throw Failure(ExitCode::bad_scene, path + ": " + to_text(state.errors()));
  const Errors errors = world.restore(*state);
  if (!errors.empty()) throw Failure(ExitCode::bad_scene, path + ": " + to_text(errors));
}

}  // namespace sheave::tools
