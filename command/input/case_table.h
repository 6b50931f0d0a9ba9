#pragma once
// Tables of load cases: CSV, or JSON.
//
//   case,load,/bodies/hook/mass        [{"case": "empty", "load": 50, "/bodies/hook/mass": 10},
//   empty,50,10                         {"case": "full", "load": 500}]
//   full,500,
//
// "case" is the name of a case. The other names are settings ("/json/pointer") or parameters of a
// scene in Jsonnet. An empty cell, or a key that is missing, leaves the scene's own value.

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace sheave::command {

/// A load case: a scene with other values.
struct LoadCase {
  std::string name;  ///< not empty
  /// Settings or parameters with their values: JSON, or bare words.
  std::vector<std::pair<std::string, std::string>> values;
};

inline constexpr std::size_t most_cases = 10'000;
inline constexpr std::size_t most_case_columns = 1000;
inline constexpr std::size_t most_case_bytes = std::size_t{16} << 20U;

/// Reads a table whose name ends in .csv or .json. The names of its cases differ. A Failure: 2 for
/// another ending, 65 with the line of the fault, 66, 74.
[[nodiscard]] std::vector<LoadCase> read_cases(const std::string& path);

}  // namespace sheave::command
