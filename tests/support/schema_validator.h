#pragma once
// Validates JSON by a schema with an independent implementation, Python's jsonschema.

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace sheave::test {

class SchemaValidator {
 public:
  explicit SchemaValidator(const std::string& schema)
      : folder_(testing::TempDir() + "sheave_schema_test_" +
                testing::UnitTest::GetInstance()->current_test_info()->name()) {
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "schema.json") << schema;
  }
  ~SchemaValidator() { std::filesystem::remove_all(folder_); }
  SchemaValidator(const SchemaValidator&) = delete;
  SchemaValidator& operator=(const SchemaValidator&) = delete;

  static bool available() {
    return std::system("python3 -c 'import jsonschema' >/dev/null 2>&1") == 0;  // NOLINT
  }
  /// `valid`: what the schema should say; `definition`: which of its definitions, by default the
  /// whole.
  void add(const std::string& name, const std::string& json, bool valid,
           const std::string& definition = {}) {
    cases_.push_back({{"name", name},
                      {"json", nlohmann::json::parse(json)},
                      {"valid", valid},
                      {"definition", definition}});
  }
  /// Cases for which the validator does not say what was expected.
  std::string disagreements() {
    std::ofstream(folder_ / "cases.json") << nlohmann::json(cases_);
    std::ofstream(folder_ / "check.py") << R"(
import json, sys, warnings
warnings.simplefilter("ignore")
import jsonschema
schema = json.load(open("schema.json"))
jsonschema.Draft7Validator.check_schema(schema)
validators = {"": jsonschema.Draft7Validator(schema)}
for name in schema["definitions"]:
    own = {"$ref": "#/definitions/" + name, "definitions": schema["definitions"]}
    validators[name] = jsonschema.Draft7Validator(own)
for case in json.load(open("cases.json")):
    errors = [e.message[:200] for e in validators[case["definition"]].iter_errors(case["json"])]
    if (not errors) != case["valid"]:
        print(case["name"], errors or "is accepted")
)";
    const std::string command =
        "cd '" + folder_.string() + "' && python3 check.py > result.txt 2>&1";
    const int status = std::system(command.c_str());  // NOLINT
    std::stringstream text;
    text << std::ifstream(folder_ / "result.txt").rdbuf();
    return text.str() + (status == 0 ? "" : "python3 failed");
  }

 private:
  std::filesystem::path folder_;
  std::vector<nlohmann::json> cases_;
};

}  // namespace sheave::test
