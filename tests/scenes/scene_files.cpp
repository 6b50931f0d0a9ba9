#include "tests/scenes/scene_files.h"

#include <algorithm>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

namespace sheave::test {

std::string read_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  EXPECT_TRUE(file) << path;
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::vector<std::filesystem::path> scene_files(const std::string& folder) {
  std::vector<std::filesystem::path> files;
  const std::filesystem::path root = std::filesystem::path(SHEAVE_SOURCE_DIR) / "scenes" / folder;
  for (const auto& entry : std::filesystem::directory_iterator(root)) {
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<std::filesystem::path> valid_scene_files() {
  std::vector<std::filesystem::path> files;
  const std::filesystem::path root = std::filesystem::path(SHEAVE_SOURCE_DIR) / "scenes";
  for (const auto& entry : std::filesystem::directory_iterator(root)) {
    const std::string folder = entry.path().filename();
    if (!entry.is_directory() || folder == "invalid") continue;
    for (auto& file : scene_files(folder)) files.push_back(std::move(file));
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string test_name(const std::filesystem::path& path) {
  std::string name = path.parent_path().filename().string() + "_" + path.stem().string();
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  return name;
}

std::string scene_text(const std::string& members) {
  return "{\n\"format\": \"sheave-scene/1\",\n\"gravity\": [0, -10, 0],\n\"duration\": 1" +
         (members.empty() ? "" : ",\n" + members) + "\n}\n";
}

}  // namespace sheave::test
