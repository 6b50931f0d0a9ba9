#pragma once
// Where reported forces act: the certificate's own account of it.

#include <array>
#include <vector>

#include "cable/certificate/evidence.h"

namespace sheave::certify {

struct SpanPush {
  int body = 0;
  Vector3 point = Vector3::Zero();
  Vector3 force = Vector3::Zero();
};
struct SpanPushes {
  std::array<SpanPush, 6> all;
  int count = 0;
};

/// What a span does with its tension of that end: it pulls its ends together and, where the planes
/// of its wheels differ, is held in their planes by the flanges (`guided`).
///
/// A tangent point at the angle psi of its circle, radius r, signed radius q, tangent t
/// (counter-clockwise), changes L - l by (r u.t - q) dpsi at the start and (q - r u.t) dpsi at the
/// end. The angles keep the tangency
///   G1 = e1 . (a2 - c1) - r1 = 0,   G2 = e2 . (a1 - c2) - r2 = 0
/// when the bodies move by v (of the material of either body, with e and c fixed to it), so M dpsi
/// = -g with
///   M = [t1.(a2 - c1), r2 e1.t2; r1 e2.t1, t2.(a1 - c2)],   g1 = e1.(v2(a2) - v1(a2)),   g2 = e2.(v1(a1) - v2(a1)),
/// and with M^T y = k, k the two factors above, d(L - l) gains -y.g: a pair of forces -y1 e1 at a2
/// and one of -y2 e2 at a1.
[[nodiscard]] SpanPushes pushes_of(const SpanEvidence& span, End when, bool guided);

struct JointPush {
  int body = 0;
  Vector3 point = Vector3::Zero();
  Vector3 force = Vector3::Zero();
  Vector3 torque = Vector3::Zero();
  bool unknown = false;
};
using JointPushes = std::vector<JointPush>;

/// The reported wrench on body_b about its anchor, the opposite on body_a, and of gears and racks
/// what the carrier has to bear.
[[nodiscard]] JointPushes pushes_of(const Evidence& evidence, const JointEvidence& joint, End when);

/// Completes what is known of a link over which cable can pass.
void describe_pass(const Evidence& evidence, const CableEvidence& cable, const LinkReport& first,
                   const LinkReport& second, PassEvidence& pass);

}  // namespace sheave::certify
