#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sheave::test {

/// All bytes of a file; fails the running test if it cannot be read.
[[nodiscard]] std::string read_file(const std::filesystem::path& path);
/// The scene files in a folder of scenes/, sorted by name.
[[nodiscard]] std::vector<std::filesystem::path> scene_files(const std::string& folder);
/// All scene files that should load: every folder but scenes/invalid.
[[nodiscard]] std::vector<std::filesystem::path> valid_scene_files();
/// A path as part of a test's name.
[[nodiscard]] std::string test_name(const std::filesystem::path& path);

/// The shortest valid scene with `members` added before the closing brace.
[[nodiscard]] std::string scene_text(const std::string& members = "");

}  // namespace sheave::test
