// Controls are part of the state: hashed, saved, restored and checked like the rest of it.

#include <gtest/gtest.h>

#include "cable/links/rolling.h"
#include "engine/joints/hinge.h"
#include "tests/support/builders.h"
#include "tests/support/state_bytes.h"

namespace sheave {
namespace {

using test::attach;
using test::cable;
using test::roll;

/// One of each thing that can be controlled: bodies 0 drum (speed), 1 load, 2 hand (kinematic), 3
/// bar, 4 post.
test::Machine steered_machine() {
  test::Machine machine;
  machine.model.gravity = test::down;
  machine.model.step.dt = 1.0 / 120.0;
  BodyDef drum = test::wheel("drum", {0.0, 4.0, 0.0}, 0.25, 0.05);
  drum.drive = DriveKind::speed;
  drum.drive_values = {0.0};
  const BodyId on = machine.model.add(drum);
  const BodyId load = machine.model.add(test::lump("load", {0.25, 0.0, 0.0}, 3.0));
  BodyDef hand;
  hand.name = "hand";
  hand.mobility = Mobility::kinematic;
  hand.position = {2.0, 3.0, 0.0};
  const BodyId held = machine.model.add(hand);
  const BodyId bar = machine.model.add(test::lump("bar", {4.0, 1.0, 0.0}, 1.0));
  BodyDef post = test::wheel("post", {2.0, 1.0, 0.0}, 0.2, 0.1);
  post.mobility = Mobility::fixed;
  const BodyId around = machine.model.add(post);
  auto spool = roll(on, test::right);
  spool->stored_length = 5.0;
  CableDef rope = cable("rope", {spool, attach(load)});
  rope.compliance = 1e-5;
  rope.damping = 50.0;
  machine.cables.push_back(rope);
  auto over = roll(around, test::left);
  over->friction = 0.2;
  auto mouth = attach(BodyId::world(), {3.5, 3.0, 0.0});
  mouth->feed_speed = 0.0;
  machine.cables.push_back(cable("line", {attach(held), over, mouth}));
  auto hinge = std::make_shared<HingeJoint>();
  hinge->name = "hinge";
  hinge->body_b = bar;
  hinge->anchor = {3.5, 1.0, 0.0};
  hinge->axis = Vector3::UnitZ();
  hinge->angle.drive = CoordinateDrive::speed;
  hinge->angle.drive_values = {0.0};
  hinge->angle.drive_limit = 50.0;
  machine.model.joints.push_back(hinge);
  return machine;
}

constexpr BodyId drum_id{0};
constexpr BodyId load_id{1};
constexpr BodyId hand_id{2};

/// Sets something of every kind, as a function of the step.
void steer(Simulation& s, int step) {
  const double phase = 0.1 * step;
  Errors errors;
  const auto keep = [&](const Errors& more) {
    errors.insert(errors.end(), more.begin(), more.end());
  };
  keep(s.world.set_drive(drum_id, std::sin(phase)));
  keep(s.world.set_force(
      load_id,
      {{std::cos(phase), 0.5, 0.0}, {0.0, 0.01, 0.0}, Vector3{0.0, 0.1, 0.0}, ForceFrame::body}));
  MotionTarget target;
  target.position = {2.0 + 0.2 * std::sin(phase), 3.0, 0.1 * std::sin(2.0 * phase)};
  if (step % 3 == 0) target.velocity = Vector3{0.1, 0.0, 0.0};
  keep(s.world.set_motion(hand_id, target));
  keep(s.world.set_joint_drive(0, 0, std::cos(phase)));
  keep(s.world.set_joint_drive_limit(0, 0, 20.0 + std::cos(phase)));
  keep(s.world.set_gravity({0.1 * std::sin(phase), -9.0, 0.0}));
  keep(s.set_compliance(0, 1e-5 * (1.5 + std::sin(phase))));
  keep(s.set_breaking_tension(0, 1e5 + step));
  keep(s.set_friction(1, 1, 0.2 + 0.1 * std::sin(phase)));
  keep(s.set_feed_speed(1, 2, 0.3 * std::cos(phase)));
  EXPECT_TRUE(errors.empty()) << test::text(errors);
}

void run(Simulation& s, int from, int to) {
  for (int i = from; i < to; ++i) {
    steer(s, i);
    const StepReport report = s.world.step();
    ASSERT_TRUE(report.ok()) << report.divergence->message;
  }
}

TEST(ControlsState, EqualControlsGiveEqualRuns) {
  Simulation a = test::start(steered_machine());
  Simulation b = test::start(steered_machine());
  run(a, 0, 100);
  run(b, 0, 100);
  EXPECT_EQ(hash(a.world.state()), hash(b.world.state()));
  // And another one is another.
  Simulation c = test::start(steered_machine());
  run(c, 0, 99);
  steer(c, 100);
  ASSERT_TRUE(c.world.step().ok());
  EXPECT_NE(hash(c.world.state()), hash(a.world.state()));
}

TEST(ControlsState, ARunFromASnapshotContinuesEqually) {
  Simulation s = test::start(steered_machine());
  run(s, 0, 50);
  const State snapshot = s.world.state();
  run(s, 50, 1050);
  const std::uint64_t end = hash(s.world.state());
  ASSERT_TRUE(s.world.restore(snapshot).empty());
  EXPECT_EQ(hash(s.world.state()), hash(snapshot));
  run(s, 50, 1050);
  EXPECT_EQ(hash(s.world.state()), end);
  // Without anybody who sets them again they hold, in a world of its own and by way of bytes, too.
  ASSERT_TRUE(s.world.restore(snapshot).empty());
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(s.world.step().ok());
  Simulation other = test::start(steered_machine());
  const Result<State> read = state_from_bytes(to_bytes(snapshot));
  ASSERT_TRUE(read.ok()) << test::text(read.errors());
  EXPECT_EQ(hash(*read), hash(snapshot));
  EXPECT_EQ(to_bytes(*read), to_bytes(snapshot));
  ASSERT_TRUE(other.world.restore(*read).empty());
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(other.world.step().ok());
  EXPECT_EQ(hash(other.world.state()), hash(s.world.state()));
}

TEST(ControlsState, AStoppedStepUndoesControlsSetWithinIt) {
  Simulation s = test::start(steered_machine());
  run(s, 0, 10);
  const std::uint64_t before = hash(s.world.state());
  int called = 0;
  const StepReport report =
      s.world.step([&] { return called > 1; }, [&] { steer(s, 1000 + ++called); });
  EXPECT_TRUE(report.stopped);
  EXPECT_GT(called, 1);
  EXPECT_EQ(hash(s.world.state()), before);
}

TEST(ControlsState, TheHashDependsOnEveryBitOfTheControls) {
  Simulation s = test::start(steered_machine());
  run(s, 0, 3);
  const std::string bytes = test::as_version_2(s.world.state());
  State bare = s.world.state();
  bare.controls = {};
  // What the controls add to the file comes last, but for their own table sizes.
  const std::size_t first = test::as_version_2(bare).size() - 7 * sizeof(std::uint64_t);
  bare = s.world.state();
  bare.history = {};
  const std::uint64_t original = hash(bare);
  int flips = 0;
  int refused = 0;
  for (std::size_t i = first; i < bytes.size(); ++i) {
    for (int bit = 0; bit < 8; bit += 3) {
      std::string flipped = bytes;
      flipped[i] = static_cast<char>(flipped[i] ^ (1 << bit));
      const Result<State> read = state_from_bytes(flipped);
      ++flips;
      if (read.ok()) {
        EXPECT_NE(hash(*read), original) << "byte " << i << " bit " << bit;
      } else {
        ++refused;
      }
    }
  }
  EXPECT_GT(flips, 1000);
  EXPECT_LT(refused, flips / 3);
}

TEST(ControlsState, AClearedControlEqualsOneNeverSet) {
  Simulation s = test::start(steered_machine());
  const std::uint64_t before = hash(s.world.state());
  steer(s, 1);
  EXPECT_NE(hash(s.world.state()), before);
  EXPECT_FALSE(s.world.state().controls.empty());
  s.world.clear_gravity();
  Errors errors;
  for (const Errors& more :
       {s.world.clear_drive(drum_id), s.world.clear_force(load_id), s.world.clear_joint_drive(0, 0),
        s.clear_compliance(0), s.clear_breaking_tension(0), s.clear_friction(1, 1),
        s.clear_feed_speed(1, 2)}) {
    errors.insert(errors.end(), more.begin(), more.end());
  }
  EXPECT_TRUE(errors.empty()) << test::text(errors);
  // A hand that has been told to go somewhere is led back.
  EXPECT_TRUE(s.world.state().controls.motions.any());
  ASSERT_TRUE(s.world.clear_motion(hand_id).empty());
  State state = s.world.state();
  state.controls.motions.clear(hand_id.index);
  EXPECT_TRUE(state.controls.empty());
  EXPECT_EQ(hash(state), before);
}

/// The message of the only error.
std::string message(const Errors& errors) {
  EXPECT_EQ(errors.size(), 1U);
  return errors.empty() ? "" : errors.front().message;
}

TEST(ControlsState, BadRequestsAreReportedAndChangeNothing) {
  Simulation s = test::start(steered_machine());
  run(s, 0, 5);
  const std::uint64_t before = hash(s.world.state());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  MotionTarget nowhere;
  nowhere.position = {nan, 0.0, 0.0};
  MotionTarget twisted;
  twisted.orientation = Quaternion(2.0, 0.0, 0.0, 0.0);
  MotionTarget jump;
  jump.over = 0.0;
  MotionTarget spin;
  spin.angular_velocity = Vector3::UnitX();
  struct Case {
    Errors errors;
    std::string says;
  };
  const std::vector<Case> cases{
      {s.world.set_gravity({0.0, infinite, 0.0}), "finite"},
      {s.world.set_drive({17}, 1.0), "no body number 17; there are 5"},
      {s.world.set_drive({-7}, 1.0), "no body number -7"},
      {s.world.set_drive(BodyId::world(), 1.0), "world"},
      {s.world.set_drive(load_id, 1.0), "\"load\" has no drive"},
      {s.world.set_drive(drum_id, nan), "\"drum\" must go to a finite value, not to nan"},
      {s.world.set_drive(drum_id, {1.0, -0.1}), "at least 0 s, not -0.1"},
      {s.world.set_drive(drum_id, {1.0, 1.0, 2.0}), "no rate"},
      {s.world.clear_drive(load_id), "no drive"},
      {s.world.set_force(drum_id, {.force = Vector3::UnitX()}), "\"drum\" is turned by its drive"},
      {s.world.set_force(hand_id, {}), "kinematic"},
      {s.world.set_force({4}, {}), "static"},
      {s.world.set_force(load_id, {.force = {nan, 0.0, 0.0}}), "finite"},
      {s.world.set_motion(load_id, {}), "\"load\" is free"},
      {s.world.set_motion(hand_id, nowhere), "finite"},
      {s.world.set_motion(hand_id, twisted), "length 1, not 2"},
      {s.world.set_motion(hand_id, jump), "above 0, not 0"},
      {s.world.set_motion(hand_id, spin), "needs a velocity"},
      {s.world.clear_motion(hand_id, nan), "above 0"},
      {s.world.set_joint_drive(3, 0, 1.0), "no joint number 3; there are 1"},
      {s.world.set_joint_drive(0, 2, 1.0), "\"hinge\" has no coordinate number 2; it has 1"},
      {s.world.set_joint_drive(0, 0, infinite), "\"hinge\" must go to a finite value"},
      {s.world.set_joint_drive_limit(0, 0, -1.0), "at least 0, not -1"},
      {s.set_compliance(1, 1e-5), "\"line\" is rigid"},
      {s.set_compliance(0, 0.0), "above 0, not 0"},
      {s.set_compliance(2, 1e-5), "no cable number 2; there are 2"},
      {s.set_breaking_tension(0, -1.0), "above 0, not -1"},
      {s.set_wrap_friction(0, 0.3), "\"rope\" has no wrap_friction"},
      {s.set_friction(0, 0, 0.1), "link 0 of cable \"rope\" has no friction"},
      {s.set_friction(1, 1, nan), "above 0, not nan"},
      {s.set_friction(1, 9, 0.1), "\"line\" has no link number 9; it has 3"},
      {s.set_feed_speed(1, 0, 0.1), "feeds no cable"},
      {s.set_feed_speed(1, 2, nan), "finite"},
  };
  for (const Case& one : cases) {
    EXPECT_NE(message(one.errors).find(one.says), std::string::npos)
        << test::text(one.errors) << "\nshould say: " << one.says;
  }
  EXPECT_EQ(hash(s.world.state()), before);
}

TEST(ControlsState, ForeignControlsAreNotRestored) {
  Simulation s = test::start(steered_machine());
  run(s, 0, 5);
  const State good = s.world.state();
  const std::uint64_t before = hash(good);
  std::vector<State> bad;
  const auto spoil = [&](auto change) {
    State state = good;
    change(state.controls);
    bad.push_back(std::move(state));
  };
  const DriveControl drive = *good.controls.body_drives.find(0);
  spoil([](Controls& c) { c.gravity.x() = std::nan(""); });
  spoil([&](Controls& c) { c.body_drives.put(1, 5, drive); });
  spoil([&](Controls& c) { c.body_drives.put(5, 6, drive); });
  spoil([&](Controls& c) { c.joint_drives.put(1, 2, drive); });
  spoil([&](Controls& c) {
    DriveControl wrong = drive;
    wrong.target.end = std::nan("");
    c.body_drives.put(0, 5, wrong);
  });
  spoil([&](Controls& c) { c.forces.put(4, 5, *good.controls.forces.find(1)); });
  spoil([&](Controls& c) { c.motions.put(0, 5, *good.controls.motions.find(2)); });
  spoil([&](Controls& c) {
    MotionControl wrong = *good.controls.motions.find(2);
    wrong.start_orientation.coeffs() *= 3.0;
    c.motions.put(2, 5, wrong);
  });
  spoil([](Controls& c) { c.cables.put(1, 2, {1e-5, not_set, not_set, 0.0}); });
  spoil([](Controls& c) { c.cables.put(0, 2, {-1e-5, not_set, not_set, 0.0}); });
  spoil([](Controls& c) { c.links.put(0, 5, {0.3, false, {}}); });
  spoil([](Controls& c) { c.links.put(7, 8, {0.3, false, {}}); });
  for (std::size_t i = 0; i < bad.size(); ++i) {
    const Errors errors = s.world.restore(bad[i]);
    EXPECT_EQ(errors.size(), 1U) << i;
    EXPECT_EQ(hash(s.world.state()), before) << i;
  }
  EXPECT_TRUE(s.world.restore(good).empty());
  // A world without cables has no use for their controls.
  test::Machine bodies = steered_machine();
  bodies.cables.clear();
  Simulation without = test::start(bodies);
  State state = without.world.state();
  state.controls.cables.put(0, 1, {1e-5, not_set, not_set, 0.0});
  EXPECT_FALSE(without.world.restore(state).empty());
}

TEST(ControlsState, FilesOfTheFormerVersionHaveNoControls) {
  Simulation s = test::start(steered_machine());
  ASSERT_TRUE(s.world.step().ok());
  std::string old = test::as_version_2(s.world.state());
  // Without what the controls add: a flag, six empty tables, and an empty memory.
  old.resize(old.size() - 8 * sizeof(std::uint64_t));
  old[7] = '1';
  const Result<State> read = state_from_bytes(old);
  ASSERT_TRUE(read.ok()) << test::text(read.errors());
  State same = s.world.state();
  same.history = {};
  EXPECT_EQ(hash(*read), hash(same));
  EXPECT_TRUE(read->controls.empty());
  old[7] = '6';
  const Result<State> newer = state_from_bytes(old);
  ASSERT_FALSE(newer.ok());
  EXPECT_NE(newer.errors()[0].message.find("SHSTATE6"), std::string::npos);
}

}  // namespace
}  // namespace sheave
