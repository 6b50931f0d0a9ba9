// Scenes in Jsonnet: parameters, imports, limits, places of faults; the templates against their
// closed forms.

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <sys/resource.h>
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/check.h"
#include "scenes/control/load_wind.h"
#include "scenes/control/scene_supervisor.h"
#include "scenes/jsonnet/evaluate.h"
#include "scenes/scene.h"
#include "tests/scenes/scene_files.h"
#include "tests/support/effort.h"

namespace sheave {
namespace {

using testing::HasSubstr;

const std::string ball = R"(
function(mass=1, name='ball', at=[0, 0, 0]) {
  format: 'sheave-scene/1', gravity: [0, -10, 0], duration: 1,
  bodies: [
    {name: name, mass: mass, position: at, shape: {type: 'sphere', radius: 1}},
    {name: 'stone', mass: 2 * mass, shape: {type: 'sphere', radius: 0.5}},
  ],
}
)";

SceneResult loaded(const std::string& text, const std::vector<SceneParameter>& parameters = {}) {
  return load_scene_text(text, "scene.jsonnet", {}, {parameters, {}});
}

class Jsonnet : public testing::Test {
 protected:
  void SetUp() override {
    if (!jsonnet::is_available()) GTEST_SKIP() << "built without libjsonnet";
  }
};

TEST_F(Jsonnet, ParametersAreNumbersTextsAndJson) {
  const SceneResult plain = loaded(ball);
  ASSERT_TRUE(plain) << to_string(plain.errors.front());
  EXPECT_EQ(plain->model.bodies[0].mass, 1.0);
  const SceneResult other =
      loaded(ball, {{"mass", "2.5"}, {"name", "big ball"}, {"at", "[1, 2, 3]"}});
  ASSERT_TRUE(other) << to_string(other.errors.front());
  EXPECT_EQ(other->model.bodies[0].mass, 2.5);
  EXPECT_EQ(other->model.bodies[0].name, "big ball");
  EXPECT_EQ(other->model.bodies[0].position, Vector3(1.0, 2.0, 3.0));
  EXPECT_EQ(other->model.bodies[1].mass, 5.0);
}

TEST_F(Jsonnet, OverridesChangeTheEvaluatedScene) {
  const SceneResult scene =
      load_scene_text(ball, "scene.jsonnet", {{"/bodies/stone/mass", "7", ""}});
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->model.bodies[1].mass, 7.0);
}

TEST_F(Jsonnet, UnknownParametersAreReported) {
  const SceneResult unknown = loaded(ball, {{"mas", "2"}});
  ASSERT_FALSE(unknown);
  EXPECT_THAT(to_string(unknown.errors.front()), HasSubstr("mas"));
  const SceneResult none = loaded("{format: 'sheave-scene/1'}", {{"mass", "2"}});
  ASSERT_FALSE(none);
  EXPECT_THAT(to_string(none.errors.front()), HasSubstr("the scene has no parameters"));
  const SceneResult json = load_scene_text("{}", "scene.json", {}, {{{"mass", "2"}}, {}});
  ASSERT_FALSE(json);
  EXPECT_THAT(to_string(json.errors.front()), HasSubstr("has no parameter \"mass\""));
  EXPECT_THAT(to_string(json.errors.front()), HasSubstr("by its JSON pointer"));
}

TEST_F(Jsonnet, AFunctionBeforeDoesNotHideThatAnotherProgramTakesNoParameters) {
  // After the first evaluation the loader knows that `ball` is a function.
  for (const char* mass : {"2", "3"}) {
    const SceneResult scene = loaded(ball, {{"mass", mass}});
    ASSERT_TRUE(scene) << to_string(scene.errors.front());
    EXPECT_EQ(scene->model.bodies[0].mass, std::stod(mass));
  }
  const SceneResult unknown = loaded(ball, {{"mas", "2"}});
  ASSERT_FALSE(unknown);
  EXPECT_THAT(to_string(unknown.errors.front()), HasSubstr("mas"));
  const SceneResult none = loaded("{format: 'sheave-scene/1'}", {{"mass", "2"}});
  ASSERT_FALSE(none);
  EXPECT_THAT(to_string(none.errors.front()), HasSubstr("the scene has no parameters"));
}

TEST_F(Jsonnet, FaultsOfTheProgramHaveTheirPlace) {
  const SceneResult syntax = loaded("{\n  a: 1,\n  b: [1, 2\n}\n");
  ASSERT_FALSE(syntax);
  EXPECT_EQ(syntax.errors.front().file, "scene.jsonnet");
  EXPECT_EQ(syntax.errors.front().line, 4);
  const SceneResult unknown = loaded("{\n  a: wheel,\n}\n");
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.errors.front().line, 2);
  EXPECT_EQ(unknown.errors.front().column, 6);
  EXPECT_THAT(unknown.errors.front().message, HasSubstr("wheel"));
  const SceneResult error = loaded("{\n  a:\n    error 'too heavy',\n}\n");
  ASSERT_FALSE(error);
  EXPECT_EQ(error.errors.front().line, 3);
  EXPECT_EQ(error.errors.front().message, "too heavy");
}

TEST_F(Jsonnet, FaultsOfTheSceneAreReportedInBothTexts) {
  const SceneResult scene = loaded(ball, {{"mass", "-1"}});
  ASSERT_FALSE(scene);
  ASSERT_EQ(scene.errors.size(), 2U);
  for (const SceneError& error : scene.errors) {
    EXPECT_EQ(error.file, "scene.jsonnet");
    EXPECT_THAT(error.message, HasSubstr("made JSON: line"));
  }
  EXPECT_EQ(scene.errors[0].line, 2) << "the only place with 'ball'";
  EXPECT_EQ(scene.errors[1].line, 6) << "the only place with 'stone'";
  // Nothing with a name: only the made JSON has a place.
  const SceneResult nameless = loaded("{format: 'sheave-scene/1', gravity: [0, -10], duration: 1}");
  ASSERT_FALSE(nameless);
  EXPECT_EQ(nameless.errors.front().file, "scene.jsonnet (made JSON)");
  EXPECT_GT(nameless.errors.front().line, 0);
}

TEST_F(Jsonnet, ImportsStayInTheirFolders) {
  namespace fs = std::filesystem;
  const fs::path root = fs::temp_directory_path() / ("sheave-jsonnet-" + std::to_string(getpid()));
  fs::create_directories(root / "scenes" / "parts");
  fs::create_directories(root / "other");
  const auto write = [&](const char* name, const std::string& text) {
    std::ofstream(root / name) << text;
  };
  write("scenes/parts/one.libsonnet", "{mass: 1 + (import 'two.libsonnet')}");
  write("scenes/parts/two.libsonnet", "2");
  write("other/three.libsonnet", "{mass: 3}");
  fs::create_symlink(root / "other" / "three.libsonnet", root / "scenes" / "link.libsonnet");
  const auto scene_with = [&](const std::string& import, const JsonnetOptions& options = {}) {
    const std::string text =
        "{format: 'sheave-scene/1', gravity: [0, -10, 0], duration: 1, "
        "bodies: [{name: 'a', mass: (import '" +
        import + "').mass, shape: {type: 'sphere', radius: 1}}]}";
    return load_scene_text(text, (root / "scenes" / "scene.jsonnet").string(), {}, options);
  };
  const SceneResult good = scene_with("parts/one.libsonnet");
  EXPECT_TRUE(good) << to_string(good.errors.front());
  for (const std::string& outside :
       {std::string("../other/three.libsonnet"), std::string("link.libsonnet"),
        (root / "other" / "three.libsonnet").string(), std::string("/etc/passwd")}) {
    const SceneResult bad = scene_with(outside);
    ASSERT_FALSE(bad) << outside;
    EXPECT_THAT(to_string(bad.errors.front()), HasSubstr("outside of the scene's folder"))
        << outside;
  }
  const SceneResult missing = scene_with("nothing.libsonnet");
  ASSERT_FALSE(missing);
  EXPECT_THAT(to_string(missing.errors.front()), HasSubstr("there is no such file"));
  const JsonnetOptions allowed{{}, {(root / "other").string()}};
  EXPECT_TRUE(scene_with("../other/three.libsonnet", allowed));
  EXPECT_TRUE(scene_with("three.libsonnet", allowed));
  fs::remove_all(root);
}

TEST_F(Jsonnet, EvaluationHasLimits) {
  jsonnet::Limits limits;
  limits.seconds = 1;
  limits.memory = std::size_t{256} << 20U;
  const auto fault = [&](const std::string& text) {
    const jsonnet::Outcome made = jsonnet::evaluate(text, "scene.jsonnet", {}, limits);
    return made.errors.empty() ? std::string("none") : made.errors.front().message;
  };
  EXPECT_THAT(fault("local f(x) = f(x + 1) + 1; f(0)"), HasSubstr("ax stack frames exceeded"));
  EXPECT_THAT(fault("local f(x) = if x == 0 then 0 else f(x - 1) tailstrict; f(1e12)"),
              testing::AnyOf(HasSubstr("more than 1 s"), HasSubstr("MB of memory")));
  // A sanitizer that reports the end of memory needs memory itself, and may wait for ever.
  if (!test::instrumented) {
    EXPECT_THAT(fault("local d(s, n) = if n == 0 then s else d(s + s, n - 1) tailstrict; "
                      "std.length(d('abcdefgh', 40))"),
                testing::AnyOf(HasSubstr("MB of memory"), HasSubstr("more than 1 s")));
  }
  EXPECT_THAT(fault(std::string(200000, '[')), testing::Not("none"));
}

/// Evaluates where the system allows this user no further process; ends with 0 if the message is
/// about processes.
[[noreturn]] void evaluate_without_processes() {
  // Root has no such limit.
  if (::geteuid() == 0 && ::setuid(65534) != 0) std::_Exit(2);
  const rlimit one{1, 1};
  if (::setrlimit(RLIMIT_NPROC, &one) != 0) std::_Exit(3);
  const SceneResult result = loaded(ball);
  const bool told = !result && result.errors.front().message.find("ulimit -u") != std::string::npos;
  std::_Exit(told ? 0 : 1);
}

TEST_F(Jsonnet, TellsThatNoProcessCanBeStarted) {
  EXPECT_EXIT(evaluate_without_processes(), testing::ExitedWithCode(0), "");
}

TEST_F(Jsonnet, TheLibraryReadsTablesInCsv) {
  const auto scene_of = [](const std::string& table) {
    return loaded(
        "local s = import 'sheave.libsonnet'; local t = s.csv('" + table +
        "'); s.scene({duration: 1, loads: [{type: 'wind', name: 'w', body: 'b', drag_area: 1, "
        "times: t.t, velocities: s.vectors(t.u, t.v, t.w)}]}, [s.weight('b', 1, [0, 0, 0])])");
  };
  const SceneResult scene = scene_of("t, u,v,w\\r\\n0,0,0,0\\n\\n1.5,5e0,0,-2\\n");
  ASSERT_TRUE(scene) << to_string(scene.errors.front());
  ASSERT_EQ(scene->loads.size(), 1U);
  const auto& wind = dynamic_cast<const WindLoad&>(*scene->loads[0]);
  EXPECT_EQ(wind.times, (std::vector<double>{0.0, 1.5}));
  EXPECT_EQ(wind.velocities[1], Vector3(5.0, 0.0, -2.0));
  const SceneResult uneven = scene_of("t,u,v,w\\n0,0,0\\n");
  ASSERT_FALSE(uneven);
  EXPECT_THAT(to_string(uneven.errors.front()),
              HasSubstr("3 cells where the first line has 4 names"));
}

// The fault is in the table: its file, row and column, and the remedy.
TEST_F(Jsonnet, FaultsOfTablesAreLocatedInTheTable) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "tables";
  std::filesystem::create_directories(folder);
  const auto write = [&](const std::string& name, const std::string& text) {
    std::ofstream(folder / name, std::ios::binary) << text;
    return (folder / name).string();
  };
  const std::string program =
      write("gust.jsonnet",
            "local s = import 'sheave.libsonnet'; local t = s.csv(importstr 'gust.csv');\n"
            "s.scene({duration: 1, loads: [{type: 'force', name: 'gust', body: 'b', times: t.t,\n"
            "forces: s.vectors(t.u, t.u, t.u)}]}, [s.weight('b', 1, [0, 0, 0])])");
  const auto fault = [&](const std::string& table) {
    const std::string path = write("gust.csv", table);
    const SceneResult scene = load_scene(program);
    if (scene) return std::string("none");
    EXPECT_EQ(scene.errors.size(), 1U);
    const std::string text = to_string(scene.errors.front());
    EXPECT_TRUE(text.starts_with(path + ":")) << text;
    return text.substr(std::min(path.size(), text.size()));
  };
  EXPECT_EQ(fault("\xef\xbb\xbft,u\r\n0,1\r\n\r\n2,+1.5e0\r\n"), "none") << "as Excel writes it";
  EXPECT_EQ(fault("t,u\n0,1\n2,\"1,5\"\n"),
            ":3:3: column \"u\": \"1,5\" is no number; decimals need a point: 1.5");
  EXPECT_THAT(fault("t;u\n0;1,5\n"),
              HasSubstr(":1:1: the cells must be separated by commas, not by semicolons"));
  EXPECT_THAT(fault("t\tu\n0\t1\n"), HasSubstr("not by tabs"));
  EXPECT_THAT(fault("t,u\n0,1,5\n"), HasSubstr(":2:5: 3 cells where the first line has 2 names; a "
                                               "comma separates cells, so decimals need a point"));
  EXPECT_EQ(fault("t,u\n0,fast\n"), ":2:3: column \"u\": \"fast\" is no number");
  EXPECT_EQ(fault("t,u\n0,\n"), ":2:3: column \"u\": the number is missing");
  EXPECT_EQ(fault("t,u\n0,inf\n"), ":2:3: column \"u\": \"inf\" is no finite number");
  EXPECT_EQ(fault(""), ":1:1: there is no line of names");
}

struct TemplateCase {
  std::string file;
  std::vector<SceneParameter> parameters;
};

TEST_F(Jsonnet, TemplatesAgreeWithTheirClosedForms) {
  const std::vector<TemplateCase> cases{
      {"tackle", {}},
      {"tackle", {{"parts", "2"}, {"effort", "60"}}},
      {"tackle", {{"parts", "3"}, {"load", "60"}, {"effort", "25"}}},
      {"tackle", {{"parts", "8"}, {"load", "400"}, {"effort", "40"}}},
      {"wheel-train", {}},
      {"wheel-train", {{"wheels", "7"}, {"heavy", "1.5"}}},
      {"chain", {{"rods", "4"}}},
      {"trolley-crane", {}},
      {"finger", {}},
      {"finger", {{"force", "6"}, {"lengths", "[0.05, 0.04, 0.03, 0.02]"}}},
      {"cable-robot", {{"height", "2.5"}, {"mass", "80"}}},
      {"jib", {}},
      {"jib", {{"angle", "1"}, {"aside", "-0.4"}, {"rope", "2"}}},
      {"rail", {}},
      {"rail", {{"mass", "800"}, {"height", "2"}}},
      {"cleat", {}},
      {"cleat", {{"load", "60"}}},
      {"ratchet", {}},
      {"ratchet", {{"load", "60"}, {"pull", "900"}}},
  };
  for (const TemplateCase& one : cases) {
    const std::string path =
        std::string(SHEAVE_SOURCE_DIR) + "/scenes/templates/" + one.file + ".jsonnet";
    const SceneResult scene = load_scene(path, {}, {one.parameters, {}});
    ASSERT_TRUE(scene) << path << to_string(scene.errors.front());
    ASSERT_FALSE(scene->checks.empty()) << path;
    Result<Simulation> simulation = create_simulation(*scene);
    ASSERT_TRUE(simulation);
    CheckRecorder recorder(*scene, *simulation);
    recorder.record(*simulation);
    while (simulation->world.state().time < scene->duration - 1e-9) {
      ASSERT_TRUE(simulation->step().ok()) << path;
      recorder.record(*simulation);
    }
    for (const CheckResult& check : recorder.results()) {
      EXPECT_TRUE(check.passed) << path << ": " << check.message;
    }
  }
}

}  // namespace
}  // namespace sheave
