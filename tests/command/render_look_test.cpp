// sheave render: one scale of tensions for a run, formats, trails.

#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/command/process.h"
#include "tests/command/scenes.h"

#if SHEAVE_HAS_RENDER

#include "command/render/look.h"
#include "command/render/trails.h"

namespace sheave::test {
namespace {

using command::PictureFormat;
using command::PictureOptions;
using testing::HasSubstr;

Scene atwood(double tension_max = 0.0) {
  SceneResult result = load_scene_text(atwood_scene, "atwood.json");
  EXPECT_TRUE(result);
  Scene scene = *result;
  scene.camera = CameraDef{};
  if (tension_max > 0.0) scene.camera->tension_max = tension_max;
  return scene;
}

command::Look look_of(const Scene& scene, const PictureOptions& options) {
  command::Progress progress("survey", 0.0, 100.0, true);
  const auto moments = command::choose_moments(scene, options, 0.0, 0.0);
  return command::survey(scene, {options, 0.0}, moments, progress);
}

PictureOptions still_at(double time) {
  PictureOptions options;
  options.still = "still.png";
  options.at = time;
  return options;
}

TEST(TensionScale, IsTheSameForAllPicturesOfARun) {
  const Scene scene = atwood();
  PictureOptions film;
  film.video = "film.mp4";
  film.fps = 7.0;
  const double tension_max = look_of(scene, film).tension_max;
  // The rope carries 12 N on one side and 16 N on the other; a round number above that.
  EXPECT_GE(tension_max, 16.0);
  EXPECT_LE(tension_max, 20.0);
  for (const double time : {0.0, 0.3, 1.0}) {
    EXPECT_EQ(look_of(scene, still_at(time)).tension_max, tension_max) << time;
  }
}

TEST(TensionScale, ASceneOrAnOptionFixesIt) {
  EXPECT_EQ(look_of(atwood(123.0), still_at(0.5)).tension_max, 123.0);
  PictureOptions options = still_at(0.5);
  options.tension_max = 77.0;
  EXPECT_EQ(look_of(atwood(123.0), options).tension_max, 77.0);
}

TEST(PictureFormat, TurnsWidthAndHeight) {
  PictureOptions options;
  options.width = 800;
  options.height = 450;
  EXPECT_EQ(command::sized(options, PictureFormat::landscape).width, 800);
  EXPECT_EQ(command::sized(options, PictureFormat::portrait).width, 450);
  EXPECT_EQ(command::sized(options, PictureFormat::portrait).height, 800);
  // 600 x 600 are as many pixels.
  EXPECT_EQ(command::sized(options, PictureFormat::square).width, 600);
  EXPECT_EQ(command::sized(options, PictureFormat::square).height, 600);
}

TEST(PictureFormat, TheBestFormatFollowsTheShapeOfTheScene) {
  Scene tall = atwood();
  tall.model.bodies[1].position.y() = -9.0;
  PictureOptions options = still_at(0.1);
  options.format = PictureFormat::best;
  EXPECT_EQ(look_of(tall, options).format, PictureFormat::portrait);
  Scene wide = atwood();
  BodyDef post;
  post.name = "post";
  post.mobility = Mobility::fixed;
  post.shapes = wide.model.bodies[1].shapes;
  post.position = {12.0, 0.0, 0.0};
  wide.model.add(post);
  EXPECT_EQ(look_of(wide, options).format, PictureFormat::landscape);
}

TEST(Trails, ShowThePathOfTheLastSeconds) {
  const Scene scene = atwood();
  command::Trails trails(scene, {"heavy:0.25", "wheel:10:0.5,0,0"});
  EXPECT_NEAR(trails.longest_interval(), 0.25 / 120.0, 1e-12);
  Simulation simulation = command::make_simulation(scene);
  trails.observe(simulation.world);
  for (int k = 0; k < 50; ++k) {
    ASSERT_TRUE(simulation.world.step().ok());
    trails.observe(simulation.world);
  }
  render::DrawList list;
  trails.add_to(list, 0.02);
  ASSERT_EQ(list.tubes.size(), 2U);
  // 25 steps of 0.01 s are 26 places, give or take the rounding of the time; the wheel's are all.
  EXPECT_NEAR(static_cast<double>(list.tubes[0].points.size()), 26.0, 1.0);
  EXPECT_EQ(list.tubes[1].points.size(), 51U);
  const Vector3 now = simulation.world.position(BodyId{2});
  EXPECT_EQ(list.tubes[0].points.back().position, now);
  for (const render::TubePoint& point : list.tubes[1].points) {
    EXPECT_NEAR(point.position.norm(), 0.5, 1e-12) << "a point of the rim";
  }
}

TEST(Trails, RefusesWrongTrails) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const std::string still = folder.path("still.png");
  for (const char* trail : {"heavy", "heavy:", "heavy:x", "heavy:-1", "nobody:1", "heavy:1:2,3"}) {
    const ProcessResult result = run_sheave({"render", scene, "--still", still, "--trail", trail});
    EXPECT_EQ(result.exit_code, 2) << trail;
    EXPECT_THAT(result.err, HasSubstr("--trail"));
  }
  EXPECT_FALSE(std::filesystem::exists(still));
}

TEST(Trails, SuggestsASimilarName) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const ProcessResult result =
      run_sheave({"render", scene, "--still", folder.path("still.png"), "--trail", "heavi:1"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("there is no body \"heavi\", did you mean \"heavy\"?"));
}

TEST(RenderLook, AGifThatIsTooFastIsWrongUsage) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const std::string film = folder.path("film.gif");
  const ProcessResult result = run_sheave({"render", scene, "--video", film, "--fps", "60"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("--fps 60: the frame rate of a GIF must be at most 50"));
  EXPECT_FALSE(std::filesystem::exists(film));
}

TEST(RenderLook, TrailsAndFormatsAreDrawn) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("atwood.json", atwood_scene);
  const auto draw = [&](const char* name, std::vector<std::string> more) {
    std::vector<std::string> arguments{"render",  scene, "--still",  folder.path(name),
                                       "--width", "96",  "--height", "64"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(run_sheave(arguments).exit_code, 0);
    return read_file(folder.path(name));
  };
  const std::string plain = draw("plain.png", {});
  EXPECT_NE(draw("trail.png", {"--trail", "heavy:1"}), plain);
  EXPECT_NE(draw("scale.png", {"--tension-max", "100"}), plain);
  EXPECT_EQ(draw("landscape.png", {"--format", "landscape"}), plain);
  // Width 64 and height 96 are in the header.
  EXPECT_EQ(draw("portrait.png", {"--format", "portrait"}).substr(16, 8),
            std::string("\0\0\0\x40\0\0\0\x60", 8));
}

}  // namespace
}  // namespace sheave::test

#endif  // SHEAVE_HAS_RENDER
