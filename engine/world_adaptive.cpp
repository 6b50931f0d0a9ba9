// A step whose substeps keep a tolerance: engine/step_size.h decides on their lengths.

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/index.h"
#include "engine/world_course.h"

namespace sheave {
namespace {

/// The time in which errors add up to the tolerance [s].
constexpr double time_of_tolerance = 1.0;

}  // namespace

World::AdaptiveCourse::AdaptiveCourse(Content& content, StepActor* actor)
    : Course(content, actor),
      sizes_(content.model.step, *content.bodies, content.state.step_size),
      held_until_(content.state.time),
      has_loads_(actor != nullptr && actor->has_loads()) {}

double World::AdaptiveCourse::time_of(std::int64_t tick) const {
  const double share = static_cast<double>(tick) / static_cast<double>(ticks);
  return (static_cast<double>(c_.state.steps) + share) * c_.model.step.dt;
}

void World::AdaptiveCourse::begin_substep() {
  const int count = c_.model.step.substeps;
  bool begins = place_.index == 0 && place_.tick == 0 && !place_.off_grid;
  while (place_.index + 1 < count &&
         is_due(c_.driver.end_of_substep(place_.index), c_.state.time, slop_)) {
    ++place_.index;
    begins = true;
    located_ = 0;
  }
  if (actor_ == nullptr) return;
  const bool due = begins || std::exchange(is_instant_, false);
  if (!actor_->acts_by_substeps() || !due) return actor_->look_on();
  can_return_ = false;
  // A control that has been set changes forces at this instant.
  if (c_.driver.sets_controls([&] { act(begins); })) sizes_.restart(c_.state.time);
}

void World::AdaptiveCourse::plan() {
  const std::int64_t size = ticks >> sizes_.level();
  next_ = (place_.tick / size + 1) * size;
  // No substep is much shorter than the others.
  constexpr double least = 0.01;
  const double length = c_.model.step.dt * static_cast<double>(size) / static_cast<double>(ticks);
  whole_ = length;
  const bool off_grid = place_.off_grid;
  if (off_grid && next_ < ticks && time_of(next_) - c_.state.time < least * length) next_ += size;
  plan_ = {time_of(next_), true, !off_grid && place_.tick % size == 0};
  instant_ = next_instant();
  double instant = instant_;
  if (actor_ != nullptr && actor_->acts_by_substeps()) {
    instant = std::min(instant, c_.driver.end_of_substep(place_.index));
  }
  if (plan_.end - instant > slop_) plan_ = {instant, false, false};
}

// The part of a load that is not its mean must not move bodies by more than the tolerance per
// second, in substeps of any length. The estimate of the error does not see that part: a force that
// swings with the period of the substeps has the mean 0. At a corner a new substep begins where a
// shorter one would be needed otherwise.
void World::AdaptiveCourse::plan_with_loads() {
  plan();
  to_corner_ = false;
  if (!has_loads_) return;
  while (true) {
    const double length = plan_.end - c_.state.time;
    const LoadDefect defect = actor_->load_defect(length);
    if (sizes_.allows(defect.distance, length)) return;
    if (defect.corner < plan_.end - slop_ && !is_due(defect.corner, c_.state.time, slop_)) {
      plan_ = {defect.corner, false, false};
      to_corner_ = true;
    } else if (sizes_.shorten()) {
      plan();
      to_corner_ = false;
    } else {
      return;
    }
  }
}

std::optional<Divergence> World::AdaptiveCourse::attempt(bool half) {
  const double end = half ? 0.5 * (c_.state.time + plan_.end) : plan_.end;
  expect(end);
  if (half || !plan_.on_grid) return c_.driver.run_to(end);
  const std::int64_t size = ticks >> sizes_.level();
  return c_.driver.run_part(place_.tick / size, ticks / size);
}

void World::AdaptiveCourse::go_back() {
  // A substep in parts has moved its mark.
  if (c_.driver.was_cut()) can_return_ = false;
  ++before_.undone_substeps;
  c_.driver.go_back(start_, before_, place_.mark);
}

void World::AdaptiveCourse::note_miss(const StepSizeVerdict& verdict, bool jumped) {
  StepStatistics& statistics = c_.substep.statistics;
  ++statistics.missed_tolerance;
  // A velocity that is off moves the body until the motion turns.
  const double error =
      jumped ? verdict.error : std::max(verdict.error, verdict.jump * time_of_tolerance);
  if (error <= statistics.missed_error) return;
  statistics.missed_error = error;
  statistics.missed_time = c_.state.time;
  statistics.missed_body = verdict.body;
}

void World::AdaptiveCourse::note_event(double length, double jump, bool of_velocity) {
  StepStatistics& statistics = c_.substep.statistics;
  ++statistics.bracketed_events;
  if (of_velocity) {
    statistics.event_distance += length * jump;
  } else {
    statistics.event_speed += jump;
  }
}

bool World::AdaptiveCourse::returns(const StepSizeVerdict& verdict, double h, std::int64_t level) {
  if (!verdict.event || !can_return_ || returns_ == most_returns) return false;
  // A substep that is no longer than one in which the event is allowed to be is short enough.
  const bool refused = sizes_.level() > level;
  if (last_length_ < (refused ? 0.75 : 1.5) * h) return false;
  ++returns_;
  const std::int64_t next = refused ? sizes_.level() : level;
  held_until_ = std::max(held_until_, c_.state.time);
  StepStatistics before = last_place_.statistics;
  before.undone_substeps = c_.substep.statistics.undone_substeps + 2;
  c_.driver.go_back(last_start_, before, last_place_.mark);
  c_.state.step_size = last_start_.step_size;
  c_.state.step_size.level = next;
  c_.state.memory = last_start_.memory;
  c_.margins.clear();
  place_ = last_place_;
  can_return_ = false;
  return true;
}

World::AdaptiveCourse::Outcome World::AdaptiveCourse::judge() {
  const std::int64_t level = sizes_.level();
  const double h = c_.state.time - start_.time;
  judged_ = c_.state.step_size;
  const StepSizeVerdict verdict = sizes_.judge(start_, c_.state);
  if (c_.driver.was_cut()) can_return_ = false;
  if (verdict.may_pass && passes(judged_)) return Outcome::kept;
  if (over()) return Outcome::undone;
  const bool refused = !verdict.accepted && !verdict.is_last;
  if (!refused || sizes_.level() > level) {
    if (returns(verdict, h, level)) return Outcome::returned;
  }
  if (refused) {
    go_back();
    return Outcome::undone;
  }
  const bool jumped = verdict.of_velocity || (verdict.is_last && jumps(judged_, verdict.jump));
  if (verdict.is_last && !(jumped && verdict.is_placed)) note_miss(verdict, jumped);
  if (verdict.event || verdict.is_last) note_event(h, verdict.jump, jumped);
  // The event is over.
  if (verdict.event) held_until_ = c_.state.time;
  return Outcome::kept;
}

bool World::AdaptiveCourse::passes(const StepSizeMemory& memory) {
  const std::int64_t size = next_ - place_.tick;
  const bool fits = next_ + size <= ticks && next_ % size == 0;
  if (!plan_.on_grid || !fits || c_.driver.was_cut()) return false;
  if (instant_ < time_of(next_ + size) + slop_) return false;
  const StepSizeMemory refused = c_.state.step_size;
  expect(time_of(next_ + size));
  const bool diverges = c_.driver.run_part(next_ / size, ticks / size).has_value();
  if (over()) return false;
  if (!diverges && !c_.driver.was_cut() && !(watched_ && look())) {
    c_.state.step_size = memory;
    const StepSizeVerdict verdict = sizes_.judge(start_, c_.state);
    if (verdict.accepted && !verdict.event) {
      next_ += size;
      plan_.end = time_of(next_);
      ++c_.substep.statistics.kept_substeps;
      is_pair_ = true;
      return true;
    }
  }
  c_.state.step_size = refused;
  return false;
}

bool World::AdaptiveCourse::jumps(const StepSizeMemory& before, double jump) {
  if (!(jump > 0.0) || before.accelerations.empty() || c_.driver.was_cut()) return false;
  const StepSizeMemory memory = c_.state.step_size;
  const StepStatistics done = c_.substep.statistics;
  const double h = c_.state.time - start_.time;
  c_.driver.go_back(start_, before_, place_.mark);
  expect(start_.time + StepSizeControl::length_of_proof * h);
  const bool diverges =
      c_.driver.run_to(start_.time + StepSizeControl::length_of_proof * h).has_value();
  if (over()) return false;
  const double in_longer = diverges ? 0.0 : sizes_.jump_after(before, start_, c_.state);
  c_.state.step_size = memory;
  c_.driver.go_back(start_, before_, place_.mark);
  repeat_plan(place_.tick, done);
  return in_longer > 0.0 && StepSizeControl::is_jump(jump, in_longer);
}

bool World::AdaptiveCourse::may_have_decided() const {
  if (!c_.model.colliders.empty() || c_.model.ground) return true;
  return !std::ranges::equal(last_start_.features, c_.state.features, {}, &FeatureState::integers,
                             &FeatureState::integers);
}

bool World::AdaptiveCourse::returns_from_the_end() {
  if (!can_return_ || !sizes_.knows() || c_.driver.was_cut() || !may_have_decided()) return false;
  const StepSizeMemory memory = c_.state.step_size;
  const StepStatistics done = c_.substep.statistics;
  const std::int64_t level = sizes_.level();
  const double h = std::ldexp(c_.model.step.dt, -static_cast<int>(level));
  start_ = c_.state;
  jumped_ = false;
  expect(start_.time + h);
  const bool diverges = c_.driver.run_to(start_.time + h).has_value();
  if (over()) return false;
  if (!diverges && returns(sizes_.judge(start_, c_.state), h, level)) return true;
  c_.state.step_size = memory;
  repeat_last_substep(done);
  return false;
}

void World::AdaptiveCourse::repeat_last_substep(const StepStatistics& done) {
  c_.driver.go_back(last_start_, last_place_.statistics, last_place_.mark);
  if (has_loads_) load_memory_ = &last_start_.memory;
  jumped_ = last_start_.step_size.accelerations.empty();
  repeat_plan(last_place_.tick, done);
}

void World::AdaptiveCourse::repeat_plan(std::int64_t tick, const StepStatistics& done) {
  expect(plan_.end);
  const std::int64_t size = next_ - tick;
  static_cast<void>(plan_.on_grid ? c_.driver.run_part(tick / size, ticks / size)
                                  : c_.driver.run_to(plan_.end));
  StepStatistics& statistics = c_.substep.statistics;
  statistics.kept_substeps = done.kept_substeps;
  statistics.undone_substeps = done.undone_substeps + 2;
  statistics.missed_tolerance = done.missed_tolerance;
  statistics.missed_error = done.missed_error;
  statistics.missed_time = done.missed_time;
  statistics.missed_body = done.missed_body;
  statistics.bracketed_events = done.bracketed_events;
  statistics.event_distance = done.event_distance;
  statistics.event_speed = done.event_speed;
}

std::optional<Divergence> World::AdaptiveCourse::advance() {
  c_.start_margins.swap(c_.margins);
  locates_ = located_ < most_located && c_.watches();
  watched_ = locates_ || actor_watches();
  is_pair_ = false;
  start_ = c_.state;
  mark_ = last_place_.mark == NoteMark::instant ? NoteMark::before : NoteMark::instant;
  place_.mark = mark_;
  before_ = place_.statistics = c_.substep.statistics;
  if (has_loads_) load_memory_ = &start_.memory;
  jumped_ = !sizes_.knows();
  for (NotedFeature* feature : c_.noted) feature->mark_notes(place_.mark);
  std::optional<Divergence> divergence;
  while (true) {
    plan_with_loads();
    if (!sizes_.knows()) {
      divergence = attempt(true);
      if (over()) return {};
      if (!divergence) sizes_.note(start_, c_.state);
      go_back();
    }
    if (!divergence) divergence = attempt(false);
    if (over()) return {};
    if (divergence) {
      if (!sizes_.shorten()) return divergence;
      divergence.reset();
      go_back();
    } else if (watched_ && look()) {
      plan_.on_grid = false;
      divergence = locate(plan_);
      is_instant_ = true;
      note_event(bracket_, sizes_.change_of_velocity(start_, c_.state), true);
      sizes_.restart(c_.state.time);
      break;
    } else if (const Outcome outcome = judge(); outcome == Outcome::returned) {
      return {};
    } else if (outcome == Outcome::kept) {
      break;
    }
  }
  arrive();
  return divergence;
}

void World::AdaptiveCourse::arrive() {
  ++c_.substep.statistics.kept_substeps;
  is_instant_ = is_instant_ || is_due(instant_, c_.state.time, slop_);
  std::swap(last_start_, start_);
  last_place_ = place_;
  last_length_ = c_.state.time - last_start_.time;
  can_return_ = !is_instant_ && !is_pair_ && sizes_.knows() && !c_.driver.was_cut();
  place_.off_grid = c_.state.time != time_of(next_);
  if (!place_.off_grid) {
    place_.tick = next_;
    const bool even = place_.tick % (2 * (ticks >> sizes_.level())) == 0;
    if (even && c_.state.time >= held_until_) sizes_.lengthen();
  } else {
    const double share = c_.state.time / c_.model.step.dt - static_cast<double>(c_.state.steps);
    place_.tick = std::clamp<std::int64_t>(
        static_cast<std::int64_t>(share * static_cast<double>(ticks)), place_.tick, ticks - 1);
  }
  if (!act_features() && !to_corner_) return;
  can_return_ = false;
  sizes_.restart(c_.state.time);
}

void World::AdaptiveCourse::run(StepReport& report) {
  c_.margins.clear();
  if (act_features()) sizes_.restart(c_.state.time);
  do {
    while (place_.tick < ticks && report.ok()) {
      begin_substep();
      report.divergence = advance();
      report.stopped = over();
    }
  } while (report.ok() && returns_from_the_end());
  report.stopped = over();
}

}  // namespace sheave
