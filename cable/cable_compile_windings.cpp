// Checks of windings: impossible ones are errors, and ones that look like a mistake give a warning.
//
// Ghost turns. A cable that is bent away from a wheel by an angle a does not touch the wheel when
// it is tight. Tangents on the side of the given winding exist nevertheless, with an arc of 2 pi -
// a between them. A wrap of almost a whole turn is therefore one of two things: a cable that does
// not reach its wheel, or a cable that was laid round it once on purpose. Geometry cannot
// distinguish them, but the user can: the first link is "lifted", the second has "turns". Without
// either, wraps of more than `longest_wrap` are an error, in one plane and in space. The bound
// of 300 degrees allows band brakes, bollards and crossed belts, which are wrapped by up to 270
// degrees. Between two spans that join the same two wheels no link could be lifted (crossed belts
// round wheels that nearly touch), so such links are not checked.
//
// The other winding. A cable that comes to a wheel and leaves it in the wheel's plane cannot pass
// through itself, but the rows of the solver do not know that: with the wrong winding the two spans
// cross beside the wheel, and the simulation runs. Some machines need such crossings: a crossed
// belt, a rope with whole turns, a figure of eight, a band round three quarters of its drum. A
// wheel that turns a cable back, as most wheels do, is wrapped by a little more than half a turn if
// its winding is wrong. The warning therefore names a link only if its two spans cross, if they
// would not cross with the other winding, if its wrap is at most 2/3 of a turn without whole turns,
// and if the spans do not join the same two wheels.

#include <cmath>

#include "cable/cable_compiler.h"
#include "engine/index.h"

namespace sheave {
namespace {

/// Whether two spans cross between their ends, seen along `normal`.
bool cross_each_other(const SpanGeometry& a, const SpanGeometry& b, const Vector3& normal) {
  // fraction of a span; spans that end at one point do not count as crossing
  constexpr double margin = 1e-6;
  const Vector3 along_a = a.end - a.start;
  const Vector3 along_b = b.end - b.start;
  const Vector3 apart = b.start - a.start;
  const double across = dot(normal, cross(along_a, along_b));
  if (!(std::abs(across) > 1e-9 * along_a.norm() * along_b.norm())) return false;
  const double on_a = dot(normal, cross(apart, along_b)) / across;
  const double on_b = dot(normal, cross(apart, along_a)) / across;
  const auto inside = [](double share) { return share > margin && share < 1.0 - margin; };
  return inside(on_a) && inside(on_b);
}

}  // namespace

void CableCompiler::check_windings(const CableDef& def) {
  constexpr double most_turned_back = 2.0 * pi * 2.0 / 3.0;
  const auto count = static_cast<int>(links_.size());
  for (int i = 0; i < count; ++i) {
    const LinkGeometry& wheel = links_[at(i)];
    if (wheel.geodesic && !wheel.starts_lifted) check_surface(i);
    if (!wheel.wraps() || wheel.geodesic || wheel.starts_lifted || wheel.extra_turns > 0) continue;
    if (!def.closed && (i == 0 || i + 1 == count)) continue;
    int before = (i + count - 1) % count;
    while (links_[at(before)].starts_lifted) before = (before + count - 1) % count;
    const int after = next_touched(i);
    if (before == after) continue;
    const double wrap = start_wrap(i, geometry_[at(before)], geometry_[at(i)]);
    if (wrap <= most_turned_back) find_wrong_winding(i, before, after);
    if (wrap <= longest_wrap) continue;
    const std::string degrees = std::to_string(std::lround(wrap * 180.0 / pi));
    fail("/links/" + std::to_string(i),
         link_name(i) +
             ": the cable does not reach the wheel on the side that \"winding\" says, and "
             "would be wound round it by " +
             degrees +
             " degrees; give \"lifted\": true if it passes the wheel by at time 0, the other "
             "\"winding\" if it runs on the other side, or \"turns\": 1 if it is meant to go all "
             "the way round, and once more");
  }
}

void CableCompiler::find_wrong_winding(int link, int before, int after) {
  const LinkGeometry& wheel = links_[at(link)];
  SpanSetup in;
  SpanSetup out;
  choose_kind(in, links_[at(before)], wheel);
  choose_kind(out, wheel, links_[at(after)]);
  if (in.kind != SpanKind::planar || out.kind != SpanKind::planar) return;
  const Vector3 normal = now_->orientation(wheel.carrier) * wheel.normal;
  if (!cross_each_other(geometry_[at(before)], geometry_[at(link)], normal)) return;
  LinkGeometry other = wheel;
  other.side = -wheel.side;
  other.signed_radius = -wheel.signed_radius;
  choose_kind(in, links_[at(before)], other);
  choose_kind(out, other, links_[at(after)]);
  const SpanGeometry to = span_geometry(*now_, in, links_[at(before)], other);
  const SpanGeometry from = span_geometry(*now_, out, other, links_[at(after)]);
  if (!to.has_tangent || !from.has_tangent || cross_each_other(to, from, normal)) return;
  const Winding better = other.side > 0 ? Winding::counter_clockwise : Winding::clockwise;
  const int on = wheel.touched();
  std::string body = on == bodies_.count() ? "world" : bodies_.name(on);
  system_->winding_warnings_.push_back({name_, link, std::move(body), better});
}

}  // namespace sheave
