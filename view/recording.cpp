#include "view/recording.h"

#include <algorithm>
#include <cmath>

namespace sheave::view {

Recording::Recording(const Simulation& simulation)
    : channels_(simulation, simulation.cable_reports()), columns_(channels_.channels().size()) {}

void Recording::add(const Simulation& simulation) {
  const std::vector<CableReport> reports = simulation.cable_reports();
  ropes_.follow(simulation.world, reports);
  if (!channels_.fits(reports, ropes_)) {
    channels_.extend(reports, ropes_);
    columns_.resize(channels_.channels().size(), std::vector<double>(times_.size(), 0.0));
  }
  channels_.sample(simulation, reports, ropes_, values_);
  times_.push_back(simulation.world.state().time);
  for (std::size_t i = 0; i < values_.size(); ++i) columns_[i].push_back(values_[i]);
}

void Recording::halve() {
  const std::size_t count = times_.size();
  const auto thin = [count](std::vector<double>& values) {
    std::size_t kept = 0;
    for (std::size_t k = 0; k < count; ++k) {
      if (k % 2 == 0 || k + 1 == count) values[kept++] = values[k];
    }
    values.resize(kept);
  };
  thin(times_);
  for (std::vector<double>& column : columns_) thin(column);
}

double Recording::halving_error() const {
  double largest = 0.0;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (channels_.channels()[i].kind != ChannelKind::length) continue;
    const std::vector<double>& v = columns_[i];
    for (std::size_t k = 1; k + 1 < v.size(); k += 2) {
      const double share = (times_[k] - times_[k - 1]) / (times_[k + 1] - times_[k - 1]);
      const double error = std::abs(v[k - 1] + share * (v[k + 1] - v[k - 1]) - v[k]);
      if (error > largest) largest = error;
    }
  }
  return largest;
}

std::vector<RecordedEvent> Recording::events() const {
  std::vector<RecordedEvent> sorted = events_;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const RecordedEvent& a, const RecordedEvent& b) { return a.time < b.time; });
  return sorted;
}

}  // namespace sheave::view
