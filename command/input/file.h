#pragma once
// Input files that a command reads completely.

#include <cstddef>
#include <string>

namespace sheave::command {

/// The bytes of a file. Throws a Failure that names the file: 66 if it does not exist, 74 if it
/// cannot be read or is a folder, 65 if it is longer than `most`, 130 if a caught signal ends the
/// wait for a pipe.
[[nodiscard]] std::string read_input(const std::string& path, std::size_t most);

/// The bytes of standard input up to its end, or somewhat more than `most`. Throws a Failure: 74 if
/// standard input cannot be read, 130 if a caught signal ends the wait.
[[nodiscard]] std::string read_standard_input(std::size_t most);

}  // namespace sheave::command
