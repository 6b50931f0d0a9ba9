// From simulated machines to draw lists.
#include <cmath>

#include <gtest/gtest.h>

#include "engine/joints/hinge.h"
#include "engine/shapes/box.h"
#include "engine/shapes/cylinder.h"
#include "engine/shapes/polyhedron.h"
#include "engine/shapes/prism.h"
#include "render/renderer.h"
#include "render/view_builder.h"
#include "render/view_survey.h"
#include "tests/support/builders.h"

namespace sheave::render {
namespace {

template <class T>
int count(const DrawList& list) {
  int n = 0;
  for (const Solid& solid : list.solids) n += std::holds_alternative<T>(solid.shape) ? 1 : 0;
  return n;
}

/// The Atwood machine with shapes on its bodies.
test::Machine shaped_atwood() {
  test::Machine machine = test::Atwood{}.machine();
  for (BodyDef& body : machine.model.bodies) {
    const bool wheel = body.mobility == Mobility::rotor;
    body.shapes.clear();
    if (wheel) {
      auto cylinder = std::make_shared<Cylinder>();
      cylinder->radius = test::Atwood{}.radius;
      body.shapes.push_back({cylinder});
    } else {
      auto box = std::make_shared<Box>();
      box->size = {0.2, 0.2, 0.2};
      body.shapes.push_back({box});
    }
  }
  return machine;
}

TEST(ViewBuilder, DrawsEveryBodyAndTheWholeCable) {
  const Simulation s = test::start(shaped_atwood());
  const auto reports = s.cable_reports();
  const ViewBuilder builder(s.world, reports, {.force_labels = true, .title = "atwood"});
  const DrawList list = builder.build(s.world, reports);
  EXPECT_EQ(count<SheaveShape>(list), 1);
  EXPECT_EQ(count<BoxShape>(list), 2);
  EXPECT_EQ(count<SphereShape>(list), 2);  // the knots at the cable's ends
  EXPECT_EQ(list.tubes.size(), 1U);
  EXPECT_EQ(list.labels.size(), 2U);
  EXPECT_EQ(list.planes.size(), 0U);
  EXPECT_TRUE(list.legend);
  EXPECT_TRUE(validate(list).empty());
  EXPECT_EQ(list.title, "atwood");
  EXPECT_EQ(list.time, 0.0);
}

TEST(ViewBuilder, DrawsWheelsThatHaveNoShape) {
  test::Machine machine = test::Atwood{}.machine();
  for (BodyDef& body : machine.model.bodies) body.shapes.clear();
  for (BodyDef& body : machine.model.bodies) {
    if (!body.mass) body.mass = 1.0;
    if (!body.inertia) body.inertia = Vector3(0.1, 0.1, 0.1);
  }
  auto roll = std::make_shared<RollingLink>();
  roll->body = BodyId{0};
  roll->winding = Winding::clockwise;
  roll->center = Vector3(0, 0, 0);
  roll->normal = Vector3(0, 0, 1);
  roll->radius = test::Atwood{}.radius;
  machine.cables[0].links[1] = roll;
  const Simulation s = test::start(machine);
  const auto reports = s.cable_reports();
  const DrawList list = ViewBuilder(s.world, reports).build(s.world, reports);
  EXPECT_EQ(count<SheaveShape>(list), 1);
  EXPECT_TRUE(validate(list).empty());
}

TEST(ViewBuilder, ACamIsAPlainDiscAndNotAWheelWithASecondAxle) {
  test::Machine machine = shaped_atwood();
  auto disc = std::make_shared<Cylinder>();
  disc->radius = test::Atwood{}.radius;
  machine.model.bodies[0].shapes = {{disc, {0.0, -0.1, 0.0}}, {disc, {0.0, 0.1, -0.3}}};
  const Simulation s = test::start(machine);
  const auto reports = s.cable_reports();
  const DrawList list = ViewBuilder(s.world, reports).build(s.world, reports);
  EXPECT_EQ(count<SheaveShape>(list), 0);
  EXPECT_EQ(count<CylinderShape>(list), 2);
}

TEST(ViewBuilder, ChangesNothing) {
  Simulation s = test::start(shaped_atwood());
  const ViewBuilder builder(s.world, s.cable_reports());
  test::run(s.world, 0.3);
  const std::uint64_t before = hash(s.world.state());
  ViewSurvey survey;
  for (int i = 0; i < 3; ++i) {
    const auto reports = s.cable_reports();
    survey.add(s.world, reports);
    EXPECT_FALSE(builder.build(s.world, reports).solids.empty());
  }
  EXPECT_EQ(hash(s.world.state()), before);
}

TEST(ViewBuilder, WheelTurnsWithItsBody) {
  Simulation s = test::start(shaped_atwood());
  const ViewBuilder builder(s.world, s.cable_reports());
  test::run(s.world, 0.4);
  const DrawList list = builder.build(s.world, s.cable_reports());
  for (const Solid& solid : list.solids) {
    if (!std::holds_alternative<SheaveShape>(solid.shape)) continue;
    EXPECT_LT(solid.orientation.angularDistance(s.world.orientation(BodyId{0})), 1e-12);
    EXPECT_GT(solid.orientation.angularDistance(Quaternion::Identity()), 0.1);
  }
}

TEST(ViewBuilder, BlockGetsCheeksForItsSheaves) {
  test::Tackle tackle;
  tackle.strands = 4;
  const Simulation s = test::start(tackle.machine());
  const auto reports = s.cable_reports();
  const DrawList list = ViewBuilder(s.world, reports).build(s.world, reports);
  EXPECT_TRUE(validate(list).empty());
  EXPECT_GE(count<SheaveShape>(list), 3);
}

TEST(ViewBuilder, AFloorIsDrawnOnlyWhereThereIsGround) {
  test::Machine machine = shaped_atwood();
  machine.model.ground = GroundDef{{0, -7, 0}, {0, 3, 0}};
  const Simulation s = test::start(machine);
  const DrawList list = ViewBuilder(s.world, s.cable_reports()).build(s.world, s.cable_reports());
  ASSERT_EQ(list.planes.size(), 1U);
  EXPECT_EQ(list.planes[0].point.y(), -7.0);
  EXPECT_EQ(list.planes[0].normal.y(), 1.0);
  machine.model.ground.reset();
  const Simulation floating = test::start(machine);
  EXPECT_TRUE(ViewBuilder(floating.world, floating.cable_reports())
                  .build(floating.world, floating.cable_reports())
                  .planes.empty());
}

TEST(ViewBuilder, RoundingIsNotShownAsTension) {
  // A belt that turns freely carries nothing but rounding errors.
  test::Machine machine = test::belt(0.5, 0.2, 2.0, 0.1, 0.02);
  machine.model.gravity = test::down;
  Simulation s = test::start(machine);
  test::run(s.world, 0.2);
  auto reports = s.cable_reports();
  for (CableReport& cable : reports) {
    for (SpanReport& span : cable.spans) span.tension = 1e-9;
  }
  const DrawList list = ViewBuilder(s.world, reports).build(s.world, reports);
  EXPECT_GT(list.legend->max, 1.0);
  EXPECT_EQ(list.tubes[0].points[0].color, slack_color);
}

TEST(Drawable, PolyhedraAndPrismsFaceOutwards) {
  Polyhedron cube;
  for (int i = 0; i < 8; ++i) cube.points.emplace_back(i & 1, (i >> 1) & 1, (i >> 2) & 1);
  Prism wedge;
  wedge.outline = {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}};
  wedge.length = 3.0;
  const auto volume = [](const Shape& shape) {
    const TriangleMesh& mesh = *std::get<MeshShape>(shape).mesh;
    double sum = 0.0;
    for (const auto& t : mesh.triangles) {
      sum += mesh.vertices[t[0]].dot(mesh.vertices[t[1]].cross(mesh.vertices[t[2]])) / 6.0;
    }
    return sum;
  };
  EXPECT_NEAR(volume(drawable(cube)), 1.0, 1e-12);
  EXPECT_NEAR(volume(drawable(wedge)), 3.0, 1e-12);
}

TEST(MotionPlane, IsNormalToTheWheelsCommonAxis) {
  const Simulation s = test::start(shaped_atwood());
  const auto normal = motion_plane(s.world.model(), s.cable_reports());
  ASSERT_TRUE(normal);
  EXPECT_NEAR(normal->z(), 1.0, 1e-12);
  auto reports = s.cable_reports();
  reports[0].links[1].normal = {0, 0, -1};
  EXPECT_NEAR(motion_plane(s.world.model(), reports)->z(), 1.0, 1e-12);
  reports.push_back(reports[0]);
  reports[1].links[1].normal = {1, 0, 0};
  EXPECT_FALSE(motion_plane(s.world.model(), reports));
  EXPECT_FALSE(motion_plane(Model{}, {}));
}

TEST(ViewSurvey, BoundsAndScaleCoverTheRun) {
  Simulation s = test::start(shaped_atwood());
  ViewSurvey survey;
  EXPECT_TRUE(survey.bounds().isEmpty());
  EXPECT_EQ(survey.tension_max(), 1.0);
  survey.add(s.world, s.cable_reports());
  const Eigen::AlignedBox3d before = survey.bounds();
  test::run(s.world, 0.5);
  survey.add(s.world, s.cable_reports());
  EXPECT_TRUE(survey.bounds().contains(before));
  EXPECT_LT(survey.bounds().min().y(), before.min().y());
  // T = m1 (g + a) and m2 (g - a), both about 12 N; the next round number.
  EXPECT_GE(survey.tension_max(), 12.0);
  EXPECT_LE(survey.tension_max(), 15.0);
}

TEST(AutomaticCamera, ShowsTheWholeRunClearOfTheLegend) {
  Simulation s = test::start(shaped_atwood());
  ViewSurvey survey;
  survey.add(s.world, s.cable_reports());
  const ViewBuilder builder(s.world, s.cable_reports(), {.title = "atwood"});
  const DrawList list = builder.build(s.world, s.cable_reports());
  const Camera camera =
      automatic_camera(s.world.model(), s.cable_reports(), survey.bounds(), list, 640, 360);
  const Projector projector(camera, 640, 360);
  for (int i = 0; i < 8; ++i) {
    const Vector3 corner = survey.bounds().corner(static_cast<Eigen::AlignedBox3d::CornerType>(i));
    const auto p = projector.project(corner);
    ASSERT_TRUE(p);
    EXPECT_GT(p->x, 10.0);
    EXPECT_LT(p->x, 560.0);
    EXPECT_GT(p->y, 20.0);
    EXPECT_LT(p->y, 350.0);
  }
}

TEST(ViewBuilder, BodiesHaveTheColoursTheyAreGiven) {
  const Simulation simulation = test::start(shaped_atwood());
  const std::vector<CableReport> cables = simulation.cable_reports();
  ViewOptions options;
  const DrawList plain =
      ViewBuilder(simulation.world, cables, options).build(simulation.world, cables);
  options.body_colors = {std::nullopt, rgb(0x102030)};  // the first weight; nothing for the second
  const DrawList painted =
      ViewBuilder(simulation.world, cables, options).build(simulation.world, cables);
  ASSERT_EQ(painted.solids.size(), plain.solids.size());
  int different = 0;
  for (std::size_t i = 0; i < plain.solids.size(); ++i) {
    if (painted.solids[i].color == plain.solids[i].color) continue;
    ++different;
    EXPECT_EQ(painted.solids[i].color, rgb(0x102030));
    EXPECT_TRUE(std::holds_alternative<BoxShape>(painted.solids[i].shape));
  }
  EXPECT_EQ(different, 1);
}

TEST(ViewBuilder, JointsCanBeLeftOut) {
  Model model;
  auto hinge = std::make_shared<HingeJoint>();
  hinge->name = "hinge";
  hinge->body_b = model.add(test::lump("lump", {0.4, 0.0, 0.0}, 1.0));
  model.joints.push_back(hinge);
  const World world = test::start(model);
  ViewOptions options;
  const auto parts = [&] { return ViewBuilder(world, {}, options).build(world, {}).solids.size(); };
  const std::size_t with_joints = parts();
  options.joints = false;
  EXPECT_LT(parts(), with_joints);
}

}  // namespace
}  // namespace sheave::render
