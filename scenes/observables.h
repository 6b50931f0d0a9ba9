#pragma once
// Every number of a running simulation that has a name: the columns of a CSV file, and what the
// checks of a scene refer to.
//
// t, the time, and what quantity_groups() lists, e.g. weight.vy, rope.1.tension, rope.link0.slip,
// door.angle, energy.total.

#include <algorithm>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cable/simulation.h"
#include "engine/result.h"

namespace sheave {

/// The last part of a name, and what it stands for.
struct Quantity {
  std::string_view name;
  std::string_view unit;  ///< empty: a pure number
  std::string_view help;  ///< "the same": as the one before
};

/// Quantities whose names begin alike.
struct QuantityGroup {
  std::string_view prefix;  ///< e.g. "<body>."
  std::span<const Quantity> quantities;
};

/// All of them but the time, for the documentation.
[[nodiscard]] std::span<const QuantityGroup> quantity_groups();
/// Those that are no columns unless they are asked for: they cost more than to look them up.
[[nodiscard]] std::span<const QuantityGroup> requested_quantity_groups();

/// A quantity of this joint that this body has too, so that they cannot have the same name; empty
/// if there is none.
[[nodiscard]] std::string shared_quantity(const JointDef& joint, const BodyDef& body);

/// The observables of one model, in a fixed order: time, bodies, cables, joints, energies; then
/// those on request.
class ObservableSet {
 public:
  /// Which of them a set has: making a name takes time, and most runs need none of those on
  /// request.
  enum class Extent { columns, everything };

  explicit ObservableSet(const Simulation& simulation, Extent extent = Extent::everything);
  /// The same for what a simulation would be made from.
  ObservableSet(const Model& model, const std::vector<CableDef>& cables,
                Extent extent = Extent::everything);

  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  /// How many of names() are columns by default; those on request follow.
  [[nodiscard]] std::size_t default_count() const { return default_count_; }
  [[nodiscard]] bool contains(std::string_view name) const {
    return std::find(names_.begin(), names_.end(), name) != names_.end();
  }
  /// Position of a name in names(); an error suggests a name that is nearly the same.
  [[nodiscard]] Result<int> index_of(std::string_view name) const;
  /// Whether the observable means something before the first step. Forces do not.
  [[nodiscard]] bool known_at_start(int index) const;

  /// The unit of an observable: "N", "rad/s", ...; empty for a pure number. Where the joint's drive
  /// decides, both that it may be ("m, m/s").
  [[nodiscard]] std::string_view unit(int index) const;

  /// Whether a state alone tells it. Forces of bearings and powers take the substep before.
  [[nodiscard]] bool follows_from_state(int index) const;

  /// The values of all that are columns by default, in the order of names(). `simulation` must be
  /// of the model this set was made for.
  void sample(const Simulation& simulation, std::vector<double>& values) const;
  /// The values at `indices` only: costs nothing for bodies and joints that are not asked for, and
  /// cables and energies only if one of them is.
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
    energy,
    // On request.
    momentum,
    bearing,
    drive,
    direction,
    link_friction,
    joint_friction,
    joint_drive,
    scene_momentum,
    power
  };
  struct Source {
    Group group = Group::time;
    int entity = 0;      ///< index of the body, cable or joint
    int item = 0;        ///< index of the span, link or coordinate
    int quantity = 0;    ///< which of the group's names
    bool angle = false;  ///< of coordinates: units have rad for m
  };
  class Sampler;

  void add_bodies(const Model& model);
  void add_cable(std::string_view name, int entity, int spans, int links);
  void add_joints(const Model& model);
  void add(std::string name, Source source);
  void add_time();
  void add_energies();
  void add_requested_bodies(const Model& model);
  void add_requested_cable(std::string_view name, int entity, int spans, int links);
  void add_requested_joints(const Model& model);
  void add_requested_sums();

  std::vector<std::string> names_;
  std::vector<Source> sources_;
  std::size_t default_count_ = 0;
};

}  // namespace sheave
