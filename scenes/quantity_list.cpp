#include "scenes/quantity_list.h"

#include <algorithm>
#include <array>
#include <limits>

#include <fmt/format.h>

#include "scenes/control/scene_supervisor.h"

namespace sheave {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// An index of the columns, or of everything if a text needs more.
template <class Make>
std::shared_ptr<const QuantityIndex> sufficient(std::span<const std::string> texts,
                                                const Make& make) {
  std::shared_ptr<const QuantityIndex> columns = make(ObservableSet::Extent::columns);
  const bool suffices = std::all_of(texts.begin(), texts.end(), [&](const std::string& text) {
    return columns->compile(text).ok();
  });
  if (suffices) return columns;
  return make(ObservableSet::Extent::everything);
}

}  // namespace

QuantityIndex::QuantityIndex(const Simulation& simulation, ObservableSet::Extent extent)
    : set_(simulation, extent) {
  index_names();
  // Names of parameters decide whether a hyphen is a minus.
  const Model& model = simulation.world.model();
  if (extent == ObservableSet::Extent::columns && model.parameters.empty()) return;
  Scene scene;
  if (const auto* own = dynamic_cast<const SceneSupervisor*>(simulation.supervisor.get())) {
    own->append_to(scene);
  }
  scene.model = model;
  scene.cables = *simulation.cable_definitions;
  settings_.emplace(std::move(scene));
}

QuantityIndex::QuantityIndex(const Scene& scene, ObservableSet::Extent extent)
    : set_(scene.model, scene.cables, scene.loads, extent) {
  index_names();
  if (extent == ObservableSet::Extent::columns && scene.model.parameters.empty()) return;
  settings_.emplace(scene);
}

void QuantityIndex::index_names() {
  const std::vector<std::string>& names = set_.names();
  indices_.reserve(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    indices_.emplace(names[i], static_cast<int>(i));
    longest_ = std::max(longest_, names[i].size());
  }
}

std::shared_ptr<const QuantityIndex> QuantityIndex::of(const Simulation& simulation,
                                                       std::span<const std::string> texts) {
  return sufficient(texts, [&](ObservableSet::Extent extent) {
    return std::make_shared<const QuantityIndex>(simulation, extent);
  });
}

std::shared_ptr<const QuantityIndex> QuantityIndex::of(const Scene& scene,
                                                       std::span<const std::string> texts) {
  return sufficient(texts, [&](ObservableSet::Extent extent) {
    return std::make_shared<const QuantityIndex>(scene, extent);
  });
}

std::optional<int> QuantityIndex::find(std::string_view name) const {
  const auto found = indices_.find(name);
  return found == indices_.end() ? std::nullopt : std::optional(found->second);
}

std::optional<ExpressionNumber> QuantityIndex::setting(std::string_view pointer) const {
  if (!settings_) return {};
  Result<ExpressionNumber> found = settings_->find(pointer, *this);
  return found ? std::optional(std::move(*found)) : std::nullopt;
}

std::string QuantityIndex::fault(std::string_view name) const {
  if (settings_ && name.starts_with('/')) {
    const Result<ExpressionNumber> found = settings_->find(name, *this);
    return found ? std::string() : found.errors().front().message;
  }
  const Result<int> index = set_.index_of(name);
  if (index) return {};
  const std::string parameter = settings_ ? settings_->suggestion(name) : std::string();
  return parameter.empty()
             ? index.errors().front().message
             : fmt::format("there is no quantity and no parameter \"{}\"{}", name, parameter);
}

Errors QuantityList::add(std::string_view text) {
  if (const std::optional<int> observable = index_->find(text)) {
    add(*observable);
    return {};
  }
  Result<Expression> expression = index_->compile(text);
  if (!expression) return expression.errors();
  return add(std::move(*expression), text);
}

Errors QuantityList::add(Expression expression, std::string_view text) {
  if (taken_ == Taken::at_moments && expression.course_count() > 0) {
    return {{"", fmt::format("\"{}\" has a statistic over time, and here a quantity has the value "
                             "of one moment; a run has courses: its tables, plots, checks, "
                             "measures, triggers and controllers",
                             text)}};
  }
  Known known;
  for (const int observable : expression.quantities()) {
    known.at_start = known.at_start && index_->set().known_at_start(observable);
    known.from_state = known.from_state && index_->set().follows_from_state(observable);
  }
  known_.push_back(known);
  list_.add(std::move(expression), std::string(text));
  return {};
}

void QuantityList::add(int observable) {
  const ObservableSet& set = index_->set();
  known_.push_back({set.known_at_start(observable), set.follows_from_state(observable)});
  list_.add(observable);
}

const std::string& QuantityList::text(std::size_t i) const {
  const int observable = list_.quantity(i);
  return observable < 0 ? list_.text(i)
                        : index_->set().names()[static_cast<std::size_t>(observable)];
}

std::string QuantityList::unit(std::size_t i) const {
  const int observable = list_.quantity(i);
  return observable < 0 ? list_.unit(i).text() : std::string(index_->set().unit(observable));
}

void QuantityList::evaluate(const Simulation& simulation, const ExpressionMoment* moment,
                            std::span<double> values) const {
  // Most lists are short and need no allocation.
  std::array<double, 64> few;  // NOLINT(*-member-init): sample() sets the values
  std::vector<double> many;
  std::span<double> observed(few);
  const std::vector<int>& observables = list_.operands();
  if (observables.size() > few.size()) {
    many.resize(observables.size());
    observed = many;
  }
  observed = observed.first(observables.size());
  index_->set().sample(simulation, observables, observed);
  for (std::size_t i = 0; moment != nullptr && moment->starts && i < observables.size(); ++i) {
    if (!index_->set().known_at_start(observables[i])) observed[i] = unknown;
  }
  list_.evaluate(observed, values, moment);
}

void QuantityList::sample(const Simulation& simulation, std::span<double> values) const {
  evaluate(simulation, nullptr, values);
}

void QuantityList::observe(const Simulation& simulation, std::span<double> values) const {
  sample(simulation, values);
  if (simulation.world.state().steps > 0) return;
  for (std::size_t i = 0; i < known_.size(); ++i) {
    if (!known_[i].at_start) values[i] = unknown;
  }
}

void QuantityList::follow(const Simulation& simulation, std::span<Course> courses,
                          std::span<double> values) const {
  const State& state = simulation.world.state();
  const ExpressionMoment moment{state.time, state.steps == 0 && state.time <= 0.0, courses};
  evaluate(simulation, &moment, values);
}

}  // namespace sheave
