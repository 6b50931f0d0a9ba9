// Conditions in which the model of a cable does not hold: spans without a tangent, attachments that
// reach a wheel, wraps that leave their plane, bodies that find no place for a wrap.
//
// An attachment between two spans holds the cable at one of its points. Cable that comes to a wheel
// is laid onto it. If the cable is drawn on, the attachment reaches the point where its span
// touches the rim. The cable behind the attachment would then have to be laid onto the wheel, too,
// which the model cannot do; its span would run through the wheel, and the further motion would be
// that of no machine. (The grip of a chairlift, which passes wheels, is a different machine.) The
// motion therefore ends there: when the span on the attachment's other side begins to cut the wheel
// next to the attachment, or when a body has come inside a wheel to which it is attached, where no
// tangent exists.
//
// A wrap on a body in space lies in the plane in which the cable came onto the body, as in a
// groove. On a smooth body it would follow a geodesic. A geodesic leaves that plane where a span
// leans out of the plane, or where the sum of the forces of both spans has a component normal to
// the plane; only a groove can balance that component.

#include <algorithm>
#include <cmath>

#include "cable/cable_system.h"
#include "cable/link_contact.h"
#include "engine/index.h"

namespace sheave {

template <class Visit>
void CableSystem::for_each_grip(Visit visit) const {
  for (const CompiledCable& cable : cables_) {
    for (const int link : cable.grips) {
      const int out = span_after(cable, link);
      const int in = span_before(cable, link, spans_);
      if (in < 0 || !spans_[at(out)].active) continue;
      visit(link, out, spans_[at(out)].second, in);
      visit(link, in, spans_[at(in)].first, out);
    }
  }
}

void CableSystem::begin_grips(const Substep& substep) {
  clear_grips_.clear();
  for_each_grip([&](int, int, int wheel, int beyond) {
    const LinkGeometry& link = links_[at(wheel)];
    const bool watched =
        link.lifts && wheel != spans_[at(beyond)].first && wheel != spans_[at(beyond)].second;
    clear_grips_.push_back(watched &&
                           !clearance(substep, link, geometry_of(substep, beyond)).cuts(link));
  });
}

void CableSystem::check_grips(const Substep& substep) {
  // Beyond this distance another part of the cable crosses the wheel, not the attachment.
  constexpr double near = 2.0 / (2.0 * pi);  // times the perimeter: two radii
  std::size_t visited = 0;
  for_each_grip([&](int, int span, int wheel, int beyond) {
    const LinkGeometry& link = links_[at(wheel)];
    if (clear_grips_[visited++] == 0) return;
    if (geometry_of(substep, span).length > near * link.perimeter()) return;
    if (clearance(substep, link, geometry_of(substep, beyond)).cuts(link)) arrived_ = span;
  });
}

void CableSystem::note_missing_tangent(Substep& substep, int span) {
  ++notes_.edition;
  Fallback& missing = notes_.fallbacks[at(span)];
  if (missing.substeps++ == 0) missing.first_time = substep.next.time;
  ++substep.statistics.geometry_fallbacks;
  const SpanSetup& setup = spans_[at(span)];
  const LinkGeometry& first = links_[at(setup.first)];
  const LinkGeometry& second = links_[at(setup.second)];
  const bool wheel_first = first.wraps();
  const LinkGeometry& wheel = wheel_first ? first : second;
  const LinkGeometry& point = wheel_first ? second : first;
  const int link = wheel_first ? setup.first : setup.second;
  if (point.wraps() || point.hybrid || !wheel.lifts || wheel.outline) return;
  if (link > cables_[at(setup.cable)].last_listed_link()) return;
  // A kinematic body may be led through a wheel, as by a pointer; there is a warning for that.
  if (point.body < substep.bodies.count() &&
      substep.bodies[point.body].mobility == Mobility::kinematic) {
    return;
  }
  // Beyond this distance the tangent is missing because the span leans out of the wheel's plane.
  constexpr double beside_squared = 2.0;
  const LinkCircle circle = circle_of(substep, wheel);
  const Vector3 apart = center_of(substep, point, 0) - circle.center;
  const double seen_squared = cross(circle.normal, apart).squaredNorm();
  if (seen_squared < beside_squared * wheel.signed_radius * wheel.signed_radius) arrived_ = span;
}

std::string CableSystem::dead_end(const Substep& substep) const {
  if (arrived_ < 0) return {};
  const SpanSetup& setup = spans_[at(arrived_)];
  const CompiledCable& cable = cables_[at(setup.cable)];
  const bool wheel_first = links_[at(setup.first)].wraps();
  const auto name_of = [&](int link) {
    const int body = links_[at(link)].touched();
    return "link " + std::to_string(link - cable.first_link) + " on \"" +
           (body == substep.bodies.count() ? "world" : substep.bodies.name(body)) + "\"";
  };
  return "cable \"" + cable.name + "\": its attachment, " +
         name_of(wheel_first ? setup.second : setup.first) + ", has reached the wheel of " +
         name_of(wheel_first ? setup.first : setup.second) +
         ", and attachments do not pass wheels: stop the drive or the run before that, or end the "
         "cable there";
}

void CableSystem::note_leans(const Substep& substep, const CompiledCable& cable) {
  constexpr double most = 0.0174524064372835;  // sine of 1 degree
  // Below this resultant the cable hardly touches the body, and its direction is undefined.
  constexpr double least_pull = 1e-3;
  for (int k = cable.first_span; k < cable.first_span + cable.span_count; ++k) {
    const int link = spans_[at(k)].second;
    if (!spans_[at(k)].active || spans_[at(k)].kind != SpanKind::spatial) continue;
    if (link <= cable.last_listed_link()) continue;
    const Vector3 in = geometry_of(substep, k).direction;
    const Vector3 out = geometry_of(substep, span_after(cable, link)).direction;
    const Vector3 normal = circle_of(substep, links_[at(link)]).normal;
    double sine = std::max(std::abs(dot(normal, in)), std::abs(dot(normal, out)));
    const Vector3 pull = out - in;
    const double size = pull.norm();
    if (size > least_pull) sine = std::max(sine, std::abs(dot(normal, pull)) / size);
    if (!(sine > most)) continue;
    ++notes_.edition;
    cable_parts::Lean& lean = notes_.leans[at(spans_[at(k)].cable)];
    if (lean.observed.substeps == 0) lean.observed.first_time = substep.next.time;
    if (lean.last_time < substep.next.time) ++lean.observed.substeps;
    lean.last_time = substep.next.time;
    if (sine <= lean.sine) continue;
    lean.sine = std::min(sine, 1.0);
    lean.body = links_[at(link)].body;
  }
}

std::vector<CableSystem::TangentWarning> CableSystem::tangent_warnings() const {
  std::vector<TangentWarning> warnings;
  for (int k = 0; k < span_count(); ++k) {
    const Fallback& fallback = notes_.fallbacks[at(k)];
    if (fallback.substeps == 0) continue;
    const CompiledCable& cable = cables_[at(spans_[at(k)].cable)];
    const int span = k - cable.first_span;
    warnings.push_back({cable.name, span < cable.listed_spans ? span : -1, fallback.substeps,
                        fallback.first_time});
  }
  return warnings;
}

std::vector<CableSystem::WrapWarning> CableSystem::wrap_warnings() const {
  std::vector<WrapWarning> warnings;
  for (std::size_t c = 0; c < cables_.size(); ++c) {
    if (notes_.crowded[c].substeps == 0) continue;
    warnings.push_back({cables_[c].name, notes_.crowded[c].substeps, notes_.crowded[c].first_time});
  }
  return warnings;
}

std::vector<CableSystem::LeanWarning> CableSystem::lean_warnings() const {
  std::vector<LeanWarning> warnings;
  for (std::size_t c = 0; c < cables_.size(); ++c) {
    const cable_parts::Lean& lean = notes_.leans[c];
    if (lean.observed.substeps == 0) continue;
    warnings.push_back({cables_[c].name, lean.body, std::asin(lean.sine), lean.observed.substeps,
                        lean.observed.first_time});
  }
  return warnings;
}

}  // namespace sheave
