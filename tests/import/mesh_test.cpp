// Meshes of STL and OBJ files: integrals against closed forms and against MuJoCo, faults by name and
// line, paths that leave the folder.

#include "scenes/import/mesh.h"

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/import/model_files.h"

namespace sheave {
namespace {

using import::MeshSolid;
using import::TriangleMesh;
using testing::HasSubstr;

std::string file_of(const std::string& name) {
  std::ifstream file(test::model_path("meshes/" + name), std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::string message(const Result<TriangleMesh>& mesh) {
  return mesh ? "" : mesh.errors().front().message;
}

/// Triangles as binary STL.
std::string binary_stl(const std::vector<std::array<Vector3, 3>>& triangles, std::uint32_t count) {
  std::string bytes(80, 's');
  const auto append = [&](std::uint32_t word) {
    for (int i = 0; i < 4; ++i) bytes += static_cast<char>((word >> (8 * i)) & 255U);
  };
  append(count);
  for (const auto& triangle : triangles) {
    bytes += std::string(12, '\0');
    for (const Vector3& corner : triangle) {
      for (int k = 0; k < 3; ++k) {
        const auto value = static_cast<float>(corner[k]);
        std::uint32_t word = 0;
        std::memcpy(&word, &value, 4);
        append(word);
      }
    }
    bytes += std::string(2, '\0');
  }
  return bytes;
}

/// The corners of a tetrahedron at the origin and the unit points, seen from outside.
std::vector<std::array<Vector3, 3>> unit_tetrahedron() {
  const Vector3 o = Vector3::Zero();
  const Vector3 x = Vector3::UnitX();
  const Vector3 y = Vector3::UnitY();
  const Vector3 z = Vector3::UnitZ();
  return {{o, y, x}, {o, x, z}, {x, y, z}, {y, o, z}};
}

// V = 1/6, the centre at 1/4, and about it the moments of x^2 and x y are V (1/10 - 1/16) = V 3/80
// and V (1/20 - 1/16) = -V / 80.
TEST(Meshes, ATetrahedronHasItsClosedForms) {
  const auto mesh = import::read_stl(binary_stl(unit_tetrahedron(), 4));
  ASSERT_TRUE(mesh) << message(mesh);
  EXPECT_EQ(mesh->points.size(), 4U);
  const Result<MeshSolid> solid = import::solid_of(*mesh);
  ASSERT_TRUE(solid);
  EXPECT_NEAR(solid->volume, 1.0 / 6.0, 1e-16);
  EXPECT_LT((solid->center - Vector3::Constant(0.25)).norm(), 1e-15);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      EXPECT_NEAR(solid->inertia(i, j), (i == j ? 6.0 : 1.0) / 480.0, 1e-16);
    }
  }
}

// 0.2 x 0.1 x 0.05 m, rounded to floats of 6e-8: (b^2 + c^2) / 12 of each axis.
TEST(Meshes, ABrickOfAnyFormatHasItsMoments) {
  const auto mesh = import::read_stl(file_of("brick.stl"));
  ASSERT_TRUE(mesh) << message(mesh);
  std::string obj;
  std::string words = "solid a brick of words\n";
  for (const Vector3& p : mesh->points) obj += fmt::format("v {} {} {}\n", p.x(), p.y(), p.z());
  for (const auto& [a, b, c] : mesh->triangles) {
    obj += fmt::format("f {}/1/2 -{} {}//3\n", a + 1, mesh->points.size() - b, c + 1);
    words += "facet normal 0 0 0\n outer loop\n";
    for (const auto i : {a, b, c}) {
      const Vector3& p = mesh->points[i];
      words += fmt::format("  vertex {} {} {:+e}\n", p.x(), p.y(), p.z());
    }
    words += " endloop\nendfacet\n";
  }
  for (const auto& read : {mesh, import::read_obj(obj), import::read_stl(words + "endsolid\n")}) {
    ASSERT_TRUE(read) << message(read);
    const Result<MeshSolid> solid = import::solid_of(*read);
    ASSERT_TRUE(solid);
    EXPECT_NEAR(solid->volume, 1e-3, 1e-9);
    EXPECT_LT((solid->center - Vector3(0.13, 0.04, 0.045)).norm(), 1e-7);
    const Vector3 moments = Vector3(0.0125, 0.0425, 0.05) / 12.0 * 1e-3;
    EXPECT_LT((solid->inertia - Matrix3(moments.asDiagonal())).norm(), 1e-11);
  }
}

TEST(Meshes, FaultsNameTheLineOrTheByte) {
  EXPECT_THAT(message(import::read_obj("v 0 0\n")), HasSubstr("line 1: v must have 3 finite"));
  EXPECT_THAT(message(import::read_obj("v 0 0 nan\n")), HasSubstr("finite"));
  EXPECT_THAT(message(import::read_obj("v 0 0 1e999\n")), HasSubstr("finite"));
  EXPECT_THAT(message(import::read_obj("v 0 0 0\n\nf 1 2 3\n")),
              HasSubstr("line 3: f names the point \"2\""));
  EXPECT_THAT(message(import::read_obj("v 0 0 0\nf 1 -2 1\n")), HasSubstr("\"-2\""));
  EXPECT_THAT(message(import::read_obj("v 0 0 0\nf 1 0.5 1\n")), HasSubstr("\"0.5\""));
  EXPECT_THAT(message(import::read_obj("v 0 0 0\nf 1 1\n")), HasSubstr("3 points or more"));
  EXPECT_THAT(message(import::read_stl("solid s\nfacet\nvertex 1 2\n")), HasSubstr("line 3"));
  EXPECT_THAT(message(import::read_stl("something")), HasSubstr("no STL file"));
  auto triangles = unit_tetrahedron();
  triangles[1][2].x() = std::nan("");
  EXPECT_THAT(message(import::read_stl(binary_stl(triangles, 4))), HasSubstr("byte 170"));
  EXPECT_THAT(message(import::read_stl(binary_stl(unit_tetrahedron(), 5))), HasSubstr("no STL"));
}

TEST(Meshes, OpenAndInvertedSurfacesHaveNoSolid) {
  auto triangles = unit_tetrahedron();
  triangles.pop_back();
  triangles.push_back(triangles.back());
  const auto open = import::read_stl(binary_stl(triangles, 4));
  ASSERT_TRUE(open);
  const Result<MeshSolid> none = import::solid_of(*open);
  ASSERT_FALSE(none);
  EXPECT_THAT(none.errors().front().message, HasSubstr("not closed"));
  auto inverted = unit_tetrahedron();
  for (auto& triangle : inverted) std::swap(triangle[0], triangle[1]);
  const Result<MeshSolid> inside = import::solid_of(*import::read_stl(binary_stl(inverted, 4)));
  ASSERT_FALSE(inside);
  EXPECT_THAT(inside.errors().front().message, HasSubstr("counter-clockwise"));
}

TEST(Meshes, TooManyTrianglesAreRefused) {
  std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf";
  for (std::size_t i = 0; i < import::most_triangles + 3; ++i) obj += i % 2 == 0 ? " 1" : " 2";
  EXPECT_THAT(message(import::read_obj(obj)), HasSubstr("more than 1000000 triangles"));
  std::string stl(80, '\0');
  stl += std::string("\x41\x42\x0f\x00", 4);  // 1000001
  stl.resize(84 + 50 * 1'000'001, '\0');
  EXPECT_THAT(message(import::read_stl(stl)), HasSubstr("at most 1000000"));
}

class ImportedMeshes : public testing::Test {
 protected:
  void SetUp() override {
    if (!import::is_available()) GTEST_SKIP() << "built without tinyxml2";
  }
};

// MuJoCo keeps points in single precision, 6e-8 of them.
TEST_F(ImportedMeshes, HaveTheMassesOfMujoco) {
  const test::ReadModel model(test::plain_model("meshes"));
  const auto pose = pose_of(*model, import::mjcf::reference_positions(*model), {});
  const nlohmann::json bodies = test::references("meshes")["reference"]["bodies"];
  ASSERT_EQ(bodies.size(), 4U);
  ASSERT_EQ(model->bodies.size(), 5U);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const auto own = model->bodies[i + 1].inertial.seen_from(pose.bodies[i + 1].frame);
    EXPECT_NEAR(own.mass, bodies[i]["mass"].get<double>(), 1e-6 * own.mass) << i;
    EXPECT_LT((own.center - test::vector_at(bodies[i]["center"], 0)).norm(), 1e-6) << i;
    Matrix3 tensor;
    for (int k = 0; k < 9; ++k) {
      tensor(k / 3, k % 3) = bodies[i]["tensor"][static_cast<std::size_t>(k)].get<double>();
    }
    EXPECT_LT((own.inertia - tensor).norm(), 1e-6 * tensor.norm()) << i;
  }
}

std::string mesh_notes(const std::string& assets, const std::string& geom,
                       const std::string& compiler = "meshdir=\"meshes\"") {
  const std::string text = fmt::format(
      "<mujoco><compiler {}/><asset>\n{}\n</asset><worldbody><body><freejoint/>\n<geom "
      "type=\"mesh\" {}/><geom size=\"0.1\"/></body></worldbody></mujoco>",
      compiler, assets, geom);
  const import::Outcome made = import::import_model(text, test::model_path("text.xml"));
  std::string all;
  for (const import::Note& note : made.notes) all += fmt::format("{}: {}\n", note.line, note.text);
  for (const SceneError& error : made.errors) all += to_string(error) + "\n";
  return all + made.json;
}

TEST_F(ImportedMeshes, AreShapesByTheirHulls) {
  const std::string made = mesh_notes(R"(<mesh file="angle.obj"/>)", R"(mesh="angle")");
  EXPECT_THAT(made, HasSubstr("2: 20 triangles, the hull has 10 corners"));
  EXPECT_THAT(made, HasSubstr("polyhedron"));
  const import::Outcome whole =
      import::import_model(test::plain_model("meshes"), test::model_path("meshes.xml"));
  EXPECT_TRUE(load_scene_text(whole.json, "meshes")) << "five meshes on four bodies";
}

TEST_F(ImportedMeshes, WhatCannotBeReadIsToldWithItsLine) {
  const std::string use = R"(mesh="m")";
  EXPECT_THAT(mesh_notes(R"(<mesh name="m" file="none.stl"/>)", use),
              HasSubstr("2: file \"meshes/none.stl\": there is no such file"));
  EXPECT_THAT(mesh_notes(R"(<mesh name="m" file="none.stl"/>)", use),
              HasSubstr("4: neither shape nor mass: mesh \"m\" (line 2)"));
  EXPECT_THAT(mesh_notes(R"(<mesh name="m" file="../meshes.xml"/>)", use),
              HasSubstr(".stl or .obj"));
  EXPECT_THAT(mesh_notes(R"(<mesh name="m" vertex="0 0 0"/>)", use),
              HasSubstr("only meshes of files"));
  EXPECT_THAT(mesh_notes(R"(<mesh name="n" file="brick.stl"/>)", use), HasSubstr("name of a mesh"));
  for (const char* const path : {"../../model_files.h", "/etc/passwd", "../../../import/x.stl"}) {
    EXPECT_THAT(mesh_notes(fmt::format("<mesh name=\"m\" file=\"{}\"/>", path), use),
                HasSubstr("must lie in the folder of the model or below"))
        << path;
  }
  EXPECT_THAT(mesh_notes(R"(<mesh name="m" file="../../brick.stl"/>)", use,
                         R"(meshdir="meshes" strippath="true")"),
              HasSubstr("12 triangles"));
}

}  // namespace
}  // namespace sheave
