// The certificate on the laws along coordinates of joints.

#include <cmath>

#include <gtest/gtest.h>

#include "cable/certificate.h"
#include "engine/joint_report.h"
#include "engine/joints/hinge.h"
#include "engine/joints/slider.h"
#include "tests/support/builders.h"

namespace sheave::test::joint_law {
namespace {

// The damper of a slider whose axis is fixed in a body that swings 4 m away: with `xpbd` its force
// works against the motion at the end of a substep, which is 4 m x (w h)^2 / 2 less than the change
// of the coordinate. One without a spring counts that change.
TEST(JointLaw, DampedSliderFarFromTheBodyThatCarriesItsAxis) {
  for (const auto& [integrator, stiffness] : {std::pair{IntegratorKind::xpbd, 6000.0},
                                              {IntegratorKind::xpbd, 0.0},
                                              {IntegratorKind::rattle, 6000.0},
                                              {IntegratorKind::rattle, 0.0}}) {
    Machine machine;
    machine.model.gravity = down;
    machine.model.step = direct_settings(integrator, 0.003);
    const BodyId swing = machine.model.add(lump("swing", {4.0, 0.4, 0.0}, 1.0));
    const BodyId held = machine.model.add(wheel("held", Vector3::Zero(), 0.16, 0.01));
    auto slider = std::make_shared<SliderJoint>();
    slider->name = "rail";
    slider->body_a = swing;
    slider->body_b = held;
    slider->anchor = {8.0, -0.1, 0.0};
    slider->axis = Vector3(0.8, 0.6, 0.0);
    slider->travel.stiffness = stiffness;
    slider->travel.damping = 15.0;
    machine.model.joints.push_back(slider);
    Simulation simulation = start(machine);
    for (int i = 0; i < 100; ++i) {
      ASSERT_TRUE(simulation.world.step().ok());
      const Certificate certificate = *simulation.certificate();
      EXPECT_TRUE(certificate.clean(1e-5)) << certificate.worst()->sentence();
    }
  }
}

// A drive turns a body in its plane about an axis that leans to it by 1 rad and can give: what the
// axes are apart by, a tenth of a radian, is what the lock's part of the torque makes of it, without
// the drive's, which acts along the mean of both axes; and what the drive does against the lock
// flows within the joint.
TEST(JointLaw, DriveAgainstAnElasticLockOfItsOwnJoint) {
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    Machine machine;
    machine.model.gravity = down;
    machine.model.step = direct_settings(integrator, 0.003);
    BodyDef plane = lump("plane", Vector3::Zero(), 2.0);
    plane.mobility = Mobility::planar;
    const BodyId body = machine.model.add(plane);
    auto hinge = std::make_shared<HingeJoint>();
    hinge->name = "oblique";
    hinge->body_b = body;
    hinge->anchor = {1.0, 0.5, 0.0};
    hinge->axis = Vector3(std::sin(1.0), 0.0, std::cos(1.0));
    hinge->angular_compliance = 1e-6;
    hinge->angle.drive = CoordinateDrive::speed;
    hinge->angle.drive_values = {0.5};
    machine.model.joints.push_back(hinge);
    Simulation simulation = start(machine);
    for (int i = 0; i < 100; ++i) {
      ASSERT_TRUE(simulation.world.step().ok());
      const Certificate certificate = *simulation.certificate();
      EXPECT_TRUE(certificate.clean(1e-5)) << certificate.worst()->sentence();
    }
    EXPECT_GT(joint_reports(simulation.world)[0].torque.norm(), 1e4);
  }
}

}  // namespace
}  // namespace sheave::test::joint_law
