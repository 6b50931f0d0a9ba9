// sheave render: which files appear, and what happens when they cannot.

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "command/run/player.h"
#include "tests/command/process.h"
#include "tests/command/scenes.h"

#if SHEAVE_HAS_RENDER

namespace sheave::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

// Small pictures: this is not about how they look.
const std::vector<std::string> small{"--width", "96", "--height", "64"};

bool have_ffmpeg() {
  static const bool found = std::system("ffmpeg -version > /dev/null 2>&1") == 0;
  return found;
}

ProcessResult render(const std::string& scene, std::vector<std::string> options,
                     const ProcessOptions& process = {}) {
  options.insert(options.begin(), {"render", scene});
  options.insert(options.end(), small.begin(), small.end());
  return run_sheave(options, process);
}

/// Width and height in the header of a PNG file.
std::vector<int> png_size(const std::string& bytes) {
  EXPECT_EQ(bytes.substr(1, 3), "PNG");
  const auto number = [&](std::size_t at) {
    int value = 0;
    for (std::size_t i = at; i < at + 4; ++i) {
      value = value * 256 + static_cast<unsigned char>(bytes.at(i));
    }
    return value;
  };
  return {number(16), number(20)};
}

// A folder that somebody else has made must not decide which files are written.
TEST(Render, FramesTakeThePlaceOfLinks) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const std::string precious = folder.write("precious", "what nobody has named\n");
  std::filesystem::create_directory(folder.path("frames"));
  const std::string frame = folder.path("frames") + "/frame_000000.png";
  std::filesystem::create_symlink("../precious", frame);
  const ProcessResult result =
      render(scene, {"--png", folder.path("frames"), "--duration", "0.02", "-q"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(read_file(precious), "what nobody has named\n");
  EXPECT_FALSE(std::filesystem::is_symlink(frame));
  // Where it has been named, a link stays one.
  std::filesystem::create_symlink("target.png", folder.path("still.png"));
  EXPECT_EQ(render(scene, {"--still", folder.path("still.png"), "-q"}).exit_code, 0);
  EXPECT_TRUE(std::filesystem::is_symlink(folder.path("still.png")));
  EXPECT_TRUE(std::filesystem::is_regular_file(folder.path("target.png")));
}

TEST(ModesPicture, HasTheRequestedSize) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("spring.json", R"json({
    "format": "sheave-scene/1", "gravity": [0, -10, 0], "duration": 0.1,
    "bodies": [{"name": "load", "mobility": "slider", "axis": [0, 1, 0], "mass": 2,
                "position": [0, -1, 0], "shape": {"type": "sphere", "radius": 0.1}}],
    "cables": [{"name": "rope", "compliance": 0.002, "links": [
      {"type": "attachment", "body": "world"}, {"type": "attachment", "body": "load"}]}]
  })json");
  std::vector<std::string> options{"modes", scene, "--still", folder.path("mode.png")};
  options.insert(options.end(), small.begin(), small.end());
  const ProcessResult result = run_sheave(options);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(png_size(read_file(folder.path("mode.png"))), ElementsAre(96, 64));
  EXPECT_EQ(
      run_sheave({"modes", scene, "--still", folder.path("mode.png"), "--width", "8"}).exit_code,
      2);
}

TEST(RenderCommand, WritesEveryOutputInOneGo) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  std::vector<std::string> options{
      "--png", folder.path("frames"), "--still", folder.path("still.png"), "--at", "0.5", "--fps",
      "10"};
  if (have_ffmpeg()) options.insert(options.end(), {"--video", folder.path("film.mp4")});
  const ProcessResult result = render(scene, options);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, IsEmpty());
  EXPECT_THAT(result.err, IsEmpty());
  EXPECT_THAT(png_size(read_file(folder.path("still.png"))), ElementsAre(96, 64));
  EXPECT_THAT(png_size(read_file(folder.path("frames/frame_000000.png"))), ElementsAre(96, 64));
  EXPECT_TRUE(std::filesystem::exists(folder.path("frames/frame_000010.png")));
  EXPECT_FALSE(std::filesystem::exists(folder.path("frames/frame_000011.png")));
  EXPECT_NE(read_file(folder.path("frames/frame_000000.png")),
            read_file(folder.path("frames/frame_000010.png")));
  if (have_ffmpeg()) {
    EXPECT_THAT(folder.entries(), ElementsAre("atwood.json", "film.mp4", "frames", "still.png"));
    EXPECT_EQ(read_file(folder.path("film.mp4")).substr(4, 4), "ftyp");
  }
}

TEST(Player, ShowsTheFirstTensionsAtTheStart) {
  const SceneResult scene = load_scene_text(atwood_scene, "atwood.json");
  ASSERT_TRUE(scene);
  Simulation simulation = command::make_simulation(*scene);
  const std::vector<CableReport> start = command::reports_to_show(*scene, simulation);
  EXPECT_EQ(start[0].spans[0].length, simulation.cable_reports()[0].spans[0].length);
  EXPECT_EQ(simulation.world.state().time, 0.0);
  ASSERT_TRUE(simulation.world.step().ok());
  const std::vector<CableReport> later = simulation.cable_reports();
  ASSERT_EQ(start[0].spans.size(), later[0].spans.size());
  for (std::size_t k = 0; k < later[0].spans.size(); ++k) {
    EXPECT_GT(start[0].spans[k].tension, 1.0);
    EXPECT_EQ(start[0].spans[k].tension, later[0].spans[k].tension);
    EXPECT_NE(start[0].spans[k].length, later[0].spans[k].length);
  }
}

TEST(RenderCommand, APictureOfARestHasTheTensionsOfTheRest) {
  // 1000 kg on an elastic rope that the scene stretches to 52.6 kN: at rest it carries 9810 N, told
  // as "9.8 kN". (The recipe of docs/how-to/statics.md.)
  const TemporaryFolder folder;
  const std::string scene = folder.write("load.json", R"({
    "format": "sheave-scene/1", "gravity": [0, -9.81, 0], "duration": 1,
    "bodies": [{"name": "load", "mass": 1000, "position": [0, -10, 0], "shape": {"type": "box", "size": [1, 1, 1]}}],
    "cables": [{"name": "rope", "axial_stiffness": 1e6, "rest_lengths": [9.5], "links": [
      {"type": "attachment", "body": "world", "point": [0, 0, 0]}, {"type": "attachment", "body": "load"}]}]
  })");
  const std::string state = folder.path("rest.state");
  ASSERT_EQ(run_sheave({"statics", scene, "--save-state", state}).exit_code, 0);
  const std::string still = folder.path("rest.svg");
  const ProcessResult result =
      render(scene, {"--load-state", state, "--at", "0", "--labels", "--still", still});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(read_file(still), HasSubstr(">9.8 kN<"));
  EXPECT_THAT(read_file(still), Not(HasSubstr("52.6 kN")));
}

TEST(Player, ShowsTheTensionsOfARestAndTheNextOnesOfAStateWithout) {
  const SceneResult scene = load_scene_text(atwood_scene, "atwood.json");
  ASSERT_TRUE(scene);
  Simulation simulation = command::make_simulation(*scene);
  State state = simulation.world.state();
  // Known tensions stay, be they what they may.
  ASSERT_TRUE(simulation.world.step().ok());
  State known = simulation.world.state();
  known.time = 0.0;
  known.steps = 0;
  ASSERT_TRUE(simulation.world.restore(known).empty());
  const double tension = simulation.cable_reports()[0].spans[0].tension;
  EXPECT_EQ(command::reports_to_show(*scene, simulation)[0].spans[0].tension, tension);
  // A state that differs from the scene's start has the tensions of a step from itself: on a cable
  // that has gone slack there are none.
  for (double& length : state.features.back().reals) {
    length = length > 0.0 ? 2.0 * length : length;
  }
  ASSERT_TRUE(simulation.world.restore(state).empty());
  EXPECT_EQ(command::reports_to_show(*scene, simulation)[0].spans[0].tension, 0.0);
}

TEST(RenderCommand, StartsFromASavedState) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const std::string state = folder.path("half.state");
  ASSERT_EQ(run_sheave({"run", scene, "-q", "--steps", "37", "--save-state", state}).exit_code, 0);
  EXPECT_EQ(render(scene, {"--png", folder.path("all"), "--fps", "10"}).exit_code, 0);
  const ProcessResult rest =
      render(scene, {"--png", folder.path("rest"), "--fps", "10", "--load-state", state, "--still",
                     folder.path("now.png"), "--at", "0.37"});
  EXPECT_EQ(rest.exit_code, 0) << rest.err;
  // Frames at 0.4, 0.5 ... 1 s; the camera shows what is left of the way.
  EXPECT_TRUE(std::filesystem::exists(folder.path("rest/frame_000006.png")));
  EXPECT_FALSE(std::filesystem::exists(folder.path("rest/frame_000007.png")));
  EXPECT_TRUE(std::filesystem::exists(folder.path("now.png")));
  const ProcessResult early =
      render(scene, {"--still", folder.path("a.png"), "--at", "0.3", "--load-state", state});
  EXPECT_EQ(early.exit_code, 2);
  EXPECT_THAT(early.err, HasSubstr("the loaded state is later, at 0.37"));
  const ProcessResult late =
      render(scene, {"--still", folder.path("a.png"), "--duration", "0.2", "--load-state", state});
  EXPECT_EQ(late.exit_code, 2);
  EXPECT_THAT(late.err, HasSubstr("--duration"));
  EXPECT_EQ(render(scene, {"--still", folder.path("a.png"), "--load-state", folder.path("none")})
                .exit_code,
            66);
  EXPECT_EQ(render(scene, {"--still", state, "--load-state", state}).exit_code, 2);
}

TEST(RenderCommand, TheSameFilesTwice) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  EXPECT_EQ(render(scene, {"--still", folder.path("a.png"), "--at", "0.505"}).exit_code, 0);
  EXPECT_EQ(render(scene, {"--still", folder.path("b.png"), "--at", "0.505"}).exit_code, 0);
  EXPECT_EQ(render(scene, {"--still", folder.path("c.png"), "--at", "0.8"}).exit_code, 0);
  EXPECT_EQ(read_file(folder.path("a.png")), read_file(folder.path("b.png")));
  EXPECT_NE(read_file(folder.path("a.png")), read_file(folder.path("c.png")));
}

TEST(RenderCommand, TheSameFilesForAnyNumberOfThreads) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  for (const char* threads : {"1", "2", "5"}) {
    std::vector<std::string> options{"--png", folder.path(threads), "--fps",
                                     "20",    "--parallel",         threads};
    if (have_ffmpeg()) {
      options.insert(options.end(), {"--video", folder.path(threads) + std::string(".mp4")});
    }
    EXPECT_EQ(render(scene, options).exit_code, 0);
  }
  for (const char* threads : {"2", "5"}) {
    for (int frame = 0; frame <= 20; ++frame) {
      const std::string name =
          std::string("/frame_0000") + (frame < 10 ? "0" : "") + std::to_string(frame) + ".png";
      EXPECT_EQ(read_file(folder.path(threads) + name), read_file(folder.path("1") + name));
    }
    if (!have_ffmpeg()) continue;
    EXPECT_EQ(read_file(folder.path(threads) + std::string(".mp4")),
              read_file(folder.path("1.mp4")));
  }
}

TEST(RenderCommand, SpeedAndRateDecideTheNumberOfFrames) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  // Neither frame interval is a multiple of dt = 0.01 s.
  EXPECT_EQ(render(scene, {"--png", folder.path("slow"), "--fps", "30", "--speed", "0.5",
                           "--duration", "0.2"})
                .exit_code,
            0);
  EXPECT_TRUE(std::filesystem::exists(folder.path("slow/frame_000012.png")));
  EXPECT_FALSE(std::filesystem::exists(folder.path("slow/frame_000013.png")));
}

TEST(RenderCommand, OlderFramesInTheFolderAreMentioned) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const std::string frames = folder.path("frames");
  EXPECT_EQ(render(scene, {"--png", frames, "--fps", "4"}).exit_code, 0);
  const ProcessResult result = render(scene, {"--png", frames, "--fps", "2"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("frame_000003.png"));
}

TEST(RenderCommand, TextsOfAStillStayTextsInSvg) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  EXPECT_EQ(render(scene, {"--still", folder.path("still.svg"), "--labels"}).exit_code, 0);
  const std::string svg = read_file(folder.path("still.svg"));
  EXPECT_EQ(svg.rfind("<?xml", 0), 0U);
  EXPECT_THAT(svg, HasSubstr(">t = "));
  EXPECT_THAT(svg, HasSubstr("data:image/png;base64,iVBORw0KGgo"));  // the mark of PNG files
}

TEST(RenderCommand, AStillShowsTheHighestTensionInTheBestFormat) {
  // A load is dropped into its rope: k = 1e5 N/m and 10 rad/s, so the tension is highest after
  // pi / 10 s, and 1/60 s from there is the nearest step, at 0.3167 s.
  const TemporaryFolder folder;
  const std::string scene = folder.write("load.json", R"({
    "format": "sheave-scene/1", "gravity": [0, -9.81, 0], "duration": 0.5,
    "bodies": [{"name": "load", "mass": 1000, "position": [0, -10, 0], "shape": {"type": "box", "size": [1, 1, 1]}}],
    "cables": [{"name": "rope", "axial_stiffness": 1e6, "links": [
      {"type": "attachment", "body": "world", "point": [0, 0, 0]}, {"type": "attachment", "body": "load"}]}],
    "step": {"dt": 0.016666666666666666, "substeps": 16}
  })");
  const std::string still = folder.path("still.svg");
  const ProcessResult result = run_sheave({"render", scene, "--still", still, "--label-names"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const std::string svg = read_file(still);
  EXPECT_THAT(svg, HasSubstr(">t = 0.32 s<"));
  EXPECT_THAT(svg, HasSubstr(">rope: 19.6 kN<"));  // 2 m g
  EXPECT_THAT(svg, HasSubstr("width=\"720\" height=\"1280\""));
  // A time, or a size, that is given holds.
  ASSERT_EQ(render(scene, {"--still", still, "--at", "0.5"}).exit_code, 0);
  EXPECT_THAT(read_file(still), HasSubstr(">t = 0.50 s<"));
  EXPECT_THAT(read_file(still), HasSubstr("width=\"96\" height=\"64\""));
  EXPECT_EQ(run_sheave({"render", scene, "--still", "/no/such/folder/a.png"}).exit_code, 74);
}

// A force of 1 ms pulls a weight of 1 t on a rigid rope: its mean over each of two steps of 0.5 ms is
// 4.5 kN, so the rope has 9.81 kN + 4.5 kN. No 240th part of the run ends there.
TEST(RenderCommand, AStillShowsTheHighestTensionOfAllSteps) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("pulled.json", R"({
    "format": "sheave-scene/1", "gravity": [0, -9.81, 0], "duration": 1,
    "bodies": [{"name": "load", "mass": 1000, "mobility": "slider", "axis": [0, 1, 0],
      "position": [0, -3, 0], "shape": {"type": "box", "size": [1, 1, 1]}}],
    "cables": [{"name": "rope", "links": [
      {"type": "attachment", "body": "world", "point": [0, 0, 0]}, {"type": "attachment", "body": "load"}]}],
    "loads": [{"type": "force", "name": "pull", "body": "load", "times": [0.1, 0.1005, 0.101],
      "forces": [[0, 0, 0], [0, -9000, 0], [0, 0, 0]]}],
    "step": {"dt": 0.0005, "substeps": 1}
  })");
  const std::string still = folder.path("still.svg");
  const ProcessResult result = run_sheave({"render", scene, "--still", still, "--label-names"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(read_file(still), HasSubstr(">rope: 14.3 kN<"));
}

TEST(RenderCommand, WrongUsage) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  EXPECT_EQ(render(scene, {}).exit_code, 2);
  EXPECT_EQ(render(scene, {"--video", folder.path("film.txt")}).exit_code, 2);
  EXPECT_EQ(render(scene, {"--still", folder.path("still.jpg")}).exit_code, 2);
  EXPECT_EQ(render(scene, {"--at", "1"}).exit_code, 2) << "of what?";
  const ProcessResult late = render(scene, {"--still", folder.path("s.png"), "--at", "5"});
  EXPECT_EQ(late.exit_code, 2);
  EXPECT_THAT(late.err, HasSubstr("ends at 1 s"));
  EXPECT_THAT(folder.entries(), ElementsAre("atwood.json"));
}

TEST(RenderCommand, UnwritableOutputsAre74) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  EXPECT_EQ(render(scene, {"--still", "/no/such/folder/a.png"}).exit_code, 74);
  EXPECT_EQ(render(scene, {"--video", "/no/such/folder/a.mp4"}).exit_code, 74);
  EXPECT_EQ(render(scene, {"--png", "/proc/frames"}).exit_code, 74);
}

TEST(RenderCommand, MissingFfmpegIsExplained) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const ProcessResult result =
      render(scene, {"--video", folder.path("film.mp4")}, {.environment = {"PATH=/nowhere"}});
  EXPECT_EQ(result.exit_code, 74);
  EXPECT_THAT(result.err, HasSubstr("ffmpeg"));
  EXPECT_THAT(folder.entries(), ElementsAre("atwood.json"));
}

TEST(RenderCommand, ADivergingRunLeavesTheFramesSoFar) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("runaway.json", runaway_scene);
  const ProcessResult result = render(scene, {"--png", folder.path("frames"), "--fps", "100",
                                              "--still", folder.path("late.png"), "--at", "9"});
  EXPECT_EQ(result.exit_code, 75) << result.err;
  EXPECT_THAT(result.err, HasSubstr("\"rocket\""));
  EXPECT_THAT(result.err, HasSubstr("partial"));
  EXPECT_THAT(result.err, HasSubstr("late.png: not written"));
  EXPECT_TRUE(std::filesystem::exists(folder.path("frames/frame_000000.png")));
  EXPECT_THAT(folder.entries(), ElementsAre("frames", "runaway.json"));
}

TEST(RenderCommand, AnInterruptLeavesAVideoThatPlays) {
  if (!have_ffmpeg()) GTEST_SKIP() << "no ffmpeg here";
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const std::string film = folder.path("film.mp4");
  std::vector<std::string> arguments{
      "render", scene, "--video", film, "--png", folder.path("frames"), "--speed", "0.001"};
  arguments.insert(arguments.end(), small.begin(), small.end());
  Process process(arguments);
  const std::string frame = folder.path("frames/frame_000003.png");
  ASSERT_TRUE(process.wait_until([&] { return std::filesystem::exists(frame); }));
  process.send(SIGINT);
  const ProcessResult result = process.wait();
  EXPECT_EQ(result.exit_code, 130);
  EXPECT_THAT(result.err, HasSubstr("partial"));
  EXPECT_THAT(folder.entries(), ElementsAre("atwood.json", "film.mp4", "frames"));
  EXPECT_EQ(std::system(("ffprobe -v error " + film).c_str()), 0);
}

}  // namespace
}  // namespace sheave::test

#endif  // SHEAVE_HAS_RENDER
