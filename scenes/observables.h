#pragma once
// All named numbers of a running simulation: the columns of a CSV file, and the quantities of
// checks.
//
// The numbers are the time t and the quantities in quantity_groups(), e.g. weight.vy,
// rope.1.tension, rope.link0.slip, door.angle, biceps.activation, energy.total.

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cable/simulation.h"
#include "engine/result.h"

namespace sheave {

class LoadDef;

/// The last part of a name, and its meaning.
struct Quantity {
  std::string_view name;
  std::string_view unit;  ///< empty: a pure number
  std::string_view help;  ///< "the same": as the quantity before
};

/// Quantities whose names have a common prefix.
struct QuantityGroup {
  std::string_view prefix;  ///< e.g. "<body>."
  std::span<const Quantity> quantities;
};

/// All quantities except the time, for the documentation.
[[nodiscard]] std::span<const QuantityGroup> quantity_groups();
/// Quantities that are columns only on request, because they cost more than a look-up or few machines
/// have them.
[[nodiscard]] std::span<const QuantityGroup> requested_quantity_groups();

/// A quantity that this joint and this body both have, so that they cannot have the same name;
/// empty if there is none.
[[nodiscard]] std::string shared_quantity(const JointDef& joint, const BodyDef& body);

/// The observables of one model in a fixed order: time, bodies, cables, joints, muscles,
/// energies; then those on request.
class ObservableSet {
 public:
  /// The extent of a set. Composing names takes time, and most runs need no observables on request.
  enum class Extent { columns, everything };

  /// Muscles are those of the supervisor of the simulation.
  explicit ObservableSet(const Simulation& simulation, Extent extent = Extent::everything);
  /// The same set for the definitions of a simulation, with the muscles among `loads`.
  ObservableSet(const Model& model, const std::vector<CableDef>& cables,
                std::span<const std::shared_ptr<const LoadDef>> loads = {},
                Extent extent = Extent::everything);

  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  /// Number of names() that are columns by default; those on request follow.
  [[nodiscard]] std::size_t default_count() const { return default_count_; }
  /// Index of a name in names(). The error suggests a similar name.
  [[nodiscard]] Result<int> index_of(std::string_view name) const;
  /// Whether the observable is defined before the first step. Forces are not.
  [[nodiscard]] bool known_at_start(int index) const;

  /// The unit of an observable: "N", "rad/s", ...; empty for a pure number. Both units if the
  /// joint's drive determines it ("m, m/s").
  [[nodiscard]] std::string_view unit(int index) const;

  /// Whether a state alone determines it. Forces of bearings and powers need the substep before.
  [[nodiscard]] bool follows_from_state(int index) const;

  /// The values of all columns by default, in the order of names(). `simulation` must have the
  /// model of this set.
  void sample(const Simulation& simulation, std::vector<double>& values) const;
  /// Only the values at `indices`. Bodies and joints without such a value cost nothing; cables and
  /// energies are evaluated only if one of their values is included.
  void sample(const Simulation& simulation, std::span<const int> indices,
              std::span<double> values) const;

 private:
  enum class Group {
    time,
    body,
    span,
    link,
    cable,
    joint,
    coordinate,
    muscle,
    energy,
    // On request.
    momentum,
    bearing,
    drive,
    direction,
    link_friction,
    groove,
    memory,
    joint_friction,
    joint_drive,
    fibre,
    scene_momentum,
    power
  };
  struct Source {
    Group group = Group::time;
    int entity = 0;      ///< index of the body, cable, joint or muscle
    int item = 0;        ///< index of the span, link or coordinate
    int quantity = 0;    ///< index of the quantity in its group
    bool angle = false;  ///< for coordinates: their unit is rad instead of m
  };
  struct CableParts {
    std::string_view name;
    int spans = 0;
    int links = 0;
    std::vector<int> grooves;  ///< links that are drums with a groove
  };
  class Sampler;

  void add_all(const Model& model, std::span<const CableParts> cables,
               std::span<const std::string> muscles, Extent extent);
  void add_bodies(const Model& model);
  void add_cable(const CableParts& cable, int entity);
  void add_joints(const Model& model);
  void add(std::string name, Source source);
  void add_time();
  void add_muscles(std::span<const std::string> muscles, std::span<const Quantity> quantities,
                   Group group);
  void add_energies();
  void add_requested_bodies(const Model& model);
  void add_requested_cable(const CableParts& cable, int entity);
  void add_requested_joints(const Model& model);
  void add_requested_sums();

  std::vector<std::string> names_;
  std::vector<Source> sources_;
  std::size_t default_count_ = 0;
};

}  // namespace sheave
