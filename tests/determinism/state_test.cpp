// The same bits, however a state was reached, and a hash that sees every one of them.

#include "engine/state.h"

#include <bit>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include "engine/joints/hinge.h"
#include "tests/support/builders.h"
#include "tests/support/state_bytes.h"

namespace sheave {
namespace {

using test::attach;
using test::cable;
using test::left;
using test::right;
using test::roll;

/// Everything at once: mounted sheaves on a free block, skew planes, an elastic and a rigid cable,
/// a belt, a joint, a kinematic drive and a floor.
test::Machine busy_machine() {
  test::Tackle tackle;
  tackle.strands = 4;
  tackle.block_mobility = Mobility::free;
  tackle.effort = 3.0;
  test::Machine machine = tackle.machine();
  machine.model.step = test::settings(1.0 / 60.0, 5, 8);
  machine.model.bodies[0].angular_velocity = {0.1, 0.2, 0.3};
  machine.cables[0].axial_stiffness = 1e5;
  machine.cables[0].damping = 3.0;
  BodyDef drive = test::wheel("drive", {5.0, 0.0, 0.0}, 0.3, 0.1);
  drive.mobility = Mobility::kinematic;
  drive.mass.reset();
  drive.inertia.reset();
  drive.angular_velocity = {0.0, 0.0, 20.0};
  drive.oscillation = {0.0, 0.01, 0.0};
  drive.oscillation_frequency = 2.0;
  const BodyId driver = machine.model.add(drive);
  const BodyId follower = machine.model.add(test::wheel("follower", {6.0, 0.0, 0.0}, 0.1, 0.01));
  CableDef belt = cable("belt", {roll(driver, left), roll(follower, left)});
  belt.closed = true;
  belt.compliance = 1e-4;
  machine.cables.push_back(belt);
  const BodyId door = machine.model.add(test::lump("door", {-2.0, 1.0, 0.3}, 2.0));
  const BodyId stone = machine.model.add(test::lump("stone", {-3.0, 1.0, 0.5}, 1.0));
  auto hinge = std::make_shared<HingeJoint>();
  hinge->name = "hinge";
  hinge->body_b = door;
  hinge->anchor = {-2.0, 1.5, 0.3};
  hinge->axis = Vector3(1.0, 0.2, 0.1);
  machine.model.joints.push_back(hinge);
  machine.cables.push_back(cable("leash", {attach(door, {0.1, 0.0, 0.1}), attach(stone)}));
  machine.model.ground.emplace();
  machine.model.ground->point = {0.0, -0.5, 0.0};
  return machine;
}

void step(World& world, int steps) {
  for (int i = 0; i < steps; ++i) {
    const StepReport report = world.step();
    ASSERT_TRUE(report.ok()) << report.divergence->message;
  }
}

TEST(Determinism, TwoRunsAgreeBitForBit) {
  Simulation a = test::start(busy_machine());
  Simulation b = test::start(busy_machine());
  for (int i = 0; i < 60; ++i) {
    step(a.world, 1);
    step(b.world, 1);
    ASSERT_EQ(hash(a.world.state()), hash(b.world.state())) << "step " << i;
  }
}

TEST(Determinism, SaveRestoreAndRunAgreesWithRun) {
  Simulation straight = test::start(busy_machine());
  step(straight.world, 60);

  Simulation s = test::start(busy_machine());
  step(s.world, 30);
  const State snapshot = s.world.state();
  const std::string bytes = to_bytes(snapshot);
  step(s.world, 30);
  EXPECT_EQ(hash(s.world.state()), hash(straight.world.state()));
  // Back in the same world, ...
  ASSERT_TRUE(s.world.restore(snapshot).empty());
  EXPECT_EQ(hash(s.world.state()), hash(snapshot));
  step(s.world, 30);
  EXPECT_EQ(hash(s.world.state()), hash(straight.world.state()));
  // ... and in another one that has already done something else, by way of bytes.
  Simulation other = test::start(busy_machine());
  step(other.world, 7);
  const Result<State> read = state_from_bytes(bytes);
  ASSERT_TRUE(read.ok()) << test::text(read.errors());
  ASSERT_TRUE(other.world.restore(*read).empty());
  step(other.world, 30);
  EXPECT_EQ(hash(other.world.state()), hash(straight.world.state()));
  EXPECT_EQ(to_bytes(other.world.state()), to_bytes(straight.world.state()));
}

TEST(Determinism, RestoringTheStartStartsAgain) {
  Simulation s = test::start(busy_machine());
  const State start = s.world.state();
  step(s.world, 10);
  const std::uint64_t first = hash(s.world.state());
  ASSERT_TRUE(s.world.restore(start).empty());
  step(s.world, 10);
  EXPECT_EQ(hash(s.world.state()), first);
}

TEST(StateHash, ChangesWithEverySingleBit) {
  Simulation s = test::start(busy_machine());
  step(s.world, 3);
  State plain = s.world.state();
  plain.history = {};
  const std::string bytes = test::as_version_2(plain);
  const std::uint64_t original = hash(plain);
  int flips = 0;
  // The first word is the format's tag; counts cannot change alone.
  for (std::size_t i = 8; i < bytes.size(); ++i) {
    for (int bit = 0; bit < 8; ++bit) {
      std::string changed = bytes;
      changed[i] = static_cast<char>(changed[i] ^ (1 << bit));
      const Result<State> state = state_from_bytes(changed);
      if (!state) continue;
      ++flips;
      ASSERT_NE(hash(*state), original) << "byte " << i << " bit " << bit;
    }
  }
  EXPECT_GT(flips, 10000);
}

TEST(StateHash, DistinguishesMinusZeroAndTheOrder) {
  State a;
  a.bodies.resize(2);
  State b = a;
  b.bodies[0].position.x() = -0.0;
  EXPECT_NE(hash(a), hash(b));
  a.bodies[0].position.x() = 1.0;
  b.bodies[0].position.x() = 0.0;
  b.bodies[1].position.x() = 1.0;
  EXPECT_NE(hash(a), hash(b));
}

TEST(StateBytes, RoundTripIsExact) {
  State state;
  state.steps = -7;
  state.time = 0.1;
  state.bodies.resize(2);
  state.bodies[1].angle = std::numeric_limits<double>::denorm_min();
  state.bodies[0].velocity.z() = -0.0;
  state.features.resize(3);
  state.features[1].reals = {1.0 / 3.0, std::numeric_limits<double>::infinity()};
  state.features[2].integers = {std::numeric_limits<std::int64_t>::min(), 5};
  const std::string bytes = to_bytes(state);
  const Result<State> read = state_from_bytes(bytes);
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(to_bytes(*read), bytes);
  EXPECT_EQ(hash(*read), hash(state));
}

TEST(StateBytes, EveryTruncationAndExtensionIsAnError) {
  Simulation s = test::start(busy_machine());
  const std::string bytes = to_bytes(s.world.state());
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    ASSERT_FALSE(state_from_bytes(bytes.substr(0, n)).ok()) << n;
  }
  EXPECT_FALSE(state_from_bytes(bytes + '\0').ok());
  EXPECT_FALSE(state_from_bytes(bytes + std::string(8, '\0')).ok());
}

// A change of one byte is one of one word, which the checksum takes up one to one: none is missed.
// What it would be taken for by versions without one is no state of theirs.
TEST(StateBytes, EveryChangedByteIsAnError) {
  Simulation s = test::start(busy_machine());
  step(s.world, 5);
  const std::string bytes = to_bytes(s.world.state(), {1234, 5678});
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    for (const int change : {1, 2, 3, 0x10, 0x55, 0x80, 0xff}) {
      std::string changed = bytes;
      changed[i] = static_cast<char>(changed[i] ^ change);
      const Result<State> state = state_from_bytes(changed);
      ASSERT_FALSE(state.ok()) << "byte " << i << " by " << change;
    }
    for (const char value : {'\0', '1', '2', '\x7f', '\xff'}) {
      if (bytes[i] == value) continue;
      std::string changed = bytes;
      changed[i] = value;
      ASSERT_FALSE(state_from_bytes(changed).ok()) << "byte " << i << " to " << int{value};
    }
  }
}

TEST(StateBytes, HaveTheLayoutOfTheirMachineAndAChecksum) {
  const std::string bytes = to_bytes(State{}, {1234, 5678});
  const Result<SavedState> saved = saved_state_from_bytes(bytes);
  ASSERT_TRUE(saved.ok()) << test::text(saved.errors());
  EXPECT_TRUE(saved->checked);
  EXPECT_EQ(saved->origin.scene, 1234U);
  EXPECT_EQ(saved->origin.layout, 5678U);
  const Result<SavedState> old = saved_state_from_bytes(test::without_checksum(bytes));
  ASSERT_TRUE(old.ok()) << test::text(old.errors());
  EXPECT_FALSE(old->checked);
  EXPECT_EQ(hash(old->state), hash(saved->state));
}

TEST(StateBytes, OfTheVersionWithoutAHistoryLoadAndAreChecked) {
  Simulation s = test::start(busy_machine());
  step(s.world, 3);
  State plain = s.world.state();
  plain.history = {};
  std::string old = test::as_version_3(plain);
  const Result<SavedState> saved = saved_state_from_bytes(old);
  ASSERT_TRUE(saved.ok()) << test::text(saved.errors());
  EXPECT_TRUE(saved->checked);
  EXPECT_EQ(hash(saved->state), hash(plain));
  EXPECT_TRUE(s.world.restore(saved->state).empty());
  old[100] = static_cast<char>(old[100] ^ 1);
  EXPECT_FALSE(saved_state_from_bytes(old).ok());
}

TEST(StateBytes, GarbageAndHugeCountsAreErrors) {
  EXPECT_FALSE(state_from_bytes("").ok());
  EXPECT_FALSE(state_from_bytes("{\"format\": \"sheave-scene/1\"}").ok());
  EXPECT_FALSE(state_from_bytes(std::string(4096, '\xff')).ok());
  const std::string good = test::without_checksum(to_bytes(State{}));
  // Words: tag, steps, time, bodies, features. Counts up to 2^64 - 1 must not allocate or wrap.
  for (const std::size_t word : {std::size_t{3}, std::size_t{4}}) {
    for (const std::uint64_t count :
         {std::uint64_t{1}, std::uint64_t{1} << 32, std::uint64_t{1} << 60, std::uint64_t{1} << 61,
          ~std::uint64_t{0}, ~std::uint64_t{0} / 14 + 1, ~std::uint64_t{0} / 112 + 1}) {
      std::string bytes = good;
      std::memcpy(bytes.data() + 8 * word, &count, 8);
      const Result<State> state = state_from_bytes(bytes);
      ASSERT_FALSE(state.ok());
      EXPECT_FALSE(state.errors().front().message.empty());
    }
  }
}

}  // namespace
}  // namespace sheave
