// Links with friction: the decision between sticking and sliding.
//
// A link holds while the ratio of the tensions on both sides is at most e^(m a) (Euler-Eytelwein;
// a: wrap angle). If the ratio is larger, cable slides over the link towards the larger tension,
// and the ratio is e^(m a) (cable/cable_runs.cpp). The link holds again when cable would have to
// slide against the pull.
//
// A link with one direction (Passage) holds any tension in the other one: its exponent there is
// infinite. Cable that has slid forward and would slide back holds at once.
//
// A rigid span that no body can lengthen (between two posts, two holes of one body, a driven drum
// and an eyelet) has no tension of its own: its row has no gradient, so a multiplier would have no
// effect. With the links at its ends it is part of ONE capstan whose exponent is the sum of theirs.
// Links are therefore judged between two tensions that bodies determine, over all such spans in
// between:
//
//   all hold      |ln T_b - ln T_a| <= sum of m a
//   all slide     otherwise, towards the larger one
//
// Prescribed motion (a drum's drive, a feed) of such a span determines its tension. A span that has
// become too short takes cable from the side that gives it at the lower tension; on the way to the
// span that tension becomes T e^(sum). A span that has become too long gives cable to the side that
// pulls harder, at T e^(-sum). The links beside the span are then judged by that tension, as by one
// that a body determines.
//
// A span of constant compliance c can be stretched by its whole length. No cable is left in it then
// that could slide out, so the links at its ends hold whatever the tensions: its own tension is its
// length / c, and the next span has the tension of its own stretch.
//
// In a ring the tension must return to its initial value, so not all of its links can slide (unless
// their exponents cancel). If all of them would slide, one of the links that slide in the direction
// of the excess exponent holds: the link over which the least cable has passed.
//
// While the links of such a span hold, statics leaves its tension undetermined within the cones of
// its neighbours, and likewise beside a side that can neither give nor take cable
// (cable/cable_held.cpp).

#include <algorithm>
#include <cmath>
#include <limits>

#include "cable/cable_system.h"
#include "cable/held_pulls.h"
#include "cable/link_contact.h"
#include "cable/sheaths.h"
#include "engine/index.h"
#include "engine/math/portable.h"

namespace sheave {
namespace {

/// Largest number of changes of a link between sticking and sliding in one substep while several
/// links change at once: simultaneous changes can cycle.
constexpr int most_flips = 4;

/// The same limit while only one link changes at a time, the first that must. Such changes need not
/// cycle; more of them are due to rounding or to a solver far from convergence.
constexpr int most_single_flips = 12;

/// Number of changes after which a link over which no cable passes may remain a sliding link. Such
/// a link has been made to hold before, and its tensions exceeded the bound.
constexpr int resting_flips = 2;

/// Rounding error of sums of exponents.
constexpr double exponent_rounding = 1e-12;

/// Logarithm of the tension of slack cable.
constexpr double no_pull = -std::numeric_limits<double>::infinity();

bool is_still(const MovingBody& body) { return !body.translates && !body.rotates; }

/// Whether the solver cannot move the link's centre.
bool center_is_still(const Substep& substep, const LinkGeometry& link) {
  const MovingBody& carrier = substep.moving[at(link.carrier)];
  return !carrier.translates && (!carrier.rotates || (link.centered && !link.mounted));
}

/// Whether the solver cannot move cable that sticks to the link.
bool rim_is_still(const Substep& substep, const LinkGeometry& link) {
  return center_is_still(substep, link) &&
         (!link.wraps() || is_still(substep.moving[at(link.body)]));
}

}  // namespace

double CableSystem::friction_exponent(const Substep& substep, int link,
                                      const SpanGeometry& incoming,
                                      const SpanGeometry& outgoing) const {
  const LinkGeometry& geometry = links_[at(link)];
  // The ratio of an efficiency does not depend on the wrap.
  if (geometry.loss_exponent > 0.0 && geometry.loss.pin == 0.0) return geometry.loss_exponent;
  const double wrap = wrap_angle(substep, geometry, incoming, outgoing, stored_arcs_[at(link)]);
  return geometry.loss.pin > 0.0 ? geometry.loss.exponent(wrap) : geometry.friction * wrap;
}

void CableSystem::remember_friction(const Substep& substep, const CompiledCable& cable) {
  for (int k = cable.first_span; k < cable.first_span + cable.span_count; ++k) {
    if (!spans_[at(k)].active) continue;
    const int link = spans_[at(k)].second;
    if (!cable.closed && link == cable.last_listed_link()) continue;
    if (!links_[at(link)].passes() || links_[at(link)].frictionless()) continue;
    start_exponents_[at(link)] = friction_exponent(substep, link, start_spans_[at(k)],
                                                   start_spans_[at(next_span(cable, k))]);
  }
}

bool CableSystem::is_open(const Substep& substep, const CompiledCable& cable, Run run) const {
  if (cable.compliance > 0.0 || cable.inverse_stiffness > 0.0) return false;
  int last = run.first;
  for (int i = 1; i < run.count; ++i) last = next_span(cable, last);
  const LinkGeometry& start = links_[at(spans_[at(run.first)].first)];
  const LinkGeometry& end = links_[at(spans_[at(last)].second)];
  bool still = rim_is_still(substep, start) && rim_is_still(substep, end);
  bool one_body = on_one_body(start, end);
  for (int k = run.first; k != last && (still || one_body); k = next_span(cable, k)) {
    const LinkGeometry& between = links_[at(spans_[at(k)].second)];
    still = still && center_is_still(substep, between);
    one_body = one_body && between.carrier == start.body;
  }
  return still || one_body;
}

bool CableSystem::is_drained(const CompiledCable& cable, Run run) const {
  if (cable.compliance == 0.0) return false;
  for (int i = 0, k = run.first; i < run.count; ++i, k = next_span(cable, k)) {
    if (references_[at(k)].rest_length > cable.quantum) return false;
  }
  return true;
}

void CableSystem::collect_pieces(const Substep& substep, const CompiledCable& cable) {
  pieces_.clear();
  const double rounding = cable_parts::length_rounding * substep.bodies.scale();
  for_each_run(cable, [&](Run run) {
    Piece piece;
    piece.run = run;
    piece.last = run.first;
    for (int i = 1; i < run.count; ++i) piece.last = next_span(cable, piece.last);
    const int link = spans_[at(piece.last)].second;
    const bool ends = !cable.closed && link == cable.last_listed_link();
    if (!ends && links_[at(link)].passes()) piece.link = link;
    piece.first_pull = portable::log(multipliers_[at(run.first)]);
    piece.last_pull = portable::log(multipliers_[at(piece.last)]);
    if (is_open(substep, cable, run)) {
      double spare = 0.0;
      Row row;
      SpanGeometry before;
      for (int i = 0, k = run.first; i < run.count; ++i, k = next_span(cable, k)) {
        row.clear();
        const SpanGeometry span = evaluate(substep, k, row);
        spare += row.value;
        const int over = spans_[at(k)].first;
        if (i > 0 && !links_[at(over)].frictionless()) {
          piece.rise += slip_[at(over)] * friction_exponent(substep, over, before, span);
        }
        before = span;
      }
      piece.turns = turns_wheel(substep, cable, run);
      piece.kind = spare > rounding    ? Piece::Kind::too_long
                   : spare < -rounding ? Piece::Kind::too_short
                                       : Piece::Kind::open;
    }
    pieces_.push_back(piece);
  });
  if (pieces_.empty()) return;
  // The list of a ring begins and ends with a piece whose tension bodies determine, unless a link
  // that passes no cable opens the ring.
  const bool ring = cable.closed && pieces_.back().link >= 0;
  // A single piece has the link that holds between its own two ends, so that link is judged, too.
  if (!ring || (pieces_.size() == 1 && shared(pieces_.back().link))) {
    pieces_.back().link = -1;
    return;
  }
  const auto opening =
      std::find_if(pieces_.begin(), pieces_.end(), [](const Piece& p) { return p.link < 0; });
  if (opening != pieces_.end()) {
    std::rotate(pieces_.begin(), opening + 1, pieces_.end());
    return;
  }
  const auto moves = std::find_if(pieces_.begin(), pieces_.end(),
                                  [](const Piece& p) { return p.kind == Piece::Kind::moves; });
  if (moves == pieces_.end()) {
    pieces_.back().link = -1;
    return;
  }
  std::rotate(pieces_.begin(), moves, pieces_.end());
  pieces_.push_back(pieces_.front());
  pieces_.back().link = -1;
}

double CableSystem::grip(const Substep& substep, std::size_t piece) {
  Piece& before = pieces_[piece];
  if (std::isnan(before.grip)) {
    const int outgoing = pieces_[piece + 1].run.first;
    const CompiledCable& cable = cables_[at(spans_[at(outgoing)].cable)];
    // In the position solve `rattle` uses the wrap angles at the start of the substep
    // (linearise_run()).
    const bool by_start =
        knows_start_ && sweeps_[at(spans_[at(outgoing)].cable)] == 0 && kept_slip_.empty();
    const double start = start_exponents_[at(before.link)];
    if (by_start && cable.is_rigid()) return before.grip = start;
    before.grip = friction_exponent(substep, before.link, geometry_of(substep, before.last),
                                    geometry_of(substep, outgoing));
    if (by_start) before.grip = cable_parts::early_exponent(false, start, before.grip);
  }
  return before.grip;
}

bool CableSystem::may_change(int link) {
  const int most = slip_changes_.single ? most_single_flips : most_flips;
  if (slip_changes_.single && slip_changes_.done) return false;
  const bool may = flips_[at(link)] < most;
  slip_changes_.refused = slip_changes_.refused || !may;
  return may;
}

void CableSystem::set_slip(std::size_t from, std::size_t to, int slip) {
  // All links change or none, because one that does not slide holds the others.
  bool changes = false;
  for (std::size_t i = from; i < to; ++i) {
    changes = changes || pending_slip_[at(pieces_[i].link)] != slip;
  }
  if (!changes) return;
  for (std::size_t i = from; i < to; ++i) {
    if (!may_change(pieces_[i].link)) return;
  }
  slip_changes_.done = true;
  for (std::size_t i = from; i < to; ++i) {
    const int link = pieces_[i].link;
    if (pending_slip_[at(link)] == slip) continue;
    pending_slip_[at(link)] = slip;
    ++flips_[at(link)];
  }
}

void CableSystem::serve_pieces(const Substep& substep, std::size_t first, std::size_t last) {
  const auto serves = [](const Piece& p) {
    return p.kind == Piece::Kind::too_short || p.kind == Piece::Kind::too_long;
  };
  if (std::none_of(pieces_.begin() + static_cast<std::ptrdiff_t>(first),
                   pieces_.begin() + static_cast<std::ptrdiff_t>(last) + 1, serves)) {
    return;
  }
  // For each of these pieces: the tension that it would have from either side alone, NaN if that
  // side can neither give nor take cable, and the index of the piece that decides on that side.
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  // A piece that is too long and that neither side pulls is slack: it gives its spare cable without
  // tension.
  const auto left_with = [](Piece::Kind kind, double pull) {
    return std::isnan(pull) && kind == Piece::Kind::too_long ? no_pull : pull;
  };
  double pull = none;
  HeldPulls held;
  std::size_t origin = first;
  for (std::size_t i = first; i <= last; ++i) {
    Piece& piece = pieces_[i];
    if (i > first) held.add(links_[at(pieces_[i - 1].link)], grip(substep, i - 1));
    if (serves(piece)) {
      piece.from_before = offered_pull(piece.kind, pull, held.forwards, held.backwards);
      piece.before = origin;
      pull = left_with(piece.kind, piece.from_before);
      held = {};
    } else if (piece.kind == Piece::Kind::moves) {
      pull = piece.last_pull;
      held = {};
    }
    if (piece.kind != Piece::Kind::moves) pull += piece.rise;
    if (piece.kind != Piece::Kind::open) origin = i;
  }
  pull = none;
  held = {};
  origin = last;
  for (std::size_t i = last + 1; i-- > first;) {
    Piece& piece = pieces_[i];
    if (i < last) held.add(links_[at(piece.link)], grip(substep, i));
    if (serves(piece)) {
      piece.from_behind =
          offered_pull(piece.kind, pull - piece.rise, held.backwards, held.forwards);
      piece.behind = origin;
      pull = left_with(piece.kind, piece.from_behind);
      held = {};
    } else if (piece.kind == Piece::Kind::moves) {
      pull = piece.first_pull;
      held = {};
    } else {
      pull -= piece.rise;
    }
    if (piece.kind != Piece::Kind::open) origin = i;
  }
  for (std::size_t i = first; i <= last; ++i) {
    if (serves(pieces_[i])) serve(i);
  }
}

void CableSystem::serve(std::size_t index) {
  Piece& piece = pieces_[index];
  const bool takes = piece.kind == Piece::Kind::too_short;
  const double before = piece.from_before;
  const double behind = piece.from_behind;
  if (std::isnan(before) && std::isnan(behind)) {
    // Neither side can give the missing cable or pull the spare cable.
    if (!takes) piece.first_pull = piece.last_pull = no_pull;
    return;
  }
  // If both sides are equal, both act, so that a mirrored machine gives the mirrored result.
  constexpr double alike = 1e-12;
  const bool both = before == behind || std::abs(before - behind) <= alike;
  const bool first = both || std::isnan(behind) || (takes ? before < behind : before > behind);
  const bool second = both || std::isnan(before) || !first;
  const double pull = first ? before : behind;
  piece.first_pull = pull;
  piece.last_pull = pull + piece.rise;
  piece.served = true;
  if (pull == no_pull && !takes) return;
  if (first) set_slip(piece.before, index, takes ? 1 : -1);
  if (second) set_slip(index, piece.behind, takes ? -1 : 1);
  piece.fed_before = first;
  piece.fed_behind = second;
}

void CableSystem::judge_links(const Substep& substep, const CompiledCable& cable, std::size_t first,
                              std::size_t last) {
  serve_pieces(substep, first, last);
  const auto decided = [](const Piece& p) {
    return p.kind == Piece::Kind::moves || p.kind == Piece::Kind::too_long || p.served;
  };
  std::size_t from = last + 1;
  for (std::size_t i = first; i <= last; ++i) {
    const Piece& piece = pieces_[i];
    if (!decided(piece)) {
      // No side can give the missing cable, so the tension beyond this piece is unknown.
      if (piece.kind == Piece::Kind::too_short) from = last + 1;
      continue;
    }
    const std::size_t start = from;
    from = i;
    if (start > last || pieces_[start].fed_behind || piece.fed_before) continue;
    const double before = pieces_[start].last_pull;
    const double after = piece.first_pull;
    if (before == after && i == start + 1) continue;
    double rise = 0.0;
    HeldPulls held;
    for (std::size_t k = start; k < i; ++k) {
      held.add(links_[at(pieces_[k].link)], grip(substep, k));
      if (k > start) rise += pieces_[k].rise;
    }
    if (before == no_pull && after == no_pull) continue;
    const double excess = after - before - rise;
    if (excess > held.forwards && !is_drained(cable, pieces_[start].run)) set_slip(start, i, 1);
    if (-excess > held.backwards && !is_drained(cable, piece.run)) set_slip(start, i, -1);
  }
}

double CableSystem::hold_ring(const Substep& substep, const CompiledCable& cable, Run run,
                              const std::vector<double>& spare) {
  int last = run.first;
  for (int i = 1; i < run.count; ++i) last = next_span(cable, last);
  if (!cable.closed || !shared(spans_[at(last)].second)) return 0.0;
  double rise = 0.0;
  SpanGeometry before = geometry_of(substep, last);
  for (int i = 0, k = run.first; i < run.count; ++i, k = next_span(cable, k)) {
    const SpanGeometry span = geometry_of(substep, k);
    const int link = spans_[at(k)].first;
    if (slip_[at(link)] != 0)
      rise += slip_[at(link)] * friction_exponent(substep, link, before, span);
    before = span;
  }
  if (std::abs(rise) <= exponent_rounding) return 0.0;
  // Holds one of the links that slide in the direction of the excess exponent: the link over which
  // the least cable has passed.
  const int way = rise > 0.0 ? 1 : -1;
  double passed = 0.0;
  double least = std::numeric_limits<double>::infinity();
  int held = -1;
  for (int i = 0, k = run.first; i < run.count; ++i, k = next_span(cable, k)) {
    // No cable passes the last link of the ring, but its surface may move.
    const bool slides = i + 1 < run.count || run_work_.arcs[at(i)].link >= 0;
    passed = slides ? passed + spare[at(i)] : 0.0;
    const double slid = slides ? pass_arc(at(i), passed) : 0.0;
    const int link = spans_[at(k)].second;
    if (slip_[at(link)] != way || slid * way >= least) continue;
    least = slid * way;
    held = link;
  }
  pending_slip_[at(held)] = 0;
  ++flips_[at(held)];
  return -least * way;
}

void CableSystem::update_slip(const Substep& substep, const CompiledCable& cable) {
  slip_changes_ = {};
  look_at_links(substep, cable);
  if (slip_changes_.refused && pending_slip_ == slip_) {
    slip_changes_.single = true;
    look_at_links(substep, cable);
  }
  slip_ = pending_slip_;
}

bool CableSystem::may_slide_by_means(const CompiledCable& cable, int link) {
  const bool elastic = cable.compliance > 0.0 || cable.inverse_stiffness > 0.0;
  if (!knows_start_ || !elastic || run_work_.means[at(link)] != 0) return false;
  run_work_.means[at(link)] = 1;
  slip_changes_.means = true;
  return true;
}

void CableSystem::look_at_links(const Substep& substep, const CompiledCable& cable) {
  // A link goes on sliding if cable has moved with the pull by more than rounding.
  const double rounding = cable_parts::length_rounding * substep.bodies.scale();
  for_each_run(cable, [&](Run run) {
    if (run.count == 1) return;
    const std::vector<double>& spare = run_spare(substep, cable, run);
    double passed = hold_ring(substep, cable, run, spare);
    for (int i = 0, k = run.first; i + 1 < run.count; ++i, k = next_span(cable, k)) {
      passed += spare[at(i)];
      const double slid = pass_arc(at(i), passed);
      const int link = spans_[at(k)].second;
      int& slip = pending_slip_[at(link)];
      if (links_[at(link)].frictionless() || slip == 0) continue;
      if (slid * slip > rounding) continue;
      if (may_slide_by_means(cable, link)) continue;
      // A link that could not hold before, and over which no cable passes, is at its bound.
      if (slid * slip >= -rounding && flips_[at(link)] >= resting_flips) continue;
      if (!may_change(link)) continue;
      slip_changes_.done = true;
      slip = 0;
      run_work_.means[at(link)] = 0;
      ++flips_[at(link)];
    }
  });
  release_links(substep, cable);
}

void CableSystem::release_links(const Substep& substep, const CompiledCable& cable) {
  collect_pieces(substep, cable);
  for (std::size_t first = 0, i = 0; i < pieces_.size(); ++i) {
    if (pieces_[i].link >= 0) continue;
    judge_links(substep, cable, first, i);
    first = i + 1;
  }
}

bool CableSystem::revise_impulses(const Substep& substep) {
  // Elastic cables are left out: the force of a spring is the same in both halves of the substep.
  // Only holding links are judged, because the positions have shown that the others slide.
  bool changed = false;
  for (const CompiledCable& cable : cables_) {
    if (!cable.has_friction || cable.compliance > 0.0 || cable.inverse_stiffness > 0.0) continue;
    if (kept_slip_.empty()) {
      kept_slip_ = slip_;
      kept_flips_ = flips_;
      std::fill(flips_.begin(), flips_.end(), 0);
    }
    slip_changes_ = {};
    release_links(substep, cable);
    changed = changed || pending_slip_ != slip_;
    slip_ = pending_slip_;
  }
  return revise_pins(substep) || changed;
}

void CableSystem::end_impulses() {
  if (kept_slip_.empty()) return;
  slip_ = pending_slip_ = kept_slip_;
  flips_ = kept_flips_;
  kept_slip_.clear();
}

bool CableSystem::revise(Substep& substep) {
  bool changed = false;
  given_.knows_multipliers = true;
  for (const CompiledCable& cable : cables_) {
    if (cable.has_sheaths) changed = Sheaths(*this).revise(substep, cable) || changed;
    if (!cable.has_friction) continue;
    const auto begin = slip_.begin() + cable.first_link;
    revised_.assign(begin, begin + cable.link_count);
    update_slip(substep, cable);
    changed = changed || slip_changes_.means;
    changed = changed || !std::equal(revised_.begin(), revised_.end(), begin);
    changed = has_other_given(substep, cable) || changed;
  }
  return revise_bearings(substep) || changed;
}

}  // namespace sheave
