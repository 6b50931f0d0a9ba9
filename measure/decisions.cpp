#include "measure/decisions.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

namespace sheave::measure {
namespace {

struct Words {
  std::array<std::string_view, 2> branches;
  std::array<std::string_view, 2> units;
};

Words words_of(const AlternativeKey& key, bool angle) {
  switch (key.kind) {
    case Alternative::span:
      return {{"is taut", "is slack"}, {"N", "m"}};
    case Alternative::link:
      return {{"holds", "slides"}, {"", ""}};
    case Alternative::touch:
      return {{"touches", "is open"}, {"N", "m"}};
    case Alternative::contact:
      return {{"holds", "slides"}, {"", ""}};
    case Alternative::stop:
      return {{"is free", "is touched"}, {angle ? "rad" : "m", ""}};
  }
  return {};
}

/// Of an alternative that a run has never met: bodies that were never within reach were apart.
BranchRecord record_of(const std::map<AlternativeKey, BranchRecord>& run,
                       const AlternativeKey& key) {
  const auto own = run.find(key);
  if (own != run.end()) return own->second;
  BranchRecord none;
  none.visited[1] = key.kind == Alternative::touch;
  return none;
}

std::optional<double> error_of_margin(const std::array<BranchRecord, 3>& records,
                                      std::size_t branch) {
  std::array<double, 3> m{};
  for (std::size_t run = 0; run < 3; ++run) {
    if (!records[run].least[branch]) return {};
    m[run] = records[run].least[branch]->margin;
  }
  return std::abs(m[0] - m[2]) + std::max(std::abs(m[1] - m[2]), 0.5 * std::abs(m[0] - m[1]));
}

/// The decision to stay in a branch; nothing if the first run was never in it, or has left it as the
/// others have.
std::optional<Decision> decision_of(const std::array<BranchRecord, 3>& records,
                                    std::size_t branch) {
  Decision decision;
  for (std::size_t run = 0; run < 3; ++run) {
    decision.took_other[run] = records[run].visited[1 - branch];
  }
  const std::optional<LeastMargin>& least = records[0].least[branch];
  const bool was_in = records[0].visited[branch];
  if (!was_in || (!least && !decision.differs())) return {};
  if (least) {
    decision.margin = least->margin;
    decision.time = least->time;
  }
  if (decision.differs()) {
    // The branches part where the first of the runs enters the other one.
    const auto entered = std::ranges::find_if(
        records, [](const BranchRecord& record) { return record.first_change.has_value(); });
    if (decision.took_other[0]) decision.margin = 0.0;
    if (entered != records.end()) decision.time = *entered->first_change;
    decision.close = true;
    return decision;
  }
  decision.error = error_of_margin(records, branch);
  decision.close = decision.error && *decision.error > 0.0 && decision.safety() <= 1.0;
  return decision;
}

}  // namespace

double Decision::safety() const {
  return error && *error > 0.0 ? margin / *error : std::numeric_limits<double>::infinity();
}

std::vector<Decision> find_decisions(
    const BranchReader& reader, const std::array<std::map<AlternativeKey, BranchRecord>, 3>& runs) {
  std::vector<Decision> decisions;
  std::set<AlternativeKey> keys;
  for (const auto& run : runs) {
    for (const auto& [key, record] : run) keys.insert(key);
  }
  for (const AlternativeKey& key : keys) {
    const std::array<BranchRecord, 3> records{record_of(runs[0], key), record_of(runs[1], key),
                                              record_of(runs[2], key)};
    for (const std::size_t branch : {0U, 1U}) {
      std::optional<Decision> decision = decision_of(records, branch);
      if (!decision) continue;
      const Words words = words_of(key, reader.is_angle(key));
      decision->alternative = reader.name_of(key);
      decision->branch = words.branches[branch];
      decision->other = words.branches[1 - branch];
      decision->unit = words.units[branch];
      decisions.push_back(std::move(*decision));
    }
  }
  std::ranges::stable_sort(decisions, [](const Decision& a, const Decision& b) {
    if (a.close != b.close) return a.close;
    return a.safety() < b.safety();
  });
  return decisions;
}

}  // namespace sheave::measure
