#pragma once
// The list of all numbers of all controls, for hashes and files. Internal to the engine.

#include "engine/controls.h"

namespace sheave {

// Each function calls visit(member) in a fixed order, with the member's own type. `Self` may be
// const.

template <class Value, class Visit>
void visit_ramp(Value& ramp, const Visit& visit) {
  visit(ramp.from);
  visit(ramp.to);
  visit(ramp.start);
  visit(ramp.start_rate);
  visit(ramp.end);
  visit(ramp.end_rate);
  visit(ramp.rate_after);
}

/// The members of a table's entries.
template <class Control>
struct ControlMembers;

template <>
struct ControlMembers<DriveControl> {
  template <class Self, class Visit>
  static void visit(Self& self, const Visit& visit) {
    visit(self.has_target);
    visit_ramp(self.target, visit);
    visit(self.limit);
  }
};

template <>
struct ControlMembers<ForceControl> {
  template <class Self, class Visit>
  static void visit(Self& self, const Visit& visit) {
    visit(self.acts);
    visit(self.frame);
    visit(self.force);
    visit(self.torque);
    visit(self.arm);
  }
};

template <>
struct ControlMembers<MotionControl> {
  template <class Self, class Visit>
  static void visit(Self& self, const Visit& visit) {
    visit(self.moves);
    visit(self.returns);
    visit_ramp(self.position, visit);
    visit_ramp(self.turn, visit);
    visit(self.start_orientation);
  }
};

template <>
struct ControlMembers<CableControl> {
  template <class Self, class Visit>
  static void visit(Self& self, const Visit& visit) {
    visit(self.compliance);
    visit(self.breaking_tension);
    visit(self.wrap_friction);
    visit(self.added_length);
  }
};

template <>
struct ControlMembers<LinkControl> {
  template <class Self, class Visit>
  static void visit(Self& self, const Visit& visit) {
    visit(self.friction);
    visit(self.has_feed);
    visit_ramp(self.feed_speed, visit);
  }
};

/// Calls visit(table) for every table, in a fixed order.
template <class Self, class Visit>
void visit_tables(Self& controls, const Visit& visit) {
  visit(controls.body_drives);
  visit(controls.forces);
  visit(controls.motions);
  visit(controls.joint_drives);
  visit(controls.cables);
  visit(controls.links);
}

}  // namespace sheave
