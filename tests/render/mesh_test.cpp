#include "render/mesh.h"

#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "render/solid_mesh.h"
#include "render/tube_mesh.h"

namespace sheave::render {
namespace {

Vector3 place(const Mesh& mesh, std::uint32_t index) {
  const auto& p = mesh.vertices[index].position;
  return {p[0], p[1], p[2]};
}

/// Volume by the divergence theorem: right only if all triangles face outwards.
double volume(const Mesh& mesh) {
  double sum = 0.0;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const Vector3 a = place(mesh, mesh.triangles[t]);
    const Vector3 b = place(mesh, mesh.triangles[t + 1]);
    const Vector3 c = place(mesh, mesh.triangles[t + 2]);
    sum += a.dot(b.cross(c)) / 6.0;
  }
  return sum;
}

/// Whether every edge is shared by two triangles that run along it in opposite directions.
bool closed(const Mesh& mesh) {
  using Place = std::array<float, 3>;
  std::map<std::pair<Place, Place>, int> edges;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Place a = mesh.vertices[mesh.triangles[t + k]].position;
      const Place b = mesh.vertices[mesh.triangles[t + (k + 1) % 3]].position;
      ++edges[{a, b}];
      --edges[{b, a}];
    }
  }
  for (const auto& [edge, balance] : edges) {
    if (balance != 0) return false;
  }
  return true;
}

void expect_unit_normals(const Mesh& mesh) {
  for (const MeshVertex& v : mesh.vertices) {
    EXPECT_NEAR(std::hypot(v.normal[0], v.normal[1], v.normal[2]), 1.0F, 1e-5F);
    EXPECT_NEAR(std::hypot(v.outline[0], v.outline[1], v.outline[2]), 1.0F, 1e-5F);
  }
}

TEST(SolidMesh, BoxHasItsVolumeAndTwelveEdges) {
  const Mesh mesh = make_mesh(BoxShape{{1.0, 2.0, 3.0}}, 0);
  EXPECT_NEAR(volume(mesh), 6.0, 1e-6);
  EXPECT_TRUE(closed(mesh));
  EXPECT_EQ(mesh.lines.size(), 24U);
  expect_unit_normals(mesh);
  // The silhouette grows along the diagonal at a corner, however its faces are cut.
  for (const MeshVertex& v : mesh.vertices) {
    for (const float c : v.outline) EXPECT_NEAR(std::abs(c), 0.57735F, 1e-4F);
  }
}

TEST(SolidMesh, RoundShapesApproachTheirVolumes) {
  const auto check = [](const Shape& shape, double exact, std::size_t sharp) {
    const Mesh mesh = make_mesh(shape, 96);
    EXPECT_TRUE(closed(mesh));
    EXPECT_NEAR(volume(mesh), exact, 0.005 * exact);
    EXPECT_LT(volume(mesh), exact);
    EXPECT_EQ(mesh.lines.size(), 2 * sharp);
    expect_unit_normals(mesh);
  };
  check(SphereShape{0.5}, pi / 6.0, 0);
  check(CylinderShape{0.5, 2.0}, pi / 2.0, std::size_t{2} * 96);
  check(CapsuleShape{0.5, 2.0}, pi / 6.0 + pi / 2.0, 0);
}

TEST(SolidMesh, MeshShapeKeepsItsTriangles) {
  auto tetrahedron = std::make_shared<TriangleMesh>();
  tetrahedron->vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  tetrahedron->triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  const Mesh mesh = make_mesh(MeshShape{tetrahedron}, 0);
  EXPECT_NEAR(volume(mesh), 1.0 / 6.0, 1e-7);
  EXPECT_EQ(mesh.lines.size(), 12U);
}

TEST(SolidMesh, SheaveStaysInsideItsCylinderAndShowsItsMark) {
  for (const int spokes : {0, 5, 6}) {
    const SheaveShape sheave{0.5, 0.2, 0.03, 0.0, spokes};
    const Mesh mesh = make_mesh(sheave, 48);
    EXPECT_GT(volume(mesh), 0.0);
    expect_unit_normals(mesh);
    bool marked = false;
    for (const MeshVertex& v : mesh.vertices) {
      EXPECT_LE(std::hypot(v.position[0], v.position[1]), 0.5F);
      EXPECT_LE(std::abs(v.position[2]), 0.13F);  // the axle's pin stands out a little
      if (v.paint[3] == 255) {
        marked = true;
        EXPECT_GT(v.position[0], 0.0F);  // the marked spoke points along +x
      }
    }
    EXPECT_TRUE(marked);
  }
}

TEST(SolidMesh, GrooveLeavesRoomForTheCable) {
  // No point of the rim may reach into the cable that lies in the groove.
  for (const double width : {0.0, 0.08}) {
    const SheaveShape sheave{0.5, 0.2, 0.03, width, 5};
    const Mesh mesh = make_mesh(sheave, 64);
    for (const MeshVertex& v : mesh.vertices) {
      const double r = std::hypot(v.position[0], v.position[1]);
      const double z = std::max(0.0, std::abs(static_cast<double>(v.position[2])) - 0.5 * width);
      EXPECT_GE(std::hypot(r - 0.5, z), 0.03 - 1e-3);
    }
  }
}

Tube straight(const Vector3& from, const Vector3& to, double radius) {
  return {{{from, rgb(0xff0000)}, {to, rgb(0x0000ff)}}, radius, false};
}

TEST(TubeMesh, HasTheVolumeOfACapsule) {
  Mesh mesh;
  append_tube(straight({0, 0, 0}, {1, 2, 2}, 0.1), Vector3::Zero(), 64, mesh);
  const double exact = pi * 0.01 * 3.0 + 4.0 / 3.0 * pi * 0.001;
  EXPECT_NEAR(volume(mesh), exact, 0.01 * exact);
  EXPECT_EQ(mesh.vertices.front().paint[0], 255);
  EXPECT_EQ(mesh.vertices.back().paint[2], 255);
  expect_unit_normals(mesh);
}

TEST(TubeMesh, FarFromTheOriginKeepsItsRoundness) {
  const Vector3 far{1e6, -2e6, 3e6};
  Mesh mesh;
  append_tube(straight(far, far + Vector3(1, 0, 0), 0.01), far, 32, mesh);
  for (const MeshVertex& v : mesh.vertices) {
    EXPECT_LE(std::hypot(v.position[1], v.position[2]), 0.01 + 1e-7);
  }
}

TEST(TubeMesh, SkipsRepeatedPointsAndEmptyTubes) {
  Mesh mesh;
  append_tube({{{{1, 1, 1}, {}}, {{1, 1, 1}, {}}}, 0.1, false}, Vector3::Zero(), 8, mesh);
  append_tube({}, Vector3::Zero(), 8, mesh);
  EXPECT_TRUE(mesh.vertices.empty());
  // A full reversal and repeated points must not give undefined normals.
  Tube bent;
  for (const double x : {0.0, 0.0, 1.0, 1.0, 0.2}) bent.points.push_back({{x, 0, 0}, {}});
  append_tube(bent, Vector3::Zero(), 8, mesh);
  expect_unit_normals(mesh);
}

TEST(TubeMesh, ClosedTubeIsARing) {
  Tube ring{{}, 0.1, true};
  for (int k = 0; k < 100; ++k) {
    const double a = 2.0 * pi * k / 100.0;
    ring.points.push_back({{std::cos(a), std::sin(a), 0.0}, {}});
  }
  Mesh mesh;
  append_tube(ring, Vector3::Zero(), 48, mesh);
  EXPECT_NEAR(volume(mesh), 2.0 * pi * pi * 0.01, 0.01 * 2.0 * pi * pi * 0.01);
}

}  // namespace
}  // namespace sheave::render
