#include "measure/event_watch.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cable/cable_system.h"
#include "engine/controls.h"
#include "engine/instants.h"
#include "engine/joint_report.h"

namespace sheave::measure {
namespace {

constexpr double share_of_speed = 0.05;
constexpr double times_before = 4.0;

std::size_t touching_points(const World& world) {
  const std::vector<ContactReport> contacts = world.contacts();
  return static_cast<std::size_t>(
      std::count_if(contacts.begin(), contacts.end(),
                    [](const ContactReport& contact) { return contact.normal_force > 0.0; }));
}

std::size_t broken_joints(const World& world) {
  if (world.model().joints.empty()) return 0;
  const std::vector<JointReport> joints = joint_reports(world);
  return static_cast<std::size_t>(
      std::count_if(joints.begin(), joints.end(),
                    [](const JointReport& joint) { return joint.broken_at.has_value(); }));
}

/// Whether a cable was cut at an instant that every run finds: by its cut time, by a trigger, or by the
/// tension of an elastic cable.
bool is_cut_in_time(const CableEvent& event, const Simulation& run) {
  const std::vector<CableDef>& cables = *run.cable_definitions;
  const auto cable = std::ranges::find(cables, event.cable, &CableDef::name);
  if (cable == cables.end()) return false;
  if (cable->is_elastic()) return true;
  const CableControl* set =
      run.world.state().controls.cables.find(static_cast<int>(cable - cables.begin()));
  const bool may_break =
      cable->breaking_tension || (set != nullptr && !std::isnan(set->breaking_tension));
  if (!may_break) return true;
  const double slop = instant_slop(run.world.model().step);
  return cable->cut_time && std::abs(event.time - *cable->cut_time) <= slop;
}

}  // namespace

EventWatch::EventWatch(const Simulation& start, std::vector<TrackedBody> bodies)
    : bodies_(std::move(bodies)),
      motions_(bodies_.size()),
      hidden_(bodies_.size()),
      touching_(touching_points(start.world)),
      cable_events_(start.cables == nullptr ? 0 : start.cables->events().size()),
      broken_(broken_joints(start.world)),
      time_(start.world.state().time),
      begins_{time_, time_} {
  look_at_motions(start.world);
  look_at_friction(start.world);
}

void EventWatch::observe(const Simulation& run) {
  const double time = run.world.state().time;
  if (!(time > time_)) return;
  begins_ = {begins_[1], time_};
  time_ = time;
  ++substeps_;
  look_at_cables(run);
  look_at_joints(run.world);
  const std::size_t touching = touching_points(run.world);
  if (touching != touching_) ++changes_.contacts;
  touching_ = touching;
  const bool hit = look_at_motions(run.world);
  // The substep after a stop has the new acceleration.
  if (std::exchange(stopped_, false)) add_hidden(time_ - begins_[1]);
  const bool lets_go = look_at_friction(run.world);
  if (lets_go) {
    ++changes_.sudden;
  } else if (hit) {
    ++hits_;
  }
}

bool EventWatch::look_at_friction(const World& world) {
  bool lets_go = false;
  std::map<std::pair<int, int>, bool> holds;
  for (const ContactReport& contact : world.contacts()) {
    if (!(contact.normal_force > 0.0)) continue;
    bool& any = holds[{contact.body_a.index, contact.body_b.index}];
    any = any || contact.sticks;
  }
  for (const auto& [pair, now] : holds) {
    const auto before = holds_.find(pair);
    if (substeps_ < 2 || before == holds_.end() || before->second == now) continue;
    if (now) {
      stopped_ = true;
      ++changes_.stops;
    } else {
      lets_go = true;
    }
  }
  holds_ = std::move(holds);
  return lets_go;
}

void EventWatch::add_hidden(double length) {
  // Accelerations times (length / 2)^2 / 2; a change of a velocity is an acceleration times `length`.
  const double share = 0.125 * length;
  // A point may stick from the substep after the stop on.
  const auto jump = [](const std::vector<Vector3>& changes) {
    double most = 0.0;
    for (const Vector3& change : changes) most = std::max(most, (changes[0] - change).norm());
    return most;
  };
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    hidden_[i].moved += share * jump(motions_[i].changes);
    hidden_[i].turned += share * jump(motions_[i].turn_changes);
  }
}

void EventWatch::look_at_cables(const Simulation& run) {
  if (run.cables == nullptr) return;
  const std::vector<CableEvent>& events = run.cables->events();
  for (std::size_t i = cable_events_; i < events.size(); ++i) {
    ++changes_.events;
    const CableEvent::Kind kind = events[i].kind;
    if (kind == CableEvent::Kind::cut) {
      if (!is_cut_in_time(events[i], run)) ++by_forces_;
    } else if (kind == CableEvent::Kind::attach || kind == CableEvent::Kind::stall) {
      ++changes_.sudden;
    }
  }
  cable_events_ = events.size();
  const FeatureState& own = run.world.state().features.back();
  const auto spans = static_cast<std::size_t>(run.cables->span_count());
  taut_.resize(spans);
  for (std::size_t k = 0; k < spans; ++k) {
    const bool taut = own.reals[run.cables->tension_index(static_cast<int>(k))] > 0.0;
    // Tensions are unknown before the first substep.
    if (substeps_ > 1 && taut != taut_[k]) ++changes_.slack;
    taut_[k] = taut;
  }
}

void EventWatch::look_at_joints(const World& world) {
  const std::size_t broken = broken_joints(world);
  if (broken > broken_) {
    changes_.events += broken - broken_;
    by_forces_ += broken - broken_;
  }
  broken_ = broken;
}

void EventWatch::end_step(const StepStatistics& statistics) {
  // An impact that the run has located is not late.
  const auto located = static_cast<std::size_t>(statistics.bracketed_events);
  const std::size_t exact = std::min(hits_, located_before_ + located);
  changes_.sudden += std::exchange(hits_, 0) - exact;
  // The first substep of the next step may show an impact of this one.
  located_before_ = located - std::min(located, exact - std::min(exact, located_before_));
  if (statistics.unknown_forces > 0) changes_.sudden += by_forces_;
  by_forces_ = 0;
}

bool EventWatch::look_at_motions(const World& world) {
  bool hit = false;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const TrackedBody& body = bodies_[i];
    const BodyState& state = world.state().bodies[static_cast<std::size_t>(body.id.index)];
    Motion& motion = motions_[i];
    std::rotate(motion.changes.begin(), motion.changes.end() - 1, motion.changes.end());
    std::rotate(motion.turn_changes.begin(), motion.turn_changes.end() - 1,
                motion.turn_changes.end());
    motion.changes[0] = state.velocity - motion.velocity;
    motion.turn_changes[0] = state.angular_velocity - motion.angular_velocity;
    const double change =
        std::hypot(motion.changes[0].norm(), body.reach * motion.turn_changes[0].norm());
    motion.velocity = state.velocity;
    motion.angular_velocity = state.angular_velocity;
    motion.fastest =
        std::max(motion.fastest,
                 std::hypot(state.velocity.norm(), body.reach * state.angular_velocity.norm()));
    const double before = *std::max_element(motion.last.begin(), motion.last.end());
    // The next substep judges whether the change lasts.
    hit = hit || motion.suspect > times_before * change;
    const bool jumps = substeps_ > motion.last.size() && change > share_of_speed * motion.fastest &&
                       change > times_before * before;
    motion.suspect = jumps ? change : 0.0;
    motion.last[substeps_ % motion.last.size()] = change;
  }
  return hit;
}

}  // namespace sheave::measure
