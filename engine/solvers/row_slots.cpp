#include "engine/solvers/row_slots.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/index.h"

namespace sheave {

namespace {

/// Code of a row in the pattern.
int mark_of(const Row& row, bool whole) {
  const int kind = whole ? 2 : row.tied ? 1 : 0;
  return kind + 3 * row.term_count;
}

/// Finds the rows that have all slots of their bodies: rows of friction in several directions,
/// because each of them becomes a sum of the others.
class WholeRows {
 public:
  /// Whether the next row has all slots.
  bool next(const Row& row) {
    if (row.shares > 1) left_ = row.shares;
    return left_ > 0 && left_-- > 0;
  }

 private:
  int left_ = 0;
};

}  // namespace

RowSlots::TermPart RowSlots::part_of(const Coordinates& coordinates, const RowTerm& term,
                                     bool whole) {
  const Freedom kind = coordinates[term.body].kind;
  const bool splits = kind == Freedom::plane || kind == Freedom::space;
  if (!splits || whole || !is_zero(term.linear)) return {term.body, kind, false};
  return {term.body, kind == Freedom::plane ? Freedom::angle : Freedom::turn, true};
}

void RowSlots::find_pattern(const Coordinates& coordinates, const RowList& rows) {
  marks_.clear();
  parts_.clear();
  WholeRows whole_rows;
  for (const Row& row : rows) {
    const bool whole = whole_rows.next(row);
    marks_.push_back(mark_of(row, whole));
    for (const RowTerm& term : row.active_terms()) {
      parts_.push_back(part_of(coordinates, term, whole));
    }
  }
  lay_out(coordinates, rows);
  find_couplings(coordinates);
  sort_couplings();
}

void RowSlots::lay_out(const Coordinates& coordinates, const RowList& rows) {
  row_start_.assign(1, 0);
  dof_.clear();
  unknown_of_.clear();
  unknowns_.clear();
  const TermPart* part = parts_.data();
  for (const Row& row : rows) {
    for (const RowTerm& term : row.active_terms()) {
      const BodyFreedom& freedom = coordinates[term.body];
      const int whole = size_of(freedom.kind);
      for (int i = whole - size_of(part++->kind); i < whole; ++i) dof_.push_back(freedom.first + i);
    }
    const auto index = static_cast<int>(row_start_.size()) - 1;
    const auto end = static_cast<int>(dof_.size());
    if (row.tied) {
      unknowns_.back().rows.last = index + 1;
    } else {
      unknowns_.push_back({{row_start_.back(), end}, {index, index + 1}});
    }
    unknown_of_.push_back(static_cast<int>(unknowns_.size()) - 1);
    row_start_.push_back(end);
  }
  place_.assign(dof_.size(), 0);
  joint_.clear();
  for (std::size_t u = 0; u < unknowns_.size(); ++u) {
    if (!unknowns_[u].joins()) continue;
    joint_.push_back(static_cast<int>(u));
    lay_out_joint(unknowns_[u]);
  }
  gradient_.resize(dof_.size());
  motion_.resize(dof_.size());
  yields_.resize(rows.size());
  copies_.assign(rows.size(), {nullptr, 0});
  uncancelled_.resize(unknowns_.size());
  diagonal_.assign(unknowns_.size(), 0.0);
  changed_.assign(unknowns_.size(), 1);
  any_changed_ = true;
}

void RowSlots::lay_out_joint(Unknown& unknown) {
  // The slots are sorted, so that slots of one body are adjacent.
  const auto own = static_cast<std::ptrdiff_t>(dof_.size());
  const int from = row_start_[at(unknown.rows.first)];
  const int to = row_start_[at(unknown.rows.last)];
  std::vector<int> dofs(dof_.begin() + from, dof_.begin() + to);
  std::sort(dofs.begin(), dofs.end());
  dofs.erase(std::unique(dofs.begin(), dofs.end()), dofs.end());
  for (int s = from; s < to; ++s) {
    const auto found = std::lower_bound(dofs.begin(), dofs.end(), dof_[at(s)]);
    place_[at(s)] = static_cast<int>(own + (found - dofs.begin()));
  }
  dof_.insert(dof_.end(), dofs.begin(), dofs.end());
  unknown.slots = {static_cast<int>(own), static_cast<int>(dof_.size())};
}

void RowSlots::find_couplings(const Coordinates& coordinates) {
  // The body of each degree of freedom, and the blocks at each body in the order of unknowns.
  std::vector<int> body_of(at(coordinates.count()), 0);
  int bodies = 0;
  for (const BodyFreedom& freedom : coordinates.movable()) {
    for (int i = 0; i < size_of(freedom.kind); ++i) body_of[at(freedom.first + i)] = freedom.body;
    bodies = std::max(bodies, freedom.body + 1);
  }
  blocks_.clear();
  for (std::size_t u = 0; u < unknowns_.size(); ++u) {
    const Range slots = unknowns_[u].slots;
    for (int s = slots.first; s < slots.last; ++s) {
      const int body = body_of[at(dof_[at(s)])];
      if (s == slots.first || body != blocks_.back().body) {
        blocks_.push_back({static_cast<int>(u), body, s, 0});
      }
      ++blocks_.back().count;
    }
  }
  std::vector<int> start(at(bodies) + 1, 0);
  for (const Block& block : blocks_) ++start[at(block.body) + 1];
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<int> next = start;
  std::vector<int> touching(blocks_.size());
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    touching[at(next[at(blocks_[b].body)]++)] = static_cast<int>(b);
  }
  // For each unknown, the later unknowns that couple with it at any body.
  entries_.clear();
  std::vector<std::pair<int, Shared>> found;  // entry and slots in common
  std::vector<int> entry_with(unknowns_.size(), -1);
  int first_entry = 0;
  next = start;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const Block& block = blocks_[b];
    if (b > 0 && block.unknown != blocks_[b - 1].unknown) {
      first_entry = static_cast<int>(entries_.size());
    }
    for (int p = ++next[at(block.body)]; p < start[at(block.body) + 1]; ++p) {
      const Block& other = blocks_[at(touching[at(p)])];
      const Shared shared = common(block, other);
      if (shared.count == 0) continue;
      int& entry = entry_with[at(other.unknown)];
      if (entry < first_entry) {
        entry = static_cast<int>(entries_.size());
        entries_.emplace_back(block.unknown, other.unknown);
      }
      found.emplace_back(entry, shared);
    }
  }
  shared_start_.assign(entries_.size() + 1, 0);
  for (const auto& [entry, shared] : found) ++shared_start_[at(entry) + 1];
  std::partial_sum(shared_start_.begin(), shared_start_.end(), shared_start_.begin());
  next = shared_start_;
  shared_.resize(found.size());
  for (const auto& [entry, shared] : found) shared_[at(next[at(entry)]++)] = shared;
}

RowSlots::Shared RowSlots::common(const Block& a, const Block& b) {
  // Each block ends with the last degree of freedom of its body.
  const int count = std::min(a.count, b.count);
  return {a.first + a.count - count, b.first + b.count - count, count};
}

bool RowSlots::fill(const Coordinates& coordinates, const RowList& rows,
                    std::span<const MovingBody> bodies) {
  if (fill_pattern(coordinates, rows, bodies)) return false;
  find_pattern(coordinates, rows);
  static_cast<void>(fill_pattern(coordinates, rows, bodies));
  return true;
}

bool RowSlots::fill_pattern(const Coordinates& coordinates, const RowList& rows,
                            std::span<const MovingBody> bodies) {
  if (rows.size() != marks_.size()) return false;
  const TermPart* part = parts_.data();
  WholeRows whole_rows;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    const bool whole = whole_rows.next(row);
    auto& [source, edition] = copies_[i];
    if (row.source == nullptr || source != row.source || edition != row.edition) {
      if (marks_[i] != mark_of(row, whole)) return false;
      any_changed_ = true;
      source = row.source;
      edition = row.edition;
      changed_[at(unknown_of_[i])] = 1;
      if (!fill_row(coordinates, row, bodies, whole, part, i)) return false;
    }
    part += row.term_count;
  }
  return true;
}

bool RowSlots::fill_row(const Coordinates& coordinates, const Row& row,
                        std::span<const MovingBody> bodies, bool whole, const TermPart* part,
                        std::size_t index) {
  double* gradient = gradient_.data() + row_start_[index];
  double* motion = motion_.data() + row_start_[index];
  double yield = 0.0;
  for (const RowTerm& term : row.active_terms()) {
    if (part->body != term.body) return false;
    const BodyFreedom& freedom = coordinates[term.body];
    const bool splits = freedom.kind == Freedom::plane || freedom.kind == Freedom::space;
    if (splits && !whole && is_zero(term.linear) != part->turns_only) return false;
    const MovingBody& body = bodies[at(term.body)];
    project(part->kind, freedom, body, term.linear, term.angular, gradient);
    weigh(part->kind, body, gradient, motion);
    const int count = size_of(part->kind);
    for (int s = 0; s < count; ++s) yield += gradient[s] * motion[s];
    gradient += count;
    motion += count;
    ++part;
  }
  yields_[index] = yield;
  return true;
}

bool RowSlots::is_copy_as_in(int row, const RowSlots& other, int other_row) const {
  return copies_[at(row)].first != nullptr && copies_[at(row)] == other.copies_[at(other_row)];
}

bool RowSlots::act_along(int row, const RowSlots& other, int other_row) {
  const int from = other.row_start_[at(other_row)];
  const int to = row_start_[at(row)];
  const int count = row_start_[at(row) + 1] - to;
  if (other.row_start_[at(other_row) + 1] - from != count) return false;
  for (int s = 0; s < count; ++s) {
    if (dof_[at(to + s)] != other.dof_[at(from + s)]) return false;
    motion_[at(to + s)] = other.motion_[at(from + s)];
  }
  yields_[at(row)] = other.yields_[at(other_row)];
  copies_[at(row)].first = nullptr;
  changed_[at(unknown_of_[at(row)])] = 1;
  any_changed_ = true;
  return true;
}

void RowSlots::mix(int first_row, int count, const Matrix3& mixture, bool gradients) {
  const int slots = row_start_[at(first_row) + 1] - row_start_[at(first_row)];
  const auto mix_slot = [&](std::vector<double>& values, int slot) {
    Vector3 own = Vector3::Zero();
    for (int k = 0; k < count; ++k) own[k] = values[at(row_start_[at(first_row + k)] + slot)];
    const Vector3 mixed = times(mixture, own);
    for (int k = 0; k < count; ++k) values[at(row_start_[at(first_row + k)] + slot)] = mixed[k];
  };
  for (int s = 0; s < slots; ++s) {
    mix_slot(motion_, s);
    if (gradients) mix_slot(gradient_, s);
  }
  for (int k = 0; k < count; ++k) {
    const auto row = at(first_row + k);
    copies_[row].first = nullptr;
    changed_[at(unknown_of_[row])] = 1;
    yields_[row] = 0.0;
    for (int s = row_start_[row]; s < row_start_[row + 1]; ++s) {
      yields_[row] += std::abs(gradient_[at(s)] * motion_[at(s)]);
    }
  }
  any_changed_ = true;
}

void RowSlots::join(const RowList& rows) {
  for (const int u : joint_) {
    if (changed_[at(u)] == 0) continue;
    const Unknown& unknown = unknowns_[at(u)];
    for (int s = unknown.slots.first; s < unknown.slots.last; ++s) {
      gradient_[at(s)] = motion_[at(s)] = 0.0;
    }
    double uncancelled = 0.0;
    for (int i = unknown.rows.first; i < unknown.rows.last; ++i) {
      const double weight = rows[at(i)].weight;
      for (int s = row_start_[at(i)]; s < row_start_[at(i) + 1]; ++s) {
        const double j = gradient_[at(s)];
        const double m = weight * motion_[at(s)];
        uncancelled += std::abs(j * m);
        gradient_[at(place_[at(s)])] += j;
        motion_[at(place_[at(s)])] += m;
      }
    }
    uncancelled_[at(u)] = uncancelled;
  }
}

void RowSlots::assemble(bool symmetric) {
  constexpr double rounding = 1e-13;
  if (!any_changed_ && (symmetric || !was_symmetric_)) return;
  const double* gradient = gradient_.data();
  const double* motion = motion_.data();
  for (std::size_t u = 0; u < diagonal_.size(); ++u) {
    if (changed_[u] == 0) continue;
    const Unknown& unknown = unknowns_[u];
    double sum = 0.0;
    double whole = 0.0;
    const double* const g = gradient + unknown.slots.first;
    const double* const m = motion + unknown.slots.first;
    for_few(
        unknown.slots.last - unknown.slots.first, [&](int s) __attribute__((always_inline)) {
          const double part = g[s] * m[s];
          sum += part;
          whole += std::abs(part);
        });
    if (unknown.joins()) whole = uncancelled_[u];
    diagonal_[u] = sum < rounding * whole ? 0.0 : sum;
  }
  couple(false, above_);
  if (!symmetric) couple(true, below_);
  was_symmetric_ = symmetric;
  any_changed_ = false;
  std::fill(changed_.begin(), changed_.end(), 0);
}

void RowSlots::couple(bool transposed, std::vector<double>& values) const {
  values.resize(entries_.size());
  const double* gradient = gradient_.data();
  const double* motion = motion_.data();
  const Shared* slots = shared_.data();
  std::size_t e = 0;
  for (; e < ones_; ++e, ++slots) {
    const int from = transposed ? slots->second : slots->first;
    const int to = transposed ? slots->first : slots->second;
    values[e] = gradient[from] * motion[to];
  }
  for (; e < threes_; ++e, ++slots) {
    const double* g = gradient + (transposed ? slots->second : slots->first);
    const double* m = motion + (transposed ? slots->first : slots->second);
    values[e] = g[0] * m[0] + g[1] * m[1] + g[2] * m[2];
  }
  for (; e < entries_.size(); ++e) {
    double sum = 0.0;
    for (const Shared* end = shared_.data() + shared_start_[e + 1]; slots != end; ++slots) {
      const double* g = gradient + (transposed ? slots->second : slots->first);
      const double* m = motion + (transposed ? slots->first : slots->second);
      for_few(
          slots->count, [&](int s) __attribute__((always_inline)) { sum += g[s] * m[s]; });
    }
    values[e] = sum;
  }
}

void RowSlots::sort_couplings() {
  const auto kind_of = [&](std::size_t e) {
    const int first = shared_start_[e];
    if (shared_start_[e + 1] - first > 1) return 2;
    const int count = shared_[at(first)].count;
    return count == 1 ? 0 : count == 3 ? 1 : 2;
  };
  std::vector<std::size_t> order(entries_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return kind_of(a) < kind_of(b); });
  const std::vector<std::pair<int, int>> entries = std::move(entries_);
  const std::vector<int> starts = std::move(shared_start_);
  const std::vector<Shared> shared = std::move(shared_);
  entries_.clear();
  shared_.clear();
  shared_start_.assign(1, 0);
  ones_ = threes_ = 0;
  for (const std::size_t e : order) {
    entries_.push_back(entries[e]);
    shared_.insert(shared_.end(), shared.begin() + starts[e], shared.begin() + starts[e + 1]);
    shared_start_.push_back(static_cast<int>(shared_.size()));
    const Shared& last = shared_.back();
    const bool single = starts[e + 1] - starts[e] == 1;
    if (single && last.count == 1) ++ones_;
    if (single && (last.count == 1 || last.count == 3)) ++threes_;
  }
}

}  // namespace sheave
