#pragma once
// Input files that a command reads completely.

#include <cstddef>
#include <string>

namespace sheave::command {

/// The bytes of a file. Throws a Failure that names the file: 66 if it does not exist, 74 if it
/// cannot be read or is a folder, 65 if it is longer than `most`.
[[nodiscard]] std::string read_input(const std::string& path, std::size_t most);

}  // namespace sheave::command
