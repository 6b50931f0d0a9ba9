#include "scenes/observables.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>

#include <fmt/format.h>

#include "engine/joint_report.h"
#include "scenes/suggestion.h"

namespace sheave {
namespace {

constexpr std::array<Quantity, 14> body_quantities{{
    {"x", "m", "position of the body frame's origin"},
    {"y", "m", "the same"},
    {"z", "m", "the same"},
    {"qw", "", "orientation"},
    {"qx", "", "the same"},
    {"qy", "", "the same"},
    {"qz", "", "the same"},
    {"vx", "m/s", "velocity of the body frame's origin"},
    {"vy", "m/s", "the same"},
    {"vz", "m/s", "the same"},
    {"wx", "rad/s", "angular velocity"},
    {"wy", "rad/s", "the same"},
    {"wz", "rad/s", "the same"},
    {"angle", "rad", "angle turned about the axis: planar bodies and rotors"},
}};
constexpr std::array<Quantity, 3> span_quantities{{
    {"tension", "N", "of the free span that begins at a link, counted from 0"},
    {"length", "m", "the same"},
    {"rest_length", "m", "the same"},
}};
constexpr std::array<Quantity, 9> link_quantities{{
    {"stored_length", "m", "cable on link k, counted from 0"},
    {"wrap_angle", "rad", "the angle that it covers; of a pinhole the angle of deflection"},
    {"slip", "m", "cable that has slid over the link, forwards"},
    {"entry_x", "m", "where the cable meets the link"},
    {"entry_y", "m", "the same"},
    {"entry_z", "m", "the same"},
    {"exit_x", "m", "where the cable leaves the link"},
    {"exit_y", "m", "the same"},
    {"exit_z", "m", "the same"},
}};
constexpr std::array<Quantity, 5> cable_quantities{{
    {"length_error", "", "relative error of the length invariant"},
    {"total_length", "m", "rest lengths and stored lengths together"},
    {"wraps", "", "number of wrappable bodies that the cable lies on"},
    {"wrapped_length", "m", "cable on these bodies"},
    {"cut", "", "1 when the cable has been cut or has broken, 0 before"},
}};
constexpr std::array<Quantity, 9> joint_quantities{{
    {"force", "N", "size of the joint's force on body_b in the last substep"},
    {"fx", "N", "its parts along the axes of the world"},
    {"fy", "N", "the same"},
    {"fz", "N", "the same"},
    {"torque", "N m", "size of its torque about body_b's anchor"},
    {"tx", "N m", "its parts along the axes of the world"},
    {"ty", "N m", "the same"},
    {"tz", "N m", "the same"},
    {"broken", "", "1 when the joint has broken, 0 before"},
}};
// "<coordinate>" stands for the names that JointDef::coordinates() gives.
constexpr std::array<Quantity, 3> coordinate_quantities{{
    {"<coordinate>", "m, rad",
     "what the joint leaves free, since time 0, angles with all turns: extension (distance), twist "
     "and swing (ball with an axis), angle (hinge, plane), travel (slider), travel and angle "
     "(cylindrical, rack), angle_a and angle_b (universal, gear)"},
    {"<coordinate>_rate", "m/s, rad/s", "how fast it changes"},
    {"drive_force", "N, N m",
     "of its drive; <coordinate>_drive_force where a joint has two coordinates"},
}};
constexpr std::array<Quantity, 4> energy_quantities{{
    {"kinetic", "J", "of the whole scene"},
    {"potential", "J", "the same"},
    {"elastic", "J", "the same"},
    {"total", "J", "the same"},
}};
constexpr int tension = 0;      // in span_quantities
constexpr int broken = 8;       // in joint_quantities
constexpr int drive_force = 2;  // in coordinate_quantities

// Comparing a word with more names than this takes longer than a user waits for a hint.
constexpr std::size_t most_quantities = 100'000;

constexpr std::array<QuantityGroup, 7> groups{{
    {"<body>.", body_quantities},
    {"<cable>.<span>.", span_quantities},
    {"<cable>.link<k>.", link_quantities},
    {"<cable>.", cable_quantities},
    {"<joint>.", joint_quantities},
    {"<joint>.", coordinate_quantities},
    {"energy.", energy_quantities},
}};

/// The names of one coordinate's quantities, in the order of coordinate_quantities.
std::array<std::string, 3> coordinate_names(const JointDef& joint,
                                            const JointCoordinateInfo& coordinate) {
  const std::string name(coordinate.name);
  const bool only_one = joint.coordinates().size() == 1;
  return {name, name + "_rate", only_one ? "drive_force" : name + "_drive_force"};
}

}  // namespace

std::string shared_quantity(const JointDef& joint) {
  for (const JointCoordinateInfo& coordinate : joint.coordinates()) {
    for (const std::string& name : coordinate_names(joint, coordinate)) {
      const auto is_it = [&](const Quantity& quantity) { return quantity.name == name; };
      if (std::any_of(body_quantities.begin(), body_quantities.end(), is_it)) return name;
    }
  }
  return "";
}

std::span<const QuantityGroup> quantity_groups() { return groups; }

/// Evaluates observables of one moment. What several of them share is computed once, when first
/// asked for; asking in the order of the set therefore visits each body once.
class ObservableSet::Sampler {
 public:
  explicit Sampler(const Simulation& simulation) : simulation_(simulation) {}

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
      case Group::energy:
        return energy(source.quantity);
    }
    return 0.0;
  }

 private:
  static double of_span(const SpanReport& span, int quantity) {
    if (quantity == tension) return span.tension;
    return quantity == 1 ? span.length : span.rest_length;
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
        return std::accumulate(
            cable.wraps.begin(), cable.wraps.end(), 0.0,
            [](double sum, const WrapReport& wrap) { return sum + wrap.link.stored_length; });
      default:
        return cable.cut ? 1.0 : 0.0;
    }
  }
  static double of_joint(const JointReport& joint, int quantity) {
    if (quantity == broken) return joint.broken_at ? 1.0 : 0.0;
    const Vector3& vector = quantity < 4 ? joint.force : joint.torque;
    const int part = quantity % 4;  // its size, then x, y, z
    return part == 0 ? vector.norm() : vector[part - 1];
  }
  static double of_coordinate(const JointCoordinateReport& coordinate, int quantity) {
    if (quantity == drive_force) return coordinate.drive_force;
    return quantity == 0 ? coordinate.value : coordinate.rate;
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
  const CableReport& cable(int index) {
    if (reports_.empty()) reports_ = simulation_.cable_reports();
    return reports_[static_cast<std::size_t>(index)];
  }
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
  int body_ = -1;  // whose values are in body_values_
  std::array<double, 14> body_values_{};
  std::vector<CableReport> reports_;
  std::optional<JointReader> joints_;
  int joint_ = -1;  // whose report is in joint_report_
  JointReport joint_report_;
  std::optional<Energy> energy_;
};

ObservableSet::ObservableSet(const Simulation& simulation) {
  add_time();
  add_bodies(simulation.world.model());
  const std::vector<CableReport> reports = simulation.cable_reports();
  for (std::size_t i = 0; i < reports.size(); ++i) {
    add_cable(reports[i].name, static_cast<int>(i), static_cast<int>(reports[i].spans.size()),
              static_cast<int>(reports[i].links.size()));
  }
  add_joints(simulation.world.model());
  add_energies();
}

ObservableSet::ObservableSet(const Model& model, const std::vector<CableDef>& cables) {
  add_time();
  add_bodies(model);
  for (std::size_t i = 0; i < cables.size(); ++i) {
    add_cable(cables[i].name, static_cast<int>(i), cables[i].span_count(),
              static_cast<int>(cables[i].links.size()));
  }
  add_joints(model);
  add_energies();
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

void ObservableSet::add_cable(std::string_view name, int entity, int spans, int links) {
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
      const auto names = coordinate_names(joint, coordinates[static_cast<std::size_t>(k)]);
      for (int q = 0; q < static_cast<int>(names.size()); ++q) {
        add(fmt::format("{}.{}", joint.name, names[static_cast<std::size_t>(q)]),
            {Group::coordinate, i, k, q});
      }
    }
  }
}

void ObservableSet::add_energies() {
  for (int q = 0; q < static_cast<int>(energy_quantities.size()); ++q) {
    add(fmt::format("energy.{}", energy_quantities[static_cast<std::size_t>(q)].name),
        {Group::energy, 0, 0, q});
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
      return source.quantity != tension;
    case Group::joint:
      return source.quantity == broken;
    case Group::coordinate:
      return source.quantity != drive_force;
    default:
      return true;
  }
}

void ObservableSet::sample(const Simulation& simulation, std::vector<double>& values) const {
  values.resize(sources_.size());
  Sampler sampler(simulation);
  for (std::size_t i = 0; i < sources_.size(); ++i) values[i] = sampler.value(sources_[i]);
}

void ObservableSet::sample(const Simulation& simulation, std::span<const int> indices,
                           std::span<double> values) const {
  Sampler sampler(simulation);
  for (std::size_t i = 0; i < indices.size(); ++i) {
    values[i] = sampler.value(sources_[static_cast<std::size_t>(indices[i])]);
  }
}

}  // namespace sheave
