#include "fuzz/machine_run.h"

#include <algorithm>
#include <cmath>

#include "cable/cable_system.h"
#include "cable/links/attachment.h"
#include "cable/links/spool.h"
#include "engine/body_set.h"
#include "engine/joint_report.h"
#include "engine/joints/gear.h"
#include "fuzz/target.h"
#include "tests/support/builders.h"
#include "tests/support/rounding.h"

namespace sheave::fuzz {
namespace {

/// Certificate::clean() plus the difference between two ways of measuring the same quantity.
constexpr double trust = 0.011;

bool drives(const JointDef& joint) {
  for (const auto& entry : joint_types()) {
    if (entry.name != joint.type()) continue;
    for (const Field& field : entry.fields()) {
      const FieldSlot slot = field.slot(const_cast<void*>(joint.settings()));
      const auto* choice = std::get_if<ChoiceSlot>(&slot);
      if (choice == nullptr || field.choices.front() != "none") continue;
      if (choice->get(choice->object) != 0) return true;
    }
  }
  return false;
}

bool feeds(const LinkDef& link) {
  const auto* point = dynamic_cast<const AttachmentLink*>(&link);
  return point != nullptr && point->feed_speed.value_or(0.0) != 0.0;
}

/// Whether work may be done that World::energy() does not include.
bool is_driven(const Model& model, const std::vector<CableDef>& cables) {
  const bool by_body = std::any_of(model.bodies.begin(), model.bodies.end(), [](const BodyDef& b) {
    return b.drive != DriveKind::none || b.mobility == Mobility::kinematic || !b.torque.isZero() ||
           (b.mobility == Mobility::rotor && !b.force.isZero());
  });
  const bool by_joint = std::any_of(model.joints.begin(), model.joints.end(),
                                    [](const auto& joint) { return drives(*joint); });
  const bool by_cable = std::any_of(cables.begin(), cables.end(), [](const CableDef& cable) {
    return std::any_of(cable.links.begin(), cable.links.end(),
                       [](const auto& link) { return feeds(*link); });
  });
  // Overlapping bodies that begin to touch have the energy of a compressed spring at once.
  const bool by_contact = std::any_of(model.colliders.begin(), model.colliders.end(),
                                      [](const auto& c) { return c.compliance > 0.0; });
  return by_body || by_joint || by_cable || by_contact;
}

bool is_finite(const BodyState& body) {
  return body.position.allFinite() && body.orientation.coeffs().allFinite() &&
         body.velocity.allFinite() && body.angular_velocity.allFinite() &&
         std::isfinite(body.angle);
}

/// The largest and the smallest of all lengths of a cable [m].
struct Lengths {
  double longest = 0.0;
  double shortest = 0.0;

  void add(double length) {
    longest = std::max(longest, std::abs(length));
    shortest = std::min(shortest, length);
  }
  explicit Lengths(const CableReport& cable) {
    for (const SpanReport& span : cable.spans) add(span.rest_length);
    for (const LinkReport& link : cable.links) add(link.stored_length);
    for (const WrapReport& wrap : cable.wraps) {
      add(wrap.span.rest_length);
      add(wrap.link.stored_length);
    }
  }
};

/// Upper bound of the displacement of a point of a body in a substep [m].
double motion(const World& world) {
  double fastest = 0.0;
  for (const BodyState& body : world.state().bodies) {
    fastest = std::max(
        fastest, body.velocity.norm() + world.bodies().scale() * body.angular_velocity.norm());
  }
  return fastest * world.model().step.dt / world.model().step.substeps;
}

/// Additional cable that drums take up or release when they turn by w h, because their radius grows
/// by the pitch per turn: pitch (w h)^2 / 4 pi [m].
double layered_motion(const CableDef& cable, const World& world) {
  double turn = 0.0;
  for (const BodyState& body : world.state().bodies) {
    turn = std::max(turn, body.angular_velocity.norm());
  }
  turn *= world.model().step.dt / world.model().step.substeps;
  double sum = 0.0;
  for (const auto& link : cable.links) {
    const auto* spool = dynamic_cast<const SpoolLink*>(link.get());
    if (spool != nullptr) sum += spool->layer_pitch * turn * turn / (4.0 * pi);
  }
  return sum;
}

bool is_rigid(const CableDef& cable) {
  return !cable.is_elastic() && cable.tangent_update == TangentUpdate::iteration;
}

/// Reads all reports, so that the code of each is executed.
void read_reports(const Simulation& simulation) {
  const World& world = simulation.world;
  for (int i = -1; i < world.bodies().count(); ++i) {
    const BodyId body{i};
    require(world.position(body).allFinite() && world.velocity(body).allFinite() &&
                world.orientation(body).coeffs().allFinite() &&
                world.angular_velocity(body).allFinite(),
            "a pose that is not finite is reported");
  }
  for (const CableReport& cable : simulation.cable_reports()) {
    std::vector<int> places;
    const CableReport whole = cable.with_wraps_in_place(&places);
    require(whole.links.size() == cable.links.size() + cable.wraps.size() &&
                places.size() == whole.links.size(),
            "a link without a place");
  }
  if (simulation.cables != nullptr) {
    static_cast<void>(simulation.cables->tangent_warnings());
    static_cast<void>(simulation.cables->wrap_warnings());
    static_cast<void>(simulation.cables->stall_warnings());
    static_cast<void>(simulation.cables->slide_warnings());
  }
}

/// Scale of the angles of a joint [rad]. For a gear it is the angle of the faster body.
double turns_of(const World& world, const std::string& name) {
  for (const auto& joint : world.model().joints) {
    const auto* gear = dynamic_cast<const GearJoint*>(joint.get());
    if (gear != nullptr && joint->name == name) return std::max(1.0, std::abs(gear->ratio));
  }
  return 1.0;
}

/// The sum of all reported forces [N]; a torque is divided by the size of the scene.
double reported_forces(const Simulation& simulation) {
  const double size = simulation.world.bodies().scale();
  double forces = 0.0;
  for (const JointReport& joint : joint_reports(simulation.world)) {
    forces += joint.force.norm() + joint.torque.norm() / size;
  }
  for (const CableReport& cable : simulation.cable_reports()) {
    for (const SpanReport& span : cable.spans) forces += span.tension;
    for (const WrapReport& wrap : cable.wraps) forces += wrap.span.tension;
  }
  for (const ContactReport& contact : simulation.world.contacts()) {
    forces += contact.normal_force + contact.friction_force.norm();
  }
  return forces;
}

bool is_clean(const std::optional<Certificate>& certificate) {
  if (!certificate) return false;
  const bool clean = certificate->clean();
  for (const CertificateItem& item : certificate->items) {
    require(!clean || std::isfinite(item.relative), "a certificate with no number is clean");
    require(!item.sentence().empty(), "a certificate without words");
  }
  return clean;
}

}  // namespace

StepCheck::StepCheck(const Simulation& simulation, bool ordinary)
    : ordinary_(ordinary),
      driven_(is_driven(simulation.world.model(), simulation.cable_definitions
                                                      ? *simulation.cable_definitions
                                                      : std::vector<CableDef>())),
      before_(test::start({simulation.world.model(), simulation.cable_definitions
                                                         ? *simulation.cable_definitions
                                                         : std::vector<CableDef>()})),
      rounding_(simulation.cable_reports().size(), 0.0) {}

void StepCheck::check(const Simulation& simulation) {
  for (const BodyState& body : simulation.world.state().bodies) {
    require(is_finite(body), "a state that is not finite, and no divergence");
  }
  if (ordinary_) {
    require(std::isfinite(simulation.world.energy().total()),
            "an energy that is not finite, and no divergence");
  }
  read_reports(simulation);
  const std::optional<Certificate> certificate = simulation.certificate();
  require(certificate.has_value(), "a step without a certificate");
  const bool clean = is_clean(certificate);
  check_cables(simulation, clean);
  if (!clean || !ordinary_) return;
  check_joints(simulation);
  check_contacts(simulation);
  check_energy(simulation);
}

// Lengths are multiples of a power of two of about 1e-15 of the cable (cable/cable_system.h), so
// their sum is exact as long as no length exceeds some multiple of the cable. Beyond that each of
// the about 16 sums of a substep rounds by eps of the longest length.
void StepCheck::check_cables(const Simulation& simulation, bool clean) {
  const std::vector<CableReport> cables = simulation.cable_reports();
  const std::size_t events = simulation.cables == nullptr ? 0 : simulation.cables->events().size();
  quiet_ = events == events_ ? quiet_ + 1 : 0;
  events_ = events;
  const StepSettings& step = simulation.world.model().step;
  for (std::size_t c = 0; c < cables.size(); ++c) {
    const CableReport& cable = cables[c];
    const CableDef& definition = (*simulation.cable_definitions)[c];
    const Lengths lengths(cable);
    const double moved = motion(simulation.world) + layered_motion(definition, simulation.world);
    const double whole = std::max(cable.total_length, lengths.longest + moved);
    if (lengths.longest + moved > 4.0 * cable.total_length || driven_) {
      rounding_[c] += 16.0 * test::eps * step.substeps * whole / cable.total_length;
    }
    if (ordinary_ && !cable.cut) {
      require(std::abs(cable.length_error) <= rounding_[c],
              "cable " + std::string(cable.name) + " has come from nowhere, relative " +
                  std::to_string(cable.length_error * 1e12) + "e-12");
    }
    if (!clean || cable.cut) continue;
    require(-lengths.shortest <= trust * whole, "a length below 0, and a clean certificate");
    if (!ordinary_ || quiet_ == 0 || !is_rigid(definition)) continue;
    const double size = std::max(whole, simulation.world.bodies().scale());
    for (const SpanReport& span : cable.spans) {
      require(!span.has_tangent || span.length - span.rest_length <= trust * size,
              "a rigid span is stretched, and the certificate is clean");
    }
  }
}

void StepCheck::check_joints(const Simulation& simulation) const {
  const World& world = simulation.world;
  const double size = world.bodies().scale();
  for (const JointReport& joint : joint_reports(world)) {
    require(joint.error <= trust * size && joint.angle_error <= trust * turns_of(world, joint.name),
            joint.name + " is open, and the certificate is clean");
  }
}

void StepCheck::check_contacts(const Simulation& simulation) const {
  const double size = simulation.world.bodies().scale();
  for (const ContactReport& contact : simulation.world.contacts()) {
    require(contact.normal_force >= 0.0, "a contact pulls");
    const auto gives = [&](BodyId body) {
      for (const ColliderDef& collider : simulation.world.model().colliders) {
        if (collider.body == body && collider.compliance > 0.0) return true;
      }
      return false;
    };
    if (gives(contact.body_a) || gives(contact.body_b)) continue;
    require(contact.gap >= -trust * size, "bodies overlap, and the certificate is clean");
  }
}

namespace {

/// The change of a body's motion in a substep.
struct MotionChange {
  Vector3 center = Vector3::Zero();
  double velocity = 0.0;  ///< [m/s]
  double spin = 0.0;      ///< [rad/s]; a rotation changes velocities by h w^2 without a force

  /// Upper bound of the velocity change of a point of the body [m/s].
  [[nodiscard]] double at(const Vector3& point) const {
    return velocity + spin * (point - center).norm();
  }
};

std::vector<MotionChange> changes_of(const World& world, const LastSubstep& last) {
  std::vector<MotionChange> changes;
  for (std::size_t i = 0; i < world.state().bodies.size(); ++i) {
    const BodyState& start = last.start.bodies[i];
    const BodyState& end = world.state().bodies[i];
    changes.push_back({end.position, (end.velocity - start.velocity).norm(),
                       (end.angular_velocity - start.angular_velocity).norm() +
                           last.h * std::max(start.angular_velocity.squaredNorm(),
                                             end.angular_velocity.squaredNorm())});
  }
  return changes;
}

/// Sum of the impulses of tensions times the velocity changes at their points of action [J].
double turned_by_tensions(const Simulation& simulation, const std::vector<MotionChange>& changes,
                          double h) {
  double sum = 0.0;
  const auto add = [&](const LinkReport& link, double tension, const Vector3& point) {
    if (link.body.is_world()) return;
    sum += h * tension * changes[static_cast<std::size_t>(link.body.index)].at(point);
  };
  for (const CableReport& report : simulation.cable_reports()) {
    std::vector<int> places;
    const CableReport cable = report.with_wraps_in_place(&places);
    for (std::size_t k = 0; k < cable.spans.size(); ++k) {
      std::size_t next = (k + 1) % cable.links.size();
      while (next != k && !cable.links[next].touched) next = (next + 1) % cable.links.size();
      add(cable.links[k], cable.spans[k].tension, cable.spans[k].start);
      add(cable.links[next], cable.spans[k].tension, cable.spans[k].end);
    }
  }
  return sum;
}

/// Work of contacts that push overlapping bodies apart [J]. The substeps after a bounce remove the
/// remaining overlap; the certificate's figure `contact` measures that removal separately.
double moved_out(const World& before, const World& now) {
  double sum = 0.0;
  const std::vector<ContactReport> old = before.contacts();
  for (const ContactReport& contact : now.contacts()) {
    const ContactReport* same = nullptr;
    for (const ContactReport& other : old) {
      if (other.body_a != contact.body_a || other.body_b != contact.body_b) continue;
      const auto distance = [&](const ContactReport* of) {
        return (of->point - contact.point).squaredNorm();
      };
      if (same == nullptr || distance(&other) < distance(same)) same = &other;
    }
    if (same == nullptr) continue;
    sum += contact.normal_force * std::max(std::min(contact.gap, 0.0) - same->gap, 0.0);
  }
  return sum;
}

}  // namespace

// A certificate is clean if the work from no source is at most a hundredth of the energy flow
// (cable/certificate/energy.cpp). The flow counts as at least a millionth of the present energies
// and weights, because a gap may close while the machine is nearly at rest. The flow is at most the
// sum of all forces times the speed of the fastest point.
//
// The certificate does not include the error of the time step, which is of second order: the work
// of an impulse P that changes a velocity by dv depends by P dv on the velocity between both ends.
// The same holds if another impulse changes the velocity at P's point. An example is a light wheel
// between two ropes: its own m dv is small, but the tensions are not.
//
// Positions are rounded, too. Every force does work on the rounding, and so does the inertial force
// m v / h of a body's motion within a substep.
void StepCheck::check_energy(const Simulation& simulation) {
  const std::optional<LastSubstep> last = simulation.world.last_substep();
  // When a cable begins to touch a body that has moved into it, the next substep removes the
  // penetration.
  if (driven_ || quiet_ < 2 || !last || !before_.world.restore(last->start).empty()) return;
  // For a span without tangent the run itself warns that its numbers are unreliable.
  for (const CableReport& cable : simulation.cable_reports()) {
    const auto lost = [](const SpanReport& span) { return !span.has_tangent; };
    if (std::any_of(cable.spans.begin(), cable.spans.end(), lost)) return;
  }
  const World& world = simulation.world;
  const double size = world.bodies().scale();
  const std::vector<MotionChange> changes = changes_of(world, *last);
  double fastest = 0.0;
  double farthest = size;
  double forces = reported_forces(simulation);
  double second_order = turned_by_tensions(simulation, changes, last->h);
  double level = 0.0;
  double mass = 0.0;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const BodyProperties& body = world.bodies()[static_cast<int>(i)];
    for (const BodyState* state : {&last->start.bodies[i], &world.state().bodies[i]}) {
      fastest = std::max(fastest, state->velocity.norm() + size * state->angular_velocity.norm());
      farthest = std::max(farthest, size + state->position.norm());
    }
    const double load =
        body.mass * world.model().gravity.norm() + world.model().bodies[i].force.norm();
    forces += load;
    level += load * size;
    mass += body.mass;
    const double inertia = std::max(body.inertia.norm(), body.axis_inertia);
    const auto [center, change, turn] = changes[i];
    second_order += body.mass * change * change + inertia * turn * turn;
    forces += (body.mass * change + inertia * turn / size) / last->h;
  }
  const Energy before = before_.world.energy();
  const Energy after = world.energy();
  level += after.kinetic + after.elastic;
  const double flow = std::max(forces * fastest * last->h, 1e-6 * level);
  const double rounding = 64.0 * test::eps * farthest * (forces + mass * fastest / last->h);
  const double gain = after.total() - before.total();
  const double lifted = moved_out(before_.world, world);
  require(gain <= trust * flow + second_order + lifted * (1.0 + trust) + rounding,
          "energy has come from nowhere, and the certificate is clean: " + std::to_string(gain) +
              " J where at most " + std::to_string(flow) + " J flow");
}

}  // namespace sheave::fuzz
