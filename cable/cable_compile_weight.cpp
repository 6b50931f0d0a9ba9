// Ropes with weight at time 0: the links that they can have, and their lengths under a pretension.

#include <cmath>

#include "cable/cable_compiler.h"
#include "cable/hanging_rope.h"
#include "cable/heavy_runs.h"
#include "engine/field_check.h"
#include "engine/index.h"

namespace sheave {
namespace {

constexpr std::string_view other_ropes =
    "; give the link another form, or leave linear_density out, so that the rope has no weight";

/// Why a rope with weight cannot run over a wheel; empty if it can.
std::string wheel_fault(const LinkGeometry& wheel, const CableDef& def) {
  if (wheel.outline) return "a rope with weight runs over round wheels only";
  if (wheel.loss_exponent > 0.0) {
    return "a rope with weight turns a wheel without inertia freely; leave efficiency, "
           "bending_loss "
           "and bearing_friction out, or give the wheel a spin inertia";
  }
  if (wheel.pin_share > 0.0) {
    return "the load of the pin is that of straight spans, and a rope with weight sags; leave "
           "bearing_friction out, or give an efficiency";
  }
  if (!std::isnan(wheel.friction)) {
    return "a rope with weight does not slide over a wheel; leave friction out";
  }
  if (wheel.layer_pitch > 0.0) {
    return "a rope with weight is wound in one layer; leave layer_pitch out";
  }
  if (wheel.groove) {
    return "a rope with weight is wound in one plane; leave lead and turns_per_layer out";
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
    if (type != "attachment" && type != "pinhole" && type != "rolling" && type != "spool") {
      fail(field,
           "a rope with weight (\"linear_density\") can have links of the types \"attachment\", "
           "\"pinhole\", \"rolling\" and \"spool\"; this link is of type \"" +
               std::string(type) + "\"");
    } else if (type == "pinhole" && !links_[i].frictionless()) {
      fail(field, link_name(static_cast<int>(i)) +
                      ": a rope with weight passes pinholes freely; leave friction and passes out" +
                      std::string(other_ropes));
    } else if (links_[i].passes() && (def.damping > 0.0 || def.axial_damping > 0.0)) {
      fail(field, link_name(static_cast<int>(i)) +
                      ": a rope with weight passes pinholes and wheels without inertia without a "
                      "damper only; leave damping and axial_damping out" +
                      std::string(other_ropes));
    } else if (links_[i].wraps()) {
      const std::string fault = wheel_fault(links_[i], def);
      if (!fault.empty()) {
        fail(field, link_name(static_cast<int>(i)) + ": " + fault + std::string(other_ropes));
      }
    }
  }
}

void CableCompiler::check_inertia(const CableDef& def) {
  if (!def.axial_inertia) return;
  if (!(def.linear_density > 0.0)) {
    fail("/axial_inertia",
         "a rope with inertia needs \"linear_density\" [kg/m], its mass per length");
  }
  if (def.breaking_tension) {
    fail("/breaking_tension",
         "a rope with inertia does not break: its tension along the span is known without the "
         "waves that a break needs; leave breaking_tension or axial_inertia out");
  }
  for (std::size_t i = 0; i < def.links.size(); ++i) {
    const LinkGeometry& link = links_[i];
    std::string_view fault;
    if (link.massless) {
      fault = "a rope with inertia turns wheels with a spin inertia only; give the wheel one";
    } else if (link.slides || link.passes()) {
      fault = "a rope with inertia does not slide through a link; use a wheel with a spin inertia";
    } else if (link.bearing_arm > 0.0) {
      fault =
          "a rope with inertia turns its wheels without losses; leave efficiency, bending_loss "
          "and bearing_friction out";
    } else if (link.feeds) {
      fault = "a rope with inertia is not fed; wind it onto a drum, or leave feed_speed out";
    }
    if (fault.empty()) continue;
    fail("/links/" + std::to_string(i), link_name(static_cast<int>(i)) + ": " + std::string(fault) +
                                            ", or leave \"axial_inertia\" out");
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

namespace {

/// The constants of a rope with weight that its spans need.
CompiledCable constants_of(const CableDef& def) {
  CompiledCable cable;
  cable.linear_density = def.linear_density;
  cable.inverse_stiffness = 1.0 / *def.axial_stiffness;
  if (def.floor) cable.floor = *def.floor;
  return cable;
}

}  // namespace

WheelPlane CableCompiler::heavy_plane(const CableDef& def, int span) const {
  const int second = next_touched(span);
  SpanSetup setup;
  choose_kind(setup, links_[at(span)], links_[at(second)]);
  // Rope lies with one tension at time 0, as without friction.
  return wheel_plane_of(*now_, constants_of(def), setup, links_[at(span)], links_[at(second)],
                        geometry_[at(span)], {});
}

double CableCompiler::hanging_length(const CableDef& def, int span, double tension) {
  const HangingRope rope = hanging_rope(constants_of(def), now_->gravity, geometry_[at(span)], {});
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
             (rope.has_floor() ? " would lie slack on its floor"
                               : " would hang down without bound") +
             ": the rope's weight alone gives it more than " +
             number_text(rope.has_floor() ? found : 0.5 * rope.weight * std::abs(rope.rise)) +
             " N along the line between its ends; give a larger pretension, or rest_lengths");
  }
  return length;
}

void CableCompiler::share_lengths(const CableDef& def) {
  const auto passes = [&](int link) {
    const bool end = !def.closed && (link == 0 || link + 1 == static_cast<int>(links_.size()));
    return !end && links_[at(link)].passes();
  };
  if (given_lengths_.empty()) {
    for (const SpanGeometry& span : geometry_) given_lengths_.push_back(span.length);
  }
  const int count = def.span_count();
  int begin = 0;  // a ring's runs begin behind a link that no rope passes
  while (def.closed && begin + 1 < count && passes(begin)) ++begin;
  for (int done = 0; done < count;) {
    std::vector<int> run{(begin + done) % count};
    while (done + static_cast<int>(run.size()) < count && passes((run.back() + 1) % count)) {
      run.push_back((run.back() + 1) % count);
    }
    done += static_cast<int>(run.size());
    if (run.size() > 1) share_run(def, run);
  }
}

void CableCompiler::share_run(const CableDef& def, const std::vector<int>& run) {
  const double yield = 1.0 / *def.axial_stiffness;
  std::vector<SharedSpan> spans;
  for (const int k : run) {
    SharedSpan& span = spans.emplace_back();
    span.shape = {heavy_plane(def, k),
                  hanging_rope(constants_of(def), now_->gravity, geometry_[at(k)], {}),
                  geometry_[at(k)].length};
    span.rest = given_lengths_[at(k)];
  }
  spans.front().tension = spans.front().shape.own_weight();
  // The strain of the rope on wheels hardly depends on how the rope is shared.
  constexpr int rounds = 3;
  bool found = true;
  for (int round = 0; round < rounds && found; ++round) {
    for (std::size_t i = 1; i < spans.size(); ++i) {
      if (!links_[at(run[i])].wraps()) continue;
      double strain = 0.0;
      if (round > 0) {
        strain = 0.5 * yield *
                 (spans[i - 1].shape.ends(spans[i - 1].tension)[1] +
                  spans[i].shape.ends(spans[i].tension)[0]);
      }
      spans[i].lift =
          lift_over(spans[i].shape.wheels, 1.0 / (1.0 + std::max(strain, 0.0)),
                    geometry_[at(run[i - 1])].direction, geometry_[at(run[i])].direction);
    }
    found = share_rope(spans);
  }
  for (std::size_t i = 0; found && i < spans.size(); ++i) {
    given_lengths_[at(run[i])] = spans[i].length;
  }
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
