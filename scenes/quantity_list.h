#pragma once
// Quantities by name, and expressions of them, as numbers of a running simulation.
//
//   QuantityList list(QuantityIndex::of(simulation, texts));
//   for (const std::string& text : texts) errors += list.add(text);
//   std::vector<double> values(list.size());
//   list.sample(simulation, values);

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "scenes/expression_list.h"
#include "scenes/observables.h"
#include "scenes/scene_values.h"

namespace sheave {

/// Looks up the observables of a model, its parameters and its settings by name.
class QuantityIndex final : public QuantityNames {
 public:
  /// All observables and settings of a simulation.
  explicit QuantityIndex(const Simulation& simulation,
                         ObservableSet::Extent extent = ObservableSet::Extent::everything);
  explicit QuantityIndex(const Scene& scene,
                         ObservableSet::Extent extent = ObservableSet::Extent::everything);
  /// Finds `texts`; without settings and observables on request if they need none.
  static std::shared_ptr<const QuantityIndex> of(const Simulation& simulation,
                                                 std::span<const std::string> texts);
  static std::shared_ptr<const QuantityIndex> of(const Scene& scene,
                                                 std::span<const std::string> texts);
  QuantityIndex(const QuantityIndex&) = delete;
  QuantityIndex& operator=(const QuantityIndex&) = delete;

  [[nodiscard]] const ObservableSet& set() const { return set_; }
  [[nodiscard]] Result<Expression> compile(std::string_view text) const {
    return Expression::compile(text, *this);
  }

  [[nodiscard]] std::optional<int> find(std::string_view name) const override;
  [[nodiscard]] std::size_t longest() const override { return longest_; }
  [[nodiscard]] Unit unit(int index) const override { return Unit(set_.unit(index)); }
  [[nodiscard]] std::optional<ExpressionNumber> setting(std::string_view pointer) const override;
  [[nodiscard]] std::string fault(std::string_view name) const override;

 private:
  void index_names();

  ObservableSet set_;
  std::optional<SceneValues> settings_;  // copied, because an index outlives moves of a simulation
  std::unordered_map<std::string_view, int> indices_;  // of the names in set_
  std::size_t longest_ = 0;
};

/// Whether numbers are taken at single moments, or along a run from its start. Statistics over time
/// need a run.
enum class Taken { at_moments, along_run };

/// Numbers to take from a simulation at once. Each observable in them is evaluated once.
class QuantityList {
 public:
  explicit QuantityList(std::shared_ptr<const QuantityIndex> index, Taken taken = Taken::at_moments)
      : index_(std::move(index)), taken_(taken) {}

  /// Appends the name of a quantity or an expression (scenes/expression.h).
  [[nodiscard]] Errors add(std::string_view text);
  /// Appends an expression that index() has compiled from `text`. An error where it has a statistic
  /// over time and the numbers are taken at moments.
  [[nodiscard]] Errors add(Expression expression, std::string_view text);
  /// Appends the observable at this index of the set.
  void add(int observable);

  [[nodiscard]] std::size_t size() const { return list_.size(); }
  [[nodiscard]] const QuantityIndex& index() const { return *index_; }
  /// The name or the expression, as it was added.
  [[nodiscard]] const std::string& text(std::size_t i) const;
  [[nodiscard]] std::string unit(std::size_t i) const;
  /// Whether it is defined before the first step: all its quantities are.
  [[nodiscard]] bool known_at_start(std::size_t i) const { return known_[i].at_start; }
  /// Whether a state alone determines it: all its quantities.
  [[nodiscard]] bool follows_from_state(std::size_t i) const { return known_[i].from_state; }

  /// The values, in the order of the list. `simulation` must have the model of the index.
  void sample(const Simulation& simulation, std::span<double> values) const;
  /// The same, with NaN before the first step for those that are not known_at_start().
  void observe(const Simulation& simulation, std::span<double> values) const;

  /// Number of statistics over time in the list.
  [[nodiscard]] std::size_t course_count() const { return list_.course_count(); }
  /// The values along a run. To be called at its start and after each step, with the same
  /// course_count() courses, which begin with default values.
  void follow(const Simulation& simulation, std::span<Course> courses,
              std::span<double> values) const;

 private:
  void evaluate(const Simulation& simulation, const ExpressionMoment* moment,
                std::span<double> values) const;
  struct Known {
    bool at_start = true;
    bool from_state = true;
  };

  std::shared_ptr<const QuantityIndex> index_;
  Taken taken_;
  ExpressionList list_;
  std::vector<Known> known_;  // of each entry
};

}  // namespace sheave
