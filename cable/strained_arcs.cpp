// Cable of a material on links over which it slides: posts, wrappable bodies, wheels that slip.
//
// Within a run (cable/cable_runs.cpp) cable slides over a link that it wraps, so the cable on the
// link has no strain of its own. With the tension T that enters at one end of the arc, the tension
// at the angle phi from there is T e^(+-m phi), and the strain is e = T / EA there. The geometric
// arc a is covered by the unstretched length
//
//   A(e) = mean over the arc of a / (1 + k e),   k: the tension there over that of the run,
//
// The unstretched length of a run, in its spans and on its links, is conserved. In the function F
// of cable_material.cpp the parts G_i and on_i therefore count only links at which no cable slides
// (the ends of the run, massless wheels). The cable on the other links counts as a whole; s_j is
// its length at the start:
//
//   F(e) = sum over spans (L0_i + G_i - on_i / (1 + (e0_i + k_i e) / 2) - l_i / (1 + k_i e))
//        + sum over arcs (s_j - A_j(e)).
//
// Without friction this is l / (1 + e) for everything between the ends of the run: a rope round a
// smooth post is as long a spring as one without the post. The arc's stretch a - A and its
// compliance, the mean of a k / (1 + k e) / EA, belong to the rows of the adjacent spans. The
// gradient does not change: a tangent point that moves along the arc takes length from the span,
// and both have the same strain there.
//
// The gradient does not know whether the link turns, and neither does F: cable that the surface of
// the link carries on comes out of one span of the run and goes into the next. But friction acts
// along the travel of the cable over that surface, so the surface's own way is taken off the length
// that passes. A surface that moves towards the next span, by a past the tangent point at the first
// end of the arc and by b past the tangent point at the second, carries the unstretched length
//
//   c = (a + b) / 2 / (1 + e_m),   e_m: mean of the strains beside the arc,
//
// and the slip is s = (p + q) / 2 - c with the unstretched lengths p and q of cable that pass these
// points. (If more cable comes to lie on a post because the second tangent point moves along the
// post by d, then a = p = 0, b = -d and q = -d / (1 + e): nothing slides.) The factor 1 + e_m
// follows from the energy. In steady motion p = q and a = b. The springs of the spans gain
// (T2 - T1) (1 + e_m) p less than the bodies at their far ends give, and the link gets (T2 - T1) a.
// Friction therefore takes
//
//   D = (T2 - T1) ((1 + e_m) p - a) = (T2 - T1) (1 + e_m) s,
//
// which is never negative if cable slides towards the larger tension. Where the cable holds, its
// strain changes at the end of the arc: the loss by creep of cable_material.cpp.
//
// On an outline (cable/outline.h) friction acts at the corners, and the cable along an edge has one
// tension.
//
// On a link that sticks the cable keeps its strain, and cable comes on and off at the ends of the
// arc as on any wheel (cable/stored_strain.h). A constant `compliance` is a property of free spans;
// cable on links has none.
//
// `damping` is a property of free spans, too. But an arc without a damper would take the strain T / EA
// at once where the cable begins to slide, and would need the cable for that out of spans that their
// dampers hold: against the pull at any step size, so that the link could neither hold nor slide.
// Cable that slides over a link therefore has dampers on the arc, with a g between those of the
// adjacent spans, and with e0 of the cable that lay there (cable/cable_damping.cpp).
//
// A massless wheel turns with the cable instead (cable/massless_wheels.h). The cable lies on it without
// sliding and keeps the strain with which it has come on, as on a wheel with inertia.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "cable/cable_system.h"
#include "cable/massless_wheels.h"
#include "cable/span_contact.h"
#include "cable/span_law.h"
#include "engine/index.h"
#include "engine/math/portable.h"

namespace sheave {
namespace {

using cable_parts::ArcNode;
using cable_parts::ArcSum;
using cable_parts::SlidingArc;

/// Gauss-Legendre quadrature over [0, 1], exact to rounding for e^x / (1 + c e^x) over a
/// slice in which the exponent changes by at most slice_exponent.
constexpr std::array<double, 5> gauss_places{0.04691007703066800, 0.23076534494715845, 0.5,
                                             0.76923465505284155, 0.95308992296933200};
constexpr std::array<double, 5> gauss_weights{0.11846344252809454, 0.23931433524968324,
                                              0.28444444444444444, 0.23931433524968324,
                                              0.11846344252809454};
constexpr double slice_exponent = 0.5;
constexpr int most_slices = 8;

ArcSum sum_up(std::span<const ArcNode> nodes, double length, double strain) {
  ArcSum sum;
  for (const ArcNode& node : nodes) {
    const double own = node.end(strain);
    const double part = length * node.share / (1.0 + own);
    const double yield = node.weight / (1.0 + node.damping.share);
    sum.unstretched += part;
    sum.pull += yield * part;
    sum.kept += node.end(0.0) * part;
    sum.slope += yield * part / (1.0 + own);
  }
  return sum;
}

/// Adds nodes of a part of an arc along which the logarithm of the tension grows evenly, by `rise`
/// in all.
void add_slices(double from, double rise, double share, std::vector<ArcNode>& nodes) {
  const double wanted = std::ceil(std::abs(rise) / slice_exponent);
  const int slices = static_cast<int>(std::clamp(wanted, 1.0, double{most_slices}));
  const int before = nodes.empty() ? 0 : nodes.back().slice + 1;
  for (int slice = 0; slice < slices; ++slice) {
    for (std::size_t n = 0; n < gauss_places.size(); ++n) {
      const double place = (slice + gauss_places[n]) / slices;
      nodes.push_back({share * gauss_weights[n] / slices,
                       from * portable::exp(rise * place),
                       before + slice,
                       {}});
    }
  }
}

/// Gives the cable of an arc, which is `stored` at the start, dampers between those of the adjacent
/// spans.
void damp(std::span<ArcNode> nodes, const StoredStrain& stored, double before, double behind) {
  double place = 0.0;
  for (ArcNode& node : nodes) {
    const double middle = place + 0.5 * node.share;
    place += node.share;
    node.damping = {stored.strain_at(middle), before + middle * (behind - before)};
  }
}

/// Adds the spring of an arc to a row that may be damped (engine/solvers/row_system.h), in the form
/// yield x T = stretch: the stretch at the end without the part that dampers keep [m], and the yield
/// divided by 1 + g [m/N]. The row keeps its own damping share g. A row of `rattle` is the sum over
/// both ends of the substep.
void add_spring(double stretch, double yield, double h, bool midpoint, Row& row) {
  row.value -= stretch;
  if (!(row.damping > 0.0) || !(row.compliance > 0.0)) {
    row.compliance += yield;
    return;
  }
  const double share = (midpoint ? 2.0 : 1.0) * row.compliance * row.damping / h;
  if (midpoint) row.value -= stretch;
  const double whole = row.compliance + (1.0 + share) * yield;
  row.damping *= row.compliance / whole;
  row.compliance = whole;
}

/// The law of the arcs of a run, which without friction have the strain of its spans, as that of its
/// first span, whose row has no part of an arc yet.
LawRow arc_law(const CompiledCable& cable, const LawStep& step,
               const cable_parts::StretchedSpan& first, double strain, const Row& row) {
  const double length = first.length / (1.0 + strain);
  const LawStart remembered{0.0, 0.0, first.memory};
  if (step.rule == LawStep::Rule::start) {
    return law_row(cable, step, remembered, first.start_strain, 0.0);
  }
  if (!(strain > 0.0) || !(length > 0.0)) return law_row(cable, step, remembered, 0.0, 0.0);
  return {-row.value / (strain * length), row.compliance / length, false};
}

}  // namespace

std::span<const ArcNode> CableSystem::nodes_of(const SlidingArc& arc) const {
  return std::span<const ArcNode>(run_work_.nodes).subspan(arc.first_node, arc.node_count);
}

ArcSum CableSystem::arc_with(const SlidingArc& arc, double strain) const {
  return sum_up(nodes_of(arc), arc.length, strain);
}

void CableSystem::find_arcs(const Substep& substep, const CompiledCable& cable, Run run,
                            std::span<const double> weights) {
  run_work_.nodes.clear();
  run_work_.clear_arcs(at(run.count));
  MasslessWheels(*this).find(substep, cable, run);
  for (int i = 0, k = run.first; i < run.count; ++i, k = next_span(cable, k)) {
    const bool last = i + 1 == run.count;
    const int link = spans_[at(k)].second;
    if (last && (!cable.closed || next_span(cable, k) != run.first)) break;
    if (!slides_on(link)) continue;
    const std::size_t behind = last ? 0 : at(i + 1);
    SlidingArc& arc = run_work_.arcs[at(i)];
    arc.link = link;
    arc.damped = cable.is_damped();
    arc.start = stored_arcs_[at(link)];
    const double from_before = run_work_.stretched[at(i)].arcs[1];
    const double from_behind = run_work_.stretched[behind].arcs[0];
    arc.length = arc.start - from_before - from_behind;
    arc.surface = 0.5 * (from_behind - from_before);
    arc.before = stored_[at(strain_places_[at(link)])].total();
    // Valid also where the cable is about to leave.
    arc.before.length = arc.start - arc.before.stretch;
    arc.first_node = run_work_.nodes.size();
    add_nodes(substep, k, weights[at(i)], weights[behind]);
    arc.node_count = run_work_.nodes.size() - arc.first_node;
    if (!arc.damped) continue;
    damp(std::span(run_work_.nodes).subspan(arc.first_node), stored_[at(strain_places_[at(link)])],
         run_work_.stretched[at(i)].damping.share, run_work_.stretched[behind].damping.share);
  }
}

void CableSystem::add_nodes(const Substep& substep, int span, double from, double to) {
  const double rise = from > 0.0 && to > 0.0 && from != to ? portable::log(to / from) : 0.0;
  if (rise == 0.0) {
    run_work_.nodes.push_back({1.0, from, 0, {}});
    return;
  }
  if (!links_[at(spans_[at(span)].second)].outline) {
    add_slices(from, rise, 1.0, run_work_.nodes);
    return;
  }
  const std::size_t first = run_work_.nodes.size();
  add_outline(substep, span, from, rise);
  double whole = 0.0;
  for (std::size_t i = first; i < run_work_.nodes.size(); ++i) whole += run_work_.nodes[i].share;
  for (std::size_t i = first; i < run_work_.nodes.size(); ++i) run_work_.nodes[i].share /= whole;
  // A single corner has no arc.
  if (!(whole > 0.0)) {
    run_work_.nodes.resize(first);
    run_work_.nodes.push_back({1.0, from, 0, {}});
  }
}

void CableSystem::add_outline(const Substep& substep, int span, double from, double rise) {
  // Friction acts at the corners, in proportion to the angles by which they bend the cable.
  const int index = spans_[at(span)].second;
  const LinkGeometry& link = links_[at(index)];
  const Outline& curve = link.outline->curve;
  const SpanGeometry in = geometry_of(substep, span);
  const SpanGeometry out =
      geometry_of(substep, next_span(cables_[at(spans_[at(span)].cable)], span));
  const double entry = normal_angle(substep, link, in.direction);
  const double whole = wrap_angle(substep, link, in, out, stored_arcs_[at(index)]);
  const auto corner_part = [&](double start, double end) {
    const double length = curve.corner_radius() * (end - start);
    if (!(length > 0.0)) return;
    const double here = from * portable::exp(rise * start / whole);
    add_slices(here, rise * (end - start) / whole, length, run_work_.nodes);
  };
  const int count = curve.corner_count();
  int corner = in.second_corner;
  double bent = 0.0;
  const int most = count * (2 + static_cast<int>(std::min(whole, 1e3)));
  for (int walked = 0; walked < most && whole > 0.0; ++walked) {
    const int next = (corner + (link.side > 0 ? 1 : count - 1)) % count;
    const Vector3& a = curve.corner(link.side > 0 ? corner : next);
    const Vector3& b = curve.corner(link.side > 0 ? next : corner);
    const double normal = portable::atan2(a.x() - b.x(), b.y() - a.y());  // of the edge, outward
    double turned = link.side * (normal - entry);
    turned -= 2.0 * pi * std::floor((turned - bent) / (2.0 * pi));
    if (turned >= whole) break;
    corner_part(bent, turned);
    const int slice = run_work_.nodes.empty() ? 0 : run_work_.nodes.back().slice + 1;
    run_work_.nodes.push_back(
        {(b - a).norm(), from * portable::exp(rise * turned / whole), slice, {}});
    bent = turned;
    corner = next;
  }
  corner_part(bent, whole);
}

void CableSystem::add_arcs(const Substep& substep, const CompiledCable& cable,
                           std::span<const double> weights, double strain,
                           std::span<Row> rows) const {
  const bool at_start = substep.time == substep.start.time;
  // At rest dampers have no force.
  const double h = substep.at_rest ? std::numeric_limits<double>::infinity() : substep.h;
  LawStep step;
  step.rule = at_start ? LawStep::Rule::start : LawStep::Rule::end;
  const cable_parts::StretchedSpan& first = run_work_.stretched[0];
  const LawRow law = cable.law ? arc_law(cable, step, first, strain, rows[0]) : LawRow();
  const double slack = slack_strain(cable, {0.0, 0.0, first.memory});
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const SlidingArc& arc = run_work_.arcs[i];
    if (arc.link < 0) continue;
    // Both adjacent spans get a part of the arc, in the ratio of their tensions, so that a mirrored
    // cable has the same rows.
    const std::size_t behind = i + 1 < rows.size() ? i + 1 : 0;
    const double both = weights[i] + weights[behind];
    if (!(both > 0.0)) continue;
    const ArcSum sum = arc_with(arc, strain);
    double pull = sum.pull / both;
    double stretch = arc.length - sum.unstretched - sum.kept;
    if (at_start) {
      // At the start the cable there has the strain with which it came on, and its compliance
      // follows from that stretch.
      stretch = arc.before.stretch;
      const double strains =
          run_work_.stretched[i].start_strain + run_work_.stretched[behind].start_strain;
      pull = stretch > 0.0 && strains > 0.0 ? stretch / strains : 0.5 * arc.before.length;
      stretch -= slack * arc.before.length;
    } else if (!(strain > 0.0)) {
      // Excess length of a slack run there.
      stretch = sum.unstretched - (1.0 + slack) * arc.before.length;
    }
    const double yield = cable.law ? law.yield : cable.inverse_stiffness;
    stretch *= law.ratio;
    for (const std::size_t row : {i, behind}) {
      const double share = weights[row] / both;
      add_spring(share * stretch, pull * yield, h, knows_start_ && !at_start, rows[row]);
    }
  }
}

StoredStrain CableSystem::strained_arc(const SlidingArc& arc, double strain) const {
  const StrainEnergy energy = cable_of(cables_, arc.link).strain_energy();
  StoredStrain stored;
  StoredStrain::Piece piece;
  int slice = nodes_of(arc).front().slice;
  for (const ArcNode& node : nodes_of(arc)) {
    if (node.slice != slice) {
      stored.put(StoredStrain::End::outgoing, piece);
      piece = {};
      slice = node.slice;
    }
    const double own = node.end(strain);
    const double length = arc.length * node.share / (1.0 + own);
    piece.length += length;
    piece.stretch += own * length;
    piece.square += energy.of(own) * length;
  }
  stored.put(StoredStrain::End::outgoing, piece);
  return stored;
}

void CableSystem::settle_arcs(std::optional<double> strain) {
  const std::size_t count = run_work_.arcs.size();
  for (std::size_t i = 0; i < count; ++i) {
    SlidingArc& arc = run_work_.arcs[i];
    if (arc.link < 0) continue;
    const std::size_t behind = i + 1 < count ? i + 1 : 0;
    const double at_start =
        run_work_.stretched[i].start_strain + run_work_.stretched[behind].start_strain;
    const double at_end =
        strain ? (run_work_.weights[i] + run_work_.weights[behind]) * *strain : at_start;
    arc.carried = arc.surface / (1.0 + 0.25 * (at_start + at_end));
    arc.strain = strain;  // without a value for the run the arc keeps its own strain
    const double own = arc.before.strain();
    arc.gain = strain ? arc_with(arc, *strain).unstretched - arc.before.length
                      : (arc.length - arc.start) / (1.0 + own);
  }
}

void CableSystem::count_arcs(double share) {
  const std::size_t count = run_work_.arcs.size();
  for (std::size_t i = 0; i < count; ++i) {
    const double gain = run_work_.arcs[i].gain;
    const double carried = run_work_.arcs[i].carried;
    if (gain == 0.0 && carried == 0.0) continue;
    run_work_.spare[i] -= share * (0.5 * gain + carried);
    run_work_.spare[i + 1 < count ? i + 1 : 0] -= share * (0.5 * gain - carried);
  }
}

double CableSystem::pass_arc(std::size_t span, double& passed) const {
  const SlidingArc& arc = run_work_.arcs[span];
  if (arc.link < 0) return passed;
  const double slid = passed - 0.5 * arc.gain - arc.carried;
  passed -= arc.gain;
  if (!arc.strain || !(arc.start > 0.0) || arc.damped) return slid;
  // Friction takes (T2 - T1) slid + (mean of T) x stretch - energy of the arc. The last two terms
  // matter if the arc's strains change at once to the ratio of the tensions.
  const std::span<const ArcNode> nodes = nodes_of(arc);
  const double first = nodes.front().weight * *arc.strain;
  const double last = nodes.back().weight * *arc.strain;
  if (first == last) return slid;
  const StoredStrain::Piece now = strained_arc(arc, *arc.strain).total();
  const double grown = arc.length / arc.start;
  const double stretched = now.stretch - grown * arc.before.stretch;
  const double square = now.square - grown * arc.before.square;
  const StretchedSpan& before = run_work_.stretched[span];
  const StretchedSpan& behind =
      run_work_.stretched[span + 1 < run_work_.arcs.size() ? span + 1 : 0];
  const double mean = 0.25 * (first + last + before.start_strain + behind.start_strain);
  return slid + (mean * stretched - 0.5 * square) / (last - first);
}

double CableSystem::lay_arc(const CompiledCable& cable, std::size_t span, double moved,
                            double& passed, FeatureState& next) {
  const SlidingArc& arc = run_work_.arcs[span];
  double& stored = next.reals[stored_length_index(arc.link)];
  passed -= arc.gain;
  // In a ring no cable passes the last link of the run; cable that reaches that link stays on it.
  const bool last = span + 1 == run_work_.arcs.size();
  // At most the available cable moves on. The exception is an arc whose spans lean beyond its end:
  // its length is below 0, and so is the stored length, and the link is left.
  const double most = stored + moved - std::min(cable.quantised(arc.length), 0.0);
  const double moved_on = last ? 0.0 : std::min(cable.quantised(passed), most);
  stored += moved - moved_on;
  StoredStrain lies = arc.strain ? strained_arc(arc, *arc.strain) : stored_strain(next, arc.link);
  lies.fit(StoredStrain::End::outgoing, stored, lies.total().strain(),
           cable_of(cables_, arc.link).strain_energy());
  save_strain(lies, arc.link, next);
  return moved_on;
}

}  // namespace sheave
