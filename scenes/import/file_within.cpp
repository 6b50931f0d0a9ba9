#include "scenes/import/file_within.h"

namespace sheave::import {

std::filesystem::path folder_of(const std::string& file_name) {
  const std::filesystem::path folder = std::filesystem::path(file_name).parent_path();
  return folder.empty() ? std::filesystem::path(".") : folder;
}

std::optional<std::filesystem::path> path_within(const std::filesystem::path& folder,
                                                 const std::string& named,
                                                 const std::filesystem::path& allowed) {
  std::error_code code;
  const std::filesystem::path path = folder / named;
  const std::filesystem::path home =
      std::filesystem::weakly_canonical(allowed.empty() ? folder : allowed, code);
  if (code) return {};
  const std::filesystem::path real = std::filesystem::weakly_canonical(path, code);
  if (code || std::filesystem::path(named).is_absolute()) return {};
  const std::filesystem::path from_home = real.lexically_relative(home);
  if (from_home.empty() || *from_home.begin() == ".." || *from_home.begin() == ".") return {};
  return path;
}

}  // namespace sheave::import
