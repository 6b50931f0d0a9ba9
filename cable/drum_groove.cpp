#include "cable/drum_groove.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/vector.h"

namespace sheave {
namespace {

/// Half the arc of a change of layers [rad].
constexpr double half_arc = 0.5 * pi;

}  // namespace

/// A stretch of the groove in which R and z' are linear in the angle.
struct DrumGroove::Piece {
  double begin = 0.0;  ///< its first angle [rad]
  int layer = 0;       ///< of an arc of change: the outer one
  bool changes = false;
  double gain = 0.0;  ///< R at its beginning [m/rad]
  double rate = 0.0;  ///< dR/da [m/rad^2]

  [[nodiscard]] bool is(const Piece& other) const {
    return layer == other.layer && changes == other.changes;
  }
};

bool DrumGroove::has_layers() const { return std::isfinite(turns); }

double DrumGroove::per_layer() const { return 2.0 * pi * turns; }

double DrumGroove::gain_of(int layer) const {
  const double on = radius + layer * height;
  const double along = lead / (2.0 * pi);
  return std::sqrt(on * on + along * along);
}

DrumGroove::Piece DrumGroove::piece(double angle) const {
  if (!has_layers()) return {0.0, 0, false, gain_of(0), 0.0};
  const double whole = per_layer();
  // The bound keeps the number of a motion that diverges an integer.
  const double number = std::min(std::round(std::max(0.0, angle) / whole), double{most_layers});
  const int nearest = static_cast<int>(number);
  if (nearest > 0 && std::abs(angle - nearest * whole) < half_arc) {
    const double inner = gain_of(nearest - 1);
    return {nearest * whole - half_arc, nearest, true, inner,
            (gain_of(nearest) - inner) / (2.0 * half_arc)};
  }
  const int layer = angle < nearest * whole ? std::max(nearest - 1, 0) : nearest;
  return {layer > 0 ? layer * whole + half_arc : 0.0, layer, false, gain_of(layer), 0.0};
}

DrumGroove::Place DrumGroove::at(double angle) const {
  const Piece on = piece(angle);
  const double along = lead / (2.0 * pi);
  const double part = angle - on.begin;
  Place place;
  place.gain = on.gain + on.rate * part;
  place.layer = on.layer;
  if (!has_layers()) {
    place.slope = along;
    place.axial = start + along * angle;
    return place;
  }
  // Of the layers on the way, the even ones go forth and the odd ones back.
  const bool back = on.layer % 2 != 0;
  const double end = back ? per_layer() : 0.0;  // of the change below the layer, as a way / along
  if (on.changes) {
    const double out = part - half_arc;
    const double inwards = back ? -1.0 : 1.0;
    place.slope = inwards * along * out / half_arc;
    place.axial = start + along * (end + inwards * (half_arc * half_arc + out * out) / pi);
    place.layer = out < 0.0 ? on.layer - 1 : on.layer;
    return place;
  }
  const double past = angle - on.layer * per_layer();
  place.slope = back ? -along : along;
  place.axial = start + along * (back ? per_layer() - past : past);
  return place;
}

double DrumGroove::length(double angle) const {
  const Piece on = piece(angle);
  if (!has_layers()) return on.gain * angle;
  double sum = 0.0;
  const int full = on.changes ? on.layer - 1 : on.layer;
  for (int k = 0; k < full; ++k) sum += gain_of(k);
  sum *= per_layer();
  if (!on.changes) return sum + on.gain * (angle - on.layer * per_layer());
  const double part = angle - on.begin;
  return sum + on.gain * (per_layer() - half_arc) + (on.gain + 0.5 * on.rate * part) * part;
}

double DrumGroove::length(double angle, double turn) const {
  const Piece from = piece(angle);
  if (!from.is(piece(angle + turn))) return length(angle + turn) - length(angle);
  return (from.gain + from.rate * (angle - from.begin + 0.5 * turn)) * turn;
}

double DrumGroove::angle(double length) const {
  if (!has_layers()) return length / gain_of(0);
  double left = length;
  int layer = 0;
  // Up to the end of the arc above the layer.
  for (;;) {
    const double gain = gain_of(layer);
    const double begin = layer * per_layer();
    const double plain = gain * (per_layer() - half_arc);
    if (!(left >= plain) || layer == most_layers) return begin + left / gain;
    const double outer = gain_of(layer + 1);
    const double arc = half_arc * (gain + outer);
    const double rate = (outer - gain) / (2.0 * half_arc);
    const double into = left - plain;
    if (into < arc) {
      return begin + per_layer() - half_arc +
             2.0 * into / (gain + std::sqrt(gain * gain + 2.0 * rate * into));
    }
    // S at a change of layers, as if there were no arc.
    left -= gain * per_layer();
    ++layer;
  }
}

double DrumGroove::full_length() const {
  if (layers == 0 || !has_layers()) return std::numeric_limits<double>::infinity();
  double sum = 0.0;
  for (int k = 0; k < layers; ++k) sum += gain_of(k);
  return sum * per_layer();
}

}  // namespace sheave
