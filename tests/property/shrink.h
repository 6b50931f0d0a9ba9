#pragma once
// Smaller machines that fail, too.

#include <functional>
#include <string>

#include "tests/property/random_machine.h"

namespace sheave::test {

/// The machine as a scene file.
[[nodiscard]] std::string scene_of(const Machine& machine, const std::string& description = {});

/// The machine with bodies, joints, cables, links and settings left out one after the other, as
/// long as `fails` says that what is left still fails; `fails` is asked at most `tries` times. It
/// may throw, which counts as not failing.
[[nodiscard]] Machine shrunk(const Machine& machine,
                             const std::function<bool(const Machine&)>& fails, int tries = 400);

}  // namespace sheave::test
