// The hand of the paper's Figure 1 (scenes/paper/hand.json) against statics by potential, and what
// tendons and hinges owe whatever the hand does: excursion, one tension, axes, stops.

#include <cmath>

#include <gtest/gtest.h>

#include "engine/joints/hinge.h"
#include "tests/paper/finger_model.h"
#include "tests/paper/paper_scene.h"

namespace sheave::test {
namespace {

constexpr double light_pull = 2.5;  // of the flexors, when the fingers hang free [N]
constexpr double light_time = 1.55;
const std::vector<std::string> digits{"index", "middle", "ring", "little", "thumb"};

TEST(Hand, HasThePapers28CableJoints) {
  std::size_t spans = 0;
  for (const CableDef& cable : paper_scene("hand").cables) spans += cable.links.size() - 1;
  EXPECT_EQ(spans, 28U);
}

TEST(Hand, PostureUnderALightPullHasTheLeastPotential) {
  PaperRun hand("hand");
  hand.run(light_time);
  for (const std::string& digit : digits) {
    const FingerModel finger(hand.scene(), digit);
    const Eigen::VectorXd posture = finger.posture(light_pull);
    for (std::size_t i = 0; i < finger.joints().size(); ++i) {
      // A second after the pull has come, a motion that hinges and drums damp within 0.1 s has left
      // 1e-4 rad.
      EXPECT_NEAR(hand.value(finger.joints()[i] + ".angle"), posture[static_cast<Eigen::Index>(i)],
                  2e-4)
          << finger.joints()[i];
    }
    EXPECT_NEAR(hand.value(digit + " extensor.0.tension"), finger.extensor_tension(posture),
                200.0 * 0.025 * 2e-4)
        << digit;  // stiffness x radii x the angles' tolerance
  }
}

/// A pull that is weaker by 4 % would miss the tolerance above fifty times over.
TEST(Hand, PostureDeterminesThePull) {
  const Scene scene = paper_scene("hand");
  for (const std::string& digit : digits) {
    const FingerModel finger(scene, digit);
    const Eigen::VectorXd soft = finger.posture(0.96 * light_pull);
    const Eigen::VectorXd hard = finger.posture(light_pull);
    EXPECT_GT((hard - soft).cwiseAbs().maxCoeff(), 50.0 * 2e-4) << digit;
  }
}

/// Extensors move by radius times angle; every tendon has one tension from end to end.
void expect_tendons(const PaperRun& hand, const std::vector<CableReport>& start) {
  const std::vector<CableReport> now = hand.simulation().cable_reports();
  for (std::size_t c = 0; c < now.size(); ++c) {
    const std::string& name = hand.scene().cables[c].name;
    SCOPED_TRACE(name);
    const FingerModel finger(hand.scene(), name.substr(0, name.find(' ')));
    for (std::size_t i = 1; name.ends_with("extensor") && i < now[c].links.size(); ++i) {
      const LinkReport& link = now[c].links[i];
      const double angle = hand.value(finger.joints()[i - 1] + ".angle");
      // Exact but for what hinges give within a substep of the direct solver: 1e-7 m.
      EXPECT_NEAR(link.stored_length - start[c].links[i].stored_length, link.radius * angle, 1e-7);
    }
    const double tension = now[c].spans.front().tension;
    for (const SpanReport& span : now[c].spans) {
      EXPECT_NEAR(span.tension, tension, 1e-9 * (1.0 + tension));
    }
  }
}

/// A point or direction of the world at time 0, fixed to a body, as it is now.
Vector3 carried(const PaperRun& hand, BodyId id, const Vector3& at_start, bool direction) {
  const BodyDef& body = hand.scene().model.bodies[static_cast<std::size_t>(id.index)];
  const World& world = hand.simulation().world;
  const Quaternion to_body = body.orientation.conjugate();
  if (direction) return world.orientation(id) * Vector3(to_body * at_start);
  return world.point(id, to_body * Vector3(at_start - body.position));
}

/// Anchors and axes stay together, and angles within their stops.
void expect_hinges(const PaperRun& hand) {
  for (const auto& joint : hand.scene().model.joints) {
    const auto& hinge = dynamic_cast<const HingeJoint&>(*joint);
    SCOPED_TRACE(hinge.name);
    // The direct solver leaves squares of what its last round corrected: far below a micrometre and
    // ten microradians.
    const Vector3 gap = carried(hand, hinge.body_a, hinge.anchor, false) -
                        carried(hand, hinge.body_b, hinge.anchor, false);
    EXPECT_LT(gap.norm(), 1e-6);
    const Vector3 tilt = carried(hand, hinge.body_a, hinge.axis, true)
                             .cross(carried(hand, hinge.body_b, hinge.axis, true));
    EXPECT_LT(tilt.norm(), 1e-5);
    // Stops give by 0.05 rad/(N m); 15 N with levers up to 25 mm are 0.4 N m.
    const double angle = hand.value(hinge.name + ".angle");
    EXPECT_GT(angle, *hinge.angle.lower - 0.02);
    EXPECT_LT(angle, *hinge.angle.upper + 0.02);
  }
}

TEST(Hand, ClosesOnTheBallAndHoldsIt) {
  PaperRun hand("hand");
  const std::vector<CableReport> start = hand.simulation().cable_reports();
  const auto ball = [&] {
    return Vector3(hand.value("ball.x"), hand.value("ball.y"), hand.value("ball.z"));
  };
  Vector3 held = Vector3::Zero();
  for (int k = 1; k <= 20; ++k) {
    hand.run(0.2 * k);
    SCOPED_TRACE(0.2 * k);
    expect_tendons(hand, start);
    expect_hinges(hand);
    if (k == 17) held = ball();
  }
  EXPECT_LT((ball() - held).norm(), 1e-6);
  // Pressed in by more than its own weight would (1 N on two points of contact that give by 1e-4
  // m/N).
  EXPECT_LT(held.y(), 0.0385 - 2e-4);
}

}  // namespace
}  // namespace sheave::test
