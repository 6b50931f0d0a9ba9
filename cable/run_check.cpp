#include "cable/run_check.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "cable/cable_system.h"
#include "cable/certificate/energy_watch.h"
#include "engine/body_drive.h"
#include "engine/index.h"

namespace sheave {
namespace {

void add(Certificate& to, std::optional<CertificateItem> item, const StepSettings& step) {
  if (!item) return;
  item->advice = certificate_advice(*item, step);
  Certificate one;
  one.items.push_back(std::move(*item));
  to.merge(one);
}

}  // namespace

struct RunCheck::Content {
  /// The prescribed speeds of drives, followed from step to step.
  class Jumps {
   public:
    explicit Jumps(const Simulation& simulation) : bodies_(simulation.world.bodies().count()) {
      const World& world = simulation.world;
      for (int i = 0; i < bodies_; ++i) {
        if (world.bodies()[i].driven_by() != DriveKind::speed) continue;
        driven_.push_back(i);
        double& fastest = fastest_.emplace_back(0.0);
        for (const double speed : world.bodies().definition(i).drive_values) {
          fastest = std::max(fastest, std::abs(speed));
        }
      }
      find(simulation, 0.0, speeds_);
    }

    /// Whether a speed changes in the next step by more than a tenth of the drive's largest speed.
    bool next(const Simulation& simulation) {
      constexpr double part = 0.1;
      if (simulation.world.bodies().count() != bodies_) {
        *this = Jumps(simulation);  // another model
        return false;
      }
      find(simulation, simulation.world.model().step.dt, next_);
      bool jumped = false;
      for (std::size_t i = 0; i < next_.size(); ++i) {
        fastest_[i] = std::max({fastest_[i], std::abs(next_[i]), std::abs(speeds_[i])});
        jumped = jumped || std::abs(next_[i] - speeds_[i]) > part * fastest_[i];
      }
      speeds_.swap(next_);
      return jumped;
    }

   private:
    void find(const Simulation& simulation, double after, std::vector<double>& speeds) const {
      const World& world = simulation.world;
      const double time = world.state().time + after;
      speeds.clear();
      for (const int i : driven_) {
        speeds.push_back(BodyDrive(world.bodies()[i], world.state().controls, i).at(time));
      }
    }

    int bodies_;
    std::vector<int> driven_;  ///< bodies with a prescribed speed
    // Per drive [rad/s].
    std::vector<double> speeds_;  ///< at the end of the last step asked for
    std::vector<double> next_;
    std::vector<double> fastest_;
  };

  Content(const Simulation& simulation, double share)
      : schedule(simulation, share),
        watch(simulation),
        jumps(simulation),
        step(simulation.world.model().step),
        first_step(simulation.world.state().steps) {}

  void check(const Simulation& simulation) {
    if (const std::optional<Certificate> one = simulation.certificate()) found.merge(*one);
  }

  /// check() within a step. Counts of the instructions of a step leave this function out.
  [[gnu::noinline]] void check_within(const Simulation& simulation) { check(simulation); }

  /// The finding that substeps were too long for the tolerance.
  void note_missed_tolerance(const Simulation& simulation, const StepStatistics& statistics) {
    if (statistics.missed_tolerance == 0) return;
    const BodySet& bodies = simulation.world.bodies();
    CertificateItem item;
    item.kind = CertificateItem::Kind::tolerance;
    item.name = "body \"" + bodies.name(std::max(statistics.missed_body, 0)) + "\"";
    item.value = statistics.missed_error;
    item.unit = "m";
    item.scale = step.tolerance;
    // No other error of such a step is known.
    item.relative = std::max(1.0, item.value / item.scale);
    item.time = statistics.missed_time;
    add(found, std::move(item), step);
  }

  CertificateSchedule schedule;
  certify::EnergyWatch watch;
  Jumps jumps;
  StepSettings step;
  std::int64_t first_step;
  int steps_with_jumps = 0;
  Certificate found;
};

RunCheck::RunCheck(const Simulation& simulation, double share)
    : content_(std::make_unique<Content>(simulation, share)) {}
RunCheck::~RunCheck() = default;
RunCheck::RunCheck(RunCheck&&) noexcept = default;
RunCheck& RunCheck::operator=(RunCheck&&) noexcept = default;

std::function<void()> RunCheck::within(const Simulation& simulation) {
  constexpr int most_steps = 16;
  constexpr int most_substeps = 8;
  Content& c = *content_;
  const bool jumps = c.jumps.next(simulation) && c.steps_with_jumps < most_steps;
  const bool begins = simulation.world.state().steps == c.first_step;
  if (jumps) ++c.steps_with_jumps;
  if (c.step.substeps == 1 && c.step.tolerance == 0.0) return {};
  const bool works = c.watch.observes_substeps();
  if (!(jumps || begins || works)) return {};
  const int most = jumps ? most_substeps : (begins ? 1 : 0);
  return [&c, &simulation, done = 0, most, works]() mutable {
    if (done > 0 && done <= most) c.check_within(simulation);
    if (done > 0 && works) c.watch.observe_substep(simulation);
    ++done;
  };
}

void RunCheck::observe(const Simulation& simulation, const StepStatistics& statistics,
                       bool is_last) {
  Content& c = *content_;
  c.watch.observe(simulation, statistics);
  c.note_missed_tolerance(simulation, statistics);
  const std::size_t events = simulation.cables == nullptr ? 0 : simulation.cables->events().size();
  if (!c.schedule.is_due(is_last, events, c.watch.is_suspicious())) return;
  c.check(simulation);
}

void RunCheck::restart(const Simulation& simulation) {
  Content& c = *content_;
  add(c.found, c.watch.finding(), c.step);
  c.watch = certify::EnergyWatch(simulation);
  c.jumps = Content::Jumps(simulation);
  c.first_step = simulation.world.state().steps;
}

Certificate RunCheck::certificate() const {
  Certificate all = content_->found;
  add(all, content_->watch.finding(), content_->step);
  return all;
}

const Energy& RunCheck::energy() const { return content_->watch.energy(); }
double RunCheck::energy_taken() const { return content_->watch.integrator().taken(); }
double RunCheck::energy_exchanged() const { return content_->watch.integrator().exchanged(); }

}  // namespace sheave
