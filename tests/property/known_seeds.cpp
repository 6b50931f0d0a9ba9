#include "tests/property/known_seeds.h"

#include <filesystem>
#include <fstream>

#include <nlohmann/json.hpp>

namespace sheave::test {

std::map<std::uint64_t, std::string> known_seeds(const std::string& property) {
  const std::filesystem::path path =
      std::filesystem::path(SHEAVE_SOURCE_DIR) / "tests/property/known" / (property + ".json");
  if (!std::filesystem::exists(path)) return {};
  std::ifstream file(path);
  const nlohmann::json list = nlohmann::json::parse(file);
  std::map<std::uint64_t, std::string> seeds;
  for (const nlohmann::json& machine : list.at("machines")) {
    seeds.emplace(machine.at("seed").get<std::uint64_t>(), machine.at("why").get<std::string>());
  }
  return seeds;
}

}  // namespace sheave::test
