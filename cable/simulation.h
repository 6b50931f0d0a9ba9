#pragma once
// Bodies and cables together: the class that most programs embed.
//
//   sheave::Model model;  std::vector<sheave::CableDef> cables;
//   auto simulation = sheave::Simulation::create(model, cables);
//   if (!simulation->step().ok()) return;  // the state is the last good one
//   double tension = simulation->cable_reports()[0].spans[2].tension;

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cable/cable.h"
#include "cable/cable_report.h"
#include "cable/certificate.h"
#include "engine/instants.h"
#include "engine/world.h"

namespace sheave {

class CableSystem;
struct Simulation;

/// Sets controls while a simulation runs: the controllers and triggers of a scene. A supervisor has
/// no state of its own; its memory is State::memory.
class Supervisor {
 public:
  Supervisor() = default;
  virtual ~Supervisor() = default;
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  /// State::memory at time 0.
  [[nodiscard]] virtual std::vector<double> initial_memory() const = 0;
  /// Called before each substep, and at the instants of next_time() and find_margins().
  virtual void supervise(Simulation& simulation) const = 0;
  /// StepActor::acts_by_substeps()
  [[nodiscard]] virtual bool acts_by_substeps() const { return true; }
  /// StepActor::has_loads()
  [[nodiscard]] virtual bool has_loads() const { return false; }
  /// StepActor::set_loads()
  virtual void set_loads(Simulation& /*simulation*/, double /*length*/, bool /*jumped*/) const {}
  /// StepActor::load_defect()
  [[nodiscard]] virtual LoadDefect load_defect(const Simulation& /*simulation*/,
                                               double /*length*/) const {
    return {};
  }
  /// StepActor::next_time()
  [[nodiscard]] virtual double next_time(const Simulation& /*simulation*/, double /*slop*/) const {
    return no_instant;
  }
  /// StepActor::watches()
  [[nodiscard]] virtual bool watches() const { return false; }
  /// StepActor::margins(): replaces `margins`.
  virtual void find_margins(const Simulation& /*simulation*/, std::vector<double>& margins) const {
    margins.clear();
  }
  /// StepActor::set_loads_now()
  virtual void set_loads_now(const Simulation& /*simulation*/, Controls& /*controls*/) const {}
  /// The same supervisor for a simulation that has been edited. The supervisor finds the bodies,
  /// joints and cables that it controls by their names. State::memory stays unchanged. An error
  /// names the parts that the edit has removed.
  [[nodiscard]] virtual Result<std::shared_ptr<const Supervisor>> again(
      const Simulation& simulation) const = 0;
  /// Whether the run shall end with this state.
  [[nodiscard]] virtual bool has_stopped(const State& state) const = 0;
  /// Why State::memory cannot be the memory of this supervisor; empty if it can. States can come
  /// from files, so their memory has to be checked.
  [[nodiscard]] virtual std::string memory_fault(const State& state) const = 0;
};

/// The supervisor of a simulation in a step of its world, and the callbacks beside it.
class Supervision final : public StepActor {
 public:
  /// `before` is called before the supervisor acts, `after` when it has, once per substep. All must
  /// outlive the step.
  Supervision(Simulation& simulation, const std::function<void()>& before,
              const std::function<void()>& after)
      : simulation_(simulation), before_(before), after_(after) {}

  void act(bool begins) override;
  void look_on() override;
  [[nodiscard]] bool acts_by_substeps() const override;
  [[nodiscard]] bool has_loads() const override;
  void set_loads(double length, bool jumped) override;
  [[nodiscard]] LoadDefect load_defect(double length) override;
  [[nodiscard]] double next_time(double slop) override;
  [[nodiscard]] bool watches() const override;
  [[nodiscard]] std::span<const double> margins() override;
  void set_loads_now(Controls& controls) override;

 private:
  Simulation& simulation_;
  const std::function<void()>& before_;
  const std::function<void()>& after_;
  std::vector<double> margins_;
};

/// A world and, if it has any, its cables.
struct Simulation {
  Simulation(World made, const CableSystem* system,
             std::shared_ptr<const std::vector<CableDef>> definitions)
      : world(std::move(made)), cables(system), cable_definitions(std::move(definitions)) {}

  World world;
  /// Owned by the world; null if there are no cables.
  const CableSystem* cables = nullptr;
  /// The definitions from which the cables were compiled.
  std::shared_ptr<const std::vector<CableDef>> cable_definitions;
  /// Acts in step(); null if there is none. World::memory() must be the memory of this supervisor.
  std::shared_ptr<const Supervisor> supervisor = nullptr;
  /// Installs `acting`. From then on the world refuses states whose memory `acting` does not
  /// accept.
  void set_supervisor(std::shared_ptr<const Supervisor> acting);

  /// World::step(), with the supervisor if there is one.
  [[nodiscard]] StepReport step(const StopRequest& stop = {}) { return step(stop, {}, {}); }
  /// The same with functions that are called before each substep, before and after the supervisor;
  /// both may be empty.
  [[nodiscard]] StepReport step(const StopRequest& stop, const std::function<void()>& before,
                                const std::function<void()>& after);

  /// Calls World::leap(). Does nothing and returns 0 if there is a supervisor, because a supervisor
  /// acts before each substep.
  std::int64_t leap(std::int64_t count);

  /// Errors list all faults of bodies, joints and cables together.
  static Result<Simulation> create(const Model& model, const std::vector<CableDef>& cables);
  /// The faults that create() would report. Takes less time and memory than create() if there are
  /// no cables.
  static Errors check(const Model& model, const std::vector<CableDef>& cables);
  /// One report per cable, for the world's current state.
  [[nodiscard]] std::vector<CableReport> cable_reports() const;
  /// Measures of each cable for the world's current state. During a run, gauges cost much less than
  /// reports.
  void gauge_cables(std::vector<CableGauge>& gauges) const;
  /// The result of a check of the last substep (cable/certificate.h). Nothing at time 0, and
  /// nothing after World::restore() until the next step.
  [[nodiscard]] std::optional<Certificate> certificate() const;

  // Controls of cables. `cable` is an index in the list of definitions; `link` is an index in the
  // cable's list of links. Like the controls of World, a control holds until it is set again or
  // cleared, and it is part of the state. A control that cannot be met is an error and changes
  // nothing.

  /// Compliance of each span [m/N], > 0. The cable must be defined with a compliance.
  [[nodiscard]] Errors set_compliance(int cable, double compliance);
  [[nodiscard]] Errors clear_compliance(int cable);
  /// Tension at which the cable breaks [N], > 0 (CableDef::breaking_tension).
  [[nodiscard]] Errors set_breaking_tension(int cable, double tension);
  [[nodiscard]] Errors clear_breaking_tension(int cable);
  /// Cuts the cable before the next substep. A cable that carries no tension, or whose tensions are
  /// not known yet (time 0), is cut as soon as it carries tension. A cut cannot be undone.
  [[nodiscard]] Errors cut_cable(int cable);
  /// Cuts the cable at a length from its first link on [m, unstretched], cable on wheels and drums
  /// included, also without tension. The place must lie in a free span.
  [[nodiscard]] Errors cut_cable(int cable, double place);
  /// Capstan coefficient on wrappable bodies, > 0. The cable must be defined with one above 0.
  [[nodiscard]] Errors set_wrap_friction(int cable, double friction);
  [[nodiscard]] Errors clear_wrap_friction(int cable);
  /// Capstan coefficient, > 0. The link must be defined with one above 0.
  [[nodiscard]] Errors set_friction(int cable, int link, double friction);
  [[nodiscard]] Errors clear_friction(int cable, int link);
  /// Feed speed [m/s]. The link must be an attachment that is defined with a feed speed, which may
  /// be 0. The speed approaches its target as the speed of a drive does.
  [[nodiscard]] Errors set_feed_speed(int cable, int link, const DriveTarget& target);
  [[nodiscard]] Errors clear_feed_speed(int cable, int link);
};

}  // namespace sheave
