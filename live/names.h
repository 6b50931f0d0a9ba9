#pragma once
// Bodies, joints and cables by the names that requests use.

#include <string>
#include <string_view>
#include <vector>

#include "cable/live_world.h"

namespace sheave::live {

/// The thing with this name; a fault at `pointer` says which name may have been meant.
[[nodiscard]] Result<BodyHandle> body_named(const LiveWorld& world, const std::string& name,
                                            const std::string& pointer = "/body");
[[nodiscard]] Result<JointHandle> joint_named(const LiveWorld& world, const std::string& name,
                                              const std::string& pointer = "/joint");
[[nodiscard]] Result<CableHandle> cable_named(const LiveWorld& world, const std::string& name,
                                              const std::string& pointer = "/cable");
/// Index of a coordinate of a joint; an empty name is the first.
[[nodiscard]] Result<int> coordinate_named(const LiveWorld& world, JointHandle joint,
                                           const std::string& name);

/// What is wrong with a name that none of `names` is: there is no body "drun", did you mean "drum"?
[[nodiscard]] Error no_such(const std::string& what, const std::string& name,
                            const std::vector<std::string_view>& names, const std::string& pointer);

}  // namespace sheave::live
