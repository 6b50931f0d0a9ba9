#include "cable/simulation.h"

#include <algorithm>

#include "cable/cable_system.h"
#include "cable/knots.h"
#include "cable/machine_layout.h"
#include "cable/rope_inertia.h"

namespace sheave {

Result<Simulation> Simulation::create(const Model& model, const std::vector<CableDef>& cables) {
  Result<BodySet> compiled = BodySet::create(model);
  if (!compiled) return compiled.errors();
  auto bodies = std::make_shared<const BodySet>(std::move(*compiled));
  Errors errors;
  std::vector<std::unique_ptr<ConstraintBatch>> features;
  const CableSystem* system = nullptr;
  if (cables.empty()) Knots::check_counts(*bodies, {}, errors);
  if (!cables.empty()) {
    Result<std::unique_ptr<CableSystem>> created = CableSystem::create(cables, *bodies);
    if (!created) errors = created.errors();
    if (created) {
      system = created->get();
      // The cables are the last feature.
      if (auto inertia = RopeInertia::create(*system)) features.push_back(std::move(inertia));
      features.push_back(std::move(*created));
    }
  }
  Result<World> world = World::create(model, bodies, std::move(features),
                                      errors.empty() ? layout_of(model, cables) : 0);
  if (!world) errors.insert(errors.end(), world.errors().begin(), world.errors().end());
  if (!errors.empty()) return errors;
  return Simulation(std::move(*world), system,
                    std::make_shared<const std::vector<CableDef>>(cables));
}

Errors Simulation::check(const Model& model, const std::vector<CableDef>& cables) {
  const bool has_knots =
      std::any_of(model.bodies.begin(), model.bodies.end(),
                  [](const BodyDef& body) { return body.mobility == Mobility::knot; });
  if (cables.empty() && !has_knots) return World::check(model);
  const Result<Simulation> simulation = create(model, cables);
  return simulation ? Errors{} : simulation.errors();
}

void Supervision::act(bool begins) {
  if (begins && before_) before_();
  if (simulation_.supervisor != nullptr) simulation_.supervisor->supervise(simulation_);
  if (begins && after_) after_();
}

void Supervision::look_on() {
  if (before_) before_();
  if (after_) after_();
}

bool Supervision::acts_by_substeps() const {
  return simulation_.supervisor != nullptr && simulation_.supervisor->acts_by_substeps();
}

bool Supervision::has_loads() const {
  return simulation_.supervisor != nullptr && simulation_.supervisor->has_loads();
}

void Supervision::set_loads(double length, bool jumped) {
  if (simulation_.supervisor == nullptr) return;
  simulation_.supervisor->set_loads(simulation_, length, jumped);
}

LoadDefect Supervision::load_defect(double length) {
  if (simulation_.supervisor == nullptr) return {};
  return simulation_.supervisor->load_defect(simulation_, length);
}

double Supervision::next_time(double slop) {
  const Supervisor* own = simulation_.supervisor.get();
  return own != nullptr ? own->next_time(simulation_, slop) : no_instant;
}

bool Supervision::watches() const {
  return simulation_.supervisor != nullptr && simulation_.supervisor->watches();
}

void Supervision::set_loads_now(Controls& controls) {
  if (simulation_.supervisor != nullptr)
    simulation_.supervisor->set_loads_now(simulation_, controls);
}

std::span<const double> Supervision::margins() {
  simulation_.supervisor->find_margins(simulation_, margins_);
  return margins_;
}

StepReport Simulation::step(const StopRequest& stop, const std::function<void()>& before,
                            const std::function<void()>& after) {
  if (supervisor == nullptr && !before && !after) return world.step(stop);
  Supervision acting(*this, before, after);
  return world.step(stop, &acting);
}

void Simulation::set_supervisor(std::shared_ptr<const Supervisor> acting) {
  supervisor = std::move(acting);
  world.check_memory_by(
      [own = supervisor](const State& state) { return own->memory_fault(state); });
}

std::int64_t Simulation::leap(std::int64_t count) {
  return supervisor == nullptr ? world.leap(count) : 0;
}

std::vector<CableReport> Simulation::cable_reports() const {
  if (cables == nullptr) return {};
  return cables->report(world.bodies(), world.state(), world.state().features.back(),
                        SpanTensions::material);
}

void Simulation::gauge_cables(std::vector<CableGauge>& gauges) const {
  gauges.clear();
  if (cables == nullptr) return;
  if (world.last_substep() && cables->gauge(world.state().features.back(), gauges)) return;
  gauges.clear();
  for (const CableReport& report : cable_reports()) gauges.push_back(report.gauge());
}

}  // namespace sheave
