// Damaged scenes: whatever is done to a text, it either loads, and then survives writing and
// loading, or gives errors with a place in the text. Under the sanitizers this also shows that
// nothing is read or written that should not be.

#include <random>

#include <gtest/gtest.h>

#include "scenes/scene.h"
#include "tests/scenes/scene_compare.h"
#include "tests/scenes/scene_files.h"

namespace sheave::test {
namespace {

class Damage {
 public:
  explicit Damage(unsigned seed) : random_(seed) {}

  /// The text with one to four small changes.
  std::string apply(std::string text) {
    const std::size_t changes = 1 + pick(4);
    for (std::size_t i = 0; i < changes && !text.empty(); ++i) change(text);
    return text;
  }

 private:
  std::size_t pick(std::size_t n) { return random_() % n; }

  void change(std::string& text) {
    static const std::array<std::string, 16> pieces{
        "-1", "0", "1e308", "1e-308", "null", "true", "\"world\"", "[]",
        "{}", "[", "}",     "\"",     ",",    "//",   "1e999",     "[1, 0, 0]"};
    const std::size_t at = pick(text.size());
    switch (pick(5)) {
      case 0:
        text[at] = static_cast<char>(random_());
        break;
      case 1:
        text.erase(at, 1 + pick(20));
        break;
      case 2:
        text.insert(at, pieces[pick(pieces.size())]);
        break;
      case 3:
        text.insert(at, text.substr(pick(text.size()), 1 + pick(60)));
        break;
      default:
        replace_value(text, at, pieces[pick(pieces.size())]);
        break;
    }
  }
  /// Replaces the next number or string behind `at`: the change that most often stays valid JSON.
  static void replace_value(std::string& text, std::size_t at, const std::string& piece) {
    const std::size_t begin = text.find_first_of("-0123456789\"", text.find(": ", at));
    if (begin == std::string::npos) return;
    const std::size_t end = text[begin] == '"' ? text.find('"', begin + 1)
                                               : text.find_first_not_of("-+.eE0123456789", begin);
    if (end == std::string::npos) return;
    text.replace(begin, end - begin + (text[begin] == '"' ? 1 : 0), piece);
  }

  std::mt19937 random_;
};

TEST(LoadFuzz, DamagedScenesLoadOrExplainThemselves) {
  const auto files = valid_scene_files();
  int loaded = 0;
  int refused = 0;
  for (unsigned seed = 0; seed < 1500; ++seed) {
    const std::string text = Damage(seed).apply(read_file(files[seed % files.size()]));
    SCOPED_TRACE(testing::Message() << "seed " << seed << "\n" << text);
    const SceneResult scene = load_scene_text(text, "damaged");
    if (!scene) {
      ++refused;
      ASSERT_FALSE(scene.errors.empty());
      for (const SceneError& error : scene.errors) {
        EXPECT_FALSE(error.message.empty());
        EXPECT_GE(error.line, 1);
        EXPECT_GE(error.column, 1);
      }
      continue;
    }
    ++loaded;
    EXPECT_TRUE(scene.errors.empty());
    const std::string written = write_scene(*scene);
    const SceneResult again = load_scene_text(written, "written");
    ASSERT_TRUE(again) << to_string(again.errors.front()) << "\n" << written;
    EXPECT_EQ(difference(*scene, *again), "");
  }
  // Both outcomes must occur often enough to mean something; how often depends on the scenes.
  EXPECT_GT(loaded, 30);
  EXPECT_GT(refused, 500);
}

}  // namespace
}  // namespace sheave::test
