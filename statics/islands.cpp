#include "statics/islands.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "engine/index.h"

namespace sheave {
namespace {

/// Sets that can be joined.
class Sets {
 public:
  explicit Sets(int count) : parent_(at(count)) { std::iota(parent_.begin(), parent_.end(), 0); }
  int root(int i) {
    while (parent_[at(i)] != i) i = parent_[at(i)] = parent_[at(parent_[at(i)])];
    return i;
  }
  void join(int a, int b) {
    const int first = root(a);
    const int second = root(b);
    parent_[at(std::max(first, second))] = std::min(first, second);
  }

 private:
  std::vector<int> parent_;
};

}  // namespace

std::vector<Island> islands_of(const ConfigurationRows& rows, const MatrixX& stiffness) {
  const auto freedoms = static_cast<int>(rows.loads.size());
  const auto unknowns = static_cast<int>(rows.unknowns.size());
  Sets sets(freedoms + unknowns);  // unknowns come behind the degrees of freedom
  for (int i = 0; i < freedoms; ++i) {
    for (int k = 0; k < i; ++k) {
      if (stiffness(i, k) != 0.0 || stiffness(k, i) != 0.0) sets.join(i, k);
    }
  }
  for (int g = 0; g < unknowns; ++g) {
    const ForceUnknown& unknown = rows.unknowns[at(g)];
    bool moves = false;
    for (int i = 0; i < freedoms; ++i) {
      if (rows.gradients(g, i) == 0.0 && rows.actions(g, i) == 0.0) continue;
      sets.join(freedoms + g, i);
      moves = true;
    }
    if (!moves) sets.join(freedoms + g, 0);
    for (int k = 1; k < unknown.shares; ++k) sets.join(freedoms + g, freedoms + g + k);
    for (const ForceUnknown::Pressing& by : unknown.pressing) {
      if (by.unknown >= 0) sets.join(freedoms + g, freedoms + by.unknown);
    }
  }
  std::map<int, Island> islands;
  for (int i = 0; i < freedoms; ++i) islands[sets.root(i)].freedoms.push_back(i);
  for (int g = 0; g < unknowns; ++g) islands[sets.root(freedoms + g)].unknowns.push_back(g);
  std::vector<Island> all;
  for (auto& [root, island] : islands) all.push_back(std::move(island));
  return all;
}

ConfigurationRows rows_of(const Island& island, const ConfigurationRows& rows) {
  ConfigurationRows part;
  part.loads = rows.loads(island.freedoms);
  part.gradients = rows.gradients(island.unknowns, island.freedoms);
  part.actions = rows.actions(island.unknowns, island.freedoms);
  part.weighted = rows.weighted;
  for (const int g : island.unknowns) {
    ForceUnknown& unknown = part.unknowns.emplace_back(rows.unknowns[at(g)]);
    for (ForceUnknown::Pressing& by : unknown.pressing) {
      if (by.unknown < 0) continue;
      const auto place =
          std::lower_bound(island.unknowns.begin(), island.unknowns.end(), by.unknown);
      by.unknown = static_cast<int>(place - island.unknowns.begin());
    }
  }
  return part;
}

}  // namespace sheave
