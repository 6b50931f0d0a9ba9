#pragma once
// The common parts of gears and racks: both couple two motions relative to a carrier, with or
// without backlash.

#include "engine/joint.h"
#include "engine/joints/joint_batch.h"
#include "engine/joints/lock_rows.h"

namespace sheave {

/// Appends the effects that keep coordinate 1 equal to `ratio` times coordinate 0, within the
/// backlash.
inline void append_coupling(double ratio, double compliance, double backlash,
                            std::vector<JointEffect>& effects) {
  using Kind = JointEffect::Kind;
  const auto add = [&](Kind kind, double at) {
    effects.push_back({.kind = kind,
                       .coordinate = 0,
                       .second = 1,
                       .factor = -ratio,
                       .second_factor = 1.0,
                       .at = at,
                       .compliance = compliance,
                       .signal = {}});
  };
  if (backlash > 0.0) {
    add(Kind::lower, -0.5 * backlash);
    add(Kind::upper, 0.5 * backlash);
  } else {
    add(Kind::coupling, 0.0);
  }
}

/// Appends the errors of a coupling's bodies and ratio.
inline void check_coupling(const JointDef& joint, BodyId carrier, double ratio,
                           const char* ratio_key, const BodySet& bodies, const std::string& path,
                           Errors& errors) {
  const std::string start = "joint \"" + joint.name + "\": ";
  for (const auto& [key, body] : {std::pair{"/body_a", joint.body_a}, {"/body_b", joint.body_b}}) {
    if (body.is_world())
      errors.push_back({path + key, start + "the world does not move; name a body"});
  }
  if (!bodies.contains(carrier)) {
    errors.push_back(
        {path + "/carrier", start + "there is no body number " + std::to_string(carrier.index)});
    return;
  }
  if (!carrier.is_world() && (carrier == joint.body_a || carrier == joint.body_b)) {
    errors.push_back({path + "/carrier",
                      start + "the carrier must be another body than the two that it carries"});
  }
  if (!(ratio != 0.0)) {
    errors.push_back({path + "/" + ratio_key, start + std::string(ratio_key) + " must not be 0"});
  }
  // A row has room for four bodies.
  std::vector<int> touched;
  for (const BodyId body : {joint.body_a, joint.body_b, carrier}) {
    const int index = bodies.index(body);
    if (body.is_world()) continue;
    touched.push_back(index);
    if (bodies[index].mount >= 0) touched.push_back(bodies[index].mount);
  }
  std::sort(touched.begin(), touched.end());
  const auto count = std::unique(touched.begin(), touched.end()) - touched.begin();
  if (count > Row::max_terms) {
    errors.push_back(
        {path + "/carrier",
         start +
             "the bodies and their carriers are more than four, the most that a joint can have"});
  }
}

}  // namespace sheave
