// Which spans are affine: cable/affine_span.h.

#include <cmath>
#include <optional>

#include "cable/cable_system.h"
#include "engine/index.h"

namespace sheave {
namespace {

/// Rounding error of a direction, and of a length relative to the size of the machine.
constexpr double direction_rounding = 1e-13;

struct Place {
  bool suits = false;
  AffineSpan::End end;
};

/// The motion of the end of a span with this direction at a link. `suits` is false if that motion
/// does not keep the span affine.
Place place_of(const Substep& start, const LinkGeometry& link, double signed_radius,
               const Vector3& direction, bool ends_stay) {
  Place place;
  const BodySet& bodies = start.bodies;
  const bool changes = link.is_layered() || (link.hybrid && !ends_stay);
  if (link.outline || changes || link.passes() || link.feeds) return place;
  // A rotation about the link's centre does not move that centre.
  const bool about_centre = link.carrier == link.body && link.centered &&
                            link.carrier < bodies.count() &&
                            bodies[link.carrier].mobility == Mobility::rotor;
  const int mount = about_centre ? bodies[link.carrier].mount : link.carrier;
  const int carrier = mount >= 0 ? mount : bodies.count();
  if (carrier < bodies.count()) {
    const BodyProperties& properties = bodies[carrier];
    if (properties.mobility == Mobility::slider) {
      if (properties.axis.cross(direction).norm() > direction_rounding) return place;
      place.end.slider = carrier;
    } else if (properties.mobility != Mobility::fixed) {
      return place;
    }
  }
  if (link.wraps() && link.body < bodies.count()) {
    const BodyProperties& body = bodies[link.body];
    const Vector3 normal = start.orientation(link.carrier) * link.normal;
    if (body.mobility == Mobility::rotor) {
      const Vector3 axle =
          body.mount >= 0 ? Vector3(start.orientation(body.mount) * body.axis) : body.axis;
      if (axle.cross(normal).norm() > direction_rounding) return place;
      place.end.wheel = link.body;
      place.end.turn = signed_radius * normal;
    } else if (link.body != link.carrier) {
      return place;
    }
  }
  place.suits = true;
  return place;
}

/// Bodies as they were when a cable was defined.
struct StartView {
  BodyFrames frames;
  State state;
  Substep now;
  StartView(const BodySet& bodies, const BodyFrames& in)
      : frames(in), state(bodies.state_in(in)), now(bodies, state, 1.0, 1) {}
};

}  // namespace

bool AffineSpan::lasts(const Substep& substep) const {
  if (first.slider < 0 && second.slider < 0) return true;
  // Speeds are no bound of the motions of a search for equilibrium. One of them moves each end by at
  // most a tenth of the size of the scene (statics/equilibrium.cpp).
  constexpr double longest_search = 0.25;
  if (substep.at_rest) return length_now(substep) > longest_search * substep.bodies.scale();
  double speed = 0.0;
  for (const End* end : {&first, &second}) {
    if (end->slider < 0) continue;
    speed += std::abs(dot(direction, substep.start.bodies[at(end->slider)].velocity));
  }
  return length_now(substep) > margin * substep.h * speed + shortest * substep.bodies.scale();
}

void CableSystem::begin_affine_spans(const Substep& substep) {
  const bool unknown = affine_.empty();
  if (unknown) affine_ = affine_spans(substep.bodies, false);
  // Drag reduces a motion depending on the time step, so another step needs new rows.
  const std::array now{substep.h, substep.load_share};
  if (!unknown && now == edition_is_for_) return;
  edition_is_for_ = now;
  ++edition_;
  for (AffineSpan& affine : affine_) affine.row.edition = edition_;
}

std::vector<AffineSpan> CableSystem::affine_spans(const BodySet& bodies, bool ends_stay) const {
  std::vector<AffineSpan> spans(spans_.size());
  std::optional<StartView> start;
  for (std::size_t k = 0; k < spans_.size(); ++k) {
    const SpanSetup& setup = spans_[k];
    const CompiledCable& cable = cables_[at(setup.cable)];
    // Cable that slides over links needs the positions of its spans, and a material needs their
    // lengths.
    if (!setup.active || cable.shares || cable.inverse_stiffness > 0.0 ||
        cable.linear_density > 0.0 || cable.tangent_update != TangentUpdate::iteration) {
      continue;
    }
    if (!start || start->frames != cable.defined_in) start.emplace(bodies, cable.defined_in);
    spans[k] = affine_span(start->now, setup, ends_stay);
    spans[k].row.lower = 0.0;
    spans[k].row.told = true;
    spans[k].row.damping = cable.damping;
    spans[k].row.compliance = cable.compliance;
    spans[k].row.index = static_cast<int>(k);
  }
  return spans;
}

AffineSpan CableSystem::affine_span(const Substep& start, const SpanSetup& setup,
                                    bool ends_stay) const {
  const LinkGeometry& first = links_[at(setup.first)];
  const LinkGeometry& second = links_[at(setup.second)];
  AffineSpan affine;
  const SpanReference reference = span_reference(start, setup, first, second, 0.0);
  SpanTransport transport;
  const SpanGeometry span =
      evaluate_span(start, setup, first, second, reference, affine.row, transport);
  if (!span.has_tangent || !(span.length > 0.0)) return affine;
  const Place at_first = place_of(start, first, first.signed_radius, span.direction, ends_stay);
  const Place at_second = place_of(start, second, -second.signed_radius, span.direction, ends_stay);
  if (!at_first.suits || !at_second.suits) return affine;
  affine.first = at_first.end;
  affine.second = at_second.end;
  affine.direction = span.direction;
  affine.length = span.length;
  affine.possible = true;
  affine.length = 2.0 * span.length - affine.length_now(start);
  return affine;
}

}  // namespace sheave
