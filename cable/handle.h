#pragma once
// References of a program to the bodies, joints and cables of a LiveWorld.

#include <cstdint>

namespace sheave {

/// Identifies a body, joint or cable of a LiveWorld: a slot, and a generation that tells apart the
/// objects that have used the slot. Functions report a handle whose object was removed as an error.
/// Handles can be compared and copied. A default handle refers to nothing.
template <class Tag>
struct Handle {
  std::int32_t slot = -1;
  std::uint32_t generation = 0;
  friend constexpr bool operator==(Handle, Handle) = default;
};

struct BodyTag;
struct JointTag;
struct CableTag;
using BodyHandle = Handle<BodyTag>;
using JointHandle = Handle<JointTag>;
using CableHandle = Handle<CableTag>;

}  // namespace sheave
