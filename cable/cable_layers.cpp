// Drums with layers: the value of the row contains the radius.
//
// With the pitch p a drum of radius r0 that stores s has the radius q = sqrt(r0^2 + p s / pi),
// because s is the integral of q = r0 + p angle / 2 pi over the angle. The tangent point depends on
// q. The cable wound until then, and hence q, depends on the tangent point. If q were taken at the
// start of a substep, it would jump at the end and the span's length with it, which creates the
// energy T dq per substep, of first order in dq however small the step. Therefore q is solved for
// the present positions, by the secant method, since q hardly depends on itself (by p / 2 pi over
// the span's length and by p angle / 2 pi q).
//
// On a drum with a groove (cable/span_groove.h) the angle wound on since the start of the substep is
// solved for instead. The angle gives the radius, the moment of the span and the place on the axle.
//
// The row's gradient is exact (cable/span_row.h).

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "cable/cable_system.h"
#include "cable/span_groove.h"
#include "engine/index.h"

namespace sheave {
namespace {

/// Solves x = f(x) for a drum by the secant method, one evaluation of f at a time. x is the radius
/// with a pitch, and the angle wound on in the substep with a groove.
class DrumEnd {
 public:
  DrumEnd(const LinkGeometry& link, double sense)
      : pitch_(link.wraps() ? link.layer_pitch : 0.0),
        grooved_(link.wraps() && link.groove),
        side_(link.side),
        sense_(sense),
        start_(std::abs(link.signed_radius)),
        place_(grooved_ ? 0.0 : start_),
        scale_(grooved_ ? 1.0 + std::abs(link.wound) : start_) {}

  [[nodiscard]] bool changes() const { return pitch_ > 0.0 || grooved_; }
  /// Takes the length that the drum has taken on [m], or the angle that it has wound on [rad], with
  /// the present place, and improves the place. False if it has converged.
  bool improve(double taken_on, double turn) {
    if (!changes()) return false;
    const double found =
        grooved_ ? turn : std::sqrt(std::max(start_ * start_ + pitch_ * taken_on / pi, 0.0));
    const double miss = found - place_;
    if (!(std::abs(miss) > 4.0 * std::numeric_limits<double>::epsilon() * scale_)) return false;
    const double slope = tries_ > 0 ? (miss - last_miss_) / (place_ - last_place_) : -1.0;
    last_place_ = place_;
    last_miss_ = miss;
    place_ = ++tries_ > 1 && slope < -0.5 ? place_ - miss / slope : found;
    return true;
  }
  void set(LinkGeometry& link, double& span_radius) const {
    if (!changes()) return;
    if (grooved_) return link.follow_groove(link.wound + place_);
    link.signed_radius = side_ * place_;
    span_radius = sense_ * link.signed_radius;
  }

 private:
  double pitch_;
  bool grooved_;
  double side_;
  double sense_;
  double start_;
  double place_;
  double scale_;  ///< of rounding
  double last_place_ = 0.0;
  double last_miss_ = 0.0;
  int tries_ = 0;
};

}  // namespace

bool CableSystem::layered(int span) const {
  const LinkGeometry& first = links_[at(spans_[at(span)].first)];
  const LinkGeometry& second = links_[at(spans_[at(span)].second)];
  return (first.wraps() && first.is_layered()) || (second.wraps() && second.is_layered());
}

CableSystem::LayeredSpan CableSystem::layered_span(const Substep& substep, int span) const {
  const SpanSetup& setup = spans_[at(span)];
  LayeredSpan now{setup, links_[at(setup.first)], links_[at(setup.second)], {}, {}};
  DrumEnd first(now.first, setup.first_sense);
  DrumEnd second(now.second, setup.second_sense);
  const bool grooved = setup.kind == SpanKind::grooved;
  constexpr int most_rounds = 50;
  for (int round = 0; round < most_rounds; ++round) {
    now.geometry =
        span_geometry(substep, now.setup, now.first, now.second, &references_[at(span)].ends);
    now.transport = span_transport(substep, now.setup, now.first, now.second, references_[at(span)],
                                   now.geometry);
    const std::array<double, 2> turns =
        grooved ? wound_turns(substep, now.first, now.second, references_[at(span)], now.geometry)
                : std::array<double, 2>{};
    const bool first_improved = first.improve(-now.transport.from_first, turns[0]);
    const bool second_improved = second.improve(-now.transport.from_second, turns[1]);
    if (!first_improved && !second_improved) break;
    first.set(now.first, now.setup.first_radius);
    second.set(now.second, now.setup.second_radius);
  }
  return now;
}

SpanGeometry CableSystem::evaluate_layered(const Substep& substep, int span, Row& row,
                                           SpanTransport& transport) const {
  const LayeredSpan now = layered_span(substep, span);
  return evaluate_span(substep, now.setup, now.first, now.second, references_[at(span)], row,
                       transport);
}

}  // namespace sheave
