#include "cable/run_check.h"

#include "cable/cable_system.h"
#include "cable/certificate/energy_watch.h"

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
  Content(const Simulation& simulation, double share)
      : schedule(simulation, share), watch(simulation), step(simulation.world.model().step) {}

  CertificateSchedule schedule;
  certify::EnergyWatch watch;
  StepSettings step;
  Certificate found;
};

RunCheck::RunCheck(const Simulation& simulation, double share)
    : content_(std::make_unique<Content>(simulation, share)) {}
RunCheck::~RunCheck() = default;
RunCheck::RunCheck(RunCheck&&) noexcept = default;
RunCheck& RunCheck::operator=(RunCheck&&) noexcept = default;

void RunCheck::observe(const Simulation& simulation, const StepStatistics& statistics,
                       bool is_last) {
  Content& c = *content_;
  c.watch.observe(simulation, statistics);
  const std::size_t events = simulation.cables == nullptr ? 0 : simulation.cables->events().size();
  if (!c.schedule.is_due(is_last, events, c.watch.is_suspicious())) return;
  if (const std::optional<Certificate> one = simulation.certificate()) c.found.merge(*one);
}

void RunCheck::restart(const Simulation& simulation) {
  Content& c = *content_;
  add(c.found, c.watch.finding(), c.step);
  c.watch = certify::EnergyWatch(simulation);
}

Certificate RunCheck::certificate() const {
  Certificate all = content_->found;
  add(all, content_->watch.finding(), content_->step);
  return all;
}

const Energy& RunCheck::energy() const { return content_->watch.energy(); }

}  // namespace sheave
