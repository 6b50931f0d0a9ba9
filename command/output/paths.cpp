#include "command/output/paths.h"

#include <optional>
#include <utility>

#include <sys/stat.h>
#include <unistd.h>

#include <fmt/format.h>

#include "command/failure.h"
#include "render/destination.h"

namespace sheave::command {
namespace {

/// The key by which two names are recognised as one file: device and inode of the file, or, for a
/// file that does not exist yet, those of its folder together with the name in it.
struct Identity {
  dev_t device = 0;
  ino_t inode = 0;
  std::string name;
  friend bool operator==(const Identity&, const Identity&) = default;
};

std::optional<Identity> identity_of(const struct stat& status) {
  // Only a regular file has contents that could be lost.
  if (!S_ISREG(status.st_mode)) return {};
  return Identity{status.st_dev, status.st_ino, ""};
}

std::optional<Identity> identity_of(const std::string& path) {
  struct stat status {};
  const std::string target = render::followed(path);
  if (::stat(target.c_str(), &status) == 0) return identity_of(status);
  const std::string folder = render::folder_part(target);
  if (::stat(folder.empty() ? "." : folder.c_str(), &status) != 0) return {};
  return Identity{status.st_dev, status.st_ino, target.substr(folder.size())};
}

std::optional<Identity> identity_of(const NamedPath& file, int standard) {
  if (file.path.empty()) return {};
  if (file.path != "-") return identity_of(file.path);
  struct stat status {};
  return ::fstat(standard, &status) == 0 ? identity_of(status) : std::nullopt;
}

struct Known {
  NamedPath file;
  Identity identity;
  bool is_input;
};

}  // namespace

void check_paths(const std::vector<NamedPath>& inputs, const std::vector<NamedPath>& outputs,
                 bool prints) {
  std::vector<Known> known;
  for (const NamedPath& file : inputs) {
    if (auto identity = identity_of(file, STDIN_FILENO)) known.push_back({file, *identity, true});
  }
  std::vector<NamedPath> written = outputs;
  if (prints) written.push_back({"standard output", "-"});
  bool to_standard_output = false;
  for (const NamedPath& file : written) {
    if (file.path == "-" && std::exchange(to_standard_output, true)) {
      throw Failure(ExitCode::usage,
                    file.option + " -: another output already goes to standard output");
    }
    const std::optional<Identity> identity = identity_of(file, STDOUT_FILENO);
    if (!identity) continue;
    for (const Known& other : known) {
      if (other.identity != *identity) continue;
      throw Failure(ExitCode::usage,
                    fmt::format("{} {} and {} {} are one file; {}", other.file.option,
                                other.file.path, file.option, file.path,
                                other.is_input ? "an input must not be overwritten"
                                               : "each output needs a name of its own"));
    }
    known.push_back({file, *identity, false});
  }
}

}  // namespace sheave::command
