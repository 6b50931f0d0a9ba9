#pragma once
// Points of action of reported forces, computed independently of the solvers.

#include <array>
#include <vector>

#include "cable/certificate/evidence.h"

namespace sheave::certify {

struct SpanPush {
  int body = 0;
  Vector3 point = Vector3::Zero();
  Vector3 force = Vector3::Zero();
};
using SpanPushes = std::array<SpanPush, 4>;

/// The forces of a span on its two links: its tension at that end of the substep, along the span, and
/// the loads of a rope with weight.
[[nodiscard]] SpanPushes pushes_of(const SpanEvidence& span, End when);

struct JointPush {
  int body = 0;
  Vector3 point = Vector3::Zero();
  Vector3 force = Vector3::Zero();
  Vector3 torque = Vector3::Zero();
  bool unknown = false;
};
using JointPushes = std::vector<JointPush>;

/// The reported wrench on body_b about its anchor, the opposite on body_a, and for gears and racks
/// the reaction on the carrier. For couplings of joints the wrenches along all coupled coordinates.
[[nodiscard]] JointPushes pushes_of(const Evidence& evidence, const JointEvidence& joint, End when);

/// Completes the evidence of a link over which cable can pass.
void describe_pass(const Evidence& evidence, const CableEvidence& cable, const LinkReport& first,
                   const LinkReport& second, PassEvidence& pass);

}  // namespace sheave::certify
