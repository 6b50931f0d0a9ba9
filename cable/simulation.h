#pragma once
// Bodies and cables together: what most programs embed.
//
//   sheave::Model model;  std::vector<sheave::CableDef> cables;
//   auto simulation = sheave::Simulation::create(model, cables);
//   if (!simulation->step().ok()) return;  // the state is the last good one
//   double tension = simulation->cable_reports()[0].spans[2].tension;

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cable/cable.h"
#include "cable/cable_report.h"
#include "cable/certificate.h"
#include "engine/world.h"

namespace sheave {

class CableSystem;
struct Simulation;

/// Sets controls in the course of a simulation: controllers and triggers. It has no state of its
/// own: what it remembers is State::memory.
class Supervisor {
 public:
  Supervisor() = default;
  virtual ~Supervisor() = default;
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  /// State::memory at time 0.
  [[nodiscard]] virtual std::vector<double> initial_memory() const = 0;
  /// Called before each substep.
  virtual void supervise(Simulation& simulation) const = 0;
  /// The same for a simulation that has been edited, in which it finds what it controls by name;
  /// its memory stays as it is.
  [[nodiscard]] virtual Result<std::shared_ptr<const Supervisor>> again(
      const Simulation& simulation) const = 0;
  /// Whether the run shall end with this state.
  [[nodiscard]] virtual bool has_stopped(const State& state) const = 0;
  /// Why State::memory cannot be its own; empty if it can. States come from files, too.
  [[nodiscard]] virtual std::string memory_fault(const State& state) const = 0;
};

/// A world and, if it has any, its cables.
struct Simulation {
  Simulation(World made, const CableSystem* system,
             std::shared_ptr<const std::vector<CableDef>> definitions)
      : world(std::move(made)), cables(system), cable_definitions(std::move(definitions)) {}

  World world;
  /// Owned by the world; null if there are no cables.
  const CableSystem* cables = nullptr;
  /// What the cables were made of.
  std::shared_ptr<const std::vector<CableDef>> cable_definitions;
  /// Acts in step(); null if there is none. World::memory() must be its own.
  std::shared_ptr<const Supervisor> supervisor = nullptr;
  /// Makes it the supervisor, and the world refuse states with a memory that cannot be its own.
  void set_supervisor(std::shared_ptr<const Supervisor> acting);

  /// World::step(), with the supervisor if there is one.
  [[nodiscard]] StepReport step(const StopRequest& stop = {});

  /// World::leap(); none where there is a supervisor, which acts before each substep.
  std::int64_t leap(std::int64_t count);

  /// All faults of bodies, joints and cables are reported together.
  static Result<Simulation> create(const Model& model, const std::vector<CableDef>& cables);
  /// The faults that create() would report, with less work and memory where there are no cables.
  static Errors check(const Model& model, const std::vector<CableDef>& cables);
  /// One report per cable, for the world's current state.
  [[nodiscard]] std::vector<CableReport> cable_reports() const;
  /// Measures of each cable, for the world's current state; in the course of a run much cheaper
  /// than reports.
  void gauge_cables(std::vector<CableGauge>& gauges) const;
  /// What a check of the last substep finds (cable/certificate.h). Nothing at time 0 and after
  /// World::restore(), until the next step.
  [[nodiscard]] std::optional<Certificate> certificate() const;

  // Controls of cables, by their indices in the list of definitions, and of listed links by theirs
  // in their cable. As those of World they hold until they are set anew or cleared, are part of the
  // state, and where one cannot be met nothing changes.

  /// [m/N], > 0, of each span; of a cable that has a compliance.
  [[nodiscard]] Errors set_compliance(int cable, double compliance);
  [[nodiscard]] Errors clear_compliance(int cable);
  /// Mean tension over a substep at which the cable breaks [N], > 0.
  [[nodiscard]] Errors set_breaking_tension(int cable, double tension);
  [[nodiscard]] Errors clear_breaking_tension(int cable);
  /// Parts the cable before the next substep; one that pulls nothing, or of which nothing is known
  /// yet (time 0), as soon as it pulls. There is no way back.
  [[nodiscard]] Errors cut_cable(int cable);
  /// Capstan coefficient on wrappable bodies, > 0; of a cable that has one above 0.
  [[nodiscard]] Errors set_wrap_friction(int cable, double friction);
  [[nodiscard]] Errors clear_wrap_friction(int cable);
  /// Capstan coefficient, > 0; of a link that has one above 0.
  [[nodiscard]] Errors set_friction(int cable, int link, double friction);
  [[nodiscard]] Errors clear_friction(int cable, int link);
  /// [m/s]; of an attachment with a feed speed, which may be 0. It gets there as a drive to a speed
  /// does.
  [[nodiscard]] Errors set_feed_speed(int cable, int link, const DriveTarget& target);
  [[nodiscard]] Errors clear_feed_speed(int cable, int link);
};

}  // namespace sheave
