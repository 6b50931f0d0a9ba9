#include <sheave_version.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "command/run/error_estimate_text.h"
#include "command/run/summary.h"
#include "engine/body_set.h"

namespace sheave::command {
namespace {

// Keeps the keys in order. NaN and infinity become null.
using RunJson = nlohmann::ordered_json;

RunJson run_json(const Vector3& v) { return RunJson::array({v.x(), v.y(), v.z()}); }
RunJson run_json(const Quaternion& q) { return RunJson::array({q.w(), q.x(), q.y(), q.z()}); }
RunJson run_json(const Energy& energy) {
  return {{"kinetic", energy.kinetic},
          {"potential", energy.potential},
          {"elastic", energy.elastic},
          {"total", energy.total()}};
}

RunJson settings(const Scene& scene) {
  const StepSettings& step = scene.model.step;
  const bool fixed = step.tolerance == 0.0;
  return {{"dt", step.dt},
          {"substeps", fixed ? RunJson(step.substeps) : RunJson()},
          {"tolerance", fixed ? RunJson() : RunJson(step.tolerance)},
          {"iterations", step.iterations},
          {"solver", solver_names[static_cast<std::size_t>(step.solver)]},
          {"integrator", integrator_names[static_cast<std::size_t>(step.integrator)]},
          {"duration", scene.duration}};
}

RunJson statistics(const RunStatistics& statistics) {
  return {{"rows", statistics.rows},
          {"row_solves", statistics.row_solves},
          {"last_correction", statistics.last_correction},
          {"geometry_fallbacks", statistics.geometry_fallbacks},
          {"rounds", statistics.rounds},
          {"set_changes", statistics.set_changes},
          {"factorisations", statistics.factorisations},
          {"solver_fallbacks", statistics.solver_fallbacks},
          {"redundant_rows", statistics.redundant_rows},
          {"compromises", statistics.compromises},
          {"impossible", statistics.impossible},
          {"most_impossible", statistics.most_impossible},
          {"dead_ends", statistics.dead_ends},
          {"integrator_fallbacks", statistics.integrator_fallbacks},
          {"cut_substeps", statistics.cut_substeps},
          {"substep_parts", statistics.substep_parts},
          {"unconverged", statistics.unconverged},
          {"exhausted", statistics.exhausted},
          {"unknown_forces", statistics.unknown_forces},
          {"contacts", statistics.contacts},
          {"deepest_overlap", statistics.deepest_overlap},
          {"numerical_damping", statistics.numerical_damping},
          {"kept_substeps", statistics.kept_substeps},
          {"undone_substeps", statistics.undone_substeps},
          {"missed_tolerance", statistics.missed_tolerance}};
}

RunJson run_json(const SpanReport& span, bool known) {
  RunJson json = {{"tension", known ? RunJson(span.tension) : RunJson()},
                  {"length", span.length},
                  {"rest_length", span.rest_length}};
  if (span.hangs) {
    json["start_tension"] = span.tension_at(0.0);
    json["end_tension"] = span.tension_at(1.0);
    if (span.floored > 0.0) json["floor_length"] = span.floored;
  }
  return json;
}

RunJson run_json(const LinkReport& link) {
  RunJson json = {{"type", link.type},
                  {"stored_length", link.stored_length},
                  {"wrap_angle", link.wrap_angle},
                  {"slip", link.slip},
                  {"fed", link.fed},
                  {"entry", run_json(link.entry)},
                  {"exit", run_json(link.exit)}};
  if (link.groove) {
    json["axial_position"] = link.groove->axial_position;
    json["fleet_angle"] = link.groove->fleet_angle;
    json["layer"] = link.groove->layer;
  }
  return json;
}

RunJson cables(const RunSummary& summary) {
  RunJson list = RunJson::array();
  // Tensions are unknown before the first step.
  const bool known = summary.simulation.world.state().steps > 0;
  const std::vector<CableReport> reports = summary.simulation.cable_reports();
  for (std::size_t i = 0; i < reports.size(); ++i) {
    RunJson spans = RunJson::array();
    for (const SpanReport& span : reports[i].spans) spans.push_back(run_json(span, known));
    RunJson links = RunJson::array();
    for (const LinkReport& link : reports[i].links) links.push_back(run_json(link));
    RunJson wraps = RunJson::array();
    for (const WrapReport& wrap : reports[i].wraps) {
      wraps.push_back({{"after_link", wrap.after},
                       {"body", summary.simulation.world.model()
                                    .bodies[static_cast<std::size_t>(wrap.link.body.index)]
                                    .name},
                       {"link", run_json(wrap.link)},
                       {"span", run_json(wrap.span, known)}});
    }
    list.push_back({{"name", reports[i].name},
                    {"total_length", reports[i].total_length},
                    {"length_error", summary.monitor.cables()[i].length_error},
                    {"max_stretch", summary.monitor.cables()[i].max_stretch},
                    {"max_strain", summary.monitor.cables()[i].max_strain},
                    {"cut", reports[i].cut},
                    {"spans", std::move(spans)},
                    {"links", std::move(links)},
                    {"wraps", std::move(wraps)}});
  }
  return list;
}

RunJson joints(const RunSummary& summary) {
  RunJson list = RunJson::array();
  // Forces are unknown before the first step.
  const bool known = summary.simulation.world.state().steps > 0;
  for (const JointReport& joint : summary.joints) {
    RunJson coordinates = RunJson::array();
    for (const JointCoordinateReport& coordinate : joint.coordinates) {
      coordinates.push_back({{"name", coordinate.name},
                             {"value", coordinate.value},
                             {"rate", coordinate.rate},
                             {"drive_force", known ? RunJson(coordinate.drive_force) : RunJson()},
                             {"drive_error", known ? RunJson(coordinate.drive_error) : RunJson()}});
    }
    list.push_back({{"name", joint.name},
                    {"type", joint.type},
                    {"force", known ? run_json(joint.force) : RunJson()},
                    {"torque", known ? run_json(joint.torque) : RunJson()},
                    {"coordinates", std::move(coordinates)},
                    {"error", joint.error},
                    {"angle_error", joint.angle_error},
                    {"broken_at", joint.broken_at ? RunJson(*joint.broken_at) : RunJson()}});
  }
  return list;
}

RunJson events(const RunSummary& summary) {
  RunJson list = RunJson::array();
  for (const RunEvent& event : summary.events) {
    if (event.source != RunEvent::Source::cable) {
      const char* source = event.source == RunEvent::Source::joint ? "joint" : "trigger";
      list.push_back({{"time", event.time}, {source, event.subject}, {"kind", event.kind}});
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

RunJson bodies(const World& world) {
  RunJson list = RunJson::array();
  for (int i = 0; i < world.bodies().count(); ++i) {
    const BodyId id{i};
    list.push_back({{"name", world.bodies().name(i)},
                    {"position", run_json(world.position(id))},
                    {"orientation", run_json(world.orientation(id))},
                    {"velocity", run_json(world.velocity(id))},
                    {"angular_velocity", run_json(world.angular_velocity(id))}});
  }
  return list;
}

RunJson contacts(const World& world) {
  RunJson list = RunJson::array();
  for (const ContactReport& contact : world.contacts()) {
    list.push_back({{"body_a", world.bodies().name(contact.body_a.index)},
                    {"body_b", world.bodies().name(contact.body_b.index)},
                    {"point", run_json(contact.point)},
                    {"normal", run_json(contact.normal)},
                    {"gap", contact.gap},
                    {"normal_force", contact.normal_force},
                    {"friction_force", run_json(contact.friction_force)},
                    {"sticks", contact.sticks}});
  }
  return list;
}

RunJson warnings(const std::vector<Warning>& warnings) {
  RunJson list = RunJson::array();
  for (const Warning& warning : warnings) {
    list.push_back(
        {{"kind", warning.kind}, {"subject", warning.subject}, {"message", warning.message}});
  }
  return list;
}

RunJson outputs(const std::vector<OutputSummary>& outputs) {
  RunJson list = RunJson::array();
  for (const OutputSummary& output : outputs) {
    const bool table = output.kind == OutputSummary::Kind::table;
    list.push_back({{"kind", table ? "table" : "state"},
                    {"path", output.path},
                    {"rows", table ? RunJson(output.rows) : RunJson()},
                    {"complete", output.fault.empty()},
                    {"fault", output.fault}});
  }
  return list;
}

RunJson checks(const std::vector<CheckResult>& results) {
  RunJson list = RunJson::array();
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

RunJson divergence(const Divergence& divergence, const World& world) {
  // The divergence may be of a feature while all bodies are finite.
  const bool of_body = !divergence.body.is_world();
  return {{"body", of_body ? RunJson(world.bodies().name(divergence.body.index)) : RunJson()},
          {"feature", of_body ? RunJson() : RunJson(divergence.feature)},
          {"time", divergence.time},
          {"message", divergence.message}};
}

RunJson run_json(const measure::StepDifference& difference) {
  return {{"largest", difference.largest},
          {"time", difference.time},
          {"at_end", difference.at_end},
          {"scale", difference.scale},
          {"relative", difference.relative()},
          {"order", difference.order ? RunJson(*difference.order) : RunJson()},
          {"bound", difference.bound},
          {"unseen", difference.unseen},
          {"error", difference.error()}};
}

RunJson run_json(const CertificateItem& item) {
  return {{"kind", certificate_kind_names[static_cast<std::size_t>(item.kind)]},
          {"name", item.name},
          {"value", item.value},
          {"unit", item.unit},
          {"scale", item.scale},
          {"relative", item.relative},
          {"time", item.time},
          {"advice", item.advice}};
}

RunJson certificate(const RunSummary& summary) {
  const Certificate& own = summary.outcome.certificate;
  RunJson items = RunJson::array();
  for (const CertificateItem& item : own.items) items.push_back(run_json(item));
  const CertificateItem* worst = own.worst();
  return {{"clean", own.clean(summary.trust)},
          {"trust", summary.trust},
          {"substeps", own.substeps},
          {"worst", worst == nullptr ? RunJson() : run_json(*worst)},
          {"items", std::move(items)},
          {"text", certificate_text(own, summary.trust)}};
}

RunJson decisions(const measure::ErrorEstimate& estimate) {
  RunJson list = RunJson::array();
  for (const measure::Decision& own : estimate.decisions) {
    list.push_back({{"alternative", own.alternative},
                    {"branch", own.branch},
                    {"other_branch", own.other},
                    {"margin", own.margin},
                    {"unit", own.unit},
                    {"time", own.time},
                    {"error", own.error ? RunJson(*own.error) : RunJson()},
                    {"entered_other_branch", own.took_other},
                    {"close", own.close}});
  }
  return list;
}

RunJson error_estimate(const measure::ErrorEstimate& estimate, const World& world) {
  RunJson bodies = RunJson::array();
  for (const measure::BodyDifference& body : estimate.bodies) {
    bodies.push_back({{"name", body.name},
                      {"position", run_json(body.position)},
                      {"turn", run_json(body.turn)}});
  }
  RunJson spans = RunJson::array();
  for (const measure::SpanDifference& span : estimate.spans) {
    spans.push_back({{"name", span.name}, {"tension", run_json(span.tension)}});
  }
  const auto kind = [](measure::StepErrorKind of) {
    return measure::step_error_kind_names[static_cast<std::size_t>(of)];
  };
  const bool fixed = estimate.tolerance == 0.0;
  RunJson object{{"substeps", fixed ? RunJson(estimate.substeps) : RunJson()},
                 {"tolerance", fixed ? RunJson() : RunJson(estimate.tolerance)},
                 {"end", estimate.end},
                 {"position", run_json(estimate.position)},
                 {"position_kind", kind(estimate.position_kind)},
                 {"tension", run_json(estimate.tension)},
                 {"tension_kind", kind(estimate.tension_kind)},
                 {"motion", estimate.motion},
                 {"events", estimate.changes.count()},
                 {"sudden_events", estimate.changes.sudden},
                 {"stops", estimate.changes.stops},
                 {"growth", estimate.growth ? RunJson(*estimate.growth) : RunJson()},
                 {"trusted_time", estimate.trusted_time},
                 {"bodies", std::move(bodies)},
                 {"spans", std::move(spans)},
                 {"decisions", decisions(estimate)},
                 {"apart", estimate.apart},
                 {"apart_body", estimate.apart_body},
                 {"conclusion", error_estimate_conclusion(estimate)}};
  if (estimate.divergence) object["divergence"] = divergence(*estimate.divergence, world);
  return object;
}

/// Numbers that are not finite are null.
RunJson rope_life(const std::vector<RopeWear>& ropes) {
  RunJson list = RunJson::array();
  for (const RopeWear& rope : ropes) {
    list.push_back({{"cable", rope.cable},
                    {"from", rope.from},
                    {"to", rope.to},
                    {"simple_bends", rope.simple_bends},
                    {"reverse_bends", rope.reverse_bends},
                    {"damage", rope.damage},
                    {"repetitions", rope.repetitions}});
  }
  return list;
}

}  // namespace

std::string to_json(const RunSummary& summary) {
  const World& world = summary.simulation.world;
  const RunOutcome& outcome = summary.outcome;
  RunJson object{{"scene", summary.scene_path},
                 {"name", summary.scene.name},
                 {"version", version_string},
                 {"status", summary.status()},
                 {"steps", outcome.steps},
                 {"sim_time", world.state().time},
                 {"wall_time", outcome.wall_time},
                 {"us_per_step", 1e6 * time_per_step(outcome)},
                 {"settings", settings(summary.scene)},
                 {"energy",
                  {{"initial", summary.monitor.initial_energy().total()},
                   {"final", summary.monitor.final_energy().total()},
                   {"max_drift", summary.monitor.max_energy_drift()},
                   {"integrator_loss", summary.monitor.integrator_loss()},
                   {"flow", summary.monitor.energy_flow()},
                   {"parts", run_json(summary.monitor.final_energy())}}},
                 {"cables", cables(summary)},
                 {"joints", joints(summary)},
                 {"bodies", bodies(world)},
                 {"statistics", statistics(outcome.statistics)},
                 {"certificate", certificate(summary)},
                 {"events", events(summary)},
                 {"warnings", warnings(summary.warnings)},
                 {"outputs", outputs(summary.outputs)}};
  if (!world.model().colliders.empty()) object["contacts"] = contacts(world);
  if (summary.checked) {
    object["checks"] = checks(summary.checks);
    object["checks_passed"] = summary.checks_passed();
  }
  if (summary.error_estimate) {
    object["error_estimate"] = error_estimate(*summary.error_estimate, world);
  }
  if (!summary.ropes.empty()) object["rope_life"] = rope_life(summary.ropes);
  if (outcome.divergence) object["divergence"] = divergence(*outcome.divergence, world);
  // As text, because most programs read JSON numbers as doubles and would lose digits.
  object["state_hash"] = fmt::format("{:016x}", hash(world.state()));
  // File names need not be UTF-8.
  return object.dump(-1, ' ', false, RunJson::error_handler_t::replace) + "\n";
}

}  // namespace sheave::command
