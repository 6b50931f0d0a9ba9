#pragma once
// The hold of links with friction between two tensions, as logarithms; internal to the cable library.

#include <cmath>
#include <limits>

#include "cable/cable_parts.h"
#include "cable/link_geometry.h"

namespace sheave {

/// The largest rise of the logarithm of the tension that a link holds against cable that would
/// slide over it towards the next span (way 1) or back (way -1). `grip`: friction times wrap angle.
inline double held_against(const LinkGeometry& link, int way, double grip) {
  return link.blocked == way ? std::numeric_limits<double>::infinity() : grip;
}

/// The hold of all links between two tensions, in either way of the cable.
struct HeldPulls {
  double forwards = 0.0;
  double backwards = 0.0;

  void add(const LinkGeometry& link, double grip) {
    forwards += held_against(link, 1, grip);
    backwards += held_against(link, -1, grip);
  }
};

/// The pull that a side with the tension `pull` would give a piece. `to` holds cable on the way from
/// the side to the piece, `from` on the way back. NaN: no cable passes on that way.
inline double offered_pull(cable_parts::Piece::Kind kind, double pull, double to, double from) {
  const bool takes = kind == cable_parts::Piece::Kind::too_short;
  if (std::isinf(takes ? to : from)) return std::numeric_limits<double>::quiet_NaN();
  return takes ? pull + to : pull - from;
}

}  // namespace sheave
