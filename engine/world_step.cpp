// A step: its substeps, and the instants at which something acts within it.

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "engine/index.h"
#include "engine/world_course.h"

namespace sheave {
namespace {

/// A function as one who acts.
class Caller final : public StepActor {
 public:
  explicit Caller(const std::function<void()>& before_substep) : call_(before_substep) {}
  void act(bool begins) override {
    if (begins) call_();
  }

 private:
  const std::function<void()>& call_;
};

}  // namespace

void World::Course::act(bool begins) {
  if (actor_ == nullptr) return;
  c_.control_interval = c_.model.step.dt / c_.model.step.substeps;
  actor_->act(begins);
  c_.control_interval = c_.model.step.dt;
}

bool World::Course::act_features() {
  const double time = c_.state.time;
  bool acted = arise();
  for (const Content::Scheduled& s : c_.scheduled) {
    FeatureState& own = c_.state.features[s.index];
    if (!s.feature->act_at(*c_.bodies, time, time + slop_, own)) continue;
    c_.driver.note_features();
    acted = true;
  }
  return acted;
}

double World::Course::next_instant() const {
  double instant = actor_ != nullptr ? actor_->next_time(slop_) : no_instant;
  for (const Content::Scheduled& s : c_.scheduled) {
    const double own = s.feature->next_instant(c_.state.features[s.index]);
    if (!is_due(own, c_.state.time, slop_)) instant = std::min(instant, own);
  }
  return instant;
}

World::Course::Stretch World::Course::next_stretch() {
  const double instant = next_instant();
  Stretch stretch{c_.driver.end_of_substep(index_), true, !shifted_};
  const bool last = index_ + 1 == c_.model.step.substeps;
  const double half = 0.5 * c_.model.step.dt / c_.model.step.substeps;
  const double away = instant - stretch.end;
  // The end of a step stays where it is.
  if (!is_due(instant, stretch.end, slop_) && (last || !(away <= half))) return stretch;
  if (std::abs(away) <= slop_) return stretch;
  return {instant, !last && std::abs(away) <= half, false};
}

void World::Course::expect(double end) {
  // A part that begins where the last one began takes its place.
  if (!has_run_) part_before_ = whole_;
  if (has_run_ && c_.state.time > part_began_) part_before_ = c_.state.time - part_began_;
  part_began_ = c_.state.time;
  has_run_ = true;
  told_ = false;
  part_ = end - c_.state.time;
  if (load_memory_ != nullptr) {
    c_.state.memory = *load_memory_;
    actor_->set_loads(part_, jumped_);
  }
  const bool lags = c_.model.step.integrator == IntegratorKind::xpbd;
  c_.part_start.clear();
  if (lags && c_.asks_for_forces()) c_.part_start = c_.state.bodies;
  c_.substep.breakage = Breakage::by_instants;
  const Expected part{c_.state.time, end};
  for (const Content::Watching& w : c_.watching) w.feature->expect(locates_ ? &part : nullptr);
}

std::optional<Divergence> World::Course::go(const Stretch& stretch) {
  expect(stretch.end);
  if (!stretch.on_grid) return c_.driver.run_to(stretch.end);
  if (c_.driver.run_affine(index_, index_ + 1, nullptr) > 0) return std::nullopt;
  if (c_.substep.work.stopped()) return std::nullopt;
  return c_.driver.run(index_);
}

bool World::Course::actor_watches() const {
  return located_ < most_located && actor_ != nullptr && actor_->watches();
}

bool World::Course::look() {
  c_.margins.clear();
  if (actor_watches()) {
    const std::span<const double> margins = actor_->margins();
    c_.margins.assign(margins.begin(), margins.end());
  }
  tell_forces();
  for (std::size_t i = 0; locates_ && i < c_.watching.size(); ++i) {
    const Content::Watching& watched = c_.watching[i];
    c_.margins.push_back(watched.feature->margin(c_.substep, c_.state.features[watched.index]));
  }
  return std::any_of(c_.margins.begin(), c_.margins.end(),
                     [](double margin) { return margin > 0.0; });
}

// The velocities of `xpbd` are means of the last part, or of the last piece of it.
double World::Course::velocity_lag() const {
  return 0.5 * (c_.driver.was_cut() ? c_.substep.h : part_);
}

std::vector<Acceleration> World::Course::mean_accelerations() const {
  std::vector<Acceleration> means(c_.part_start.size());
  const double apart = part_ - velocity_lag() + 0.5 * part_before_;
  for (std::size_t i = 0; i < means.size(); ++i) {
    const BodyProperties& body = (*c_.bodies)[static_cast<int>(i)];
    if (body.prescribed() || !yields(body.mobility)) continue;
    const BodyState& from = c_.part_start[i];
    const BodyState& to = c_.state.bodies[i];
    means[i] = {(to.velocity - from.velocity) / apart,
                (to.angular_velocity - from.angular_velocity) / apart};
  }
  return means;
}

void World::Course::tell_forces() {
  if (told_ || !c_.asks_for_forces()) return;
  told_ = true;
  if (c_.instant_forces == nullptr) c_.instant_forces = std::make_shared<InstantForces>(c_);
  State now = c_.state;
  if (actor_ != nullptr) actor_->set_loads_now(now.controls);
  const std::vector<Acceleration> means = mean_accelerations();
  for (std::size_t i = 0; i < means.size(); ++i) {
    now.bodies[i].velocity += velocity_lag() * means[i].linear;
    now.bodies[i].angular_velocity += velocity_lag() * means[i].angular;
  }
  const bool found = c_.instant_forces->find(now, whole_);
  if (!found) ++c_.substep.statistics.unknown_forces;
  if (found && c_.instant_forces->shares_are_open()) c_.instant_forces->keep_within_means(c_);
  if (found && c_.instant_forces->has_jumped(means)) c_.instant_forces->lower_to_means(c_);
  for (std::size_t i = 0; i < c_.watching.size(); ++i) {
    c_.watching[i].feature->tell_forces(
        found ? c_.instant_forces->of(i) : std::span<const double>(), whole_);
  }
}

bool World::Course::arise() {
  if (!has_run_ || !c_.asks_for_forces()) return false;
  tell_forces();
  bool arisen = false;
  for (const Content::Watching& w : c_.watching) {
    if (!w.feature->arise(*c_.bodies, c_.state.time, c_.state.features[w.index])) continue;
    c_.driver.note_features();
    arisen = true;
  }
  return arisen;
}

std::optional<Divergence> World::Course::redo(double end) {
  c_.driver.go_back(c_.search_start, before_, mark_);
  expect(end);
  return c_.driver.run_to(end);
}

std::optional<Divergence> World::Course::locate(Stretch& stretch) {
  c_.search_start = c_.driver.start_of_run();
  InstantSearch search(c_.search_start.time, stretch.end, slop_, c_.start_margins, c_.margins);
  double at = stretch.end;
  while (const std::optional<double> instant = search.next()) {
    // A part diverges although the whole has not: the whole is kept, with the conditions of features
    // within it.
    if (redo(*instant)) {
      locates_ = locates_ && search.found() < stretch.end;
      at = no_instant;
      break;
    }
    if (c_.substep.work.stopped()) break;
    at = *instant;
    look();
    search.tell(at, c_.margins);
  }
  bracket_ = search.bracket();
  if (c_.substep.work.stopped() || at == search.found()) {
    // The state is that of the instant.
  } else if (search.found() == stretch.end) {
    c_.driver.go_back(c_.search_start, before_, mark_);
    return go(stretch);
  } else if (std::optional<Divergence> divergence = redo(search.found())) {
    return divergence;
  }
  if (search.found() < stretch.end) stretch = {search.found(), false, false};
  ++located_;
  return std::nullopt;
}

void World::Course::mark() {
  before_ = c_.substep.statistics;
  for (NotedFeature* feature : c_.noted) feature->mark_notes(NoteMark::instant);
}

void World::Course::run(StepReport& report) {
  c_.margins.clear();
  act_features();
  bool begins = true;
  while (index_ < c_.model.step.substeps && report.ok()) {
    act(begins);
    // Controls may have changed the margins, which makes a first guess worse.
    c_.start_margins.swap(c_.margins);
    locates_ = located_ < most_located && c_.watches();
    const bool watched = locates_ || actor_watches();
    Stretch stretch = next_stretch();
    if (watched) mark();
    report.divergence = go(stretch);
    report.stopped = c_.substep.work.stopped();
    if (watched && report.ok() && look()) {
      report.divergence = locate(stretch);
      report.stopped = c_.substep.work.stopped();
      ++c_.substep.statistics.bracketed_events;
    }
    begins = stretch.ends_substep;
    shifted_ = stretch.end != c_.driver.end_of_substep(index_);
    if (begins) {
      ++index_;
      located_ = 0;
    }
    if (report.ok()) act_features();
  }
}

bool World::Content::acts_before(double time) const {
  return std::any_of(scheduled.begin(), scheduled.end(), [&](const Scheduled& s) {
    return s.feature->next_instant(state.features[s.index]) < time;
  });
}

StepReport World::step(const StopRequest& stop) { return step(stop, nullptr); }

StepReport World::step(const StopRequest& stop, const std::function<void()>& before_substep) {
  if (!before_substep) return step(stop, nullptr);
  Caller caller(before_substep);
  return step(stop, &caller);
}

StepReport World::step(const StopRequest& stop, StepActor* actor) {
  Content& c = *content_;
  StepReport report;
  c.substep.statistics = {};
  if (stop) c.mark_notes();
  const double step_end = static_cast<double>(c.state.steps + 1) * c.model.step.dt;
  const bool adapts = c.model.step.tolerance > 0.0;
  const bool acts = adapts || actor != nullptr || c.watches() ||
                    c.acts_before(step_end + instant_slop(c.model.step));
  if (stop && acts) c.step_start = c.state;
  c.substep.work.begin_step(stop ? &stop : nullptr);
  if (adapts) {
    AdaptiveCourse(c, actor).run(report);
  } else if (acts) {
    Course(c, actor).run(report);
  } else {
    const int count = c.model.step.substeps;
    for (int i = 0; i < count && report.ok();) {
      i += c.driver.run_affine(i, count, stop && i == 0 ? &c.step_start : nullptr);
      if (i < count && !c.substep.work.stopped()) report.divergence = c.driver.run(i++);
      report.stopped = c.substep.work.stopped();
    }
  }
  c.substep.work.begin_step(nullptr);
  if (report.stopped) c.undo_step();
  if (report.ok()) ++c.state.steps;
  if (c.stays_in_place) c.driver.put_in_place(c.bodies_place, c.reals_place);
  report.statistics = c.substep.statistics;
  return report;
}

std::int64_t World::leap(std::int64_t count) {
  Content& c = *content_;
  if (c.model.step.tolerance > 0.0) return 0;
  if (!c.scheduled.empty()) {
    // A step in which something acts is no such step.
    const auto acts = [&](std::int64_t steps) {
      return c.acts_before(static_cast<double>(c.state.steps + steps) * c.model.step.dt +
                           instant_slop(c.model.step));
    };
    while (count > 0 && acts(count)) count /= 2;
  }
  const std::int64_t done = c.driver.leap(count);
  if (done > 0 && c.stays_in_place) c.driver.put_in_place(c.bodies_place, c.reals_place);
  return done;
}

}  // namespace sheave
