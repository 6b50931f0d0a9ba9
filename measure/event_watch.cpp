#include "measure/event_watch.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cable/cable_system.h"
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

bool is_sudden(const CableEvent& event) {
  return event.kind == CableEvent::Kind::cut || event.kind == CableEvent::Kind::attach ||
         event.kind == CableEvent::Kind::stall;
}

}  // namespace

EventWatch::EventWatch(const Simulation& start, std::vector<TrackedBody> bodies)
    : bodies_(std::move(bodies)),
      motions_(bodies_.size()),
      touching_(touching_points(start.world)),
      cable_events_(start.cables == nullptr ? 0 : start.cables->events().size()),
      broken_(broken_joints(start.world)),
      time_(start.world.state().time) {
  look_at_motions(start.world);
}

void EventWatch::observe(const Simulation& run) {
  const double time = run.world.state().time;
  if (!(time > time_)) return;
  time_ = time;
  ++substeps_;
  look_at_cables(run);
  look_at_joints(run.world);
  const std::size_t touching = touching_points(run.world);
  if (touching != touching_) ++changes_.contacts;
  touching_ = touching;
  if (look_at_motions(run.world)) ++changes_.sudden;
}

void EventWatch::look_at_cables(const Simulation& run) {
  if (run.cables == nullptr) return;
  const std::vector<CableEvent>& events = run.cables->events();
  for (std::size_t i = cable_events_; i < events.size(); ++i) {
    ++changes_.events;
    if (is_sudden(events[i])) ++changes_.sudden;
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
  changes_.events += broken - std::min(broken, broken_);
  changes_.sudden += broken - std::min(broken, broken_);
  broken_ = broken;
}

bool EventWatch::look_at_motions(const World& world) {
  bool hit = false;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const TrackedBody& body = bodies_[i];
    const BodyState& state = world.state().bodies[static_cast<std::size_t>(body.id.index)];
    Motion& motion = motions_[i];
    const double change =
        std::hypot((state.velocity - motion.velocity).norm(),
                   body.reach * (state.angular_velocity - motion.angular_velocity).norm());
    motion.velocity = state.velocity;
    motion.angular_velocity = state.angular_velocity;
    motion.fastest =
        std::max(motion.fastest,
                 std::hypot(state.velocity.norm(), body.reach * state.angular_velocity.norm()));
    const double before = *std::max_element(motion.last.begin(), motion.last.end());
    hit = hit || (substeps_ > motion.last.size() && change > share_of_speed * motion.fastest &&
                  change > times_before * before);
    motion.last[substeps_ % motion.last.size()] = change;
  }
  return hit;
}

}  // namespace sheave::measure
