#include <sheave_version.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/run_summary.h"

namespace sheave::tools {
namespace {

// Keeps the keys in the order in which people expect them. NaN and infinity become null.
using Json = nlohmann::ordered_json;

Json json(const Vector3& v) { return Json::array({v.x(), v.y(), v.z()}); }
Json json(const Quaternion& q) { return Json::array({q.w(), q.x(), q.y(), q.z()}); }
Json json(const Energy& energy) {
  return {{"kinetic", energy.kinetic},
          {"potential", energy.potential},
          {"elastic", energy.elastic},
          {"total", energy.total()}};
}

Json settings(const Scene& scene) {
  const StepSettings& step = scene.model.step;
  return {{"dt", step.dt},
          {"substeps", step.substeps},
          {"iterations", step.iterations},
          {"solver", solver_names[static_cast<std::size_t>(step.solver)]},
          {"integrator", integrator_names[static_cast<std::size_t>(step.integrator)]},
          {"duration", scene.duration}};
}

Json statistics(const RunStatistics& statistics) {
  return {{"rows", statistics.rows},
          {"row_solves", statistics.row_solves},
          {"last_correction", statistics.last_correction},
          {"geometry_fallbacks", statistics.geometry_fallbacks},
          {"rounds", statistics.rounds},
          {"set_changes", statistics.set_changes},
          {"solver_fallbacks", statistics.solver_fallbacks},
          {"redundant_rows", statistics.redundant_rows},
          {"integrator_fallbacks", statistics.integrator_fallbacks},
          {"contacts", statistics.contacts},
          {"deepest_overlap", statistics.deepest_overlap},
          {"numerical_damping", statistics.numerical_damping}};
}

Json json(const SpanReport& span, bool known) {
  return {{"tension", known ? Json(span.tension) : Json()},
          {"length", span.length},
          {"rest_length", span.rest_length}};
}

Json json(const LinkReport& link) {
  return {{"type", link.type},
          {"stored_length", link.stored_length},
          {"wrap_angle", link.wrap_angle},
          {"slip", link.slip},
          {"fed", link.fed},
          {"entry", json(link.entry)},
          {"exit", json(link.exit)}};
}

Json cables(const RunSummary& summary) {
  Json list = Json::array();
  // Before the first step nobody knows the tensions.
  const bool known = summary.simulation.world.state().steps > 0;
  const std::vector<CableReport> reports = summary.simulation.cable_reports();
  for (std::size_t i = 0; i < reports.size(); ++i) {
    Json spans = Json::array();
    for (const SpanReport& span : reports[i].spans) spans.push_back(json(span, known));
    Json links = Json::array();
    for (const LinkReport& link : reports[i].links) links.push_back(json(link));
    Json wraps = Json::array();
    for (const WrapReport& wrap : reports[i].wraps) {
      wraps.push_back({{"after_link", wrap.after},
                       {"body", summary.simulation.world.model()
                                    .bodies[static_cast<std::size_t>(wrap.link.body.index)]
                                    .name},
                       {"link", json(wrap.link)},
                       {"span", json(wrap.span, known)}});
    }
    list.push_back({{"name", reports[i].name},
                    {"total_length", reports[i].total_length},
                    {"length_error", summary.monitor.cables()[i].length_error},
                    {"max_stretch", summary.monitor.cables()[i].max_stretch},
                    {"cut", reports[i].cut},
                    {"spans", std::move(spans)},
                    {"links", std::move(links)},
                    {"wraps", std::move(wraps)}});
  }
  return list;
}

Json joints(const RunSummary& summary) {
  Json list = Json::array();
  // Before the first step nobody knows the forces.
  const bool known = summary.simulation.world.state().steps > 0;
  for (const JointReport& joint : summary.joints) {
    Json coordinates = Json::array();
    for (const JointCoordinateReport& coordinate : joint.coordinates) {
      coordinates.push_back({{"name", coordinate.name},
                             {"value", coordinate.value},
                             {"rate", coordinate.rate},
                             {"drive_force", known ? Json(coordinate.drive_force) : Json()}});
    }
    list.push_back({{"name", joint.name},
                    {"type", joint.type},
                    {"force", known ? json(joint.force) : Json()},
                    {"torque", known ? json(joint.torque) : Json()},
                    {"coordinates", std::move(coordinates)},
                    {"broken_at", joint.broken_at ? Json(*joint.broken_at) : Json()}});
  }
  return list;
}

Json events(const RunSummary& summary) {
  Json list = Json::array();
  for (const RunEvent& event : summary.events) {
    if (event.of_joint) {
      list.push_back({{"time", event.time}, {"joint", event.subject}, {"kind", event.kind}});
      continue;
    }
    list.push_back({{"time", event.time},
                    {"cable", event.subject},
                    {"link", event.link},
                    {"body", event.body},
                    {"kind", event.kind}});
  }
  return list;
}

Json bodies(const World& world) {
  Json list = Json::array();
  for (int i = 0; i < world.bodies().count(); ++i) {
    const BodyId id{i};
    list.push_back({{"name", world.bodies().name(i)},
                    {"position", json(world.position(id))},
                    {"orientation", json(world.orientation(id))},
                    {"velocity", json(world.velocity(id))},
                    {"angular_velocity", json(world.angular_velocity(id))}});
  }
  return list;
}

Json contacts(const World& world) {
  Json list = Json::array();
  for (const ContactReport& contact : world.contacts()) {
    list.push_back({{"body_a", world.bodies().name(contact.body_a.index)},
                    {"body_b", world.bodies().name(contact.body_b.index)},
                    {"point", json(contact.point)},
                    {"normal", json(contact.normal)},
                    {"gap", contact.gap},
                    {"normal_force", contact.normal_force},
                    {"friction_force", json(contact.friction_force)},
                    {"sticks", contact.sticks}});
  }
  return list;
}

Json warnings(const std::vector<Warning>& warnings) {
  Json list = Json::array();
  for (const Warning& warning : warnings) {
    list.push_back(
        {{"kind", warning.kind}, {"subject", warning.subject}, {"message", warning.message}});
  }
  return list;
}

Json checks(const std::vector<CheckResult>& results) {
  Json list = Json::array();
  for (const CheckResult& result : results) {
    const auto statistic = static_cast<std::size_t>(result.check.statistic);
    list.push_back({{"quantity", result.check.quantity},
                    {"statistic", statistic_names[statistic]},
                    {"measured", result.measured},
                    {"expected", result.check.equals},
                    {"tolerance", result.tolerance},
                    {"error", result.error},
                    {"passed", result.passed},
                    {"message", result.message},
                    {"because", result.check.because}});
  }
  return list;
}

Json divergence(const Divergence& divergence, const World& world) {
  return {{"body", world.bodies().name(divergence.body.index)},
          {"time", divergence.time},
          {"message", divergence.message}};
}

}  // namespace

std::string to_json(const RunSummary& summary) {
  const World& world = summary.simulation.world;
  const RunOutcome& outcome = summary.outcome;
  Json object{{"scene", summary.scene_path},
              {"name", summary.scene.name},
              {"version", version_string},
              {"status", name_of(outcome.status)},
              {"steps", outcome.steps},
              {"sim_time", world.state().time},
              {"wall_time", outcome.wall_time},
              {"us_per_step", 1e6 * time_per_step(outcome)},
              {"settings", settings(summary.scene)},
              {"energy",
               {{"initial", summary.monitor.initial_energy().total()},
                {"final", summary.monitor.final_energy().total()},
                {"max_drift", summary.monitor.max_energy_drift()},
                {"parts", json(summary.monitor.final_energy())}}},
              {"cables", cables(summary)},
              {"joints", joints(summary)},
              {"bodies", bodies(world)},
              {"statistics", statistics(outcome.statistics)},
              {"events", events(summary)},
              {"warnings", warnings(summary.warnings)}};
  if (!world.model().colliders.empty()) object["contacts"] = contacts(world);
  if (summary.checked) {
    object["checks"] = checks(summary.checks);
    object["checks_passed"] = summary.checks_passed();
  }
  if (outcome.divergence) object["divergence"] = divergence(*outcome.divergence, world);
  // As text: JSON numbers of this size lose digits in most programs.
  object["state_hash"] = fmt::format("{:016x}", hash(world.state()));
  // File names need not be UTF-8.
  return object.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace sheave::tools
