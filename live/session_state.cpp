#include "live/session_state.h"

#include <algorithm>

#include <fmt/format.h>

#include "engine/index.h"
#include "scenes/control/scene_supervisor.h"
#include "scenes/format.h"
#include "scenes/json/document.h"

namespace sheave::live {

std::string line_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string dropped_event(std::int64_t count) {
  return line_of({{"event", "dropped"}, {"count", count}});
}

Errors check_name(const std::string& name) {
  if (is_name(name)) return {};
  return {{"/name", fmt::format("a name must consist of {}", name_rule)}};
}

SessionState::SessionState(const Scene& scene, Simulation simulation, Hooks called,
                           const Limits& bounds, std::vector<Warning> at_start)
    : about{scene.name, scene.duration, {}, {}},
      world(LiveWorld::of(std::move(simulation), std::move(at_start))),
      names(world),
      hooks(std::move(called)),
      limits(bounds) {
  world.check_run();
  for (const auto& own : scene.controllers) about.controllers.push_back(own->name);
  for (const TriggerDef& own : scene.triggers) about.triggers.push_back(own.name);
}

const QuantityIndexPointer& SessionState::quantities() {
  if (!quantities_) {
    quantities_ = std::make_shared<const QuantityIndex>(world.simulation());
  }
  return quantities_;
}

void SessionState::refresh() {
  names.refresh();
  quantities_.reset();
  for (auto& [name, subscription] : subscriptions) {
    if (!subscription.readings.empty()) subscription.readings.find_again(quantities(), names);
  }
}

std::size_t SessionState::part_count() const {
  const Model& model = world.simulation().world.model();
  std::size_t count = model.bodies.size() + model.joints.size() + world.cables().size();
  for (const BodyDef& body : model.bodies) count += body.shapes.size();
  for (const CableDef& cable : *world.simulation().cable_definitions) count += cable.links.size();
  return count;
}

KeptSnapshot SessionState::keep() const { return {world.snapshot(), revision, part_count()}; }

std::optional<std::string> SessionState::stopped_by() const {
  const Supervisor* own = world.simulation().supervisor.get();
  if (own == nullptr || !own->has_stopped(world.state())) return {};
  std::string name;
  if (const auto* supervisor = dynamic_cast<const SceneSupervisor*>(own)) {
    const auto times = supervisor->acted_at(world.state());
    double last = -1.0;
    for (std::size_t i = 0; i < times.size(); ++i) {
      const TriggerDef& trigger = supervisor->trigger(i);
      if (trigger.action != TriggerAction::stop || times[i].value_or(-1.0) <= last) continue;
      last = *times[i];
      name = trigger.name;
    }
  }
  return name;
}

Ending SessionState::step(std::string& reason) {
  const LiveReport report = world.step(hooks.stop);
  if (report.stopped) return Ending::interrupted;
  ++unlogged_steps;
  tell(report);
  if (report.divergence) {
    reason = report.divergence->message;
    return Ending::divergence;
  }
  const std::optional<std::string> trigger = stopped_by();
  if (!trigger) return Ending::none;
  reason = fmt::format("trigger \"{}\" has stopped the run", *trigger);
  return Ending::trigger;
}

void SessionState::log_steps() {
  while (unlogged_steps > 0) {
    const std::int64_t count = std::min(unlogged_steps, limits.steps);
    log(fmt::format(R"({{"at_step":{},"type":"step","count":{}}})", logged_to, count));
    unlogged_steps -= count;
    logged_to += count;
  }
  logged_to = world.state().steps;
}

void SessionState::log(std::string_view request) {
  if (!hooks.log) return;
  request.remove_suffix(1);
  hooks.log(fmt::format(R"({},"checksum":"{}"}})", request, log_written.add(request)));
}

Json SessionState::event(std::string_view kind) const {
  return {{"event", kind}, {"step", world.state().steps}, {"time", world.time()}};
}

void SessionState::send(const Json& event, bool needed) const {
  if (hooks.event) hooks.event(line_of(event), needed);
}

void SessionState::tell(const LiveReport& report) {
  for (const auto& [name, subscription] : subscriptions) {
    if (subscription.events) tell_events(name, report);
    if (!report.ok() || subscription.readings.empty()) continue;
    if (world.state().steps % subscription.every != 0) continue;
    Json line = event("values");
    line["subscription"] = name;
    subscription.readings.read(world, line);
    send(line, false);
  }
}

void SessionState::tell_events(const std::string& name, const LiveReport& report) const {
  for (const CableEvent& happened : report.events) {
    Json line = event("cable");
    line["time"] = happened.time;
    line["subscription"] = name;
    line["cable"] = happened.cable;
    line["kind"] = cable_event_names[static_cast<std::size_t>(happened.kind)];
    line["link"] = happened.link;
    line["body"] = happened.body.empty() ? "world" : happened.body;
    send(line, false);
  }
  for (const JointHandle joint : report.broken_joints) {
    Json line = event("joint");
    line["subscription"] = name;
    line["joint"] = *world.name(joint);
    line["kind"] = "break";
    send(line, false);
  }
  for (const Warning& warning : report.warnings) {
    Json line = event("warning");
    line["subscription"] = name;
    line["kind"] = warning.kind;
    line["subject"] = warning.subject;
    line["message"] = warning.message;
    send(line, false);
  }
  if (report.omitted == 0) return;
  Json line = event("omitted");
  line["subscription"] = name;
  line["count"] = report.omitted;
  send(line, false);
}

}  // namespace sheave::live
