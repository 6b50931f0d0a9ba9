#include "scenes/quantity_list.h"

#include <algorithm>
#include <array>
#include <limits>

namespace sheave {
namespace {

/// An index of the columns, or of everything if a text needs more.
template <class Make>
std::shared_ptr<const QuantityIndex> sufficient(std::span<const std::string> texts,
                                                const Make& make) {
  auto columns = std::make_shared<const QuantityIndex>(make(ObservableSet::Extent::columns));
  const bool suffices = std::all_of(texts.begin(), texts.end(), [&](const std::string& text) {
    return columns->compile(text).ok();
  });
  if (suffices) return columns;
  return std::make_shared<const QuantityIndex>(make(ObservableSet::Extent::everything));
}

}  // namespace

QuantityIndex::QuantityIndex(ObservableSet set) : set_(std::move(set)) {
  const std::vector<std::string>& names = set_.names();
  indices_.reserve(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    indices_.emplace(names[i], static_cast<int>(i));
    longest_ = std::max(longest_, names[i].size());
  }
}

std::shared_ptr<const QuantityIndex> QuantityIndex::of(const Simulation& simulation,
                                                       std::span<const std::string> texts) {
  return sufficient(
      texts, [&](ObservableSet::Extent extent) { return ObservableSet(simulation, extent); });
}

std::shared_ptr<const QuantityIndex> QuantityIndex::of(
    const Model& model, const std::vector<CableDef>& cables,
    std::span<const std::shared_ptr<const LoadDef>> loads, std::span<const std::string> texts) {
  return sufficient(texts, [&](ObservableSet::Extent extent) {
    return ObservableSet(model, cables, loads, extent);
  });
}

std::optional<int> QuantityIndex::find(std::string_view name) const {
  const auto found = indices_.find(name);
  return found == indices_.end() ? std::nullopt : std::optional(found->second);
}

std::string QuantityIndex::fault(std::string_view name) const {
  const Result<int> index = set_.index_of(name);
  return index ? std::string() : index.errors().front().message;
}

Errors QuantityList::add(std::string_view text) {
  if (const std::optional<int> observable = index_->find(text)) {
    add(*observable);
    return {};
  }
  Result<Expression> expression = index_->compile(text);
  if (!expression) return expression.errors();
  add(std::move(*expression), text);
  return {};
}

void QuantityList::add(Expression expression, std::string_view text) {
  Known known;
  for (const int observable : expression.quantities()) {
    known.at_start = known.at_start && index_->set().known_at_start(observable);
    known.from_state = known.from_state && index_->set().follows_from_state(observable);
  }
  known_.push_back(known);
  list_.add(std::move(expression), std::string(text));
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

void QuantityList::sample(const Simulation& simulation, std::span<double> values) const {
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
  list_.evaluate(observed, values);
}

void QuantityList::observe(const Simulation& simulation, std::span<double> values) const {
  sample(simulation, values);
  if (simulation.world.state().steps > 0) return;
  for (std::size_t i = 0; i < known_.size(); ++i) {
    if (!known_[i].at_start) values[i] = std::numeric_limits<double>::quiet_NaN();
  }
}

}  // namespace sheave
