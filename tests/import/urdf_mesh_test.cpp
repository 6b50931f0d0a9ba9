// Meshes and masses of URDF, folders of packages, and the options for masses.

#include <cmath>
#include <filesystem>
#include <fstream>

#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "scenes/import/import.h"
#include "scenes/scene.h"
#include "tests/import/model_files.h"

namespace sheave {
namespace {

namespace fs = std::filesystem;
using import::Outcome;
using nlohmann::json;
using testing::HasSubstr;

/// A folder TOP/packages/arm with urdf/ and meshes/brick.stl, a brick of 0.2 x 0.1 x 0.05 m.
class UrdfMeshes : public testing::Test {
 protected:
  void SetUp() override {
    if (!import::is_available()) GTEST_SKIP() << "built without tinyxml2";
    std::string name = (fs::temp_directory_path() / "sheave-urdf.XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    top = name;
    fs::create_directories(arm() / "urdf");
    fs::create_directories(arm() / "meshes");
    fs::copy_file(test::model_path("meshes/brick.stl"), arm() / "meshes/brick.stl");
    fs::copy_file(test::model_path("meshes/brick.stl"), top / "outside.stl");
  }
  void TearDown() override {
    if (!top.empty()) fs::remove_all(top);
  }
  [[nodiscard]] fs::path arm() const { return top / "packages/arm"; }

  /// The import of a robot with a link that turns and has this mesh.
  [[nodiscard]] Outcome with_mesh(const std::string& mesh, const std::string& folder,
                                  const std::string& inertial = {}) const {
    const std::string text = "<robot name='r'>\n<link name='base'/>\n<link name='part'>" +
                             inertial + "<collision><geometry><mesh " + mesh +
                             "/></geometry></collision></link>\n<joint name='j' type='continuous'>"
                             "<parent link='base'/><child link='part'/></joint></robot>";
    import::Options options;
    options.folder = folder;
    return import::import_model(text, (arm() / "urdf/arm.urdf").string(), options);
  }

  fs::path top;
};

constexpr const char* some_mass =
    "<inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1'/></inertial>";

TEST_F(UrdfMeshes, APackageIsAFolderAroundTheModel) {
  const std::string named = "filename='package://arm/meshes/brick.stl'";
  for (const fs::path& folder : {arm(), top / "packages", top}) {
    const Outcome made = with_mesh(named, folder.string(), some_mass);
    ASSERT_TRUE(made.errors.empty()) << folder;
    const json part = json::parse(made.json)["bodies"][1];
    EXPECT_EQ(part["shapes"][0]["points"].size(), 8U) << folder;
    EXPECT_EQ(part["mass"], 1.0) << folder;
  }
  const Outcome near = with_mesh("filename='../meshes/brick.stl'", arm().string(), some_mass);
  EXPECT_THAT(import::report(near), Not(HasSubstr("--folder")));
}

TEST_F(UrdfMeshes, NoFileOutsideTheFolderIsRead) {
  fs::create_symlink(top / "outside.stl", arm() / "meshes/link.stl");
  for (const char* const file :
       {"package://arm/../../outside.stl", "../../../outside.stl",
        "package://packages/../outside.stl", "package://arm/meshes/link.stl",
        "package://../outside.stl", "package:///etc/passwd", "/etc/passwd",
        "model://arm/../../outside.stl", "../meshes/link.stl", "package://arm"}) {
    const Outcome made =
        with_mesh("filename='" + std::string(file) + "'", arm().string(), some_mass);
    ASSERT_TRUE(made.errors.empty()) << file;
    EXPECT_FALSE(json::parse(made.json)["bodies"][1].contains("shapes")) << file;
    EXPECT_THAT(import::report(made), HasSubstr("name a folder that holds it by --folder")) << file;
  }
  // Without the option only the folder of the model counts.
  EXPECT_THAT(import::report(with_mesh("filename='../meshes/brick.stl'", "", some_mass)),
              HasSubstr("must lie in the folder of the model"));
  // A file that is not read is skipped with its reason.
  EXPECT_THAT(import::report(with_mesh("filename='brick.dae'", "", some_mass)),
              HasSubstr("there is no such file"));
}

// A brick of the sizes s has the mass 1000 s1 s2 s3 and the moments m (s2^2 + s3^2) / 12, here with
// factors along its axes, of which one mirrors it. STL has single precision, 6e-8.
TEST_F(UrdfMeshes, ALinkWithoutMassHasThatOfItsShapes) {
  const Outcome made =
      with_mesh("filename='package://arm/meshes/brick.stl' scale='2 -3 .5'", arm().string());
  ASSERT_TRUE(made.errors.empty());
  const json part = json::parse(made.json)["bodies"][1];
  const Vector3 size(0.4, 0.3, 0.025);
  const double mass = 1000.0 * size.prod();
  EXPECT_NEAR(part["mass"].get<double>(), mass, 1e-6 * mass);
  for (int i = 0; i < 3; ++i) {
    const Vector3 other = size - size[i] * Vector3::Unit(i);
    const double moment = mass * other.squaredNorm() / 12.0;
    EXPECT_NEAR(part["inertia"][static_cast<std::size_t>(i)].get<double>(), moment, 1e-6 * moment);
  }
  EXPECT_THAT(import::report(made), HasSubstr("the mass of its shapes at 1000 kg/m3"));
}

TEST_F(UrdfMeshes, MassesThatNoBodyHasAreRefusedOrMended) {
  const auto made = [](const std::string& inertial, const import::Options& options) {
    return import::import_model(
        "<robot name='r'>\n<link name='base'/>\n<link name='part'>" + inertial +
            "</link>\n<joint name='j' type='spherical'><parent link='base'/>"
            "<child link='part'/></joint></robot>",
        "robot.urdf", options);
  };
  const std::string odd =
      "<inertial><mass value='2'/><inertia ixx='1' iyy='1' izz='4'/></inertial>";
  const Outcome refused = made(odd, {});
  ASSERT_EQ(refused.errors.size(), 1U);
  EXPECT_EQ(refused.errors[0].line, 3);
  EXPECT_THAT(refused.errors[0].message, HasSubstr("[1, 1, 4]"));
  EXPECT_THAT(refused.errors[0].message, HasSubstr("--balance-inertia"));
  import::Options options;
  options.balances = true;
  EXPECT_EQ(json::parse(made(odd, options).json)["bodies"][1]["inertia"], json({2, 2, 2}));
  EXPECT_THAT(made("", options).errors.at(0).message, HasSubstr("--least-mass"));
  options.least_mass = 0.5;
  const json part = json::parse(made("", options).json);
  EXPECT_EQ(part["bodies"][1]["mass"], 0.5);
  EXPECT_NEAR(part["bodies"][1]["inertia"][0].get<double>(), 0.5e-4, 1e-18);
  EXPECT_EQ(part["joints"][0]["type"], "ball");
  EXPECT_THAT(import::report(made("", options)), HasSubstr("here it has 0.5 kg"));
  // A mass in one point has no inertia, whatever the rounding of its place.
  const std::string point =
      "<inertial><origin xyz='.1 .2 .3' rpy='.1 .2 .3'/><mass value='.37'/>"
      "<inertia ixx='0' iyy='0' izz='0'/></inertial>";
  EXPECT_THAT(made(point, {}).errors.at(0).message, HasSubstr("--least-mass"));
  EXPECT_TRUE(made(point, options).errors.empty());
  // Bodies with mass stay as they are.
  EXPECT_EQ(json::parse(made(some_mass, options).json), json::parse(made(some_mass, {}).json));
}

TEST_F(UrdfMeshes, AnIncludeMayLieInTheFolderOfTheOption) {
  std::ofstream(top / "packages/ball.xml")
      << "<mujoco><worldbody><body><freejoint/><geom size='.1'/></body></worldbody></mujoco>";
  const std::string text = "<mujoco>\n<include file='../../ball.xml'/>\n</mujoco>";
  const std::string file = (arm() / "urdf/m.xml").string();
  const Outcome refused = import::import_model(text, file);
  ASSERT_EQ(refused.errors.size(), 1U);
  EXPECT_THAT(refused.errors[0].message, HasSubstr("--folder"));
  import::Options options;
  options.folder = (top / "packages").string();
  EXPECT_TRUE(import::import_model(text, file, options).errors.empty());
}

}  // namespace
}  // namespace sheave
