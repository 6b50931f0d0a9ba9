#pragma once
// The loop that all joint types share. A joint type supplies a kernel, one object per joint:
//
//   struct Kernel {
//     static constexpr int lock_count;                 // rows of the rigid constraints
//     static constexpr std::array<JointCoordinateInfo, n> coordinates;  // those in reports first
//     int anchor_body() const;                         // index of body_b, for reports
//     Vector3 anchor(const Substep&) const;            // anchor on body_b, for reports
//     bool elastic() const;                            // whether a lock has compliance
//     void lock(int index, JointTerms&) const;         // sets C, gradient, compliance, bounds
//     void coordinate(int index, JointTerms&) const;   // sets value, gradient; no whole turns
//     // The hold for which all locks are 0 and the coordinates do not change, and its use.
//     JointHold hold_here(const Kernel& defined, const Substep&) const;
//     void apply(const JointHold&);
//     void connect(...);                               // optional: JointFeature::connect()
//   };

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "engine/friction_rows.h"
#include "engine/index.h"
#include "engine/joint.h"
#include "engine/joint_feature.h"
#include "engine/joint_report.h"
#include "engine/joints/joint_breaking.h"
#include "engine/joints/joint_effect.h"
#include "engine/joints/joint_state.h"
#include "engine/joints/joint_terms.h"

namespace sheave {

/// A joint and the effects along its coordinates.
template <class Kernel>
struct JointParts {
  Kernel kernel;
  std::vector<JointEffect> effects;
  bool counts_coordinates = true;  ///< whether the state holds the coordinates; effects need them
  int lock_count = Kernel::lock_count;  ///< fewer if mobilities provide part of the constraint
  bool locks_are_idle = false;  ///< whether mobilities provide all locks, which then need no rows
  bool exact = false;  ///< rows are Row::told, and no part of a gradient is a rounding error
};

/// All joints of one type. Their state: engine/joints/joint_state.h.
template <class Kernel>
class JointBatch final : public JointFeature, public InstantFeature {
 public:
  JointBatch(std::string name, const BodySet& bodies, std::span<const JointDef* const> definitions,
             std::vector<JointParts<Kernel>> joints)
      : name_(std::move(name)), type_(definitions.front()->type()) {
    int row = 0;
    int coordinate = 0;
    for (std::size_t j = 0; j < joints.size(); ++j) {
      Joint joint{joints[j].kernel, row, static_cast<int>(effects_.size()),
                  static_cast<int>(joints[j].effects.size()),
                  joints[j].counts_coordinates ? coordinate : -1};
      const JointDef& definition = *definitions[j];
      joint.lock_count = joints[j].lock_count;
      joint.first_acting = joints[j].locks_are_idle ? joint.lock_count : 0;
      row += joint.lock_count + joint.effect_count;
      if (joint.first_coordinate >= 0) coordinate += coordinate_count;
      joint.exact = joints[j].exact;
      const double sizes =
          std::max(size_of(bodies, definition.body_a), size_of(bodies, definition.body_b));
      joint.size = sizes > 0.0 ? sizes : bodies.scale();
      joint.restricted = !joint.exact && (is_restricted(bodies, definition.body_a) ||
                                          is_restricted(bodies, definition.body_b));
      joint.has_rotor = bodies[bodies.index(definition.body_a)].mount >= 0 ||
                        bodies[bodies.index(definition.body_b)].mount >= 0;
      elastic_ = elastic_ || joint.kernel.elastic() ||
                 std::any_of(joints[j].effects.begin(), joints[j].effects.end(),
                             [](const JointEffect& e) { return e.elastic(); });
      effects_.insert(effects_.end(), joints[j].effects.begin(), joints[j].effects.end());
      joint.reported = static_cast<int>(definition.coordinates().size());
      defined_.push_back(joint.kernel);
      names_.push_back(definition.name);
      definitions_.push_back(&definition);
      breaking_.add(definition.breaking_force, definition.breaking_torque);
      joints_.push_back(joint);
    }
    multipliers_.resize(at(row));
    acted_.resize(multipliers_.size());
    starts_.resize(at(coordinate));
    layout_ = {multipliers_.size(), starts_.size(), joints_.size()};
    intact_.assign(joints_.size(), 1);
  }

  [[nodiscard]] std::string_view name() const override { return name_; }
  [[nodiscard]] FeatureState initial_state() const override { return layout_.initial(); }
  [[nodiscard]] bool has_fixed_size() const override { return false; }
  [[nodiscard]] bool accepts(const FeatureState& state) const override {
    return layout_.accepts(state);
  }
  [[nodiscard]] int row_count() const override { return static_cast<int>(multipliers_.size()); }

  void begin(const Substep& /*substep*/, const FeatureState& state) override {
    std::fill(multipliers_.begin(), multipliers_.end(), 0.0);
    for (std::size_t i = 0; i < multipliers_.size(); ++i) acted_[i] = state.reals[i] != 0.0 ? 1 : 0;
    const auto coordinates = layout_.coordinates_of(state);
    std::copy(coordinates.begin(), coordinates.end(), starts_.begin());
    for (std::size_t j = 0; j < joints_.size(); ++j) intact_[j] = layout_.broken_at(state, j) < 0.0;
    if (!held_ && !layout_.has_holds(state)) return;
    held_ = layout_.has_holds(state);
    for (std::size_t j = 0; j < joints_.size(); ++j) joints_[j].kernel = kernel_of(state, j);
  }

  double sweep(Substep& substep) override {
    double correction = 0.0;
    Row row;
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      if (intact_[j] == 0) continue;
      const Joint& joint = joints_[j];
      const std::span<double> multipliers = std::span(multipliers_).subspan(at(joint.first_row));
      for (int i = joint.first_acting; i < joint.lock_count + joint.effect_count; ++i) {
        evaluate(substep, joint, i, row);
        const double change = row.shares > 1
                                  ? sweep_friction(substep, joint, i, row.shares)
                                  : solve_row(row, substep.h, multipliers[at(i)], substep.moving);
        correction = std::max(correction, change);
        i += std::max(row.shares - 1, 0);
      }
    }
    return correction;
  }

  void linearise(Substep& substep, RowList& rows) override {
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      if (intact_[j] == 0) continue;
      const Joint& joint = joints_[j];
      measured_.coordinate = -1;
      int i = joint.first_acting;
      if (i == 0) i += append_meeting(substep, joint, rows);
      for (; i < joint.lock_count + joint.effect_count; ++i) {
        Row& row = append(substep, joint, i, rows);
        row.index = joint.first_row + i;
        complete(substep, joint, row);
      }
    }
  }
  [[nodiscard]] bool has_all_rows() const override { return true; }
  [[nodiscard]] std::span<double> multipliers() override { return multipliers_; }

  void finish(Substep& substep, FeatureState& next) override {
    const double inverse_square = 1.0 / (substep.h * substep.h);
    for (std::size_t i = 0; i < multipliers_.size(); ++i) {
      next.reals[i] = multipliers_[i] * inverse_square;
    }
    Row row;
    for (const Joint& joint : joints_) {
      if (joint.first_coordinate < 0) continue;
      for (int k = 0; k < coordinate_count; ++k) {
        row.clear();
        next.reals[multipliers_.size() + at(joint.first_coordinate + k)] =
            measure(substep, joint, k, starts_, row);
      }
    }
    if (breaking_.any()) break_joints(substep, next);
  }

  // Joints that break: engine/joints/joint_breaking.h.
  [[nodiscard]] bool watches(const Controls&) const override { return breaking_.any(); }
  void expect(const Expected* /*part*/) override { breaking_.expect(); }
  [[nodiscard]] double margin(const Substep&, const FeatureState&) const override {
    return breaking_.margin();
  }
  [[nodiscard]] bool asks_for_forces(const FeatureState& own) const override;
  void append_forces(std::vector<double>& forces) const override { breaking_.append(forces); }
  void tell_forces(std::span<const double> forces, double length) override {
    breaking_.tell(forces, length);
  }
  bool arise(const BodySet& bodies, double time, FeatureState& own) override;

  [[nodiscard]] double elastic_energy(const BodySet& bodies, const State& state,
                                      const FeatureState& own) const override;

  [[nodiscard]] std::string_view type() const override { return type_; }
  [[nodiscard]] JointReport report(int index, const Substep& now,
                                   const FeatureState& own) const override {
    const auto j = static_cast<std::size_t>(index);
    const Joint joint = joint_of(own, j);
    JointReport report;
    report.name = names_[j];
    report.type = type_;
    if (is_broken(index, own)) report.broken_at = layout_.broken_at(own, j);
    const Wrench wrench = reaction(now, joint, own);
    report.force = wrench.force;
    report.torque = wrench.torque;
    const Wrench friction = reaction(now, joint, own, true);
    report.friction_force = friction.force;
    report.friction_torque = friction.torque;
    append_coordinates(now, joint, own, report);
    if (!report.broken_at) find_errors(now, joint, own, report);
    return report;
  }
  [[nodiscard]] Wrench wrench_of(int index, const Substep& now,
                                 const FeatureState& own) const override {
    return reaction(now, joint_of(own, at(index)), own);
  }
  void release(int index, double time, FeatureState& own) const override {
    if (!is_broken(index, own)) layout_.set_broken(own, at(index), time);
  }
  [[nodiscard]] Result<JointHold> hold_here(int index, const Substep& now,
                                            const FeatureState& own) const override {
    const std::size_t j = at(index);
    JointHold hold = joint_of(own, j).kernel.hold_here(defined_[j], now);
    Joint joint = joints_[j];
    joint.kernel = defined_[j];
    hold.offset += coupling_excess(now, joint, own);
    joint.kernel.apply(hold);
    const std::string fault = fault_of_hold(now, joint, own);
    if (fault.empty()) return hold;
    return Error{"", "joint \"" + names_[j] + "\" cannot be locked in this pose: " + fault};
  }
  void lock(int index, const JointHold& hold, FeatureState& own) const override {
    layout_.set_hold(own, at(index), hold);
    layout_.set_broken(own, at(index), -1.0);
  }
  [[nodiscard]] JointHold hold(int index, const FeatureState& own) const override {
    return layout_.hold(own, at(index));
  }
  [[nodiscard]] bool is_broken(int index, const FeatureState& own) const override {
    return layout_.broken_at(own, at(index)) >= 0.0;
  }
  [[nodiscard]] double measure(int index, int coordinate, const Substep& now,
                               const FeatureState& own, Row& gradient) const override;
  [[nodiscard]] const JointEffect* drive(int index, int coordinate) const override {
    const Joint& joint = joints_[at(index)];
    const int effect = drive_effect(joint, coordinate);
    return effect < 0 ? nullptr : &effects_[at(joint.first_effect + effect)];
  }
  [[nodiscard]] int drive_row(int index, int coordinate) const override {
    const Joint& joint = joints_[at(index)];
    const int effect = drive_effect(joint, coordinate);
    return effect < 0 ? -1 : joint.first_row + joint.lock_count + effect;
  }
  void adopt(const ConstraintBatch& before, const FeatureState& from,
             FeatureState& own) const override {
    const auto* other = dynamic_cast<const JointBatch*>(&before);
    if (other == nullptr) return;
    std::map<const JointDef*, std::size_t> places;
    for (std::size_t k = 0; k < other->joints_.size(); ++k) places[other->definitions_[k]] = k;
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      const auto found = places.find(definitions_[j]);
      if (found == places.end()) continue;
      layout_.adopt(own, part(j), other->layout_, from, other->part(found->second));
    }
  }
  void connect(const Model& model, std::span<const JointPlace> places,
               std::span<const std::unique_ptr<ConstraintBatch>> features) override {
    if constexpr (requires(Kernel & kernel) { kernel.connect(model, places, features); }) {
      for (Kernel& kernel : defined_) kernel.connect(model, places, features);
      for (Joint& joint : joints_) joint.kernel.connect(model, places, features);
    }
  }
  void number_coordinates(std::span<const int> first) override {
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      for (int i = 0; i < joints_[j].effect_count; ++i) {
        JointEffect& effect = effects_[at(joints_[j].first_effect + i)];
        if (!effect.is_drive() || effect.coordinate >= joints_[j].reported) continue;
        effect.control = first[j] + effect.coordinate;
      }
    }
  }

 private:
  static constexpr int coordinate_count = static_cast<int>(Kernel::coordinates.size());
  struct Joint {
    Kernel kernel;
    int first_row = 0;
    int first_effect = 0;
    int effect_count = 0;
    int first_coordinate = -1;  // < 0: none are counted
    int reported = 0;           // number of coordinates in reports; more may be counted
    bool restricted = false;    // whether a body has a restricted mobility
    bool has_rotor = false;     // whether a body is a rotor on another one
    int lock_count = 0;
    int first_acting = 0;  // index of the first row that is needed
    bool exact = false;    // JointParts::exact
    double size = 1.0;     // size of the larger body [m]
  };
  /// The coordinate that was measured last, its value, and the place of a row with its gradient.
  struct Measured {
    int coordinate = -1;
    double value = 0.0;
    std::size_t place = 0;
  };
  [[nodiscard]] JointStateLayout::Part part(std::size_t index) const {
    const Joint& joint = joints_[index];
    return {index, joint.first_row, joint.lock_count + joint.effect_count, joint.first_coordinate,
            coordinate_count};
  }
  /// Size of a body that rows can move [m], else 0.
  static double size_of(const BodySet& bodies, BodyId body) {
    if (body.is_world()) return 0.0;
    const BodyProperties& properties = bodies[bodies.index(body)];
    return yields(properties.mobility) ? properties.size : 0.0;
  }
  static bool is_restricted(const BodySet& bodies, BodyId body) {
    if (body.is_world()) return false;
    const Mobility mobility = bodies[bodies.index(body)].mobility;
    return mobility == Mobility::planar || mobility == Mobility::slider ||
           mobility == Mobility::rotor;
  }
  /// The index of the effect that drives a coordinate; -1: none.
  [[nodiscard]] int drive_effect(const Joint& joint, int coordinate) const {
    for (int i = 0; i < joint.effect_count; ++i) {
      const JointEffect& effect = effects_[at(joint.first_effect + i)];
      if (effect.coordinate == coordinate && effect.control >= 0) return i;
    }
    return -1;
  }
  [[nodiscard]] const JointEffect& effect(const Joint& joint, int row) const {
    return effects_[at(joint.first_effect + row - joint.lock_count)];
  }
  [[nodiscard]] std::span<const double> coordinates(const FeatureState& state) const {
    return layout_.coordinates_of(state);
  }

  /// The kernel as defined, or with the hold of a joint that has been locked.
  [[nodiscard]] Kernel kernel_of(const FeatureState& state, std::size_t joint) const {
    Kernel kernel = defined_[joint];
    if (layout_.has_holds(state)) kernel.apply(layout_.hold(state, joint));
    return kernel;
  }
  /// The joint with its kernel in `state`; `joints_` have the kernels of the last begin().
  [[nodiscard]] Joint joint_of(const FeatureState& state, std::size_t joint) const {
    Joint result = joints_[joint];
    if (held_ || layout_.has_holds(state)) result.kernel = kernel_of(state, joint);
    return result;
  }
  /// The residual of a coupling, beyond its backlash [m or rad].
  double coupling_excess(const Substep& now, const Joint& joint, const FeatureState& own) const;
  /// The reason why the joint cannot be locked; empty if it can.
  std::string fault_of_hold(const Substep& now, const Joint& joint, const FeatureState& own) const;

  /// Returns the value of a coordinate and writes its gradient into `row`; `starts` are the values
  /// at the start of the substep.
  double measure(const Substep& substep, const Joint& joint, int k, std::span<const double> starts,
                 Row& row) const {
    if constexpr (coordinate_count == 0) {
      return 0.0;
    } else {
      JointTerms terms(substep, row, joint.has_rotor);
      joint.kernel.coordinate(k, terms);
      const JointCoordinateInfo& info = Kernel::coordinates[at(k)];
      if (info.measure == JointCoordinateInfo::Measure::pose) return row.value;
      const double expected =
          starts[at(joint.first_coordinate + k)] + substep_change(row, substep.moving);
      if (info.measure == JointCoordinateInfo::Measure::changes) return expected;
      // The number of whole turns is the one nearest to the value that the motion of the substep
      // predicts.
      return row.value + 2.0 * pi * std::round((expected - row.value) / (2.0 * pi));
    }
  }

  /// `row` must be empty.
  void evaluate_at(const Substep& substep, const Joint& joint, int i,
                   std::span<const double> starts, Row& row) const {
    if (i < joint.lock_count) {
      JointTerms terms(substep, row, joint.has_rotor);
      joint.kernel.lock(i, terms);
      return;
    }
    const JointEffect& acting = effect(joint, i);
    double value = measure(substep, joint, acting.coordinate, starts, row);
    if (acting.second >= 0) value = add_second(substep, joint, acting, starts, value, row);
    set_effect(acting, substep, value, starts[at(joint.first_coordinate + acting.coordinate)], row);
  }
  /// Appends the row `i` of a joint. Effects along one coordinate share its measured value.
  Row& append(const Substep& substep, const Joint& joint, int i, RowList& rows) {
    Row& row = rows.emplace_back();
    if (i < joint.lock_count || effect(joint, i).second >= 0) {
      evaluate_at(substep, joint, i, starts_, row);
      return row;
    }
    const JointEffect& acting = effect(joint, i);
    const double start = starts_[at(joint.first_coordinate + acting.coordinate)];
    if (measured_.coordinate == acting.coordinate) {
      const Row& known = rows[measured_.place];
      row.term_count = known.term_count;
      std::copy_n(known.terms.begin(), row.term_count, row.terms.begin());
      row.curved = known.curved;
    } else {
      const double value = measure(substep, joint, acting.coordinate, starts_, row);
      measured_ = {acting.coordinate, value, rows.size() - 1};
    }
    set_effect(acting, substep, measured_.value, start, row);
    return row;
  }
  /// Turns `row`, which belongs to the first coordinate, into that of the sum of two; returns the
  /// sum.
  double add_second(const Substep& substep, const Joint& joint, const JointEffect& acting,
                    std::span<const double> starts, double first, Row& row) const {
    for (RowTerm& term : std::span(row.terms).first(at(row.term_count))) {
      term.linear *= acting.factor;
      term.angular *= acting.factor;
    }
    row.curved = false;
    Row other;
    const double second = measure(substep, joint, acting.second, starts, other);
    for (const RowTerm& term : other.active_terms()) {
      row.add(term.body, acting.second_factor * term.linear, acting.second_factor * term.angular);
    }
    double sum = acting.factor * first + acting.second_factor * second;
    if constexpr (requires { joint.kernel.mesh; }) sum -= joint.kernel.mesh;
    return sum;
  }
  void evaluate(const Substep& substep, const Joint& joint, int i, Row& row) const {
    row.clear();
    evaluate_at(substep, joint, i, starts_, row);
    if (joint.restricted) drop_rounding(row, substep.moving);
  }

  /// Appends the locks by which the anchors coincide in directions of the world; returns how many.
  int append_meeting(const Substep& substep, const Joint& joint, RowList& rows) const {
    int count = 0;
    if constexpr (requires { joint.kernel.meets_along(); }) {
      const Kernel& kernel = joint.kernel;
      if (kernel.direction_count == 0) return 0;
      const Vector3 at_a = kernel.a.position(substep);
      const Vector3 at_b = kernel.b.position(substep);
      for (const Vector3& direction : kernel.meets_along()) {
        Row& row = rows.emplace_back();
        JointTerms terms(substep, row, joint.has_rotor);
        terms.tell();
        terms.set_value(dot(direction, at_a - at_b));
        terms.add_force(kernel.a.body, at_a, direction);
        terms.add_force(kernel.b.body, at_b, -direction);
        terms.set_compliance(kernel.compliance);
        row.index = joint.first_row + count++;
        complete(substep, joint, row);
      }
    }
    return count;
  }
  [[nodiscard]] bool is_of_angles(const Joint& joint, const Row& row) const {
    const int i = row.index - joint.first_row;
    if (i < joint.lock_count) return !row.curved;  // a row without a force
    const JointEffect& acting = effect(joint, i);
    if constexpr (coordinate_count == 0) {
      return false;
    } else {
      const int told = acting.second >= 0 ? acting.second : acting.coordinate;
      return Kernel::coordinates[at(told)].angle;
    }
  }
  void complete(const Substep& substep, const Joint& joint, Row& row) const {
    if (joint.restricted) drop_rounding(row, substep.moving);
    row.active = acted_[at(row.index)] != 0;
    if (is_of_angles(joint, row)) row.lever = joint.size;
    // The bound of a friction row changes from round to round, so the row is not told.
    row.told = (joint.exact || (row.told && !joint.has_rotor)) && row.friction == 0.0;
  }
  /// Sweeps friction in several directions: its `count` rows from `first` on.
  double sweep_friction(Substep& substep, const Joint& joint, int first, int count) {
    std::array<Row, 3> rows;
    for (int k = 0; k < count; ++k) evaluate(substep, joint, first + k, rows[at(k)]);
    return solve_friction(std::span(rows).first(at(count)),
                          std::span(multipliers_).subspan(at(joint.first_row + first)),
                          substep.moving);
  }

  /// The action of the joint on body_b with the forces in `state`, or of its shared friction alone.
  [[nodiscard]] Wrench reaction(const Substep& substep, const Joint& joint,
                                const FeatureState& state, bool friction_alone = false) const;
  void break_joints(const Substep& substep, FeatureState& next);
  void append_coordinates(const Substep& now, const Joint& joint, const FeatureState& own,
                          JointReport& report) const;
  void find_errors(const Substep& now, const Joint& joint, const FeatureState& own,
                   JointReport& report) const;

  std::string name_;
  std::string_view type_;
  std::vector<Joint> joints_;  // their kernels are scratch of a substep
  JointStateLayout layout_;
  std::vector<Kernel> defined_;  // kernels without the holds of locked joints
  std::vector<JointEffect> effects_;
  std::vector<std::string> names_;
  std::vector<const JointDef*> definitions_;  // identify a joint in all worlds that have it
  JointBreaking breaking_;
  bool elastic_ = false;
  // Scratch of a substep.
  std::vector<double> multipliers_;
  std::vector<char> acted_;     // whether the row had a force in the last substep
  std::vector<double> starts_;  // coordinates at the start of the substep
  std::vector<char> intact_;
  Measured measured_;
  bool held_ = false;  // whether a joint has been locked after its release
};

}  // namespace sheave

#include "engine/joints/joint_batch_report.h"
