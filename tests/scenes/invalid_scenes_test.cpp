// Every file in scenes/invalid says in its head what is wrong and which error it must give:
//   // what is wrong
//   // expect: /json/pointer: part of the message
//   // schema: rejects           if the JSON Schema alone already refuses it (schema_test.cpp)
// A comment that ends with "<-" marks the line that the error must name, or "// line: 4" does.

#include <sstream>

#include <gtest/gtest.h>

#include "scenes/scene.h"
#include "tests/scenes/scene_files.h"

namespace sheave::test {
namespace {

/// What a file's comments promise.
struct Expectation {
  std::string pointer;
  std::string message;
  int line = 0;  ///< 0: not told
};

Expectation expectation_of(const std::string& text) {
  Expectation expectation;
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    const std::string expect = "// expect: ";
    if (number == 2 && line.starts_with(expect)) {
      const std::size_t colon = line.find(": ", expect.size() - 1);
      expectation.pointer =
          colon < expect.size() ? "" : line.substr(expect.size(), colon - expect.size());
      expectation.message = line.substr(colon + 2);
    }
    if (line.ends_with("<-")) expectation.line = number;
    if (line.starts_with("// line: ")) expectation.line = std::stoi(line.substr(9));
  }
  return expectation;
}

class InvalidScene : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(InvalidScene, GivesTheExpectedError) {
  const std::string text = read_file(GetParam());
  ASSERT_TRUE(text.starts_with("// ")) << "the first line must say what is wrong";
  const Expectation expected = expectation_of(text);
  ASSERT_FALSE(expected.message.empty()) << "the second line must say what is expected";

  const SceneResult result = load_scene(GetParam());
  ASSERT_FALSE(result);
  EXPECT_EQ(result.status, SceneStatus::invalid);
  ASSERT_FALSE(result.errors.empty());
  std::string all;
  bool found = false;
  for (const SceneError& error : result.errors) {
    all += to_string(error) + "\n";
    EXPECT_EQ(error.file, GetParam());
    EXPECT_GE(error.line, 1);
    EXPECT_GE(error.column, 1);
    found = found || (error.pointer == expected.pointer &&
                      error.message.find(expected.message) != std::string::npos &&
                      (expected.line == 0 || error.line == expected.line));
  }
  EXPECT_TRUE(found) << "expected \"" << expected.pointer << "\": " << expected.message
                     << " in line " << expected.line << "; got\n"
                     << all;
  // One fault, one message: nothing follows from it that is not its own fault.
  EXPECT_EQ(result.errors.size(), 1U) << all;
}

INSTANTIATE_TEST_SUITE_P(Scenes, InvalidScene, testing::ValuesIn(scene_files("invalid")),
                         [](const auto& scene) { return test_name(scene.param); });

TEST(InvalidScenes, AreMany) { EXPECT_GE(scene_files("invalid").size(), 45U); }

}  // namespace
}  // namespace sheave::test
