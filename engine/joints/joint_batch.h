#pragma once
// The loop that all joint types share. A joint type supplies a kernel, one object per joint:
//
//   struct Kernel {
//     static constexpr int row_count;                                  // rows per joint
//     void evaluate(const Substep&, int row, Row& row) const;          // C, gradient, bounds
//   };

#include <algorithm>
#include <string>
#include <utility>

#include "engine/constraint_batch.h"
#include "engine/substep.h"

namespace sheave {

/// All joints of one type. State: reals = generalised force per row [N or N m], joint by joint, of
/// the last substep, along the row's gradient.
template <class Kernel>
class JointBatch final : public ConstraintBatch {
 public:
  JointBatch(std::string name, std::vector<Kernel> joints)
      : name_(std::move(name)), joints_(std::move(joints)) {
    multipliers_.resize(joints_.size() * Kernel::row_count);
    acted_.resize(multipliers_.size());
  }

  [[nodiscard]] std::string_view name() const override { return name_; }
  [[nodiscard]] FeatureState initial_state() const override {
    return {std::vector<double>(multipliers_.size(), 0.0), {}};
  }
  [[nodiscard]] int row_count() const override { return static_cast<int>(multipliers_.size()); }

  void begin(const Substep& /*substep*/, const FeatureState& state) override {
    std::fill(multipliers_.begin(), multipliers_.end(), 0.0);
    for (std::size_t i = 0; i < multipliers_.size(); ++i) acted_[i] = state.reals[i] != 0.0 ? 1 : 0;
  }

  double sweep(Substep& substep) override {
    double correction = 0.0;
    auto multiplier = multipliers_.begin();
    Row row;
    for (const Kernel& joint : joints_) {
      for (int i = 0; i < Kernel::row_count; ++i) {
        row.clear();
        joint.evaluate(substep, i, row);
        correction = std::max(correction, solve_row(row, substep.h, *multiplier++, substep.moving));
      }
    }
    return correction;
  }

  void linearise(Substep& substep, std::vector<Row>& rows) override {
    int index = 0;
    for (const Kernel& joint : joints_) {
      for (int i = 0; i < Kernel::row_count; ++i) {
        Row& row = rows.emplace_back();
        joint.evaluate(substep, i, row);
        row.index = index++;
        row.active = acted_[static_cast<std::size_t>(row.index)] != 0;
      }
    }
  }
  [[nodiscard]] std::span<double> multipliers() override { return multipliers_; }

  void finish(Substep& substep, FeatureState& next) override {
    const double inverse_square = 1.0 / (substep.h * substep.h);
    for (std::size_t i = 0; i < multipliers_.size(); ++i) {
      next.reals[i] = multipliers_[i] * inverse_square;
    }
  }

  [[nodiscard]] double elastic_energy(const BodySet& bodies, const State& state,
                                      const FeatureState& /*own*/) const override {
    if (std::none_of(joints_.begin(), joints_.end(),
                     [](const Kernel& joint) { return joint.compliance > 0.0; })) {
      return 0.0;
    }
    const Substep now(bodies, state, 1.0, 1);
    double energy = 0.0;
    Row row;
    for (const Kernel& joint : joints_) {
      for (int i = 0; i < Kernel::row_count; ++i) {
        row.clear();
        joint.evaluate(now, i, row);
        const bool active =
            !(row.value > 0.0 && row.lower == 0.0) && !(row.value < 0.0 && row.upper == 0.0);
        if (row.compliance > 0.0 && active) {
          energy += 0.5 * row.value * row.value / row.compliance;
        }
      }
    }
    return energy;
  }

 private:
  std::string name_;
  std::vector<Kernel> joints_;
  // Scratch of a substep.
  std::vector<double> multipliers_;
  std::vector<char> acted_;  // whether the row had a force in the last substep
};

}  // namespace sheave
