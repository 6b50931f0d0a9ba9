// Drives that need more cable than there is.
//
// A prescribed rotation turns against any load, and so does a feed. A chain is the sequence of
// spans between two links over which cable passes only if their bodies turn by themselves (driven
// wheels, fixed points, the cable's ends). The sum of a chain's rest lengths changes only by the
// cable that drives feed and draw. Two conditions limit the cable that can be drawn:
//
// - No rest length is below 0. The rest lengths of the chain and the cable wound on a free drum at
//   its end are all the cable there is: a load has reached its drum.
// - If only drives can move any part of a rigid chain, rest lengths are not shorter than the spans:
//   a belt over two wheels that are driven at different speeds. (Wheels on fixed axles between the
//   spans may turn: they give to one span the cable that they take from the other.)
//
// And no more cable can be paid out from a drum that is not round than is stored on it. (A round
// drum then holds the cable's end by its rim.)
//
// A drive that would draw more than that stalls: it does the fraction of its motion in the substep
// for which the cable suffices, and at the end of the substep it has the speed at which it draws
// exactly the cable that is fed. Other drives continue. A slowed drive may feed another chain,
// which then may lack cable in turn, and so on; the fractions only decrease. Lengths thus remain
// possible, no cable is lost, and the solver gets no contradictory rows.
//
// A drum that has drawn all cable stays locked until its drive turns the other way or stops, even
// if the load swings up when the drum stops and could unwind a little.

#include <algorithm>
#include <cmath>

#include "cable/cable_system.h"
#include "cable/link_contact.h"
#include "engine/body_drive.h"
#include "engine/index.h"

namespace sheave {
namespace {

/// Rounding error of lengths that are drawn and fed equally, relative to both together. The next
/// substep corrects it.
constexpr double overlooked = 1e-9;

/// Rotation of body `index` in the substep if its drive does its whole motion [rad].
double driven_turn(const Substep& substep, int index) {
  return BodyDrive(substep.bodies[index], substep.start.controls, index)
      .turn(substep.start.time, substep.next.time);
}

/// Largest lever arm of a cable on the link's body [m].
double reach_of(const LinkGeometry& link) {
  return link.outline ? 0.5 * link.perimeter() : std::abs(link.signed_radius);
}

}  // namespace

void CableSystem::begin_drives(const FeatureState& state) {
  std::fill(drive_work_.stalled.begin(), drive_work_.stalled.end(), 0);
  for (const CompiledCable& cable : cables_) {
    for (const int link : cable.driven_links) {
      drive_work_.locked[at(link)] = static_cast<int>(state.integers[stall_index(link)]);
    }
  }
}

int CableSystem::driven_way(const Substep& substep, int link) const {
  const BodyProperties& body = substep.bodies[links_[at(link)].body];
  if (!body.prescribed()) return 0;
  const double turn = driven_turn(substep, links_[at(link)].body);
  return turn > 0.0 ? 1 : turn < 0.0 ? -1 : 0;
}

bool CableSystem::ends_chain(const BodySet& bodies, const LinkGeometry& link) {
  if (link.passes()) return false;
  if (!link.wraps() || link.body == bodies.count()) return true;
  const BodyProperties& body = bodies[link.body];
  const bool turns = body.mobility == Mobility::free || body.mobility == Mobility::planar ||
                     body.mobility == Mobility::rotor;
  return !turns || body.prescribed();
}

bool CableSystem::can_move(const BodySet& bodies, const LinkGeometry& link) {
  if (link.carrier == bodies.count()) return false;
  const BodyProperties& carrier = bodies[link.carrier];
  return carrier.mobility != Mobility::fixed && !carrier.prescribed();
}

bool CableSystem::may_fall_short(const Substep& substep, const CompiledCable& cable) const {
  if (cable.may_lock) return true;
  for (const int link : cable.driven_links) {
    if (drive_work_.locked[at(link)] != 0) return true;
    const LinkGeometry& geometry = links_[at(link)];
    const BodyProperties& body = substep.bodies[geometry.body];
    double most = std::abs(geometry.feed_speed) * substep.h;
    if (body.prescribed())
      most += reach_of(geometry) * std::abs(driven_turn(substep, geometry.body));
    for (const bool after : {true, false}) {
      const int span = after ? link - cable.first_link : link - cable.first_link - 1;
      if (span < 0 || span >= cable.span_count) {
        if (cable.closed) return true;
        continue;
      }
      const int k = cable.first_span + span;
      if (!spans_[at(k)].active || (after ? spans_[at(k)].first : spans_[at(k)].second) != link) {
        return true;
      }
      if (references_[at(k)].rest_length < 2.0 * most) return true;
    }
    if (runs_out(cable, link) && stored_arcs_[at(link)] < 2.0 * most) return true;
  }
  return false;
}

void CableSystem::limit_drives(Substep& substep) {
  drive_work_.chains.clear();
  drive_work_.pulls.clear();
  for (auto& shares : drive_work_.feed_shares) shares = {};
  for (const CompiledCable& cable : cables_) {
    for (const int link : cable.driven_links) {
      if (driven_way(substep, link) != drive_work_.locked[at(link)])
        drive_work_.locked[at(link)] = 0;
    }
    if (cable.driven_links.empty() || !may_fall_short(substep, cable)) continue;
    find_chains(substep, cable);
    add_stored_cable(substep, cable);
  }
  if (drive_work_.chains.empty()) return;
  // Slowed drives may leave other chains short. After so many rounds the drives stop.
  constexpr int patience = 50;
  const int most = patience + static_cast<int>(drive_work_.pulls.size());
  bool short_of_cable = true;
  for (int round = 0; short_of_cable && round < most; ++round) {
    short_of_cable = false;
    for (const Chain& chain : drive_work_.chains) {
      short_of_cable = stall(substep, chain, round >= patience) || short_of_cable;
    }
  }
  for (const Pull& pull : drive_work_.pulls) {
    if (pull.span < 0) continue;
    const DriveShare& share = drive_work_.feed_shares[at(pull.span)][at(pull.end)];
    double& fed = fed_[at(pull.span)][at(pull.end)];
    references_[at(pull.span)].rest_length -= (1.0 - share.way) * fed;
    fed *= share.way;
    drive_work_.feed_rates[at(pull.span)] -= (1.0 - share.speed) * pull.speed;
  }
}

bool CableSystem::stall(Substep& substep, const Chain& chain, bool altogether) {
  std::array<double, 2> fed{};  // length [m] and speed [m/s] of the moved cable
  std::array<double, 2> drawn{};
  double gross = 0.0;
  const auto pulls =
      std::span(drive_work_.pulls).subspan(at(chain.first_pull), at(chain.pull_count));
  for (const Pull& pull : pulls) {
    const DriveShare& share = share_of(substep, pull);
    gross += share.way * pull.gross;
    const std::array change{share.way * pull.way, share.speed * pull.speed};
    for (std::size_t i = 0; i < 2; ++i) (change[i] > 0.0 ? fed : drawn)[i] += std::abs(change[i]);
  }
  const double there = std::max(chain.available + fed[0], 0.0);
  if (!(drawn[0] - there > overlooked * gross)) return false;
  const double way = altogether ? 0.0 : there / drawn[0];
  const double speed = altogether || !(drawn[1] > 0.0) ? 0.0 : std::min(fed[1] / drawn[1], 1.0);
  for (const Pull& pull : pulls) {
    if (!(pull.way < 0.0)) continue;
    DriveShare& share = share_of(substep, pull);
    share.way *= way;
    share.speed *= speed;
    drive_work_.stalled[at(pull.link)] = 1;
    if (chain.moves && pull.span < 0) {
      drive_work_.locked[at(pull.link)] = driven_way(substep, pull.link);
    }
  }
  return true;
}

DriveShare& CableSystem::share_of(Substep& substep, const Pull& pull) {
  return pull.span < 0 ? substep.drive_shares[at(links_[at(pull.link)].body)]
                       : drive_work_.feed_shares[at(pull.span)][at(pull.end)];
}

void CableSystem::find_chains(Substep& substep, const CompiledCable& cable) {
  const BodySet& bodies = substep.bodies;
  int first = first_active_span(cable, spans_);
  if (first < 0) return;
  if (cable.closed) {
    // Begin behind a link that ends a chain; without one the ring is one chain.
    for (int k = cable.first_span; k < cable.first_span + cable.span_count; ++k) {
      if (!spans_[at(k)].active || !ends_chain(bodies, links_[at(spans_[at(k)].second)])) continue;
      first = next_span(cable, k);
      break;
    }
  }
  ChainLengths lengths;
  begin_chain(substep, cable, spans_[at(first)].first, lengths);
  for (int k = first;;) {
    add_to_chain(substep, k, lengths);
    const int link = spans_[at(k)].second;
    k = next_span(cable, k);
    const bool last = k == first;
    const bool ends = last || ends_chain(bodies, links_[at(link)]);
    lengths.moves = lengths.moves || can_move(bodies, links_[at(link)]);
    if (!ends) continue;
    end_chain(substep, cable, link, lengths);
    if (last) return;
    begin_chain(substep, cable, link, lengths);
  }
}

void CableSystem::begin_chain(const Substep& substep, const CompiledCable& cable, int link,
                              ChainLengths& lengths) {
  lengths = {};
  lengths.moves = cable.compliance > 0.0 || cable.inverse_stiffness > 0.0;
  Chain chain;
  chain.first_pull = static_cast<int>(drive_work_.pulls.size());
  drive_work_.chains.push_back(chain);
  add_drum(substep, cable, link, lengths);
}

void CableSystem::end_chain(const Substep& substep, const CompiledCable& cable, int link,
                            ChainLengths& lengths) {
  add_drum(substep, cable, link, lengths);
  Chain& chain = drive_work_.chains.back();
  chain.pull_count = static_cast<int>(drive_work_.pulls.size()) - chain.first_pull;
  chain.moves = lengths.moves;
  chain.available = lengths.moves ? lengths.rest_length : lengths.rest_length - lengths.length;
  // Points that a drive moves change the lengths of spans. These changes matter only if the spans
  // limit the rest lengths.
  const auto begin = drive_work_.pulls.begin() + chain.first_pull;
  if (lengths.moves) {
    for (auto pull = begin; pull != drive_work_.pulls.end(); ++pull) {
      pull->way -= pull->way_of_points;
      pull->speed -= pull->speed_of_points;
      if (pull->way < 0.0 && drive_work_.locked[at(pull->link)] != 0) chain.available = 0.0;
    }
  }
}

void CableSystem::add_drum(const Substep& substep, const CompiledCable& cable, int link,
                           ChainLengths& lengths) const {
  const LinkGeometry& geometry = links_[at(link)];
  if (can_move(substep.bodies, geometry)) lengths.moves = true;
  if (cable.closed || (link != cable.first_link && link != cable.last_listed_link())) return;
  if (!geometry.wraps() || ends_chain(substep.bodies, geometry)) return;
  lengths.moves = true;
  lengths.rest_length += std::max(stored_arcs_[at(link)], 0.0);
}

void CableSystem::add_to_chain(const Substep& substep, int span, ChainLengths& lengths) {
  const SpanSetup& setup = spans_[at(span)];
  const SpanGeometry geometry = geometry_of(substep, span);
  lengths.rest_length += references_[at(span)].rest_length;
  lengths.length += geometry.length;
  for (const int end : {0, 1}) {
    const int index = end == 0 ? setup.first : setup.second;
    const LinkGeometry& link = links_[at(index)];
    if (link.feeds) {
      const double fed = fed_[at(span)][at(end)];
      // The rest length already contains the fed cable.
      lengths.rest_length -= fed;
      add_pull({index, span, end, fed, link.feed_end_speed, std::abs(fed), 0.0, 0.0});
    }
    const BodyProperties& body = substep.bodies[link.body];
    if (!body.prescribed()) continue;
    const double turn = driven_turn(substep, link.body);
    const double speed = substep.driven_speed(link.body);
    // The lever as in the gradient of the span's row.
    const Vector3& point = end == 0 ? geometry.start : geometry.end;
    const Vector3 arm = cross(point - substep.position(link.body), geometry.direction);
    const double lever = (end == 0 ? 1.0 : -1.0) * dot(body.axis, arm);
    const double of_points = link.wraps() ? 0.0 : lever;
    add_pull({index, -1, 0, lever * turn, lever * speed, std::abs(lever * turn), of_points * turn,
              of_points * speed});
  }
}

void CableSystem::add_stored_cable(const Substep& substep, const CompiledCable& cable) {
  for (const int link : cable.driven_links) {
    const BodyProperties& body = substep.bodies[links_[at(link)].body];
    const bool first = link == cable.first_link;
    const int span = first ? span_after(cable, link) : span_before(cable, link, spans_);
    if (!runs_out(cable, link) || !body.prescribed() || span < 0 || !spans_[at(span)].active) {
      continue;
    }
    const SpanGeometry geometry = geometry_of(substep, span);
    const Vector3& point = first ? geometry.start : geometry.end;
    const Vector3 arm = cross(point - substep.position(links_[at(link)].body), geometry.direction);
    const double lever = (first ? -1.0 : 1.0) * dot(body.axis, arm);
    const double turn = driven_turn(substep, links_[at(link)].body);
    const double speed = substep.driven_speed(links_[at(link)].body);
    const double way = lever * turn;
    Chain chain;
    chain.first_pull = static_cast<int>(drive_work_.pulls.size());
    chain.pull_count = 1;
    chain.available = stored_arcs_[at(link)];
    drive_work_.chains.push_back(chain);
    drive_work_.pulls.push_back({link, -1, 0, way, lever * speed, std::abs(way), 0.0, 0.0});
  }
}

void CableSystem::add_pull(const Pull& pull) {
  // For a wheel that cable passes, or at which both ends of the chain lie, only the difference of
  // drawn and fed cable counts.
  for (std::size_t i = at(drive_work_.chains.back().first_pull); i < drive_work_.pulls.size();
       ++i) {
    Pull& other = drive_work_.pulls[i];
    if (pull.span >= 0 || other.span >= 0) continue;
    if (links_[at(other.link)].body != links_[at(pull.link)].body) continue;
    if (pull.way < other.way) other.link = pull.link;
    other.way += pull.way;
    other.speed += pull.speed;
    other.gross += pull.gross;
    other.way_of_points += pull.way_of_points;
    other.speed_of_points += pull.speed_of_points;
    return;
  }
  drive_work_.pulls.push_back(pull);
}

// A search for equilibrium passes poses in which a span would have a length below 0: its rows are
// not satisfied there. Cable that slid over a wheel then would stay where the search has put it, so
// the length below 0 remains until the rows have drawn the bodies back. A cable of a material has no
// strain at such a length and slides.
void CableSystem::wind(int span, const SpanTransport& transport, bool searches,
                       FeatureState& next) {
  const SpanSetup& setup = spans_[at(span)];
  const CompiledCable& cable = cables_[at(setup.cable)];
  double& rest_length = next.reals[rest_length_index(span)];
  const std::array<int, 2> ends{setup.first, setup.second};
  const std::array<double, 2> amounts{transport.from_first, transport.from_second};
  std::array<double, 2> moved{};
  // The part below the quantum waits for the next substep.
  for (std::size_t end = 0; end < 2; ++end) {
    if (!links_[at(ends[end])].wraps()) continue;
    double& remainder = next.reals[remainder_index(span, static_cast<int>(end))];
    moved[end] = cable.quantised(amounts[end] + remainder);
    remainder += amounts[end] - moved[end];
  }
  const bool may_be_negative = searches && cable.inverse_stiffness == 0.0;
  if (rest_length + moved[0] + moved[1] < 0.0 && !may_be_negative) {
    slide_over_ends(span, moved, next);
  }
  for (std::size_t end = 0; end < 2; ++end) {
    double& stored = next.reals[stored_length_index(ends[end])];
    if (moved[end] > stored && runs_out(cable, ends[end])) {
      // The cable's end slides over the edge of the drum.
      next.reals[slip_index(ends[end])] += (end == 0 ? -1.0 : 1.0) * (moved[end] - stored);
      moved[end] = stored;
      drive_work_.slid[at(ends[end])] = 1;
      notes_.slides = true;
      ++notes_.edition;
    }
    rest_length += moved[end];
    stored -= moved[end];
  }
}

// Lets cable slide over a wheel that would take more than the span has.
void CableSystem::slide_over_ends(int span, std::array<double, 2>& moved, FeatureState& next) {
  double missing = -(next.reals[rest_length_index(span)] + moved[0] + moved[1]);
  for (std::size_t end = 0; end < 2; ++end) {
    const double kept = std::min(missing, std::max(-moved[end], 0.0));
    if (!(kept > 0.0)) continue;
    const int link = end == 0 ? spans_[at(span)].first : spans_[at(span)].second;
    moved[end] += kept;
    missing -= kept;
    next.reals[slip_index(link)] += end == 0 ? kept : -kept;
    drive_work_.slid[at(link)] = 1;
    notes_.slides = true;
    ++notes_.edition;
  }
}

void CableSystem::record_stalls(const Substep& substep, FeatureState& next) {
  const auto observe = [&](const CompiledCable& cable, int link, bool happens, Stall& stall,
                           CableEvent::Kind kind) {
    if (happens || stall.now) ++notes_.edition;
    if (happens && !stall.now) record(substep, cable, link, kind);
    stall.now = happens;
    if (happens && stall.observed.substeps++ == 0) stall.observed.first_time = substep.next.time;
  };
  for (const CompiledCable& cable : cables_) {
    for (const int link : cable.driven_links) {
      observe(cable, link, drive_work_.stalled[at(link)] != 0, notes_.stalls[at(link)],
              CableEvent::Kind::stall);
      next.integers[stall_index(link)] = drive_work_.locked[at(link)];
    }
    if (!notes_.slides) continue;
    for (int link = cable.first_link; link < cable.first_link + cable.link_count; ++link) {
      observe(cable, link, drive_work_.slid[at(link)] != 0, notes_.slides_at[at(link)],
              CableEvent::Kind::slip);
      drive_work_.slid[at(link)] = 0;
    }
  }
  notes_.slides = std::any_of(notes_.slides_at.begin(), notes_.slides_at.end(),
                              [](const Stall& slide) { return slide.now; });
}

std::vector<cable_parts::LinkWarning> CableSystem::link_warnings(
    const std::vector<Stall>& of_links) const {
  std::vector<cable_parts::LinkWarning> warnings;
  for (const CompiledCable& cable : cables_) {
    for (int i = 0; i < cable.link_count; ++i) {
      const int link = cable.first_link + i;
      const Fallback& observed = of_links[at(link)].observed;
      if (observed.substeps == 0) continue;
      warnings.push_back({cable.name, i < cable.listed_links ? i : -1, links_[at(link)].touched(),
                          observed.substeps, observed.first_time});
    }
  }
  return warnings;
}

void CableSystem::start_without_feed(int span, Row& row) const {
  // Cable is fed evenly during a substep, so at its start no fed cable is there.
  const SpanSetup& setup = spans_[at(span)];
  if (!links_[at(setup.first)].feeds && !links_[at(setup.second)].feeds) return;
  const double fed = fed_[at(span)][0] + fed_[at(span)][1];
  if (cables_[at(setup.cable)].law) {
    const double share = 1.0 - fed / references_[at(span)].rest_length;
    row.value = strains_[at(span)] > 0.0 ? share * row.value : row.value - fed;
    row.compliance *= share;
    return;
  }
  row.value -= fed;
  row.compliance -= fed * cables_[at(setup.cable)].inverse_stiffness;
}

bool CableSystem::runs_out(const CompiledCable& cable, int link) const {
  const bool end = !cable.closed && (link == cable.first_link || link == cable.last_listed_link());
  return end && links_[at(link)].wraps() && !definitions_[at(link)].hybrid;
}

std::vector<cable_parts::LinkWarning> CableSystem::stall_warnings() const {
  return link_warnings(notes_.stalls);
}

std::vector<cable_parts::LinkWarning> CableSystem::slide_warnings() const {
  return link_warnings(notes_.slides_at);
}

std::vector<cable_parts::LinkWarning> CableSystem::beside_warnings() const {
  return link_warnings(notes_.besides);
}

}  // namespace sheave
