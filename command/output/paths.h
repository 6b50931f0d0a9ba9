#pragma once
// Detects a command line that would overwrite an input, or write two outputs to one file.

#include <string>
#include <vector>

namespace sheave::command {

/// A file as named by the user. An empty path means no file; "-" is standard input or standard
/// output.
struct NamedPath {
  std::string option;  ///< the option that named it, e.g. "--out", or "the scene"
  std::string path;
};

/// Throws a Failure (2) if an output is an input or another output. The comparison is of files, not
/// of names, and includes files that do not exist yet. Devices and pipes may be written to twice.
/// `prints`: the command prints on standard output, which then counts as an output.
void check_paths(const std::vector<NamedPath>& inputs, const std::vector<NamedPath>& outputs,
                 bool prints);

}  // namespace sheave::command
