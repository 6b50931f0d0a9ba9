#pragma once
// How a program refers to the things of a world that lives.

#include <cstdint>

namespace sheave {

/// A body, joint or cable of a LiveWorld, for as long as it is there: where it is kept, and which
/// of those that have been kept there it is. One that is no more is told as such. Compare them,
/// copy them; a default one refers to nothing.
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
