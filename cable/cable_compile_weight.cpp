// Ropes with weight at time 0: the links that they can have, and their lengths under a pretension.

#include <cmath>

#include "cable/cable_compiler.h"
#include "cable/hanging_rope.h"
#include "engine/field_check.h"
#include "engine/index.h"

namespace sheave {
namespace {

constexpr std::string_view other_ropes =
    "; give the link another form, or leave linear_density out, so that the rope has no weight";

/// Why a rope with weight cannot run over a wheel; empty if it can.
std::string wheel_fault(const LinkGeometry& wheel, const CableDef& def) {
  if (wheel.outline) return "a rope with weight runs over round wheels only";
  if (wheel.massless) {
    return "a rope with weight turns its wheel by the difference of the tensions on both sides, so "
           "the wheel needs a spin inertia";
  }
  if (!std::isnan(wheel.friction)) {
    return "a rope with weight does not slide over a wheel; leave friction out";
  }
  if (wheel.layer_pitch > 0.0) {
    return "a rope with weight is wound in one layer; leave layer_pitch out";
  }
  if (wheel.starts_lifted) {
    return "a rope with weight lies on its wheels from the start; leave lifted out";
  }
  if (def.tangent_update == TangentUpdate::substep) {
    return "a rope with weight follows its wheels within a substep; leave tangent_update out";
  }
  return {};
}

}  // namespace

void CableCompiler::check_weight(const CableDef& def) {
  if (!(def.linear_density > 0.0)) return;
  for (std::size_t i = 0; i < def.links.size(); ++i) {
    const std::string_view type = def.links[i]->type();
    const std::string field = "/links/" + std::to_string(i);
    if (type != "attachment" && type != "rolling" && type != "spool") {
      fail(field,
           "a rope with weight (\"linear_density\") can have links of the types \"attachment\", "
           "\"rolling\" and \"spool\"; this link is of type \"" +
               std::string(type) + "\"");
    } else if (links_[i].wraps()) {
      const std::string fault = wheel_fault(links_[i], def);
      if (!fault.empty()) {
        fail(field, link_name(static_cast<int>(i)) + ": " + fault + std::string(other_ropes));
      }
    }
  }
}

void CableCompiler::check_heavy_span(const SpanSetup& setup, int first, int second) {
  const int wheel = links_[at(first)].wraps() ? first : second;
  if (!links_[at(wheel)].wraps()) return;
  const std::string field = "/links/" + std::to_string(wheel);
  const double gravity = now_->gravity.norm();
  constexpr double rounding = 1e-9;
  if (std::abs(setup.normal.dot(now_->gravity)) > rounding * gravity) {
    fail(field,
         link_name(wheel) +
             ": a rope with weight runs over wheels in a vertical plane only; turn the wheel "
             "until its axle is level" +
             std::string(other_ropes));
  } else if (setup.kind != SpanKind::planar) {
    fail(field,
         link_name(wheel) +
             ": a rope with weight needs bodies that keep both ends of a span in the plane of "
             "the wheel; give them the mobility \"planar\" or \"slider\"" +
             std::string(other_ropes));
  }
}

bool CableCompiler::weighs(const CableDef& def) const {
  return def.linear_density > 0.0 && !is_zero(now_->gravity);
}

WheelPlane CableCompiler::heavy_plane(const CableDef& def, int span) const {
  const int second = next_touched(span);
  SpanSetup setup;
  choose_kind(setup, links_[at(span)], links_[at(second)]);
  CompiledCable cable;
  cable.linear_density = def.linear_density;
  cable.inverse_stiffness = 1.0 / *def.axial_stiffness;
  return wheel_plane_of(*now_, cable, setup, links_[at(span)], links_[at(second)],
                        geometry_[at(span)]);
}

double CableCompiler::hanging_length(const CableDef& def, int span, double tension) {
  const HangingRope rope = hanging_rope(def.linear_density, 1.0 / *def.axial_stiffness,
                                        now_->gravity, geometry_[at(span)]);
  const WheelPlane wheels = heavy_plane(def, span);
  double length = 0.0;
  double found = 0.0;
  if (wheels.has_wheels) {
    const WheelCatenary between = wheel_catenary_of_tension(wheels.span, tension);
    length = between.length();
    found = between.catenary.tension;
  } else {
    const Catenary catenary = catenary_of_tension(rope, tension);
    length = catenary.length;
    found = catenary.tension;
  }
  constexpr double rounding = 1e-9;
  if (found > tension * (1.0 + rounding)) {
    fail(def.pretension ? "/pretension" : "/pretensions/" + std::to_string(span),
         "span " + std::to_string(span) +
             " would hang down without bound: the rope's weight alone "
             "gives it more than " +
             number_text(0.5 * rope.weight * std::abs(rope.rise)) +
             " N along the line between its ends; give a larger pretension, or rest_lengths");
  }
  return length;
}

double CableCompiler::heavy_start_strain(const CableDef& def, int link) const {
  double sum = 0.0;
  int count = 0;
  for (int k = 0; k < def.span_count(); ++k) {
    if (k != link && next_touched(k) != link) continue;
    const double rest_length =
        given_lengths_.empty() ? geometry_[at(k)].length : given_lengths_[at(k)];
    const WheelPlane wheels = heavy_plane(def, k);
    const WheelCatenary rope = wheel_catenary_of_length(wheels.span, rest_length);
    const double tension = k == link ? rope.first_tension : rope.second_tension;
    sum += std::max(tension, 0.0) / *def.axial_stiffness;
    ++count;
  }
  return count > 0 ? sum / count : 0.0;
}

}  // namespace sheave
