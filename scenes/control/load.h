#pragma once
// Interface of all loads: forces and motions that a scene gives to bodies over time. A new type is
// a file in scenes/control/ and a line in load_registry.cpp.

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cable/cable.h"
#include "cable/cable_report.h"
#include "engine/control_requests.h"
#include "engine/field.h"
#include "engine/instants.h"
#include "engine/result.h"
#include "engine/time_table.h"
#include "engine/vector.h"

namespace sheave {

struct Model;
class World;

/// A vector as a function of time through given points; constant before the first and after the
/// last. Without values it is 0.
class VectorTable {
 public:
  VectorTable() = default;
  VectorTable(const std::vector<double>& times, const std::vector<Vector3>& values,
              Interpolation interpolation);
  [[nodiscard]] Vector3 at(double time) const;
  [[nodiscard]] Vector3 rate(double time) const;  ///< [per s]
  /// Mean from `from` to `to` [s], from < to; exact.
  [[nodiscard]] Vector3 mean(double from, double to) const;
  /// TimeTable::moment() of each component.
  [[nodiscard]] Vector3 moment(double from, double to) const;
  /// The first point later than `time` [s]; no_instant if there is none.
  [[nodiscard]] double next_corner(double time) const;

 private:
  std::array<TimeTable, 3> parts_;
};

class LoadDef;

/// The parts of a scene to which loads refer, and all its loads.
struct LoadScope {
  const Model& model;
  const std::vector<CableDef>& cables;
  std::span<const std::shared_ptr<const LoadDef>> loads = {};
};

/// A muscle at one moment.
struct MuscleState {
  std::string name;
  double activation = 0.0;                          ///< 0 ... 1
  double tension = 0.0;                             ///< over the last substep [N]; 0 at time 0
  std::optional<double> excitation = std::nullopt;  ///< that a control has set, 0 ... 1
};

/// A substep that begins now.
struct LoadSubstep {
  double length = 0.0;  ///< [s]
  /// Velocities may have jumped at its start, so those of before say nothing.
  bool jumped = false;
};

/// The course of a load within a substep, beyond the mean or the motion with which it acts.
struct LoadCourse {
  Vector3 force = Vector3::Zero();   ///< first moment: integral of (middle - t) F [N s2]
  Vector3 torque = Vector3::Zero();  ///< likewise, of the torque in addition to that of the force
  double distance = 0.0;             ///< of a kinematic body from its motion, at most [m]
  double corner = no_instant;        ///< the first one later than the start [s]
};

/// A load at work: its tables are ready.
class ActingLoad {
 public:
  virtual ~ActingLoad() = default;
  ActingLoad(const ActingLoad&) = delete;
  ActingLoad& operator=(const ActingLoad&) = delete;

  /// Number of values in its memory; all are `no_memory` at first.
  [[nodiscard]] virtual std::size_t memory_size() const { return 0; }
  /// The force on the body over a substep.
  [[nodiscard]] virtual PointForce force(const World& world, const LoadSubstep& substep,
                                         std::span<double> memory) const;
  /// Adds the forces of a muscle over a substep, per body; `cables` are the reports of now.
  virtual void pull(const World& world, std::span<const CableReport> cables,
                    const LoadSubstep& substep, std::span<double> memory,
                    std::map<int, PointForce>& forces) const;
  /// The state of a muscle at `time` [s], without its name.
  [[nodiscard]] virtual MuscleState muscle(std::span<const double> memory, double time) const;
  /// The pose and velocity that the kinematic body has at the end of a substep of `h` [s].
  [[nodiscard]] virtual MotionTarget motion(const World& world, double h) const;
  /// Its course in such a substep; of a muscle nothing is known.
  [[nodiscard]] virtual LoadCourse course(const World& world, double h) const;

  static constexpr double no_memory = -1e300;
  /// Place in the memory of a muscle of the excitation that a control sets; no_memory: not set.
  static constexpr std::size_t set_excitation = 0;

 protected:
  ActingLoad() = default;
};

/// Settings of one load; derived types add their own.
class LoadDef {
 public:
  virtual ~LoadDef() = default;

  std::string name;  ///< unique among the loads
  BodyId body;       ///< the body on which it acts; a muscle has none

  static std::span<const Field> common_field_table();
  [[nodiscard]] virtual std::string_view type() const = 0;  ///< key in the registry, e.g. "wind"
  [[nodiscard]] virtual const void* settings() const = 0;   ///< this object, as its derived type
  /// Whether it moves a kinematic body; other loads are forces on bodies that forces can move.
  [[nodiscard]] virtual bool is_motion() const { return false; }
  /// Whether it acts along a cable, on several bodies.
  [[nodiscard]] virtual bool is_muscle() const { return false; }
  /// Indices of the bodies that it moves, for a load without faults.
  [[nodiscard]] virtual std::vector<int> bodies(const LoadScope& scope) const;
  /// Whether it acts at the centre of mass in directions of the world. Only such forces add up.
  [[nodiscard]] virtual bool is_central() const { return true; }
  /// Faults beyond the ranges of the field tables. `path` is the prefix of their paths.
  [[nodiscard]] virtual Errors validate(const LoadScope& scope, const std::string& path) const;
  [[nodiscard]] virtual std::shared_ptr<const ActingLoad> prepare(const LoadScope& scope) const = 0;

 protected:
  LoadDef() = default;
  LoadDef(const LoadDef&) = default;
  LoadDef& operator=(const LoadDef&) = default;

  [[nodiscard]] Error fault(const std::string& path, const std::string& message) const;
  /// Appends a fault unless there are as many values as times, or one value without times. An
  /// empty list of values is allowed.
  void check_table(const std::vector<double>& times, std::size_t values, std::string_view key,
                   const std::string& path, Errors& errors) const;
  /// Appends a fault unless times increase.
  void check_times(const std::vector<double>& times, const std::string& path, Errors& errors) const;
};

/// All load types, in the order of the documentation.
[[nodiscard]] std::span<const TypeEntry<LoadDef>> load_types();

/// Faults of all loads of a scene, one by one and together.
[[nodiscard]] Errors validate_loads(const LoadScope& scope,
                                    std::span<const std::shared_ptr<const LoadDef>> loads);

}  // namespace sheave
