#include "command/statics/report.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cable/links/pinhole.h"
#include "cable/links/rolling.h"
#include "cable/links/sheath.h"
#include "cable/links/surface.h"
#include "command/run/player.h"
#include "command/terminal.h"
#include "command/text/table.h"
#include "engine/body_set.h"
#include "engine/field_check.h"
#include "scenes/quantity_list.h"
#include "scenes/unit_scale.h"

namespace sheave::command {
namespace {

using StaticsJson = nlohmann::ordered_json;

bool has_friction(const std::vector<CableDef>& cables) {
  for (const CableDef& cable : cables) {
    if (cable.wrap_friction > 0.0) return true;
    for (const auto& link : cable.links) {
      const auto* rolling = dynamic_cast<const RollingLink*>(link.get());
      const auto* pinhole = dynamic_cast<const PinholeLink*>(link.get());
      if (rolling != nullptr && rolling->friction.value_or(0.0) > 0.0) return true;
      if (rolling != nullptr && rolling->efficiency.value_or(1.0) < 1.0) return true;
      if (rolling != nullptr && rolling->passes != Passage::both) return true;
      if (pinhole != nullptr && pinhole->friction > 0.0) return true;
      if (pinhole != nullptr && pinhole->passes != Passage::both) return true;
      const auto* surface = dynamic_cast<const SurfaceLink*>(link.get());
      if (surface != nullptr && surface->friction > 0.0) return true;
      const auto* sheath = dynamic_cast<const SheathLink*>(link.get());
      if (sheath != nullptr && sheath->friction > 0.0) return true;
    }
  }
  return false;
}

void take_quantities(const Simulation& simulation, const std::vector<std::string>& names,
                     StaticsResult& result) {
  if (names.empty()) {
    for (const CableReport& cable : result.cables) {
      result.quantities.push_back("max:" + std::string(cable.name) + ".tension");
      result.units.emplace_back("N");
      result.values.push_back(cable.largest_tension());
    }
    return;
  }
  QuantityList quantities(QuantityIndex::of(simulation, names));
  for (const std::string& name : names) {
    const Errors faults = quantities.add(name);
    if (!faults.empty()) throw Failure(ExitCode::usage, "--quantity: " + to_text(faults));
    if (!quantities.follows_from_state(quantities.size() - 1)) {
      throw Failure(ExitCode::usage, "--quantity " + name +
                                         ": this quantity needs motion; statics has poses, "
                                         "lengths, tensions and the forces of joints");
    }
  }
  result.quantities = names;
  for (std::size_t i = 0; i < names.size(); ++i) result.units.push_back(quantities.unit(i));
  result.values.resize(names.size());
  quantities.sample(simulation, result.values);
}

/// "max:rope.tension [kN]"
std::string quantity_label(const StaticsResult& result, std::size_t i, const UnitScale& scale) {
  const std::string& unit = result.units[i];
  return unit.empty() ? result.quantities[i]
                      : fmt::format("{} [{}{}]", result.quantities[i], scale.prefix, unit);
}

std::string body_name(const StaticsResult& result, BodyId body) {
  return body.is_world() ? "world" : result.bodies[static_cast<std::size_t>(body.index)];
}

std::string stability_text(const Equilibrium& rest) {
  switch (rest.stability) {
    case Stability::unstable:
      return fmt::format("unstable: {} of {} independent motions run away", rest.unstable_motions,
                         rest.eigenvalues.size());
    case Stability::neutral:
      return fmt::format("neutral: {} of {} independent motions meet no stiffness",
                         rest.neutral_motions, rest.eigenvalues.size());
    case Stability::stable:
      break;
  }
  return rest.eigenvalues.empty() ? "stable: no body can move" : "stable";
}

const char* stability_name(Stability stability) {
  return stability == Stability::stable    ? "stable"
         : stability == Stability::neutral ? "neutral"
                                           : "unstable";
}

/// "between the pose of the scene and this one cable "rope" has left "wheel"".
std::string event_text(const CableEvent& event) {
  const std::string body = event.body.empty() ? "the world" : "\"" + event.body + "\"";
  const std::string cable = "cable \"" + event.cable + "\"";
  switch (event.kind) {
    case CableEvent::Kind::leave:
      return cable + " has left " + body;
    case CableEvent::Kind::touch:
      return cable + " now lies on " + body;
    case CableEvent::Kind::attach:
      return cable + " has unwound completely from " + body + " and is attached there";
    case CableEvent::Kind::wind:
      return cable + " is wound up again on " + body;
    case CableEvent::Kind::cut:
      return cable + " has parted";
    case CableEvent::Kind::stall:
    case CableEvent::Kind::slip:
    case CableEvent::Kind::full:
      break;
  }
  return cable + " has slid on " + body;
}

/// `cases`: their names, or empty for a single one.
std::string open_text(const std::string& cases) {
  return (cases.empty() ? "" : cases + ": ") +
         "dry friction, a wheel with losses, or a drive with a limit acts. Its force is open "
         "within "
         "its bounds; the force told is the one that the way from the scene's pose has left. Runs "
         "that move slowly to and fro tell the bounds\n";
}

std::string verdict(const StaticsResult& result) {
  const Equilibrium& rest = result.rest;
  if (!rest.converged) return "no equilibrium found";
  std::string text = "at rest, " + stability_text(rest) + "\n";
  text += fmt::format("{} iterations; residuals: forces {:.1e}, lengths {:.1e}\n", rest.iterations,
                      rest.force_error, rest.length_error);
  text +=
      fmt::format("{} degrees of freedom, {} rigid constraints", rest.freedoms, rest.constraints);
  if (rest.redundant > 0) {
    text += fmt::format(
        ", of which {} redundant: their forces are not unique, and the smallest ones are given",
        rest.redundant);
  }
  text += "\n";
  if (result.is_open()) text += open_text("");
  for (const CableEvent& event : rest.events) {
    text += "since the pose of the scene " + event_text(event) + "\n";
  }
  if (!rest.slack_spans.empty()) {
    text += "slack:";
    for (const SlackSpan& span : rest.slack_spans) {
      text += fmt::format(" {}.{} ({} m)", result.cables[static_cast<std::size_t>(span.cable)].name,
                          span.span, short_number(span.slack));
    }
    text += "\n";
  }
  return text;
}

std::string one_text(const StaticsResult& result) {
  std::string text = printable_line(result.scene) + ": " + verdict(result);
  TextTable bodies({"centre of mass of", "x [m]", "y [m]", "z [m]", "turned [rad]"}, 1);
  for (std::size_t i = 0; i < result.bodies.size(); ++i) {
    const BodyState& body = result.state.bodies[i];
    const double turned = 2.0 * std::atan2(body.orientation.vec().norm(), body.orientation.w());
    bodies.add({result.bodies[i], short_number(body.position.x()), short_number(body.position.y()),
                short_number(body.position.z()),
                short_number(body.angle != 0.0 ? body.angle : turned)});
  }
  text += "\n" + bodies.text();
  if (!result.cables.empty()) {
    TextTable spans({"span", "tension [N]", "length [m]", "rest length [m]"}, 1);
    for (const CableReport& cable : result.cables) {
      for (std::size_t k = 0; k < cable.spans.size(); ++k) {
        const SpanReport& span = cable.spans[k];
        if (span.length == 0.0 && span.tension == 0.0) continue;
        spans.add({fmt::format("{}.{}", cable.name, k), short_number(span.tension),
                   short_number(span.length), short_number(span.rest_length)});
      }
    }
    text += "\n" + spans.text();
  }
  if (!result.joints.empty()) {
    TextTable joints({"joint", "force x [N]", "y [N]", "z [N]", "torque [N m]"}, 1);
    for (const JointReport& joint : result.joints) {
      joints.add({joint.name, short_number(joint.force.x()), short_number(joint.force.y()),
                  short_number(joint.force.z()), short_number(joint.torque.norm())});
    }
    text += "\n" + joints.text();
  }
  if (!result.supports.empty()) {
    TextTable supports({"held by its support", "force x [N]", "y [N]", "z [N]"}, 1);
    for (const SupportReaction& support : result.supports) {
      supports.add({body_name(result, support.body), short_number(support.force.x()),
                    short_number(support.force.y()), short_number(support.force.z())});
    }
    text += "\n" + supports.text();
  }
  return text;
}

StaticsJson vector_json(const Vector3& v) { return StaticsJson::array({v.x(), v.y(), v.z()}); }

StaticsJson bodies_json(const StaticsResult& result) {
  StaticsJson bodies = StaticsJson::array();
  for (std::size_t i = 0; i < result.bodies.size(); ++i) {
    const BodyState& body = result.state.bodies[i];
    const Quaternion& q = body.orientation;
    bodies.push_back({{"name", result.bodies[i]},
                      {"center_of_mass", vector_json(body.position)},
                      {"orientation", StaticsJson::array({q.w(), q.x(), q.y(), q.z()})},
                      {"angle", body.angle}});
  }
  return bodies;
}

StaticsJson case_json(const StaticsResult& result) {
  const Equilibrium& rest = result.rest;
  StaticsJson cables = StaticsJson::array();
  for (const CableReport& cable : result.cables) {
    StaticsJson spans = StaticsJson::array();
    for (const SpanReport& span : cable.spans) {
      spans.push_back({{"tension", span.tension},
                       {"length", span.length},
                       {"rest_length", span.rest_length},
                       {"slack", span.tension <= 0.0}});
      if (!span.hangs) continue;
      spans.back()["start_tension"] = span.tension_at(0.0);
      spans.back()["end_tension"] = span.tension_at(1.0);
      if (span.floored > 0.0) spans.back()["floor_length"] = span.floored;
    }
    cables.push_back({{"name", cable.name}, {"spans", std::move(spans)}});
  }
  StaticsJson joints = StaticsJson::array();
  for (const JointReport& joint : result.joints) {
    joints.push_back({{"name", joint.name},
                      {"force", vector_json(joint.force)},
                      {"torque", vector_json(joint.torque)}});
  }
  StaticsJson supports = StaticsJson::array();
  for (const SupportReaction& support : result.supports) {
    supports.push_back(
        {{"body", body_name(result, support.body)}, {"force", vector_json(support.force)}});
  }
  StaticsJson quantities = StaticsJson::object();
  for (std::size_t i = 0; i < result.quantities.size(); ++i) {
    quantities[result.quantities[i]] = result.values[i];
  }
  StaticsJson events = StaticsJson::array();
  for (const CableEvent& event : rest.events) {
    events.push_back({{"cable", event.cable},
                      {"event", cable_event_names[static_cast<std::size_t>(event.kind)]},
                      {"link", event.link < 0 ? StaticsJson() : StaticsJson(event.link)},
                      {"body", event.body}});
  }
  return {{"name", result.name.empty() ? StaticsJson() : StaticsJson(result.name)},
          {"converged", rest.converged},
          {"message", rest.message},
          {"iterations", rest.iterations},
          {"force_error", rest.force_error},
          {"length_error", rest.length_error},
          {"stability", stability_name(rest.stability)},
          {"unstable_motions", rest.unstable_motions},
          {"neutral_motions", rest.neutral_motions},
          {"eigenvalues", rest.eigenvalues},
          {"events", std::move(events)},
          {"degrees_of_freedom", rest.freedoms},
          {"constraints", rest.constraints},
          {"redundant", rest.redundant},
          {"friction_open", result.is_open()},
          {"quantities", std::move(quantities)},
          {"bodies", bodies_json(result)},
          {"cables", std::move(cables)},
          {"joints", std::move(joints)},
          {"supports", std::move(supports)}};
}

}  // namespace

StaticsResult find_rest(const StaticsCase& one, const EquilibriumSettings& settings,
                        const std::vector<std::string>& quantities) {
  Scene scene = load(one.scene);
  if (one.tells_loads) warn_of_loads_left_out(scene);
  scene.start.reset();  // the search starts in the pose, or in the loaded state
  const auto made = std::make_shared<Simulation>(make_simulation(scene));
  Simulation& simulation = *made;
  StaticsResult result;
  result.simulation = made;
  result.name = one.name;
  result.scene = scene.name.empty() ? one.scene.path : scene.name;
  result.rest = find_equilibrium(simulation, settings);
  result.state = simulation.world.state();
  for (const BodyDef& body : scene.model.bodies) result.bodies.push_back(body.name);
  result.cables = simulation.cable_reports();
  result.joints = joint_reports(simulation.world);
  result.supports = support_reactions(simulation, result.rest.forces);
  result.cable_friction = has_friction(scene.cables);
  take_quantities(simulation, quantities, result);
  return result;
}

std::string statics_text(const std::vector<StaticsResult>& results, bool quantities) {
  if (results.size() == 1 && results.front().name.empty()) {
    const StaticsResult& only = results.front();
    if (!quantities || !only.rest.converged) return one_text(only);
    TextTable asked({"quantity", "value"}, 1);
    for (std::size_t i = 0; i < only.quantities.size(); ++i) {
      const UnitScale scale = unit_scale(only.values[i], only.units[i]);
      asked.add({quantity_label(only, i, scale), short_number(only.values[i] / scale.factor)});
    }
    return one_text(only) + "\n" + asked.text();
  }
  std::vector<std::string> head{"case", "found", "stability"};
  const std::size_t count = results.front().quantities.size();
  std::vector<UnitScale> scales;
  for (std::size_t i = 0; i < count; ++i) {
    double most = 0.0;  // one prefix for all cases
    for (const StaticsResult& result : results) {
      if (i < result.values.size() && std::isfinite(result.values[i])) {
        most = std::max(most, std::abs(result.values[i]));
      }
    }
    scales.push_back(unit_scale(most, results.front().units[i]));
    head.push_back(quantity_label(results.front(), i, scales.back()));
  }
  TextTable table(std::move(head), 3);
  std::string open;  // the cases whose forces are open
  for (const StaticsResult& result : results) {
    std::vector<std::string> cells{result.name, result.rest.converged ? "yes" : "no",
                                   stability_name(result.rest.stability)};
    for (std::size_t i = 0; i < std::min(count, result.values.size()); ++i) {
      cells.push_back(short_number(result.values[i] / scales[i].factor));
    }
    cells.resize(3 + count);
    table.add(std::move(cells));
    if (result.is_open()) open += (open.empty() ? "" : ", ") + result.name;
  }
  return table.text() + (open.empty() ? "" : open_text(open));
}

std::string statics_json(const std::string& path, const std::vector<StaticsResult>& results) {
  StaticsJson cases = StaticsJson::array();
  for (const StaticsResult& result : results) cases.push_back(case_json(result));
  const StaticsJson object{
      {"format", "sheave-statics/1"}, {"scene", path}, {"cases", std::move(cases)}};
  return object.dump(-1, ' ', false, StaticsJson::error_handler_t::replace) + "\n";
}

}  // namespace sheave::command
