// Windings that look as if they were entered the wrong way round.
//
// A cable that comes to a wheel and leaves it with both spans in the wheel's plane cannot pass
// through itself, but rows know nothing of that: with the wrong winding the two spans cross beside
// the wheel, and everything runs. Some machines mean it: a belt that is crossed between two wheels,
// a rope with whole turns, a figure of eight. So a link is named only if its two spans cross, if
// they would not with the other winding, if it has no whole turns, and if the spans do not join the
// same two wheels.

#include <cmath>

#include "cable/cable_compiler.h"
#include "engine/index.h"

namespace sheave {
namespace {

/// Whether two spans cross between their ends, seen along `normal`.
bool cross_each_other(const SpanGeometry& a, const SpanGeometry& b, const Vector3& normal) {
  constexpr double margin = 1e-6;  // of a span, so that spans that end at one point do not count
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

void CableCompiler::find_wrong_windings(const CableDef& def) {
  const auto count = static_cast<int>(links_.size());
  for (int i = 0; i < count; ++i) {
    const LinkGeometry& wheel = links_[at(i)];
    if (!wheel.wraps() || wheel.starts_lifted || wheel.extra_turns > 0) continue;
    if (!def.closed && (i == 0 || i + 1 == count)) continue;
    int before = (i + count - 1) % count;
    while (links_[at(before)].starts_lifted) before = (before + count - 1) % count;
    const int after = next_touched(i);
    if (before == after) continue;
    SpanSetup in;
    SpanSetup out;
    choose_kind(in, links_[at(before)], wheel);
    choose_kind(out, wheel, links_[at(after)]);
    if (in.kind != SpanKind::planar || out.kind != SpanKind::planar) continue;
    const Vector3 normal = now_->orientation(wheel.carrier) * wheel.normal;
    if (!cross_each_other(geometry_[at(before)], geometry_[at(i)], normal)) continue;
    LinkGeometry other = wheel;
    other.side = -wheel.side;
    other.signed_radius = -wheel.signed_radius;
    choose_kind(in, links_[at(before)], other);
    choose_kind(out, other, links_[at(after)]);
    const SpanGeometry to = span_geometry(*now_, in, links_[at(before)], other);
    const SpanGeometry from = span_geometry(*now_, out, other, links_[at(after)]);
    if (!to.has_tangent || !from.has_tangent || cross_each_other(to, from, normal)) continue;
    const Winding better = other.side > 0 ? Winding::counter_clockwise : Winding::clockwise;
    const int on = wheel.touched();
    std::string body = on == bodies_.count() ? "world" : bodies_.name(on);
    system_->winding_warnings_.push_back({name_, i, std::move(body), better});
  }
}

}  // namespace sheave
