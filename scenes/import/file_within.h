#pragma once
// Files that a model names: only those in one folder or below are read.

#include <filesystem>
#include <optional>
#include <string>

namespace sheave::import {

/// The folder of a model's file.
[[nodiscard]] std::filesystem::path folder_of(const std::string& file_name);
/// The path of a file that a model in `folder` names; nothing if it is absolute, or if it, or a link
/// in it, leads out of the folder `allowed`; if that is empty, out of `folder`.
[[nodiscard]] std::optional<std::filesystem::path> path_within(
    const std::filesystem::path& folder, const std::string& named,
    const std::filesystem::path& allowed = {});

/// The remedy for a file that lies elsewhere.
inline constexpr const char* file_place =
    "the file must lie in the folder of the model or below; copy it there, or name a folder that "
    "holds it by --folder";

}  // namespace sheave::import
