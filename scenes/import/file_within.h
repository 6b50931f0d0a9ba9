#pragma once
// Files that a model names: only those in its own folder or below are read.

#include <filesystem>
#include <optional>
#include <string>

namespace sheave::import {

/// The folder of a model's file.
[[nodiscard]] std::filesystem::path folder_of(const std::string& file_name);
/// The path of a file that a model names; nothing if it is absolute, or if it, or a link in it, leads
/// out of the folder.
[[nodiscard]] std::optional<std::filesystem::path> path_within(const std::filesystem::path& folder,
                                                               const std::string& named);

}  // namespace sheave::import
