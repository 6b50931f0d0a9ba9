#pragma once
// Machines whose parts do not move by themselves.

#include <nlohmann/json.hpp>

namespace sheave::test {

/// Takes out of a scene, or a part of one, whatever moves a machine by itself, and limits that an
/// equilibrium may exceed.
void take_out_sources(nlohmann::json& part);

}  // namespace sheave::test
