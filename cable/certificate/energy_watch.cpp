#include "cable/certificate/energy_watch.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cable/cable_system.h"
#include "cable/certificate/sources_of_energy.h"
#include "cable/links/attachment.h"
#include "engine/body_drive.h"
#include "engine/body_set.h"
#include "engine/index.h"
#include "engine/joint_report.h"

namespace sheave::certify {
namespace {

constexpr std::int64_t block_steps = 16;
/// relative to the energy of the motion, in one step
constexpr double suspicious_share = 0.01;
constexpr double most_growth = 1e6;

bool has_controls(const Simulation& simulation) {
  return simulation.supervisor != nullptr || !simulation.world.state().controls.empty();
}

Vector3 gravity_of(const Simulation& simulation) {
  const Controls& controls = simulation.world.state().controls;
  return controls.has_gravity ? controls.gravity : simulation.world.bodies().gravity();
}

double fastest_feed(const Simulation& simulation) {
  double fastest = 0.0;
  if (!simulation.cable_definitions) return fastest;
  for (const CableDef& cable : *simulation.cable_definitions) {
    for (const auto& link : cable.links) {
      const auto* attachment = dynamic_cast<const AttachmentLink*>(link.get());
      if (attachment == nullptr || !attachment->feed_speed) continue;
      fastest = std::max(fastest, std::abs(*attachment->feed_speed));
    }
  }
  return fastest;
}

/// Square of the rate at which rounding moves and turns a body of unit size in a substep [1/s2].
double square_of_rounding(double substep) {
  const double rate = 64.0 * std::numeric_limits<double>::epsilon() / substep;
  return rate * rate;
}

/// Energy of all springs when stretched by the size of the scene, or by one turn [J]: driven bodies
/// can strain any of them.
double full_springs(const Model& model, const std::vector<CableDef>* cables, double size) {
  constexpr double turn = 6.3;  // [rad]
  const double way = std::max(size, turn);
  double sum = 0.0;
  const auto add_compliance = [&](double compliance) {
    if (compliance > 0.0) sum += 0.5 * way * way / compliance;
  };
  for (const auto& joint : model.joints) {
    sum += 0.5 * way * way * extreme_setting(*joint, "stiffness", false);
    add_compliance(extreme_setting(*joint, "compliance", true));
  }
  for (const ColliderDef& collider : model.colliders) add_compliance(collider.compliance);
  if (cables == nullptr) return sum;
  for (const CableDef& cable : *cables) {
    add_compliance(cable.compliance.value_or(0.0));
    sum += 0.5 * cable.axial_stiffness.value_or(0.0) * way;
    if (!cable.tension_table.empty()) sum += cable.tension_table.back() * way;
  }
  return sum;
}

}  // namespace

EnergyWatch::EnergyWatch(const Simulation& simulation)
    : sources_(simulation),
      passive_(is_passive(simulation.world.model(), simulation.cable_definitions
                                                        ? *simulation.cable_definitions
                                                        : std::vector<CableDef>())),
      keeps_(simulation.supervisor == nullptr &&
             keeps_energy(simulation.world.model(), simulation.cable_definitions
                                                        ? *simulation.cable_definitions
                                                        : std::vector<CableDef>())) {
  const BodySet& bodies = simulation.world.bodies();
  size_ = bodies.scale();
  double inertia = 0.0;
  for (int i = 0; i < bodies.count(); ++i) {
    const BodyProperties& body = bodies[i];
    if (!yields(body.mobility)) continue;
    mass_ += body.mass;
    inertia += body.inertia.norm() + body.axis_inertia;
    const Vector3 load = body.mass * bodies.gravity() + bodies.definition(i).force;
    weight_ += load.norm() * size_;
  }
  if (simulation.cable_definitions) {
    const std::vector<CableReport> reports = simulation.cable_reports();
    for (std::size_t c = 0; c < reports.size(); ++c) {
      const CableDef& cable = (*simulation.cable_definitions)[c];
      if (cable.axial_inertia) mass_ += cable.linear_density * reports[c].total_length;
    }
  }
  const StepSettings& step = simulation.world.model().step;
  still_ = 0.5 * (mass_ * size_ * size_ + inertia) * square_of_rounding(step.dt / step.substeps);
  if (step.integrator == IntegratorKind::xpbd) {
    for (int i = 0; i < bodies.count(); ++i) {
      if (bodies[i].mobility == Mobility::free && !bodies[i].isotropic) tumbling_.push_back(i);
    }
  }
  springs_ = full_springs(simulation.world.model(), simulation.cable_definitions.get(), size_);
  begin(simulation);
}

void EnergyWatch::begin(const Simulation& simulation) {
  const State& state = simulation.world.state();
  steps_ = state.steps;
  start_ = energy_ = simulation.world.energy();
  vivid_ = energy_.kinetic + energy_.elastic;
  reference_ = highest_ = block_ = block_before_ = energy_.total();
  highest_time_ = state.time;
  in_block_ = 0;
  gain_ = lost_ = most_lost_ = worked_ = exchanged_ = 0.0;
  gravity_ = gravity_of(simulation);
  taut_steps_ = 0;
  events_ = simulation.cables == nullptr ? 0 : simulation.cables->events().size();
  integrator_ = IntegratorLoss();
  integrator_.observe(simulation.world, energy_.total(), fallbacks_);
  put_in_ = vivid_ + weight_ + most_put_in(simulation);
  looked_at_ = std::abs(energy_.total()) + vivid_;
}

void EnergyWatch::observe(const Simulation& simulation, const StepStatistics& statistics) {
  const State& state = simulation.world.state();
  if (state.steps != steps_ + 1) {
    begin(simulation);
    return;
  }
  if (has_lost_rope(simulation)) {
    const double gain = gain_;
    begin(simulation);
    gain_ = gain;
    return;
  }
  if (passive_ && has_controls(simulation)) passive_ = false;
  steps_ = state.steps;
  const double before = energy_.total();
  energy_ = simulation.world.energy();
  const double total = energy_.total();
  vivid_ = std::max(vivid_, energy_.kinetic + energy_.elastic);
  if (total > highest_) {
    highest_ = total;
    highest_time_ = state.time;
  }
  fallbacks_ += statistics.integrator_fallbacks;
  integrator_.observe(simulation.world, total, fallbacks_);
  const SourceWork::Work work = take_work(simulation, statistics);
  suspicious_ = work.known && total - before - work.most > suspicious_share * scale() + rounding();
  follow_gain(before, work, state.time);
  if (!passive_) follow_input(simulation, statistics);
  if (keeps_) follow_loss(simulation, before - total, work);
}

bool EnergyWatch::has_lost_rope(const Simulation& simulation) const {
  if (simulation.cables == nullptr || !simulation.cable_definitions) return false;
  const std::vector<CableEvent>& events = simulation.cables->events();
  return std::any_of(events.begin() + static_cast<std::ptrdiff_t>(std::min(events_, events.size())),
                     events.end(), [&](const CableEvent& event) {
                       if (event.kind != CableEvent::Kind::cut) return false;
                       const auto& cables = *simulation.cable_definitions;
                       return std::any_of(cables.begin(), cables.end(), [&](const CableDef& cable) {
                         return cable.name == event.cable && cable.linear_density > 0.0;
                       });
                     });
}

SourceWork::Work EnergyWatch::take_work(const Simulation& simulation,
                                        const StepStatistics& statistics) {
  SourceWork::Work work;
  if (sources_.any()) {
    sources_.observe(simulation);
    work = sources_.take(simulation, statistics);
  }
  work.most += std::abs(statistics.external_work);
  // A change of gravity changes the potential energy, and a change of a compliance the elastic one.
  const Vector3 gravity = gravity_of(simulation);
  const auto& cables = simulation.world.state().controls.cables;
  if (gravity != gravity_ || cables.any()) work.known = false;
  gravity_ = gravity;
  exchanged_ += work.most;
  return work;
}

double EnergyWatch::scale() const { return vivid_ + exchanged_; }

bool EnergyWatch::tumbles(const World& world) const {
  constexpr double far = 0.05;  // [rad]
  const StepSettings& step = world.model().step;
  const double most = far * step.substeps / step.dt;
  return std::ranges::any_of(tumbling_, [&](int body) {
    return world.state().bodies[at(body)].angular_velocity.norm() > most;
  });
}

double EnergyWatch::rounding() const {
  // Rounding of potential energies, at the heights of the scene and at the present ones.
  return still_ +
         1e-12 * (scale() + weight_ + std::abs(start_.potential) + std::abs(energy_.potential));
}

void EnergyWatch::follow_gain(double before, const SourceWork::Work& work, double time) {
  const double total = energy_.total();
  reference_ += work.known ? work.most : std::max(total - before, 0.0);
  if (total - reference_ > gain_) {
    gain_ = total - reference_;
    gain_time_ = time;
  }
  block_ = std::max(block_, total);
  if (++in_block_ < block_steps) return;
  reference_ = std::min(reference_, std::max(block_, block_before_));
  block_before_ = block_;
  block_ = total;
  in_block_ = 0;
}

void EnergyWatch::follow_loss(const Simulation& simulation, double loss,
                              const SourceWork::Work& work) {
  const CableSystem* cables = simulation.cables;
  const bool is_taut =
      cables == nullptr || cables->all_pull(simulation.world.state().features.back());
  const std::size_t events = cables == nullptr ? 0 : cables->events().size();
  // A span that becomes taut within a step of `xpbd` is stopped only at the end of the next step.
  constexpr int settled = 2;
  const bool smooth =
      is_taut && taut_steps_ >= settled && events == events_ && !tumbles(simulation.world);
  taut_steps_ = is_taut ? taut_steps_ + 1 : 0;
  events_ = events;
  if (!smooth || !work.known) return;
  // A source takes no more energy than the bound of its work.
  loss = loss > 0.0 ? std::max(loss - work.most, 0.0) : loss;
  lost_ += loss;
  suspicious_ = suspicious_ || loss > suspicious_share * scale() + rounding();
  if (loss <= most_lost_) return;
  most_lost_ = loss;
  most_lost_time_ = simulation.world.state().time;
}

void EnergyWatch::follow_input(const Simulation& simulation, const StepStatistics& statistics) {
  worked_ += std::abs(statistics.external_work);
  const double now = std::abs(energy_.total()) + energy_.kinetic + energy_.elastic;
  // Written so that NaN counts as large.
  if (now <= 2.0 * looked_at_) return;
  looked_at_ = now;
  put_in_ = std::max(put_in_,
                     start_.kinetic + start_.elastic + weight_ + worked_ + most_put_in(simulation));
  suspicious_ = suspicious_ || highest_ - start_.total() > put_in_;
}

double EnergyWatch::most_put_in(const Simulation& simulation) const {
  if (passive_) return 0.0;
  const World& world = simulation.world;
  const State& state = world.state();
  double fastest = fastest_feed(simulation);
  double fastest_spin = 0.0;
  double inertia = 0.0;  // of all bodies, about their own centres
  double work = 0.0;
  for (int i = 0; i < world.bodies().count(); ++i) {
    const BodyProperties& body = world.bodies()[i];
    const BodyState& now = state.bodies[at(i)];
    const double spin = now.angular_velocity.norm();
    // Includes mounted rotors, which rows drive.
    const DriveKind drive = world.bodies().definition(i).drive;
    const bool led = body.mobility == Mobility::kinematic || drive == DriveKind::speed ||
                     drive == DriveKind::angle;
    inertia += body.inertia.norm() + body.axis_inertia;
    if (led) {
      fastest = std::max(fastest, now.velocity.norm() + spin * size_);
      fastest_spin = std::max(fastest_spin, spin);
    }
    // The state does not count the angle of a freely turning body.
    const double angle = std::max(std::abs(now.angle), spin * state.time);
    work += world.bodies().definition(i).torque.norm() * angle;
    if (drive == DriveKind::torque) {
      work += std::abs(BodyDrive(body, state.controls, i).at(state.time)) * angle;
    }
  }
  for (const JointReport& joint : joint_reports(world)) {
    for (const JointCoordinateReport& coordinate : joint.coordinates) {
      if (coordinate.drive_target == 0.0 && coordinate.drive_force == 0.0) continue;
      const double rate = std::abs(coordinate.rate);
      fastest = std::max(fastest, rate * (coordinate.angle ? size_ : 1.0));
      if (coordinate.angle) fastest_spin = std::max(fastest_spin, rate);
      work += std::abs(coordinate.drive_force * coordinate.value);
    }
  }
  if (fastest > 0.0 || fastest_spin > 0.0) work += springs_;
  return 0.5 * (mass_ * fastest * fastest + inertia * fastest_spin * fastest_spin) + work;
}

std::optional<CertificateItem> EnergyWatch::finding() const {
  const double floor = rounding();
  // As in single substeps, a millionth of the energy of the weights counts as moving: a machine
  // almost at rest creeps within the solver's tolerance.
  const double least = std::max(scale(), 1e-6 * weight_);
  CertificateItem item{
      CertificateItem::Kind::energy, "the whole run", 0.0, "J", least, 0.0, gain_time_, {}};
  const auto worse = [&](double value, double over, double time) {
    const double excess = value - floor;
    if (!(excess > 0.0)) return;
    const double relative = over > 0.0 ? excess / over : 1e300;
    if (!(relative > item.relative)) return;
    item.value = value;
    item.scale = over;
    item.relative = relative;
    item.time = time;
  };
  worse(gain_, least, gain_time_);
  if (keeps_) {
    worse(lost_ - 2.0 * std::max(integrator_.taken(), 0.0), least, most_lost_time_);
  }
  const double grown = highest_ - start_.total();
  if (grown > most_growth * put_in_) worse(grown, put_in_, highest_time_);
  if (!passive_ && item.relative == 0.0) return std::nullopt;
  return item;
}

}  // namespace sheave::certify
