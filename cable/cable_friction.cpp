// Links with friction: where does cable slide?
//
// A link holds while the tensions on both sides differ by no more than the factor e^(m a)
// (Euler-Eytelwein; a: wrap angle); if they differ by more, cable slides over it towards the larger
// one, and the two are tied (cable/cable_runs.cpp). It holds again when cable would have to slide
// against the pull.
//
// A rigid span that no body can lengthen (between two posts, two holes of one body, a driven drum
// and an eyelet) has no tension of its own: its row has no gradient, so a multiplier would do
// nothing. With the links at its ends it is part of ONE capstan whose exponent is the sum of
// theirs. So links are judged from one tension that bodies decide to the next one, over all such
// spans in between:
//
//   all hold      |ln T_b - ln T_a| <= sum of m a
//   all slide     otherwise, towards the larger one
//
// What prescribed motion (a drum's drive, a feed) makes of such a span decides more. One that has
// become too short takes cable from that side which gives it at the lower tension, T e^(sum) on the
// way there; one that has become too long gives it to the side that pulls harder, T e^(-sum). It
// has that tension then, and is judged by like a body's.
//
// A span of constant compliance c can be stretched by all of its length. Then no cable is left in
// it that could slide out, so the links at its ends hold whatever the tensions: it has its length /
// c, the next span what its own stretch gives.
//
// Round a ring the tension comes back to itself, so not all of its links slide (unless their
// exponents cancel): where they would, the one holds over which the least has passed, of those that
// slide as there is too much of it.
//
// While its links hold, statics leaves the tension of such a span open within the cones of its
// neighbours, and so beside a dead end (cable/cable_held.cpp).

#include <algorithm>
#include <cmath>
#include <limits>

#include "cable/cable_system.h"
#include "cable/link_contact.h"
#include "engine/index.h"
#include "engine/math/portable.h"

namespace sheave {
namespace {

/// More changes of a link between sticking and sliding in one substep, many at once, go round.
constexpr int most_flips = 4;

/// One at a time, the first of those that have to, they need not; beyond that it is rounding or a
/// solver far from convergence.
constexpr int most_single_flips = 12;

/// A link that slid by nothing has been made to hold, and did not.
constexpr int resting_flips = 2;

/// What rounding leaves of sums of exponents.
constexpr double exponent_rounding = 1e-12;

/// Nothing pulls, as the logarithm of a tension.
constexpr double no_pull = -std::numeric_limits<double>::infinity();

bool is_still(const MovingBody& body) { return !body.translates && !body.rotates; }

/// Whether nothing that the solver does moves the link's centre.
bool center_is_still(const Substep& substep, const LinkGeometry& link) {
  const MovingBody& carrier = substep.moving[at(link.carrier)];
  return !carrier.translates && (!carrier.rotates || (link.centered && !link.mounted));
}

/// Whether nothing that the solver does moves cable that sticks to the link.
bool rim_is_still(const Substep& substep, const LinkGeometry& link) {
  return center_is_still(substep, link) &&
         (!link.wraps() || is_still(substep.moving[at(link.body)]));
}

}  // namespace

double CableSystem::friction_exponent(const Substep& substep, int link,
                                      const SpanGeometry& incoming,
                                      const SpanGeometry& outgoing) const {
  const LinkGeometry& geometry = links_[at(link)];
  if (geometry.loss_exponent > 0.0) return geometry.loss_exponent;
  return geometry.friction *
         wrap_angle(substep, geometry, incoming, outgoing, stored_arcs_[at(link)]);
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
  // A ring begins, and ends, with a piece whose tension bodies decide, unless a link that does not
  // pass cable opens it.
  const bool ring = cable.closed && pieces_.back().link >= 0;
  // Of a single piece, too, the link that holds has its two ends on its sides.
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
    // The positions of `rattle` know what slides by the angles of the start (linearise_run()).
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
  // All or none, because what does not slide holds the others.
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
  // What each of them would have from either side alone, NaN if that side is a dead end, and from
  // where.
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const auto offer = [](Piece::Kind kind, double pull, double held) {
    return kind == Piece::Kind::too_short ? pull + held : pull - held;
  };
  // What has cable to spare that nobody pulls at is slack, and gives it to whom it lacks.
  const auto left_with = [](Piece::Kind kind, double pull) {
    return std::isnan(pull) && kind == Piece::Kind::too_long ? no_pull : pull;
  };
  double pull = none;
  double held = 0.0;
  std::size_t origin = first;
  for (std::size_t i = first; i <= last; ++i) {
    Piece& piece = pieces_[i];
    if (i > first) held += grip(substep, i - 1);
    if (serves(piece)) {
      piece.from_before = offer(piece.kind, pull, held);
      piece.before = origin;
      pull = left_with(piece.kind, piece.from_before);
      held = 0.0;
    } else if (piece.kind == Piece::Kind::moves) {
      pull = piece.last_pull;
      held = 0.0;
    }
    if (piece.kind != Piece::Kind::moves) pull += piece.rise;
    if (piece.kind != Piece::Kind::open) origin = i;
  }
  pull = none;
  held = 0.0;
  origin = last;
  for (std::size_t i = last + 1; i-- > first;) {
    Piece& piece = pieces_[i];
    if (i < last) held += grip(substep, i);
    if (serves(piece)) {
      piece.from_behind = offer(piece.kind, pull - piece.rise, held);
      piece.behind = origin;
      pull = left_with(piece.kind, piece.from_behind);
      held = 0.0;
    } else if (piece.kind == Piece::Kind::moves) {
      pull = piece.first_pull;
      held = 0.0;
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
    // Nothing can give what it lacks, or pull what it has to spare.
    if (!takes) piece.first_pull = piece.last_pull = no_pull;
    return;
  }
  // Where both sides are alike, so is what they do: a machine's mirror image does the mirror image.
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
      // What it lacks nobody can give it, so nothing is known on its far side.
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
    double held = 0.0;
    for (std::size_t k = start; k < i; ++k) {
      held += grip(substep, k);
      if (k > start) rise += pieces_[k].rise;
    }
    if (before == no_pull && after == no_pull) continue;
    const double excess = after - before - rise;
    if (excess > held && !is_drained(cable, pieces_[start].run)) set_slip(start, i, 1);
    if (-excess > held && !is_drained(cable, piece.run)) set_slip(start, i, -1);
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
  // Of those that slide the way in which there is too much of it, the one over which the least has
  // passed.
  const int way = rise > 0.0 ? 1 : -1;
  double passed = 0.0;
  double least = std::numeric_limits<double>::infinity();
  int held = -1;
  for (int i = 0, k = run.first; i < run.count; ++i, k = next_span(cable, k)) {
    passed = i + 1 < run.count ? passed + spare[at(i)] : 0.0;
    const double slid = i + 1 < run.count ? pass_arc(at(i), passed) : 0.0;
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
  // Links that slide: has the cable moved with the pull, and by more than rounding?
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
      // One that does not hold either, but over which nothing passes, is at its bound.
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
  // The force of a spring is the same in both halves. What slides has been found to slide.
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
  return changed;
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
