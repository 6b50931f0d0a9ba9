#include "web/engine/playground.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <fmt/format.h>

#include "engine/body_set.h"
#include "engine/state.h"
#include "measure/run_error.h"
#include "scenes/control/scene_supervisor.h"
#include "web/engine/machine_view.h"

namespace sheave::web {
namespace {

constexpr std::size_t most_kept = 32;

}  // namespace

Json faults_json(const std::vector<SceneError>& errors) {
  Json list = Json::array();
  for (const SceneError& error : errors) {
    list.push_back({{"line", error.line},
                    {"column", error.column},
                    {"pointer", error.pointer},
                    {"message", error.message},
                    {"value", error.value},
                    {"allowed", error.allowed},
                    {"text", to_string(error)}});
  }
  return {{"errors", list}};
}

Json faults_json(const Errors& errors) {
  Json list = Json::array();
  for (const Error& error : errors) {
    list.push_back(
        {{"line", 0},
         {"column", 0},
         {"pointer", error.path},
         {"message", error.message},
         {"text", error.path.empty() ? error.message : error.path + ": " + error.message}});
  }
  return {{"errors", list}};
}

std::unique_ptr<Playground> Playground::open(const std::string& text,
                                             const std::vector<Override>& overrides, Json& answer) {
  SceneResult scene = load_scene_text(text, "scene", overrides);
  if (!scene) {
    answer = faults_json(scene.errors);
    return nullptr;
  }
  auto simulation = create_simulation(*scene);
  if (!simulation) {
    answer = faults_json(simulation.errors());
    return nullptr;
  }
  return std::unique_ptr<Playground>(
      new Playground(std::move(*scene.scene), std::move(simulation).value()));
}

Playground::Playground(Scene scene, Simulation simulation)
    : scene_(std::move(scene)),
      world_(LiveWorld::of(std::move(simulation))),
      channels_(world_.simulation(), world_.simulation().cable_reports()),
      controls_(slider_controls(scene_, world_.simulation())) {
  world_.check_run();
  start_ = world_.snapshot();
}

Json Playground::describe() const {
  Json channels = Json::array();
  for (const view::FrameChannel& channel : channels_.channels()) {
    channels.push_back(view::channel_json(channel));
  }
  Json controls = Json::array();
  for (const SliderControl& control : controls_) {
    controls.push_back({{"name", control.name},
                        {"unit", control.unit},
                        {"value", control.value},
                        {"minimum", control.minimum},
                        {"maximum", control.maximum}});
  }
  const StepSettings& step = world_.simulation().world.model().step;
  const Vector3& gravity = scene_.model.gravity;
  const Json settings = {
      {"solver", solver_names[static_cast<std::size_t>(step.solver)]},
      {"integrator", integrator_names[static_cast<std::size_t>(step.integrator)]},
      {"substeps", step.substeps},
      {"iterations", step.iterations},
      {"gravity", {gravity.x(), gravity.y(), gravity.z()}}};
  described_ = channels_.channels().size();
  return {{"machine", machine_description(scene_, world_.simulation(), channels_)},
          {"channels", channels},
          {"controls", controls},
          {"settings", settings}};
}

std::string Playground::events_text(const LiveReport& report) const {
  std::string text;
  for (const CableEvent& event : report.events) {
    text += fmt::format("{}\t{:.17g}\tcable {}: {} at {}{}\n",
                        cable_event_names[static_cast<std::size_t>(event.kind)], event.time,
                        event.cable, cable_event_names[static_cast<std::size_t>(event.kind)],
                        event.link < 0 ? std::string("a wrap") : fmt::format("link {}", event.link),
                        event.body.empty() ? "" : " on " + event.body);
  }
  for (const JointHandle joint : report.broken_joints) {
    const auto name = world_.name(joint);
    text += fmt::format("broken\t{:.17g}\tjoint {} breaks\n", world_.time(), name ? *name : "");
  }
  return text;
}

Playground::Ending Playground::step(std::string& text) {
  const StepSettings& settings = world_.simulation().world.model().step;
  const double h = settings.dt / settings.substeps;
  std::function<void()> pull;
  if (pointer_.holds()) pull = [&] { pointer_.act(world_, h); };
  const LiveReport report = world_.step({}, pull);
  text = events_text(report);
  if (report.divergence) {
    text = report.divergence->message;
    return Ending::diverged;
  }
  const auto& supervisor = world_.simulation().supervisor;
  if (supervisor != nullptr && supervisor->has_stopped(world_.state())) return Ending::stopped;
  return Ending::none;
}

const std::vector<double>& Playground::sample() {
  const Simulation& simulation = world_.simulation();
  const std::vector<CableReport> reports = simulation.cable_reports();
  ropes_.follow(simulation.world, reports);
  if (!channels_.fits(reports, ropes_)) channels_.extend(reports, ropes_);
  channels_.sample(simulation, reports, ropes_, values_);
  return values_;
}

void Playground::keep() {
  if (kept_.size() == most_kept) kept_.pop_front();
  kept_.push_back({world_.time(), world_.snapshot()});
}

bool Playground::go_back(double seconds) {
  pointer_.release(world_);
  reference_.reset();
  world_.check_run();
  if (std::isinf(seconds)) {
    kept_.clear();
    return start_ && world_.restore(*start_).empty();
  }
  const double wanted = world_.time() - seconds;
  while (kept_.size() > 1 && kept_.back().time > wanted) kept_.pop_back();
  return !kept_.empty() && world_.restore(kept_.back().snapshot).empty();
}

Errors Playground::set_control(const std::string& name, double value) {
  for (const SliderControl& control : controls_) {
    if (control.name != name) continue;
    const auto set = [&](LiveWorld& world) {
      // A position drive reaches its target in 0.1 s, like a hand on a lever.
      return world.set_in_simulation(
          [&](Simulation& simulation) { return control.point.set(simulation, value, 0.1); });
    };
    Errors errors = set(world_);
    if (errors.empty() && reference_ && !set(reference_->world).empty()) reference_.reset();
    return errors;
  }
  return {{"", "there is no control \"" + name + "\""}};
}

Errors Playground::change(const Settings& settings) {
  if (settings.gravity) {
    if (Errors errors = world_.set_gravity(*settings.gravity); !errors.empty()) return errors;
    if (reference_ && !reference_->world.set_gravity(*settings.gravity).empty()) reference_.reset();
  }
  StepSettings step = settings.step;
  step.dt = world_.simulation().world.model().step.dt;
  if (step == world_.simulation().world.model().step) return {};
  const auto done = world_.edit([&](Edit& edit) { edit.set_step(step); });
  return done ? Errors{} : done.errors();
}

Errors Playground::grab(int body, const Vector3& point) {
  release();
  if (Errors errors = pointer_.grab(world_, body, point); !errors.empty()) return errors;
  if (reference_) reference_->pointer.copy_grip(pointer_);
  return {};
}

void Playground::drag(const Vector3& target) {
  pointer_.move(target);
  if (reference_) reference_->pointer.move(target);
}

void Playground::release() {
  pointer_.release(world_);
  if (reference_) reference_->pointer.release(reference_->world);
}

Errors Playground::set_reference(int refinement) {
  reference_.reset();
  if (refinement <= 0) return {};
  Scene fine = scene_;
  fine.model.step.solver = SolverKind::direct;
  fine.model.step.integrator = IntegratorKind::rattle;
  fine.model.step.iterations = std::max(fine.model.step.iterations, StepSettings{}.iterations);
  const StepSettings& now = world_.simulation().world.model().step;
  fine.model.step.substeps = std::min(now.substeps * refinement, 100'000);
  auto simulation = create_simulation(fine);
  if (!simulation) return simulation.errors();
  Reference made{LiveWorld::of(std::move(simulation).value()), pointer_, {}};
  if (Errors errors = made.world.restore(world_.state()); !errors.empty()) return errors;
  made.bodies = measure::tracked_bodies(made.world.simulation().world.bodies());
  reference_.emplace(std::move(made));
  return {};
}

bool Playground::step_reference() {
  if (!reference_) return false;
  LiveWorld& world = reference_->world;
  const StepSettings& settings = world.simulation().world.model().step;
  const double h = settings.dt / settings.substeps;
  const LiveReport report = world.step({}, [&] { reference_->pointer.act(world, h); });
  if (!report.ok()) reference_.reset();
  return report.ok();
}

double Playground::error() const {
  if (!reference_) return std::numeric_limits<double>::quiet_NaN();
  measure::Trajectory run;
  run.scale = world_.simulation().world.bodies().scale();
  run.bodies = reference_->bodies;
  measure::Trajectory reference = run;
  run.frames.push_back(measure::frame_of(world_.simulation(), run.bodies));
  reference.frames.push_back(measure::frame_of(reference_->world.simulation(), run.bodies));
  return measure::position_errors(run, reference).front();
}

Json Playground::certificate(bool reset) {
  Certificate all = world_.run_certificate();
  if (const auto one = world_.simulation().certificate()) all.merge(*one);
  const CertificateItem* worst = all.worst();
  const Json answer = {{"clean", all.clean()},
                       {"substeps", all.substeps},
                       {"relative", worst == nullptr ? 0.0 : worst->relative},
                       {"sentence", worst == nullptr ? std::string() : worst->sentence()}};
  if (reset) world_.check_run();
  return answer;
}

std::string Playground::hash_text() const { return fmt::format("{:016x}", hash(world_.state())); }

}  // namespace sheave::web
