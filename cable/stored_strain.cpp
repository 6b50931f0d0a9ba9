#include "cable/stored_strain.h"

#include <algorithm>
#include <limits>

namespace sheave {

StoredStrain::StoredStrain(std::span<const double> reals) {
  for (std::size_t i = 0; i < most_pieces; ++i) {
    pieces_[i] = {reals[3 * i], reals[3 * i + 1], reals[3 * i + 2]};
    if (pieces_[i].length > 0.0) count_ = i + 1;
  }
}

void StoredStrain::save(std::span<double> reals) const {
  for (std::size_t i = 0; i < most_pieces; ++i) {
    const Piece piece = i < count_ ? pieces_[i] : Piece{};
    reals[3 * i] = piece.length;
    reals[3 * i + 1] = piece.stretch;
    reals[3 * i + 2] = piece.square;
  }
}

double StoredStrain::rest_of(End end, double arc, double beyond) const {
  double length = 0.0;
  for (std::size_t i = 0; i < count_; ++i) {
    const Piece& piece = pieces_[end == End::incoming ? i : count_ - 1 - i];
    const double covered = piece.length + piece.stretch;
    if (arc <= covered) return length + arc / (1.0 + piece.strain());
    length += piece.length;
    arc -= covered;
  }
  return length + arc / (1.0 + beyond);
}

StoredStrain::Piece StoredStrain::take(End end, double length) {
  Piece taken;
  while (count_ > 0 && length > 0.0) {
    Piece& piece = pieces_[end == End::incoming ? 0 : count_ - 1];
    const bool whole = !(length < piece.length);
    const double share = whole ? 1.0 : length / piece.length;
    const Piece part{share * piece.length, share * piece.stretch, share * piece.square};
    taken.length += part.length;
    taken.stretch += part.stretch;
    taken.square += part.square;
    if (!whole) {
      piece.length -= part.length;
      piece.stretch -= part.stretch;
      piece.square -= part.square;
      break;
    }
    length -= piece.length;
    if (end == End::incoming) std::copy(pieces_.begin() + 1, pieces_.end(), pieces_.begin());
    --count_;
  }
  return taken;
}

void StoredStrain::put(End end, double length, const Level& level) {
  const double strain = level.strain;
  const Piece piece{length, strain * length, level.square * length};
  if (count_ > 0 && length > 0.0) {
    Piece& last = pieces_[end == End::incoming ? 0 : count_ - 1];
    if (last.strain() == strain) {
      last.length += piece.length;
      last.stretch += piece.stretch;
      last.square += piece.square;
      return;
    }
  }
  put(end, piece);
}

void StoredStrain::put(End end, const Piece& piece) {
  if (!(piece.length > 0.0)) return;
  if (end == End::incoming) {
    std::copy_backward(pieces_.begin(), pieces_.begin() + static_cast<std::ptrdiff_t>(count_),
                       pieces_.begin() + static_cast<std::ptrdiff_t>(count_) + 1);
  }
  pieces_[end == End::incoming ? 0 : count_] = piece;
  if (++count_ > most_pieces) merge_cheapest();
}

void StoredStrain::merge_cheapest() {
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < count_; ++i) {
    const Piece& a = pieces_[i];
    const Piece& b = pieces_[i + 1];
    const double apart = a.strain() - b.strain();
    // Twice the energy / EA that the common strain does not represent.
    const double cost = apart * apart * a.length * b.length / (a.length + b.length);
    if (!(cost < least)) continue;
    least = cost;
    best = i;
  }
  Piece& merged = pieces_[best];
  const Piece& next = pieces_[best + 1];
  merged.length += next.length;
  merged.stretch += next.stretch;
  merged.square += next.square;
  std::copy(pieces_.begin() + static_cast<std::ptrdiff_t>(best) + 2,
            pieces_.begin() + static_cast<std::ptrdiff_t>(count_),
            pieces_.begin() + static_cast<std::ptrdiff_t>(best) + 1);
  --count_;
}

void StoredStrain::fit(End end, double length, const Level& level) {
  if (!(length > 0.0)) {
    count_ = 0;
    return;
  }
  const double excess = total().length - length;
  if (excess > 0.0) take(end, excess);
  if (excess < 0.0) put(end, -excess, level);
}

StoredStrain::Piece StoredStrain::total() const {
  Piece sum;
  for (std::size_t i = 0; i < count_; ++i) {
    sum.length += pieces_[i].length;
    sum.stretch += pieces_[i].stretch;
    sum.square += pieces_[i].square;
  }
  return sum;
}

double StoredStrain::strain_at(double share) const {
  const Piece all = total();
  double arc = share * (all.length + all.stretch);
  for (std::size_t i = 0; i < count_; ++i) {
    arc -= pieces_[i].length + pieces_[i].stretch;
    if (arc <= 0.0) return pieces_[i].strain();
  }
  return count_ > 0 ? pieces_[count_ - 1].strain() : 0.0;
}

double StoredStrain::most_strain() const {
  double most = 0.0;
  for (std::size_t i = 0; i < count_; ++i) most = std::max(most, pieces_[i].strain());
  return most;
}

}  // namespace sheave
