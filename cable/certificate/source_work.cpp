#include "cable/certificate/source_work.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "cable/cable_system.h"
#include "cable/certificate/joint_frames.h"
#include "cable/certificate/sources_of_energy.h"
#include "cable/links/attachment.h"
#include "cable/links/spool.h"
#include "engine/body_drive.h"
#include "engine/body_set.h"
#include "engine/constraint_batch.h"
#include "engine/dynamics/mounted_drive.h"
#include "engine/index.h"
#include "engine/joint_feature.h"
#include "engine/joint_report.h"

namespace sheave::certify {
namespace {

/// The largest speeds of a body in a substep.
struct Speeds {
  double centre = 0.0;  ///< [m/s]
  double spin = 0.0;    ///< [rad/s]
};

Speeds speeds_of(const LastSubstep& last, const State& end, int body) {
  const BodyState& from = last.start.bodies[at(body)];
  const BodyState& to = end.bodies[at(body)];
  const double way = (to.position - from.position).norm();
  const double turn = std::abs(to.angle - from.angle);
  return {std::max({from.velocity.norm(), to.velocity.norm(), way / last.h}),
          std::max({from.angular_velocity.norm(), to.angular_velocity.norm(), turn / last.h})};
}

/// Radius about the centre of mass of a ball that contains the body's shapes [m].
double size_of(const BodySet& bodies, int body) {
  double size = 0.0;
  for (const PlacedShape& placed : bodies.definition(body).shapes) {
    const double radius = placed.shape->half_extent().norm();
    const Vector3 arm = placed.position - bodies[body].center_of_mass;
    if (std::isfinite(radius)) size = std::max(size, arm.norm() + radius);
  }
  return size;
}

/// The state of a body; at rest for the world.
BodyState state_of(const State& state, int body) {
  return at(body) < state.bodies.size() ? state.bodies[at(body)] : BodyState{};
}

/// The feature with the joints of a type, and its place among the features.
std::pair<std::size_t, const JointFeature*> joint_feature_of(const World& world,
                                                             std::string_view type) {
  for (std::size_t i = 0; i < world.features().size(); ++i) {
    const auto* joints = dynamic_cast<const JointFeature*>(world.features()[i].get());
    if (joints != nullptr && joints->type() == type) return {i, joints};
  }
  return {0, nullptr};
}

bool is_prescribed(const BodyProperties& body) {
  return body.mobility == Mobility::kinematic || body.prescribed();
}

/// Weight of all rope of a cable [N]: a bound of the part that it has in tensions at ends of spans, and
/// in forces on wheels, besides the tension along the chord.
double weight_of_rope(const Simulation& simulation, int cable) {
  const CableSystem& system = *simulation.cables;
  const CompiledCable& own = system.cables()[at(cable)];
  if (!(own.linear_density > 0.0)) return 0.0;
  const std::vector<double>& reals = simulation.world.state().features.back().reals;
  double length = 0.0;
  for (int k = own.first_span; k < own.first_span + own.span_count; ++k) {
    length += reals[system.rest_length_index(k)];
  }
  for (int i = own.first_link; i < own.first_link + own.link_count; ++i) {
    length += reals[system.stored_length_index(i)];
  }
  const Controls& controls = simulation.world.state().controls;
  const Vector3 gravity =
      controls.has_gravity ? controls.gravity : simulation.world.bodies().gravity();
  return own.linear_density * gravity.norm() * length;
}

/// Bound of the forces with which a span of a cable has pulled in the last substep and at its start
/// [N].
double largest_tension(const Simulation& simulation, const State& start, int cable) {
  const CableSystem& system = *simulation.cables;
  const CompiledCable& own = system.cables()[at(cable)];
  const auto& now = simulation.world.state().features.back().reals;
  const auto& before = start.features.back().reals;
  double largest = 0.0;
  for (int k = own.first_span; k < own.first_span + own.span_count; ++k) {
    const std::size_t i = system.tension_index(k);
    largest = std::max({largest, std::abs(now[i]), std::abs(before[i])});
  }
  return largest + weight_of_rope(simulation, cable);
}

/// Largest distance of the cable at a link from the centre of the body that carries the link [m].
double reach_of(const LinkReport& link, const Vector3& centre) {
  double reach = (link.center - centre).norm() + link.radius;
  for (const Vector3& corner : link.path) reach = std::max(reach, (corner - centre).norm());
  return reach;
}

/// The radius of a drum that has taken up all cable, with the way of the cable along the drum.
double full_radius(const SpoolLink& drum, double radius, const CableReport& report) {
  double length = 0.0;
  for (const SpanReport& span : report.spans) length += span.rest_length;
  for (const LinkReport& link : report.links) length += link.stored_length;
  if (drum.has_groove()) {
    const double turns = length / (2.0 * pi * radius);
    const double per_layer = drum.turns_per_layer.value_or(turns);
    const double layers = turns / per_layer;
    return radius + layers * drum.layer_height.value_or(0.0) +
           std::abs(drum.lead.value_or(0.0)) * std::min(turns, per_layer);
  }
  return std::sqrt(radius * radius + drum.layer_pitch * length / pi);
}

}  // namespace

SourceWork::SourceWork(const Simulation& simulation) {
  find_bodies(simulation);
  find_joint_drives(simulation);
  if (simulation.cables != nullptr) find_holds(simulation);
}

bool SourceWork::any() const {
  return !prescribed_.empty() || !twisted_.empty() || !motors_.empty() || !joint_drives_.empty() ||
         !feeds_.empty();
}

void SourceWork::find_bodies(const Simulation& simulation) {
  const BodySet& bodies = simulation.world.bodies();
  const Model& model = simulation.world.model();
  const auto concerns = [&](BodyId id, int body) {
    const int index = bodies.index(id);
    return index < bodies.count() && (index == body || bodies[index].mount == body);
  };
  for (int i = 0; i < bodies.count(); ++i) {
    const BodyProperties& body = bodies[i];
    const BodyDef& definition = bodies.definition(i);
    const bool has_motor = body.mount < 0 && body.driven_by() == DriveKind::torque;
    if (has_motor || !is_zero(definition.torque)) twisted_.push_back(i);
    if (body.mounted_drive != DriveKind::none) motors_.push_back(i);
    if (!is_prescribed(body)) continue;
    Prescribed source;
    source.body = i;
    source.jointed = std::ranges::any_of(model.joints, [&](const auto& joint) {
      return concerns(joint->body_a, i) || concerns(joint->body_b, i);
    });
    source.collides = std::ranges::any_of(
        model.colliders, [&](const ColliderDef& collider) { return concerns(collider.body, i); });
    prescribed_.push_back(std::move(source));
  }
}

void SourceWork::find_holds(const Simulation& simulation) {
  const BodySet& bodies = simulation.world.bodies();
  const std::vector<CableReport> reports = simulation.cable_reports();
  for (std::size_t c = 0; c < reports.size(); ++c) {
    const CableReport& report = reports[c];
    const auto& links = (*simulation.cable_definitions)[c].links;
    const CompiledCable& compiled = simulation.cables->cables()[c];
    for (std::size_t i = 0; i < links.size() && i < report.links.size(); ++i) {
      const auto* attachment = dynamic_cast<const AttachmentLink*>(links[i].get());
      if (attachment != nullptr && attachment->feed_speed) {
        feeds_.push_back(
            {static_cast<int>(c), static_cast<int>(i), compiled.first_link + static_cast<int>(i)});
      }
    }
    for (Prescribed& source : prescribed_) {
      const Vector3 centre = simulation.world.state().bodies[at(source.body)].position;
      Hold hold{static_cast<int>(c)};
      for (std::size_t i = 0; i < report.links.size(); ++i) {
        const int body = bodies.index(report.links[i].body);
        if (body == bodies.count()) continue;
        if (body != source.body && bodies[body].mount != source.body) continue;
        const bool is_end = !compiled.closed && (i == 0 || i + 1 == report.links.size());
        hold.spans += is_end ? 1.0 : 2.0;
        LinkReport link = report.links[i];
        const auto* drum =
            i < links.size() ? dynamic_cast<const SpoolLink*>(links[i].get()) : nullptr;
        if (drum != nullptr) link.radius = full_radius(*drum, link.radius, report);
        hold.reach = std::max(hold.reach, reach_of(link, centre));
        // The cable can move to other points of these.
        const bool is_shape = link.surface || !link.path.empty();
        if (is_shape) hold.reach = std::max(hold.reach, size_of(bodies, source.body));
      }
      if (bodies.definition(source.body).wrappable) {
        hold.spans += 2.0;
        hold.reach = std::max(hold.reach, size_of(bodies, source.body));
      }
      if (hold.spans > 0.0) source.holds.push_back(hold);
    }
  }
}

void SourceWork::find_joint_drives(const Simulation& simulation) {
  const World& world = simulation.world;
  const JointReader reader(world);
  std::map<std::string_view, int> counts;  // of the joints of one type so far
  for (std::size_t j = 0; j < world.model().joints.size(); ++j) {
    const JointDef& joint = *world.model().joints[j];
    const int index = counts[joint.type()]++;
    if (!is_driven(joint)) continue;
    const auto [place, feature] = joint_feature_of(world, joint.type());
    const JointReport report = reader.report(static_cast<int>(j));
    const std::vector<CoordinateSettings> settings = coordinates_of(joint);
    for (std::size_t k = 0; k < report.coordinates.size(); ++k) {
      const int row = feature->drive_row(index, static_cast<int>(k));
      if (row < 0) continue;
      JointDrive drive;
      drive.joint = static_cast<int>(j);
      drive.coordinate = static_cast<int>(k);
      drive.feature = place;
      drive.row = at(row);
      drive.body_a = world.bodies().index(joint.body_a);
      drive.body_b = world.bodies().index(joint.body_b);
      drive.angle = report.coordinates[k].angle;
      drive.compliant = k < settings.size() && settings[k].settings->drive_compliance > 0.0;
      for (const int body : {drive.body_a, drive.body_b}) {
        if (body < world.bodies().count()) drive.size += size_of(world.bodies(), body);
      }
      drive.value = report.coordinates[k].value;
      drive.rate = report.coordinates[k].rate;
      drive.target = report.coordinates[k].drive_target;
      joint_drives_.push_back(drive);
    }
  }
}

void SourceWork::observe(const Simulation& simulation) {
  const std::optional<LastSubstep> last = simulation.world.last_substep();
  if (!last) {
    work_.known = false;
    return;
  }
  seen_ += last->h;
  if (!prescribed_.empty()) add_prescribed(simulation, *last);
  if (!twisted_.empty() || !motors_.empty()) add_torques(simulation, *last);
  if (!joint_drives_.empty()) add_joint_drives(simulation, *last);
  if (!feeds_.empty()) add_feeds(simulation, *last);
}

void SourceWork::add_prescribed(const Simulation& simulation, const LastSubstep& last) {
  const World& world = simulation.world;
  for (const Prescribed& source : prescribed_) {
    const BodyProperties& body = world.bodies()[source.body];
    const Speeds speeds = speeds_of(last, world.state(), source.body);
    if (speeds.centre == 0.0 && speeds.spin == 0.0) continue;
    if (source.jointed) work_.known = false;
    if (source.collides) {
      const std::vector<ContactReport> contacts = world.contacts();
      if (std::ranges::any_of(contacts, [&](const ContactReport& contact) {
            const int a = world.bodies().index(contact.body_a);
            const int b = world.bodies().index(contact.body_b);
            return a == source.body || b == source.body;
          })) {
        work_.known = false;
      }
    }
    if (body.mobility == Mobility::rotor) {
      const double before = last.start.bodies[at(source.body)].angular_velocity.squaredNorm();
      const double now = world.state().bodies[at(source.body)].angular_velocity.squaredNorm();
      work_.most += 0.5 * body.axis_inertia * std::max(now - before, 0.0);
    }
    for (const Hold& hold : source.holds) {
      const double speed = speeds.centre + speeds.spin * hold.reach;
      work_.most +=
          hold.spans * largest_tension(simulation, last.start, hold.cable) * speed * last.h;
    }
  }
}

void SourceWork::add_torques(const Simulation& simulation, const LastSubstep& last) {
  const World& world = simulation.world;
  const State& end = world.state();
  for (const int i : twisted_) {
    const BodyProperties& body = world.bodies()[i];
    double torque = world.bodies().definition(i).torque.norm();
    if (body.mount < 0 && body.driven_by() == DriveKind::torque) {
      const double impulse =
          BodyDrive(body, last.start.controls, i).integral(last.start.time, end.time);
      torque += std::abs(impulse) / last.h;
    }
    work_.most += torque * speeds_of(last, end, i).spin * last.h;
  }
  if (motors_.empty()) return;
  const auto features = world.features();
  for (std::size_t f = 0; f < features.size(); ++f) {
    if (features[f]->name() != mounted_drives_name) continue;
    for (std::size_t k = 0; k < motors_.size(); ++k) {
      const double torque = std::abs(end.features[f].reals[k]);
      const double spins = speeds_of(last, end, motors_[k]).spin +
                           speeds_of(last, end, world.bodies()[motors_[k]].mount).spin;
      work_.most += torque * spins * last.h;
    }
  }
}

void SourceWork::add_joint_drives(const Simulation& simulation, const LastSubstep& last) {
  const World& world = simulation.world;
  bool compliant = false;
  for (const JointDrive& drive : joint_drives_) {
    compliant = compliant || drive.compliant;
    const double force = std::abs(world.feature_state(drive.feature).reals[drive.row]);
    if (force == 0.0 || drive.compliant) continue;
    double rate = 0.0;
    for (const State* when : {&last.start, &world.state()}) {
      const BodyState a = state_of(*when, drive.body_a);
      const BodyState b = state_of(*when, drive.body_b);
      const double turning = (b.angular_velocity - a.angular_velocity).norm();
      const double reach = (b.position - a.position).norm() + drive.size;
      const double spins = a.angular_velocity.norm() + b.angular_velocity.norm();
      const double moving = (b.velocity - a.velocity).norm() + spins * reach;
      rate = std::max(rate, drive.angle ? turning : moving);
    }
    work_.most += force * rate * last.h;
  }
  if (compliant) add_compliant_drives(simulation, last.h);
}

void SourceWork::add_compliant_drives(const Simulation& simulation, double h) {
  const JointReader reader(simulation.world);
  JointReport report;
  int joint = -1;
  for (JointDrive& drive : joint_drives_) {
    if (!drive.compliant) continue;
    if (drive.joint != joint) report = reader.report(drive.joint);
    joint = drive.joint;
    const JointCoordinateReport& now = report.coordinates[at(drive.coordinate)];
    const double rate =
        std::max({std::abs(now.rate), std::abs(drive.rate), std::abs(now.value - drive.value) / h});
    // The end of a compliant drive moves with the target.
    const double target = std::abs(now.drive_target - drive.target) / h;
    if (now.drive_force != 0.0) work_.most += std::abs(now.drive_force) * (rate + target) * h;
    drive.value = now.value;
    drive.rate = now.rate;
    drive.target = now.drive_target;
  }
}

void SourceWork::add_feeds(const Simulation& simulation, const LastSubstep& last) {
  for (const Feed& feed : feeds_) {
    const LinkControl* set = last.start.controls.links.find(feed.index);
    double speed = std::abs(simulation.cables->defined_feed(feed.cable, feed.link));
    if (set != nullptr && set->has_feed) {
      speed = std::max(std::abs(set->feed_speed.at(last.start.time)),
                       std::abs(set->feed_speed.at(simulation.world.state().time)));
    }
    if (speed == 0.0) continue;
    work_.most += largest_tension(simulation, last.start, feed.cable) * speed * last.h;
  }
}

SourceWork::Work SourceWork::take(const Simulation& simulation, const StepStatistics& statistics) {
  Work work = work_;
  // Of a substep that is done in parts only the last part is observed. A source that has done no
  // work in that part is taken for one that does none.
  const double dt = simulation.world.model().step.dt;
  const bool all_seen = std::abs(seen_ - dt) <= 1e-9 * dt && statistics.cut_substeps == 0;
  if (work.most > 0.0 && !all_seen) work.known = false;
  work_ = {};
  seen_ = 0.0;
  return work;
}

}  // namespace sheave::certify
