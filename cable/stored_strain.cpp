#include "cable/stored_strain.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sheave {

double StoredStrain::Piece::slope() const {
  if (moment == 0.0) return 0.0;
  const double most = 2.0 * stretch / (length * length);
  return std::clamp(12.0 * moment / (length * length * length), -most, most);
}

double StoredStrain::Piece::strain_at(End end) const {
  const double half = 0.5 * slope() * length;
  return end == End::incoming ? strain() - half : strain() + half;
}

double StoredStrain::Piece::rest_of(End end, double arc) const {
  if (moment == 0.0) return arc / (1.0 + strain());
  // (1 + e) x - f x^2 / 2 = arc, with the strain e at the end and its fall f from there on.
  const double at_end = 1.0 + strain_at(end);
  const double fall = end == End::incoming ? -slope() : slope();
  return 2.0 * arc / (at_end + std::sqrt(std::max(at_end * at_end - 2.0 * fall * arc, 0.0)));
}

StoredStrain::Piece StoredStrain::Piece::split(End end, double part, const StrainEnergy& energy) {
  const double share = part / length;
  const double along = slope();
  const double left = length - part;
  Piece taken{share * length, share * stretch, share * square, 0.0, share * scatter};
  if (along != 0.0) {
    const double mean = strain();
    const double above = (end == End::incoming ? -0.5 : 0.5) * along * left;
    const double spread = along * along * (part * part * part - share * length * length * length);
    taken.stretch = (mean + above) * part;
    taken.square += above * part * energy.slope(mean) +
                    0.5 * energy.curve(mean) * (above * above * part + spread / 12.0);
    taken.moment = along * part * part * part / 12.0;
  }
  length -= taken.length;
  stretch -= taken.stretch;
  square -= taken.square;
  scatter -= taken.scatter;
  moment = along * left * left * left / 12.0;
  return taken;
}

namespace {

/// Integral of the square of the distance of the piece's straight line from its mean [m].
double rise_of(const StoredStrain::Piece& piece) {
  const double rise = piece.slope() * piece.length;
  return rise * rise * piece.length / 12.0;
}

StoredStrain::Piece merged(const StoredStrain::Piece& a, const StoredStrain::Piece& b) {
  StoredStrain::Piece both{
      a.length + b.length, a.stretch + b.stretch, a.square + b.square,
      a.moment + b.moment + 0.5 * (a.length * b.stretch - b.length * a.stretch), 0.0};
  const double apart = a.strain() - b.strain();
  const double means = apart * apart * (a.length * b.length / both.length);
  both.scatter = std::max(means + rise_of(a) + rise_of(b) - rise_of(both), 0.0);
  both.scatter += a.scatter + b.scatter;
  return both;
}

}  // namespace

StoredStrain::StoredStrain(std::span<const double> reals) {
  for (std::size_t i = 0; i < most_pieces; ++i) {
    pieces_[i] = {reals[5 * i], reals[5 * i + 1], reals[5 * i + 2], reals[5 * i + 3],
                  reals[5 * i + 4]};
    if (pieces_[i].length > 0.0) count_ = i + 1;
  }
}

void StoredStrain::save(std::span<double> reals) const {
  for (std::size_t i = 0; i < most_pieces; ++i) {
    const Piece piece = i < count_ ? pieces_[i] : Piece{};
    reals[5 * i] = piece.length;
    reals[5 * i + 1] = piece.stretch;
    reals[5 * i + 2] = piece.square;
    reals[5 * i + 3] = piece.moment;
    reals[5 * i + 4] = piece.scatter;
  }
}

double StoredStrain::rest_of(End end, double arc, double beyond) const {
  double length = 0.0;
  for (std::size_t i = 0; i < count_; ++i) {
    const Piece& piece = pieces_[end == End::incoming ? i : count_ - 1 - i];
    const double covered = piece.length + piece.stretch;
    if (arc <= covered) return length + piece.rest_of(end, arc);
    length += piece.length;
    arc -= covered;
  }
  return length + arc / (1.0 + beyond);
}

StoredStrain::Piece StoredStrain::take(End end, double length, const StrainEnergy& energy) {
  Piece taken;
  const auto add = [&taken](const Piece& part) {
    taken.length += part.length;
    taken.stretch += part.stretch;
    taken.square += part.square;
  };
  while (count_ > 0 && length > 0.0) {
    Piece& piece = pieces_[end == End::incoming ? 0 : count_ - 1];
    if (length < piece.length) {
      add(piece.split(end, length, energy));
      break;
    }
    add(piece);
    length -= piece.length;
    if (end == End::incoming) std::copy(pieces_.begin() + 1, pieces_.end(), pieces_.begin());
    --count_;
  }
  return taken;
}

void StoredStrain::put(End end, double length, double strain, const StrainEnergy& energy) {
  const Piece piece{length, strain * length, energy.of(strain) * length, 0.0, 0.0};
  if (count_ > 0 && length > 0.0) {
    Piece& last = pieces_[end == End::incoming ? 0 : count_ - 1];
    if (last.strain() == strain && last.moment == 0.0) {
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
  if (++count_ > most_pieces) merge_closest();
}

void StoredStrain::merge_closest() {
  // The growth of the scatter would be no measure: it is less the shorter the new piece is, so that in
  // short substeps all cable that comes on would become one piece.
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < count_; ++i) {
    const double cost = merged(pieces_[i], pieces_[i + 1]).scatter;
    if (!(cost < least)) continue;
    least = cost;
    best = i;
  }
  pieces_[best] = merged(pieces_[best], pieces_[best + 1]);
  std::copy(pieces_.begin() + static_cast<std::ptrdiff_t>(best) + 2,
            pieces_.begin() + static_cast<std::ptrdiff_t>(count_),
            pieces_.begin() + static_cast<std::ptrdiff_t>(best) + 1);
  --count_;
}

void StoredStrain::fit(End end, double length, double strain, const StrainEnergy& energy) {
  if (!(length > 0.0)) {
    count_ = 0;
    return;
  }
  const double excess = total().length - length;
  if (excess > 0.0) take(end, excess, energy);
  if (excess < 0.0) put(end, -excess, strain, energy);
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
    const Piece& piece = pieces_[i];
    const double covered = piece.length + piece.stretch;
    if (arc <= covered) {
      const double from_middle = piece.rest_of(End::incoming, arc) - 0.5 * piece.length;
      return piece.strain() + piece.slope() * from_middle;
    }
    arc -= covered;
  }
  return count_ > 0 ? pieces_[count_ - 1].strain_at(End::outgoing) : 0.0;
}

double StoredStrain::most_strain() const {
  double most = 0.0;
  for (std::size_t i = 0; i < count_; ++i) {
    most =
        std::max({most, pieces_[i].strain_at(End::incoming), pieces_[i].strain_at(End::outgoing)});
  }
  return most;
}

}  // namespace sheave
