#pragma once
// Which files a command reads and writes, so that it never writes onto what it reads, or twice onto
// one file.

#include <string>
#include <vector>

namespace sheave::command {

/// A file as the user named it. An empty path is none; "-" is standard input or standard output.
struct NamedPath {
  std::string option;  ///< how it was given, e.g. "--out" or "the scene"
  std::string path;
};

/// Throws a Failure (2) if an output is an input or another output: the same file, whatever its
/// name, and also one that does not exist yet. Devices and pipes may be written to twice. Standard
/// output counts if `prints` says that something is printed there.
void check_paths(const std::vector<NamedPath>& inputs, const std::vector<NamedPath>& outputs,
                 bool prints);

}  // namespace sheave::command
