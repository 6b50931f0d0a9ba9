#include "engine/solvers/row_slots.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/index.h"

namespace sheave {

bool RowSlots::same_pattern(const RowList& rows) const {
  std::size_t next = 0;
  const std::size_t size = signature_.size();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    const auto terms = at(row.term_count);
    if (row.source != nullptr && i < copies_.size() && copies_[i].first == row.source &&
        copies_[i].second == row.edition) {
      next += terms + 1;
      continue;
    }
    if (next + terms + 1 > size || signature_[next++] != (row.tied ? -2 : -1)) return false;
    for (std::size_t t = 0; t < terms; ++t) {
      if (signature_[next++] != row.terms[t].body) return false;
    }
  }
  return next == size;
}

bool RowSlots::find_pattern(const Coordinates& coordinates, const RowList& rows) {
  if (same_pattern(rows)) return false;
  signature_.clear();
  for (const Row& row : rows) {
    signature_.push_back(row.tied ? -2 : -1);
    for (const RowTerm& term : row.active_terms()) signature_.push_back(term.body);
  }
  lay_out(coordinates, rows);
  find_couplings(coordinates);
  return true;
}

void RowSlots::lay_out(const Coordinates& coordinates, const RowList& rows) {
  row_start_.assign(1, 0);
  row_dof_.clear();
  place_.clear();
  unknown_of_.clear();
  unknown_start_.assign(1, 0);
  dof_.clear();
  blocks_.clear();
  joined_ = false;
  std::size_t own_blocks = 0;  // of the unknown at hand
  for (const Row& row : rows) {
    if (row.tied) {
      joined_ = true;
      unknown_start_.pop_back();
    } else {
      own_blocks = blocks_.size();
    }
    const auto unknown = static_cast<int>(unknown_start_.size()) - 1;
    unknown_of_.push_back(unknown);
    for (const RowTerm& term : row.active_terms()) {
      const BodyFreedom& freedom = coordinates[term.body];
      const int count = size_of(freedom.kind);
      if (count == 0) continue;
      const auto known =
          std::find_if(blocks_.begin() + static_cast<std::ptrdiff_t>(own_blocks), blocks_.end(),
                       [&](const Block& block) { return block.body == term.body; });
      const int first = known != blocks_.end() ? known->first : static_cast<int>(dof_.size());
      if (known == blocks_.end()) {
        blocks_.push_back({unknown, term.body, first, count});
        for (int i = 0; i < count; ++i) dof_.push_back(freedom.first + i);
      }
      for (int i = 0; i < count; ++i) {
        row_dof_.push_back(freedom.first + i);
        place_.push_back(first + i);
      }
    }
    row_start_.push_back(static_cast<int>(row_dof_.size()));
    unknown_start_.push_back(static_cast<int>(dof_.size()));
  }
  gradient_.resize(row_dof_.size());
  motion_.resize(row_dof_.size());
  yields_.resize(rows.size());
  copies_.assign(rows.size(), {nullptr, 0});
  joint_gradient_.resize(dof_.size());
  joint_motion_.resize(dof_.size());
  const std::size_t unknowns = unknown_start_.size() - 1;
  uncancelled_.resize(unknowns);
  diagonal_.assign(unknowns, 0.0);
  changed_.assign(unknowns, 1);
}

void RowSlots::find_couplings(const Coordinates& coordinates) {
  std::vector<std::vector<Block>> touching(coordinates.movable().size());
  std::map<int, std::size_t> number;
  for (std::size_t i = 0; i < coordinates.movable().size(); ++i) {
    number[coordinates.movable()[i].body] = i;
  }
  for (const Block& block : blocks_) touching[number.at(block.body)].push_back(block);
  entries_.clear();
  std::map<std::pair<int, int>, std::size_t> entry_of;
  std::vector<std::vector<Shared>> shared;
  for (const std::vector<Block>& blocks : touching) {
    for (std::size_t a = 0; a < blocks.size(); ++a) {
      for (std::size_t b = a + 1; b < blocks.size(); ++b) {
        const std::pair pair{blocks[a].unknown, blocks[b].unknown};
        const auto [found, is_new] = entry_of.try_emplace(pair, entries_.size());
        if (is_new) {
          entries_.push_back(pair);
          shared.emplace_back();
        }
        shared[found->second].push_back({blocks[a].first, blocks[b].first, blocks[a].count});
      }
    }
  }
  shared_start_.assign(1, 0);
  shared_.clear();
  for (const std::vector<Shared>& of_entry : shared) {
    shared_.insert(shared_.end(), of_entry.begin(), of_entry.end());
    shared_start_.push_back(static_cast<int>(shared_.size()));
  }
}

void RowSlots::fill(const Coordinates& coordinates, const RowList& rows,
                    std::span<const MovingBody> bodies) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    auto& [source, edition] = copies_[i];
    if (row.source != nullptr && source == row.source && edition == row.edition) continue;
    source = row.source;
    edition = row.edition;
    changed_[at(unknown_of_[i])] = 1;
    double* gradient = gradient_.data() + row_start_[i];
    double* motion = motion_.data() + row_start_[i];
    double yield = 0.0;
    for (const RowTerm& term : row.active_terms()) {
      const BodyFreedom& freedom = coordinates[term.body];
      const MovingBody& body = bodies[at(term.body)];
      const int count = size_of(freedom.kind);
      project(freedom, body, term.linear, term.angular, gradient);
      weigh(freedom.kind, body, gradient, motion);
      for (int s = 0; s < count; ++s) yield += gradient[s] * motion[s];
      gradient += count;
      motion += count;
    }
    yields_[i] = yield;
  }
}

bool RowSlots::is_copy_as_in(int row, const RowSlots& other, int other_row) const {
  return copies_[at(row)].first != nullptr && copies_[at(row)] == other.copies_[at(other_row)];
}

void RowSlots::act_along(int row, const RowSlots& other, int other_row) {
  const int count = row_start_[at(row) + 1] - row_start_[at(row)];
  std::copy_n(other.motion_.begin() + other.row_start_[at(other_row)], count,
              motion_.begin() + row_start_[at(row)]);
  yields_[at(row)] = other.yields_[at(other_row)];
  copies_[at(row)].first = nullptr;
  changed_[at(unknown_of_[at(row)])] = 1;
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
    changed_[at(unknown_of_[row])] = 1;
    yields_[row] = 0.0;
    for (int s = row_start_[row]; s < row_start_[row + 1]; ++s) {
      yields_[row] += std::abs(gradient_[at(s)] * motion_[at(s)]);
    }
  }
}

void RowSlots::join(const RowList& rows) {
  if (!joined_) return;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (changed_[at(unknown_of_[i])] == 0 || rows[i].tied) continue;
    const auto unknown = at(unknown_of_[i]);
    for (int s = unknown_start_[unknown]; s < unknown_start_[unknown + 1]; ++s) {
      joint_gradient_[at(s)] = joint_motion_[at(s)] = 0.0;
    }
    uncancelled_[unknown] = 0.0;
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto unknown = at(unknown_of_[i]);
    if (changed_[unknown] == 0) continue;
    const double weight = rows[i].weight;
    double sum = 0.0;
    for (int s = row_start_[i]; s < row_start_[i + 1]; ++s) {
      const double j = gradient_[at(s)];
      const double m = weight * motion_[at(s)];
      sum += std::abs(j * m);
      joint_gradient_[at(place_[at(s)])] += j;
      joint_motion_[at(place_[at(s)])] += m;
    }
    uncancelled_[unknown] += sum;
  }
}

void RowSlots::assemble(bool symmetric) {
  constexpr double rounding = 1e-13;
  const double* gradient = joint_gradient();
  const double* motion = joint_motion();
  for (std::size_t u = 0; u < diagonal_.size(); ++u) {
    if (changed_[u] == 0) continue;
    double sum = 0.0;
    double whole = 0.0;
    for (int s = unknown_start_[u]; s < unknown_start_[u + 1]; ++s) {
      const double part = gradient[s] * motion[s];
      sum += part;
      whole += std::abs(part);
    }
    if (joined_) whole = uncancelled_[u];
    diagonal_[u] = sum < rounding * whole ? 0.0 : sum;
  }
  above_.resize(entries_.size());
  if (!symmetric) below_.resize(entries_.size());
  const bool all = !symmetric && was_symmetric_;
  for (std::size_t e = 0; e < entries_.size(); ++e) {
    const auto [i, j] = entries_[e];
    if (!all && changed_[at(i)] == 0 && changed_[at(j)] == 0) continue;
    above_[e] = coupling(e, false);
    if (!symmetric) below_[e] = coupling(e, true);
  }
  was_symmetric_ = symmetric;
  std::fill(changed_.begin(), changed_.end(), 0);
}

double RowSlots::coupling(std::size_t entry, bool transposed) const {
  const double* gradients = joint_gradient();
  const double* motions = joint_motion();
  double sum = 0.0;
  for (int p = shared_start_[entry]; p < shared_start_[entry + 1]; ++p) {
    const Shared& slots = shared_[at(p)];
    const double* gradient = gradients + (transposed ? slots.second : slots.first);
    const double* motion = motions + (transposed ? slots.first : slots.second);
    for (int s = 0; s < slots.count; ++s) sum += gradient[s] * motion[s];
  }
  return sum;
}

}  // namespace sheave
