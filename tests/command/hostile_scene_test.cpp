// Hostile texts in every place of a scene that can hold one: they are refused with a message that a
// terminal can show, or they stay texts in all that is printed, drawn and written.

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "command/scene_options.h"
#include "command/terminal.h"
#include "command/view/page_file.h"
#include "scenes/scene.h"
#include "tests/command/scenes.h"
#include "tests/command/watched_run.h"
#include "tests/support/scene_texts.h"

namespace sheave::test {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

/// How many texts `dev/fuzz texts` asks for; 0: as many as a run of all tests has time for.
std::size_t texts_asked_for() {
  const char* const text = std::getenv("SHEAVE_CASES");
  return text == nullptr ? 0 : std::strtoull(text, nullptr, 10);
}

Json parsed_file(const fs::path& path) {
  return Json::parse(std::ifstream(path), nullptr, true, true);
}

/// Whether a text is a name as bodies and joints may have: harmless wherever it is shown.
bool is_name(const std::string& text) {
  return std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == ' ';
  });
}

/// An arrow to a body, of which the other kinds of annotation have a part.
Json annotation(const std::string& kind, const std::string& text) {
  Json made = Json::object();
  made["kind"] = kind;
  made["text"] = text;
  if (kind == "arrow") made["body"] = "light";
  return made;
}

/// Scenes that between them have an object of every type.
TextPlaces all_places() {
  TextPlaces places;
  places.add(Json::parse(atwood_scene));
  Json annotated = Json::parse(atwood_scene);
  annotated["annotations"] = Json::array({annotation("arrow", "here")});
  places.add(annotated);
  std::vector<fs::path> files;
  for (const char* folder : {"/tests/scenes/corpus/v1", "/scenes/analytic", "/scenes/machines"}) {
    for (const auto& entry : fs::directory_iterator(SHEAVE_SOURCE_DIR + std::string(folder))) {
      if (entry.path().extension() == ".json") files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    return std::pair(fs::file_size(a), a) < std::pair(fs::file_size(b), b);
  });
  for (const fs::path& file : files) places.add(parsed_file(file));
  return places;
}

std::string json_text(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// The text with a word in place of which `text` stands as it is, byte by byte.
std::string with_bytes(std::string scene, const std::string& word, const std::string& text) {
  return scene.replace(scene.find(word), word.size(), text);
}

/// All texts, and then as many more as are asked for.
std::vector<std::string> texts_of(std::size_t count) {
  std::vector<std::string> texts = hostile_texts();
  for (std::size_t seed = 0; texts.size() < count; ++seed) texts.push_back(hostile_text(seed));
  return texts;
}

/// Keys that take any text at all, as the loader says, with the number of those they took.
std::map<std::string, std::size_t> free_keys(const TextPlaces& places,
                                             const std::vector<TextKey>& keys) {
  std::map<std::string, std::size_t> taken;
  // Each key meets some of them, and with SHEAVE_CASES all.
  const std::vector<std::string> texts = texts_of(texts_asked_for() / keys.size());
  const std::size_t step = texts_asked_for() == 0 ? 11 : 1;
  std::size_t first = 0;
  for (const TextKey& key : keys) {
    const std::string word = "placeforatext";
    const Json scene = places.with(key, word);
    EXPECT_FALSE(scene.is_null()) << "no scene has an object for " << key.name;
    if (scene.is_null()) continue;
    const std::string around = scene.dump();
    for (std::size_t i = first++ % step; i < texts.size(); i += step) {
      const std::string quoted = json_text(texts[i]);
      for (const std::string& text :
           {with_bytes(around, '"' + word + '"', quoted), with_bytes(around, word, texts[i])}) {
        const SceneResult result = load_scene_text(text, "scene.json");
        if (result) {
          if (!is_name(texts[i])) ++taken[key.name];
        } else {
          expect_showable(command::printable(command::to_text(result)), key.name);
        }
      }
    }
  }
  return taken;
}

TEST(HostileScene, EveryTextIsRefusedOrStaysText) {
  const TextPlaces places = all_places();
  const std::vector<TextKey> keys = text_keys();
  EXPECT_GT(keys.size(), 50U);
  std::vector<std::string> names;
  for (const auto& [name, count] : free_keys(places, keys)) names.push_back(name);
  // Those of the next test. A new one belongs there.
  EXPECT_THAT(names, testing::UnorderedElementsAre(
                         "scene.name", "scene.description", "check.because", "annotation.text",
                         "collider.groups", "collider.ignores", "parameter.meaning"));
}

bool has_gnuplot_program() {
  static const bool found = std::system("gnuplot --version > /dev/null 2>&1") == 0;  // NOLINT
  return found;
}

/// Builds without npm have none.
bool has_page() { return fs::exists(fs::path(SHEAVE_COMMAND).parent_path() / "../web/view.html"); }

/// As much of a text as an annotation may have.
std::string for_annotation(const std::string& text) {
  std::string allowed;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte < 0x7f && allowed.size() < AnnotationDef::most_bytes) allowed += c;
  }
  return allowed.empty() ? "-" : allowed;
}

/// A scene that is drawn in no time, with a text in each place that takes any.
std::string scene_full_of(const std::string& text) {
  Json scene = Json::parse(atwood_scene);
  scene["name"] = text;
  scene["description"] = text;
  scene["duration"] = 0.05;
  Json check = Json::object();
  check["quantity"] = "light.y";
  check["equals"] = 1e9;  // which it is not, so that all of it is told
  check["relative_tolerance"] = 0.01;
  check["because"] = text;
  scene["checks"] = Json::array();
  scene["checks"].push_back(check);
  Json collider = Json::object();
  collider["body"] = "light";
  collider["groups"] = Json::array({text});
  collider["ignores"] = Json::array({text});
  scene["colliders"] = Json::array({collider});
  Json parameter = Json::object();
  parameter["name"] = "p";
  parameter["value"] = 1;
  parameter["meaning"] = text;
  scene["parameters"] = Json::array({parameter});
  scene["annotations"] = Json::array();
  for (const char* kind : {"title", "caption", "arrow"}) {
    scene["annotations"].push_back(annotation(kind, for_annotation(text)));
  }
  return json_text(scene);
}

/// Pages and pictures have no element that a text has brought; in JSON texts end no string.
void expect_no_markup(const std::string& file, const std::string& name) {
  if (name.ends_with(".glb")) {
    constexpr std::size_t head = 20;  // of the file and of its first part, which is JSON
    const std::size_t end = file.find(std::string("BIN\0", 4));
    const std::string json = file.substr(head, end - head - 4);
    EXPECT_TRUE(Json::accept(json)) << name;
  } else if (!name.ends_with(".sweep")) {
    EXPECT_EQ(file.find("<script>x()"), std::string::npos) << name;
  }
}

TEST(HostileScene, StaysTextInEveryOutput) {
  if (!has_gnuplot_program()) GTEST_SKIP() << "no gnuplot";
  // One of all kinds at once, which charts and pictures cut off, and some alone.
  constexpr std::size_t texts_of_a_run = 1000;
  std::vector<std::string> texts = texts_of(texts_asked_for() / texts_of_a_run);
  std::string all;
  for (const std::string& text : texts) all += text.size() < 1000 ? text : "";
  if (texts_asked_for() == 0) texts = {texts[1]};
  texts.push_back(all);
  texts.push_back(std::string(100'000, '\x1b') + "\xe2\x80\xae");
  WatchedRuns runs;
  int charts = 0;
  for (const std::string& text : texts) {
    const std::string scene = runs.folder.write("scene.json", scene_full_of(text));
    const auto path = [&](const char* name) { return runs.folder.path(name); };
    const auto works = [&](int code, std::vector<std::string> arguments,
                           const std::vector<std::string>& files = {}) {
      const ProcessResult result = runs.run(arguments, files);
      EXPECT_EQ(result.exit_code, code) << arguments[0] << ": " << result.err;
      for (std::size_t i = 0; i < files.size(); ++i) {
        EXPECT_GT(runs.contents[i].size(), 300U) << files[i];
        expect_no_markup(runs.contents[i], files[i]);
      }
    };
    works(0, {"validate", scene});
    works(0, {"validate", "--json", scene});
    works(1, {"run", scene, "--check", "--plot", "rope.*", "--plot-file", path("a.svg")},
          {"a.svg"});
    works(1, {"run", scene, "--check", "--json"});
    works(0, {"plot", scene, "-y", "light.y", "-o", path("a.svg"), "--json"}, {"a.svg"});
    works(0,
          {"sweep", scene, "--vary", "/bodies/heavy/mass=2,3", "--measure", "light.y", "--chart",
           path("a.svg"), "--resume", path("a.sweep"), "--csv", "-"},
          {"a.svg", "a.sweep"});
    works(
        0,
        {"trade", scene, "--chart", path("a.svg"), "--markdown", path("a.md"), "--solver", "direct",
         "--substeps", "1", "--repetitions", "1", "--no-ladder", "--reference-seconds", "0.1"},
        {"a.svg", "a.md"});
    charts += 4;
    works(0, {"statics", scene, "--set", "/bodies/heavy/mass=1"});
    works(0, {"modes", scene, "--json"});
#if SHEAVE_HAS_RENDER
    works(0, {"render", scene, "--still", path("a.svg"), "--width", "96", "--height", "64"},
          {"a.svg"});
    works(0, {"render", scene, "--glb", path("a.glb")}, {"a.glb"});
    if (has_page()) works(0, {"view", scene, "-o", path("a.html")}, {"a.html"});
#endif
  }
  EXPECT_EQ(runs.gnuplots(), charts) << "the library does not tell of programs";
}

#if SHEAVE_HAS_RENDER

TEST(HostileScene, DoesNotEndAnElementOfAPage) {
  for (const std::string& text : texts_of(texts_asked_for())) {
    const std::string page = command::filled_live_page("<!--SCENE-->", scene_full_of(text));
    // The element that it is in, and its end.
    ASSERT_EQ(std::count(page.begin(), page.end(), '<'), 2) << text;
    const std::size_t begin = page.find('>') + 1;
    const std::string kept = Json::parse(page.substr(begin, page.rfind('<') - begin));
    ASSERT_EQ(kept, scene_full_of(text));
  }
}

#endif

}  // namespace
}  // namespace sheave::test
