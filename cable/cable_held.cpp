// Tensions that no body determines: those of spans that no motion lengthens (see
// cable/cable_friction.cpp).
//
// While the links around such spans hold, statics leaves the tension undetermined within the
// friction cones of its neighbours and next to dead ends. The tension keeps its last value, which
// the last slip has left, if the cones contain that value, and otherwise takes the nearest value
// within them.
//
// Over a free wheel between such spans cable may slide while no other body moves: a rope from a
// wall over a spinning brake drum into a rough eyelet. Their common row then has no residual, but
// the difference of their tensions turns the wheel. The difference is a given force: in every round
// the force that the neighbours of the last round hold, in the first round that of the last
// substep.

#include <algorithm>
#include <cmath>
#include <limits>

#include "cable/cable_system.h"
#include "engine/index.h"
#include "engine/math/portable.h"

namespace sheave {
namespace {

/// Logarithm of a zero tension.
constexpr double slack_pull = -std::numeric_limits<double>::infinity();

/// Relative changes of a given force up to this count as converged.
constexpr double settled_share = 1e-10;

/// Largest number of changes in a substep. Further changes would not improve convergence.
constexpr int most_changes = 20;

/// Widens the range of a tension (as logarithms) over a link, seen from the span behind the link.
/// The link holds `grip` in either way, and any tension in the way `blocked`. The tension before it
/// is at least `low` - grip, or else cable would slide forward, and at most `high` + grip, or else
/// cable would slide back.
void widen(int blocked, double grip, double& low, double& high) {
  low = blocked == 1 ? slack_pull : low - grip;
  high = blocked == -1 ? -slack_pull : high + grip;
}

}  // namespace

bool CableSystem::turns_wheel(const Substep& substep, const CompiledCable& cable, Run run) const {
  // If one body holds the whole run, body and run move as one, so the run does not turn the body.
  const int holds = links_[at(spans_[at(run.first)].first)].body;
  for (int i = 0, k = run.first; i + 1 < run.count; ++i, k = next_span(cable, k)) {
    const LinkGeometry& between = links_[at(spans_[at(k)].second)];
    if (between.body == holds) continue;
    if (between.wraps() && substep.moving[at(between.body)].rotates) return true;
  }
  return false;
}

void CableSystem::find_given(const Substep& substep, const CompiledCable& cable) {
  collect_pieces(substep, cable);
  if (!given_.knows_multipliers) {
    for (const Piece& piece : pieces_) {
      const int span = piece.run.first;
      given_.pulls[at(span)] = portable::log(substep.h * substep.h * start_tensions_[at(span)]);
    }
    return;
  }
  // The rounds of `rattle` find the part of the first half.
  const double rest = -portable::log(substep.load_share);
  for (Piece& piece : pieces_) {
    piece.first_pull += rest;
    piece.last_pull += rest;
  }
  hold_all(substep, cable, Held::given);
}

void CableSystem::give(const Substep& substep, const CompiledCable& cable,
                       const RunWeights& heaviest, Row& row) {
  find_given(substep, cable);
  // Bounds refer to the unknown of the run.
  const double most = substep.load_share < 1.0 ? heaviest.start : heaviest.now;
  row.lower = row.upper = portable::exp(given_.pulls[at(row.index)] + most);
}

bool CableSystem::has_other_given(const Substep& substep, const CompiledCable& cable) {
  bool any = false;
  for_each_run(cable, [&](Run run) {
    any =
        any || (run.count > 1 && turns_wheel(substep, cable, run) && is_open(substep, cable, run));
  });
  if (!any || given_.changes >= most_changes) return false;
  const auto first = given_.pulls.begin() + cable.first_span;
  given_.before.assign(first, first + cable.span_count);
  find_given(substep, cable);
  const bool changed = std::any_of(pieces_.begin(), pieces_.end(), [&](const Piece& piece) {
    const double now = given_.pulls[at(piece.run.first)];
    const double then = given_.before[at(piece.run.first - cable.first_span)];
    return piece.turns && now != then && !(std::abs(now - then) <= settled_share);
  });
  if (changed) ++given_.changes;
  return changed;
}

void CableSystem::hold_tensions(const Substep& substep, const CompiledCable& cable) {
  collect_pieces(substep, cable);
  hold_all(substep, cable, Held::reported);
}

void CableSystem::hold_all(const Substep& substep, const CompiledCable& cable, Held what) {
  for (std::size_t first = 0, i = 0; i < pieces_.size(); ++i) {
    if (pieces_[i].link >= 0) continue;
    hold_between(substep, cable, what, first, i);
    first = i + 1;
  }
}

void CableSystem::hold_between(const Substep& substep, const CompiledCable& cable, Held what,
                               std::size_t first, std::size_t last) {
  // Given forces have acted already.
  const auto open = [&](const Piece& p) {
    return p.kind != Piece::Kind::moves && !(what == Held::reported && p.turns);
  };
  // The cone that the pieces behind each piece leave for it.
  double low = slack_pull;
  double high = -slack_pull;
  for (std::size_t i = last + 1; i-- > first;) {
    Piece& piece = pieces_[i];
    if (i < last) widen(links_[at(piece.link)].blocked, grip(substep, i), low, high);
    if (!open(piece)) {
      low = high = piece.first_pull;
      continue;
    }
    if (piece.kind == Piece::Kind::too_long) low = high = slack_pull;
    low -= piece.rise;
    high -= piece.rise;
    piece.low = low;
    piece.high = high;
  }
  const double square = substep.h * substep.h;
  bool known = false;  // whether the piece before has a tension
  double pull = 0.0;
  for (std::size_t i = first; i <= last; ++i) {
    Piece& piece = pieces_[i];
    if (!open(piece)) {
      pull = piece.last_pull;
      known = true;
      continue;
    }
    const double had = portable::log(square * start_tensions_[at(piece.run.first)]);
    double value = std::clamp(had, piece.low, piece.high);
    if (known && i > first) {
      // Seen from the piece before, cable that slides forward comes at the greater tension here.
      double least = pull;
      double most = pull;
      widen(-links_[at(pieces_[i - 1].link)].blocked, grip(substep, i - 1), least, most);
      value = std::clamp(value, least, most);
    }
    if (what == Held::given) {
      given_.pulls[at(piece.run.first)] = value;
    } else {
      apply_held(substep, cable, piece, value);
    }
    pull = value + piece.rise;
    known = true;
  }
}

void CableSystem::apply_held(const Substep& substep, const CompiledCable& cable, const Piece& piece,
                             double pull) {
  SpanGeometry before;
  for (int i = 0, k = piece.run.first; i < piece.run.count; ++i, k = next_span(cable, k)) {
    if (piece.run.count > 1) {
      const SpanGeometry span = geometry_of(substep, k);
      const int over = spans_[at(k)].first;
      if (i > 0 && !links_[at(over)].frictionless()) {
        pull += slip_[at(over)] * friction_exponent(substep, over, before, span);
      }
      before = span;
    }
    multipliers_[at(k)] = portable::exp(pull);
  }
}

}  // namespace sheave
