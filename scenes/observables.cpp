#include "scenes/observables.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <optional>

#include <fmt/format.h>

#include "cable/reactions.h"
#include "engine/joint_report.h"
#include "scenes/observables_groove.h"
#include "scenes/observables_muscle.h"
#include "scenes/quantities.h"
#include "scenes/suggestion.h"

namespace sheave {
namespace {

constexpr int tension = 0;       // in span_quantities
constexpr int floor_length = 3;  // in requested_span_quantities
constexpr int broken = 8;        // in joint_quantities
constexpr int drive_force = 2;   // in coordinate_quantities

// Comparing a word with more names than this takes longer than a user waits for a suggestion.
constexpr std::size_t most_quantities = 100'000;

/// The names of one coordinate's quantities, in the order of coordinate_quantities.
std::array<std::string, 3> coordinate_names(const JointDef& joint,
                                            const JointCoordinateInfo& coordinate) {
  const std::string name(coordinate.name);
  const bool only_one = joint.coordinates().size() == 1;
  return {name, name + "_rate", only_one ? "drive_force" : name + "_drive_force"};
}

}  // namespace

std::string shared_quantity(const JointDef& joint, const BodyDef& body) {
  if (body.drive != DriveKind::none && joint.coordinates().size() == 1) return "drive_power";
  for (const JointCoordinateInfo& coordinate : joint.coordinates()) {
    for (const std::string& name : coordinate_names(joint, coordinate)) {
      const auto is_it = [&](const Quantity& quantity) { return quantity.name == name; };
      if (std::any_of(body_quantities.begin(), body_quantities.end(), is_it)) return name;
    }
  }
  return "";
}

std::span<const QuantityGroup> quantity_groups() { return quantity_group_table; }
std::span<const QuantityGroup> requested_quantity_groups() { return requested_group_table; }

/// Evaluates observables of one moment. Shared data are computed once, at their first use; in the
/// order of the set each body is visited once.
class ObservableSet::Sampler {
 public:
  explicit Sampler(const Simulation& simulation) : simulation_(simulation), muscles_(simulation) {}

  double value(const Source& source) {
    const auto item = static_cast<std::size_t>(source.item);
    switch (source.group) {
      case Group::time:
        return simulation_.world.state().time;
      case Group::body:
        return body(source.entity)[static_cast<std::size_t>(source.quantity)];
      case Group::span:
        return of_span(cable(source.entity).spans[item], source.quantity);
      case Group::link:
        return of_link(cable(source.entity).links[item], source.quantity);
      case Group::cable:
        return of_cable(cable(source.entity), source.quantity);
      case Group::joint:
        return of_joint(joint(source.entity), source.quantity);
      case Group::coordinate:
        return of_coordinate(joint(source.entity).coordinates[item], source.quantity);
      case Group::muscle:
        return muscles_.value(source.entity, source.quantity);
      case Group::fibre:
        return muscles_.fibre(source.entity, source.quantity, cables());
      case Group::energy:
        return energy(source.quantity);
      case Group::direction: {
        const SpanReport& span = cable(source.entity).spans[item];
        if (source.quantity == floor_length) return span.floored;
        return (span.end - span.start).normalized()[source.quantity];
      }
      case Group::groove:
        return groove_quantity(cable(source.entity).links[item], source.quantity);
      case Group::memory:
        return std::array{
            cable(source.entity).permanent_stretch, cable(source.entity).hysteresis_loss,
            cable(source.entity).floor_loss}[static_cast<std::size_t>(source.quantity)];
      case Group::momentum:
        return part(momentum(simulation_.world, source.entity), source.quantity);
      case Group::scene_momentum:
        return part(momentum(simulation_.world), source.quantity);
      case Group::bearing:
      case Group::drive:
      case Group::link_friction:
      case Group::joint_friction:
      case Group::joint_drive:
      case Group::power:
        return of_reaction(source);
    }
    return 0.0;
  }

 private:
  static double of_span(const SpanReport& span, int quantity) {
    switch (quantity) {
      case tension:
        return span.tension;
      case 1:
        return span.length;
      case 2:
        return span.rest_length;
      case 3:
        return span.tension_at(0.0);
      default:
        return span.tension_at(1.0);
    }
  }
  static double of_link(const LinkReport& link, int quantity) {
    switch (quantity) {
      case 0:
        return link.stored_length;
      case 1:
        return link.wrap_angle;
      case 2:
        return link.slip;
      default:
        return quantity < 6 ? link.entry[quantity - 3] : link.exit[quantity - 6];
    }
  }
  static double of_cable(const CableReport& cable, int quantity) {
    switch (quantity) {
      case 0:
        return cable.length_error;
      case 1:
        return cable.total_length;
      case 2:
        return static_cast<double>(cable.wraps.size());
      case 3:
        return std::accumulate(cable.wraps.begin(), cable.wraps.end(), 0.0,
                               [](double sum, const WrapReport& wrap) {
                                 return sum + wrap.link.stored_length + wrap.link.stored_stretch;
                               });
      default:
        return cable.cut ? 1.0 : 0.0;
    }
  }
  static double of_joint(const JointReport& joint, int quantity) {
    if (quantity == broken) return joint.broken_at ? 1.0 : 0.0;
    const Vector3& vector = quantity < 4 ? joint.force : joint.torque;
    const int part = quantity % 4;  // magnitude, then x, y, z
    return part == 0 ? vector.norm() : vector[part - 1];
  }
  static double of_coordinate(const JointCoordinateReport& coordinate, int quantity) {
    if (quantity == drive_force) return coordinate.drive_force;
    return quantity == 0 ? coordinate.value : coordinate.rate;
  }
  static double part(const Momentum& momentum, int quantity) {
    return quantity < 3 ? momentum.linear[quantity] : momentum.angular[quantity - 3];
  }
  static double size_or_part(const Vector3& vector, int quantity) {
    return quantity == 0 ? vector.norm() : vector[quantity - 1];
  }
  /// NaN before the first substep.
  double of_reaction(const Source& source) {
    if (!asked_reactions_) reactions_ = Reactions::of(simulation_);
    asked_reactions_ = true;
    if (!reactions_) return std::numeric_limits<double>::quiet_NaN();
    const int quantity = source.quantity;
    switch (source.group) {
      case Group::bearing: {
        const BearingReaction bearing = reactions_->bearing(source.entity);
        return size_or_part(quantity < 4 ? bearing.force : bearing.torque, quantity % 4);
      }
      case Group::drive: {
        const DriveReaction drive = reactions_->drive(source.entity);
        return quantity == 0 ? drive.torque : quantity == 1 ? drive.power : drive.error;
      }
      case Group::link_friction:
        return reactions_->link_friction(source.entity, source.item);
      case Group::joint_friction:
        return reactions_->joint_friction(source.entity);
      case Group::joint_drive:
        if (quantity == 0) return reactions_->drive_power(source.entity, source.item);
        return joint(source.entity).coordinates[static_cast<std::size_t>(source.item)].drive_error;
      default:
        return quantity == 0 ? reactions_->drive_power() : reactions_->friction();
    }
  }
  const std::array<double, 14>& body(int index) {
    if (index == body_) return body_values_;
    body_ = index;
    const World& world = simulation_.world;
    const BodyId id{index};
    const Vector3 x = world.position(id);
    const Quaternion q = world.orientation(id);
    const Vector3 v = world.velocity(id);
    const Vector3 w = world.angular_velocity(id);
    body_values_ = {x.x(), x.y(),
                    x.z(), q.w(),
                    q.x(), q.y(),
                    q.z(), v.x(),
                    v.y(), v.z(),
                    w.x(), w.y(),
                    w.z(), world.state().bodies[static_cast<std::size_t>(index)].angle};
    return body_values_;
  }
  const std::vector<CableReport>& cables() {
    if (reports_.empty()) reports_ = simulation_.cable_reports();
    return reports_;
  }
  const CableReport& cable(int index) { return cables()[static_cast<std::size_t>(index)]; }
  const JointReport& joint(int index) {
    if (index == joint_) return joint_report_;
    if (!joints_) joints_.emplace(simulation_.world);
    joint_ = index;
    joint_report_ = joints_->report(index);
    return joint_report_;
  }
  double energy(int quantity) {
    if (!energy_) energy_ = simulation_.world.energy();
    const std::array values{energy_->kinetic, energy_->potential, energy_->elastic,
                            energy_->total()};
    return values[static_cast<std::size_t>(quantity)];
  }

  const Simulation& simulation_;
  MuscleSampler muscles_;
  int body_ = -1;  // the body whose values are in body_values_
  std::array<double, 14> body_values_{};
  std::vector<CableReport> reports_;
  std::optional<JointReader> joints_;
  int joint_ = -1;  // the joint whose report is in joint_report_
  JointReport joint_report_;
  std::optional<Energy> energy_;
  bool asked_reactions_ = false;
  std::optional<Reactions> reactions_;
};

ObservableSet::ObservableSet(const Simulation& simulation, Extent extent) {
  const std::vector<CableReport> reports = simulation.cable_reports();
  std::vector<CableParts> cables;
  for (const CableReport& cable : reports) {
    cables.push_back({cable.name, static_cast<int>(cable.spans.size()),
                      static_cast<int>(cable.links.size()), grooved_links(cable)});
  }
  add_all(simulation.world.model(), cables, muscle_names(simulation), extent);
}

ObservableSet::ObservableSet(const Model& model, const std::vector<CableDef>& cables,
                             std::span<const std::shared_ptr<const LoadDef>> loads, Extent extent) {
  std::vector<CableParts> parts;
  for (const CableDef& cable : cables) {
    parts.push_back({cable.name, cable.span_count(), static_cast<int>(cable.links.size()),
                     grooved_links(cable)});
  }
  add_all(model, parts, muscle_names(loads), extent);
}

void ObservableSet::add_all(const Model& model, std::span<const CableParts> cables,
                            std::span<const std::string> muscles, Extent extent) {
  add_time();
  add_bodies(model);
  for (std::size_t i = 0; i < cables.size(); ++i) add_cable(cables[i], static_cast<int>(i));
  add_joints(model);
  add_muscles(muscles, muscle_quantities, Group::muscle);
  add_energies();
  default_count_ = names_.size();
  if (extent == Extent::columns) return;
  add_requested_bodies(model);
  for (std::size_t i = 0; i < cables.size(); ++i) {
    add_requested_cable(cables[i], static_cast<int>(i));
  }
  add_requested_joints(model);
  add_muscles(muscles, fibre_quantities, Group::fibre);
  add_requested_sums();
}

void ObservableSet::add(std::string name, Source source) {
  names_.push_back(std::move(name));
  sources_.push_back(source);
}

void ObservableSet::add_time() { add("t", {Group::time}); }

void ObservableSet::add_bodies(const Model& model) {
  for (int i = 0; i < static_cast<int>(model.bodies.size()); ++i) {
    const std::string& name = model.bodies[static_cast<std::size_t>(i)].name;
    for (int q = 0; q < static_cast<int>(body_quantities.size()); ++q) {
      add(fmt::format("{}.{}", name, body_quantities[static_cast<std::size_t>(q)].name),
          {Group::body, i, 0, q});
    }
  }
}

void ObservableSet::add_cable(const CableParts& cable, int entity) {
  const auto& [name, spans, links, grooves] = cable;
  for (int span = 0; span < spans; ++span) {
    for (int q = 0; q < static_cast<int>(span_quantities.size()); ++q) {
      add(fmt::format("{}.{}.{}", name, span, span_quantities[static_cast<std::size_t>(q)].name),
          {Group::span, entity, span, q});
    }
  }
  for (int link = 0; link < links; ++link) {
    for (int q = 0; q < static_cast<int>(link_quantities.size()); ++q) {
      add(fmt::format("{}.link{}.{}", name, link,
                      link_quantities[static_cast<std::size_t>(q)].name),
          {Group::link, entity, link, q});
    }
  }
  for (int q = 0; q < static_cast<int>(cable_quantities.size()); ++q) {
    add(fmt::format("{}.{}", name, cable_quantities[static_cast<std::size_t>(q)].name),
        {Group::cable, entity, 0, q});
  }
}

void ObservableSet::add_joints(const Model& model) {
  for (int i = 0; i < static_cast<int>(model.joints.size()); ++i) {
    const JointDef& joint = *model.joints[static_cast<std::size_t>(i)];
    for (int q = 0; q < static_cast<int>(joint_quantities.size()); ++q) {
      add(fmt::format("{}.{}", joint.name, joint_quantities[static_cast<std::size_t>(q)].name),
          {Group::joint, i, 0, q});
    }
    const std::span<const JointCoordinateInfo> coordinates = joint.coordinates();
    for (int k = 0; k < static_cast<int>(coordinates.size()); ++k) {
      const JointCoordinateInfo& coordinate = coordinates[static_cast<std::size_t>(k)];
      const auto names = coordinate_names(joint, coordinate);
      for (int q = 0; q < static_cast<int>(names.size()); ++q) {
        add(fmt::format("{}.{}", joint.name, names[static_cast<std::size_t>(q)]),
            {Group::coordinate, i, k, q, coordinate.angle});
      }
    }
  }
}

void ObservableSet::add_muscles(std::span<const std::string> muscles,
                                std::span<const Quantity> quantities, Group group) {
  for (int i = 0; i < static_cast<int>(muscles.size()); ++i) {
    for (int q = 0; q < static_cast<int>(quantities.size()); ++q) {
      add(fmt::format("{}.{}", muscles[static_cast<std::size_t>(i)],
                      quantities[static_cast<std::size_t>(q)].name),
          {group, i, 0, q});
    }
  }
}

void ObservableSet::add_energies() {
  for (int q = 0; q < static_cast<int>(energy_quantities.size()); ++q) {
    add(fmt::format("energy.{}", energy_quantities[static_cast<std::size_t>(q)].name),
        {Group::energy, 0, 0, q});
  }
}

void ObservableSet::add_requested_bodies(const Model& model) {
  for (int i = 0; i < static_cast<int>(model.bodies.size()); ++i) {
    const BodyDef& body = model.bodies[static_cast<std::size_t>(i)];
    const auto add_all = [&](std::span<const Quantity> quantities, Group group) {
      for (int q = 0; q < static_cast<int>(quantities.size()); ++q) {
        add(fmt::format("{}.{}", body.name, quantities[static_cast<std::size_t>(q)].name),
            {group, i, 0, q});
      }
    };
    if (!yields(body.mobility)) continue;
    add_all(momentum_quantities, Group::momentum);
    if (body.mobility != Mobility::rotor) continue;
    add_all(bearing_quantities, Group::bearing);
    if (body.drive != DriveKind::none) add_all(body_drive_quantities, Group::drive);
  }
}

void ObservableSet::add_requested_cable(const CableParts& cable, int entity) {
  const auto& [name, spans, links, grooves] = cable;
  for (int span = 0; span < spans; ++span) {
    for (int q = 0; q < static_cast<int>(requested_span_quantities.size()); ++q) {
      add(fmt::format("{}.{}.{}", name, span,
                      requested_span_quantities[static_cast<std::size_t>(q)].name),
          {Group::direction, entity, span, q});
    }
  }
  for (int link = 0; link < links; ++link) {
    add(fmt::format("{}.link{}.{}", name, link, link_friction_quantities[0].name),
        {Group::link_friction, entity, link, 0});
  }
  for (const int link : grooves) {
    for (int q = 0; q < static_cast<int>(groove_quantities.size()); ++q) {
      add(fmt::format("{}.link{}.{}", name, link,
                      groove_quantities[static_cast<std::size_t>(q)].name),
          {Group::groove, entity, link, q});
    }
  }
  for (int q = 0; q < static_cast<int>(memory_quantities.size()); ++q) {
    add(fmt::format("{}.{}", name, memory_quantities[static_cast<std::size_t>(q)].name),
        {Group::memory, entity, 0, q});
  }
}

void ObservableSet::add_requested_joints(const Model& model) {
  for (int i = 0; i < static_cast<int>(model.joints.size()); ++i) {
    const JointDef& joint = *model.joints[static_cast<std::size_t>(i)];
    const std::span<const JointCoordinateInfo> coordinates = joint.coordinates();
    if (coordinates.empty()) continue;
    add(fmt::format("{}.{}", joint.name, joint_friction_quantities[0].name),
        {Group::joint_friction, i, 0, 0});
    for (int k = 0; k < static_cast<int>(coordinates.size()); ++k) {
      const JointCoordinateInfo& own = coordinates[static_cast<std::size_t>(k)];
      const std::string prefix = coordinates.size() == 1 ? "" : std::string(own.name) + "_";
      for (int q = 0; q < 2; ++q) {
        add(fmt::format("{}.{}{}", joint.name, prefix,
                        joint_drive_quantities[static_cast<std::size_t>(q)].name),
            {Group::joint_drive, i, k, q, own.angle});
      }
    }
  }
}

void ObservableSet::add_requested_sums() {
  for (int q = 0; q < 6; ++q) {
    add(fmt::format("momentum.{}", scene_momentum_quantities[static_cast<std::size_t>(q)].name),
        {Group::scene_momentum, 0, 0, q});
  }
  for (int q = 0; q < 2; ++q) {
    add(fmt::format("power.{}", power_quantities[static_cast<std::size_t>(q)].name),
        {Group::power, 0, 0, q});
  }
}

Result<int> ObservableSet::index_of(std::string_view name) const {
  const auto found = std::find(names_.begin(), names_.end(), name);
  if (found != names_.end()) return static_cast<int>(found - names_.begin());
  Suggestion suggestion(name);
  if (names_.size() <= most_quantities) {
    for (const std::string& candidate : names_) suggestion.consider(candidate);
  }
  const std::string hint =
      suggestion.best().empty()
          ? std::string(
                "; allowed are t, <body>.x, <cable>.<span>.tension, <joint>.force, "
                "energy.total and alike")
          : suggestion.question();
  return Error{"", fmt::format("there is no quantity \"{}\"{}", name, hint)};
}

bool ObservableSet::known_at_start(int index) const {
  const Source& source = sources_[static_cast<std::size_t>(index)];
  switch (source.group) {
    case Group::span:
      return source.quantity == 1 || source.quantity == 2;
    case Group::joint:
      return source.quantity == broken;
    case Group::coordinate:
      return source.quantity != drive_force;
    case Group::muscle:
      return source.quantity != muscle_tension;
    case Group::bearing:
    case Group::drive:
    case Group::link_friction:
    case Group::joint_friction:
    case Group::joint_drive:
    case Group::power:
      return false;
    default:
      return true;
  }
}

bool ObservableSet::follows_from_state(int index) const {
  switch (sources_[static_cast<std::size_t>(index)].group) {
    case Group::bearing:
    case Group::drive:
    case Group::link_friction:
    case Group::joint_friction:
    case Group::joint_drive:
    case Group::power:
      return false;
    default:
      return true;
  }
}

void ObservableSet::sample(const Simulation& simulation, std::vector<double>& values) const {
  values.resize(default_count_);
  Sampler sampler(simulation);
  for (std::size_t i = 0; i < default_count_; ++i) values[i] = sampler.value(sources_[i]);
}

void ObservableSet::sample(const Simulation& simulation, std::span<const int> indices,
                           std::span<double> values) const {
  Sampler sampler(simulation);
  for (std::size_t i = 0; i < indices.size(); ++i) {
    values[i] = sampler.value(sources_[static_cast<std::size_t>(indices[i])]);
  }
}

}  // namespace sheave
