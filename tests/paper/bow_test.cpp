// The bow of the paper's Figure 19 (scenes/paper/bow.json) against its own equations of motion,
// which know nothing of constraints: draw weight, tensions, stored energy, exit speed, and what
// becomes of the energy.

#include <cmath>

#include <gtest/gtest.h>

#include "tests/paper/bow_model.h"
#include "tests/paper/paper_scene.h"

namespace sheave::test {
namespace {

constexpr double full_draw = -0.7;  // of the serving [m]
constexpr double release = 2.0;     // [s]

BowModel::Draw draw_fully(BowModel& bow) {
  BowModel::Draw draw;
  const double from = bow.braced_x();
  for (int i = 0; i <= 20; ++i) draw = bow.hold(from + (full_draw - from) * i / 20.0);
  return draw;
}

double exit_speed(const char* substeps) {
  PaperRun scene("bow", {{"/step/substeps", substeps, ""}});
  scene.run(release + 0.05);
  EXPECT_EQ(scene.value("nock grip.cut"), 1.0);
  return scene.value("arrow.vx");
}

TEST(Bow, BracedAndDrawnItIsInBalance) {
  BowModel bow(paper_scene("bow"));
  const BowModel::Draw braced = bow.hold(bow.braced_x());
  // The scene's positions are rounded to 1e-7 m; the string's ends give by some 1e-3 m/N, so that
  // is 1e-4 N.
  EXPECT_NEAR(braced.force, 0.0, 1e-4);
  const BowModel::Draw full = draw_fully(bow);

  PaperRun scene("bow");
  scene.run(0.1);
  const double energy = scene.value("energy.total");
  scene.run(release - 0.1);
  // What is left of the vibrations that the draw excites: less than 1e-5 of the force at the
  // hinges' damping; the arrow rocks on its rest, which moves the string's halves by 1e-5 of the
  // tension, too.
  EXPECT_NEAR(scene.value("release.0.tension"), full.force, 1e-5 * full.force);
  EXPECT_NEAR(scene.value("string.0.tension"), full.upper_tension, 3e-5 * full.upper_tension);
  EXPECT_NEAR(scene.value("string.1.tension"), full.lower_tension, 3e-5 * full.lower_tension);
  // The arrow's weight moves by less than a millimetre: 2e-4 J.
  EXPECT_NEAR(scene.value("energy.total") - energy, full.energy - braced.energy, 3e-4);
}

TEST(Bow, ModelBalancesItsEnergy) {
  BowModel bow(paper_scene("bow"));
  (void)draw_fully(bow);
  const BowModel::Shot shot = bow.loose(0.1, 4e-6);
  EXPECT_NEAR(shot.energy_error, 0.0, 1e-6);
  // Runge and Kutta's error is far below what the moment of separation, known to a step, leaves
  // open.
  EXPECT_NEAR(shot.exit_speed, bow.loose(0.03, 2e-6).exit_speed, 1e-3);
}

TEST(Bow, ArrowLeavesWithTheSpeedOfTheEquationsOfMotion) {
  BowModel bow(paper_scene("bow"));
  (void)draw_fully(bow);
  const double expected = bow.loose(0.03, 2e-6).exit_speed;
  // Second order in the substep but for the moment of separation: a quarter per halving, and no
  // more than 0.4 of it.
  const double coarse = std::abs(exit_speed("10") - expected);
  const double fine = std::abs(exit_speed("20") - expected);
  EXPECT_LT(coarse, 0.0005 * expected);
  EXPECT_LT(fine, 0.5 * coarse);
}

TEST(Bow, FreeArrowFliesAParabola) {
  PaperRun scene("bow");
  scene.run(release + 0.05);
  const double x = scene.value("arrow.x");
  const double y = scene.value("arrow.y");
  const double vx = scene.value("arrow.vx");
  const double vy = scene.value("arrow.vy");
  const double t = 0.2;
  scene.run(release + 0.05 + t);
  // Exact for rattle, whose drift is that of constant acceleration; rounding of numbers of order
  // 10.
  EXPECT_NEAR(scene.value("arrow.x"), x + vx * t, 1e-9);
  EXPECT_NEAR(scene.value("arrow.y"), y + vy * t - 5.0 * t * t, 1e-9);
}

TEST(Bow, DampingTakesTheEnergyThatTheArrowLeaves) {
  BowModel bow(paper_scene("bow"));
  (void)draw_fully(bow);
  const double losses = bow.loose(0.1, 4e-6).losses;
  PaperRun scene("bow");
  scene.run(release - 0.05);
  const double before = scene.value("energy.total");
  scene.run(release + 0.1);
  // String and tips vibrate with up to 1700 rad/s, of which 1/2400 s resolves the period with nine
  // substeps: the losses are right to (w h)^2 / 12 = 4 %.
  EXPECT_NEAR(before - scene.value("energy.total"), losses, 0.04 * losses);
}

}  // namespace
}  // namespace sheave::test
