#pragma once
// Worlds that are held and edited by tests.

#include <functional>
#include <optional>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "cable/live_world.h"
#include "tests/support/builders.h"

namespace sheave::test {

/// That of a machine that must be valid.
[[nodiscard]] inline LiveWorld live(const Machine& machine) {
  Result<LiveWorld> world = LiveWorld::create(machine.model, machine.cables);
  EXPECT_TRUE(world.ok()) << text(world.errors());
  return std::move(*world);
}

/// An edit that must be possible.
inline EditReport edit(LiveWorld& world, const std::function<void(Edit&)>& changes) {
  Result<EditReport> done = world.edit(changes);
  EXPECT_TRUE(done.ok()) << (done ? std::string() : text(done.errors()));
  return done ? std::move(*done) : EditReport{};
}

/// The fault of an edit that cannot be; nothing may have changed.
inline std::string refused(LiveWorld& world, const std::function<void(Edit&)>& changes) {
  const std::uint64_t before = hash(world.state());
  const Simulation* simulation = &world.simulation();
  const Result<EditReport> done = world.edit(changes);
  EXPECT_FALSE(done.ok());
  EXPECT_EQ(hash(world.state()), before);
  EXPECT_EQ(&world.simulation(), simulation);
  return done ? std::string() : text(done.errors());
}

inline void advance(LiveWorld& world, int steps) {
  for (int i = 0; i < steps; ++i) ASSERT_TRUE(world.step().ok());
}

/// The worst figure of the certificate of the last substep, relative.
[[nodiscard]] inline double worst_figure(const LiveWorld& world) {
  const std::optional<Certificate> certificate = world.simulation().certificate();
  EXPECT_TRUE(certificate.has_value());
  return certificate->worst() != nullptr ? certificate->worst()->relative : 0.0;
}

}  // namespace sheave::test
