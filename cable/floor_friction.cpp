#include "cable/floor_friction.h"

#include <algorithm>
#include <cmath>

#include "cable/hanging_rope.h"
#include "engine/index.h"

namespace sheave {
namespace {

/// The friction of a cable's floor under a span.
FloorGrip grip_of(const CompiledCable& cable, const Vector3& gravity, int span,
                  const FloorProfile& tensions) {
  return {&tensions, cable.floor_friction * weight_of(cable, gravity),
          span != cable.first_span || !cable.anchored[0]};
}

template <class Reals>
auto numbers_of(const CableSystem& system, Reals& reals, int place) {
  return std::span(reals).subspan(system.floor_index(place), FloorProfile::real_count);
}

}  // namespace

template <class Visit>
void FloorFriction::for_each_span(const CableSystem& system, const Substep& now,
                                  const Course& course, Visit visit) {
  for (int k = 0; k < system.span_count(); ++k) {
    const CompiledCable& cable = system.cables_[at(system.spans_[at(k)].cable)];
    if (cable.floor_friction == 0.0 || !course.spans[at(k)].active) continue;
    if (weight_of(cable, now.gravity) > 0.0) visit(k, system.floor_places_[at(k)]);
  }
}

TouchDown FloorFriction::touch_of(const CableSystem& system, const Substep& now,
                                  const Course& course, const FeatureState& own, int span,
                                  const FloorGrip& grip) {
  const SpanSetup& setup = course.spans[at(span)];
  const CompiledCable& cable = system.cables_[at(setup.cable)];
  const LinkGeometry& first = course.links[at(setup.first)];
  const LinkGeometry& second = course.links[at(setup.second)];
  const SpanGeometry straight = span_geometry(now, setup, first, second);
  const WheelPlane wheels = wheel_plane_of(now, cable, setup, first, second, straight, grip);
  const double rest_length = own.reals[system.rest_length_index(span)] +
                             own.reals[system.remainder_index(span, 0)] +
                             own.reals[system.remainder_index(span, 1)];
  if (wheels.has_wheels) {
    const WheelCatenary hung = wheel_catenary_of_length(wheels.span, rest_length);
    return touch_down(hung.rope, hung.catenary);
  }
  const HangingRope rope = hanging_rope(cable, now.gravity, straight, grip);
  return touch_down(rope, catenary_of_length(rope, rest_length));
}

double FloorFriction::limit(const CableSystem& system, const Substep& now, const Course& course,
                            const FeatureState& own, int span, FloorProfile& tensions) {
  const CompiledCable& cable = system.cables_[at(course.spans[at(span)].cable)];
  const FloorGrip grip = grip_of(cable, now.gravity, span, tensions);
  const TouchDown touch = touch_of(system, now, course, own, span, grip);
  return cable.inverse_stiffness * tensions.limit(touch.length, touch.tension, grip.slope);
}

void FloorFriction::begin(const Substep& substep, const FeatureState& state) {
  const Course course{s_.links_, s_.spans_};
  for_each_span(s_, substep, course, [&](int k, int place) {
    if (place < 0) return;
    FloorProfile& tensions = s_.laid_[at(place)];
    tensions = FloorProfile(numbers_of(s_, state.reals, place));
    // A search for equilibrium lays each rope on one way from its state.
    if (!substep.at_rest) limit(s_, substep, course, state, k, tensions);
  });
}

void FloorFriction::finish(const Substep& substep, FeatureState& next) const {
  if (substep.at_rest) return;
  const Course course{s_.links_, s_.spans_};
  s_.stray_ = -1;
  for_each_span(s_, substep, course, [&](int k, int place) {
    if (place < 0) {
      if (touch_of(s_, substep, course, next, k, {}).length > 0.0) s_.stray_ = k;
      return;
    }
    FloorProfile tensions = s_.laid_[at(place)];
    next.reals[s_.floor_loss_index(place)] += limit(s_, substep, course, next, k, tensions);
    tensions.save(numbers_of(s_, next.reals, place));
  });
}

std::string FloorFriction::stray_fault(const CableSystem& system, int span) {
  const CompiledCable& cable = system.cables_[at(system.spans_[at(span)].cable)];
  return "span " + std::to_string(span - cable.first_span) + " of cable \"" + cable.name +
         "\" lies on the floor, and \"floor_friction\" holds only rope between an "
         "anchor "
         "on the floor and the next link: keep the span above the floor, or leave floor_friction "
         "out";
}

FloorGrip FloorFriction::grip(const CableSystem& system, const Vector3& gravity, int span) {
  const int place = system.floor_places_[at(span)];
  if (place < 0) return {};
  const CompiledCable& cable = system.cables_[at(system.spans_[at(span)].cable)];
  return grip_of(cable, gravity, span, system.laid_[at(place)]);
}

FloorGrip FloorFriction::grip_in(const CableSystem& system, const Vector3& gravity,
                                 const FeatureState& own, int span, FloorProfile& room) {
  const int place = system.floor_places_[at(span)];
  if (place < 0) return {};
  room = FloorProfile(numbers_of(system, own.reals, place));
  return grip_of(system.cables_[at(system.spans_[at(span)].cable)], gravity, span, room);
}

std::vector<double> FloorFriction::kept(const CableSystem& system, const FeatureState& own,
                                        int span) {
  const int place = system.floor_places_[at(span)];
  if (place < 0) return {};
  const auto first = own.reals.begin() + static_cast<std::ptrdiff_t>(system.floor_index(place));
  return {first, first + FloorProfile::real_count + 1};
}

void FloorFriction::put(const CableSystem& system, const std::vector<double>& kept, int span,
                        FeatureState& own) {
  const int place = system.floor_places_[at(span)];
  if (place < 0 || kept.empty()) return;
  std::copy(kept.begin(), kept.end(),
            own.reals.begin() + static_cast<std::ptrdiff_t>(system.floor_index(place)));
}

bool FloorFriction::accepts(const CableSystem& system, const FeatureState& own) {
  for (int k = 0; k < system.span_count(); ++k) {
    const int place = system.floor_places_[at(k)];
    if (place < 0) continue;
    if (!FloorProfile::is_sound(numbers_of(system, own.reals, place)) ||
        !std::isfinite(own.reals[system.floor_loss_index(place)])) {
      return false;
    }
  }
  return true;
}

double FloorFriction::loss(const CableSystem& system, const FeatureState& own,
                           const CompiledCable& cable) {
  double sum = 0.0;
  for (int k = cable.first_span; k < cable.first_span + cable.span_count; ++k) {
    const int place = system.floor_places_[at(k)];
    if (place >= 0) sum += own.reals[system.floor_loss_index(place)];
  }
  return sum;
}

void FloorFriction::settle(const CableSystem& system, const BodySet& bodies, const State& state,
                           FeatureState& own) {
  if (system.laid_.empty()) return;
  const Substep now(bodies, state, 1.0, 1);
  CableSystem::Geometry current;
  system.find_geometry(now, own, current);
  const Course course{current.links, current.spans};
  for_each_span(system, now, course, [&](int k, int place) {
    if (place < 0) return;
    FloorProfile tensions(numbers_of(system, own.reals, place));
    limit(system, now, course, own, k, tensions);
    tensions.save(numbers_of(system, own.reals, place));
  });
}

int FloorFriction::lay(const CableSystem& system, const Substep& now, FeatureState& own) {
  int stray = -1;
  const Course course{system.links_, system.spans_};
  for_each_span(system, now, course, [&](int k, int place) {
    const TouchDown touch = touch_of(system, now, course, own, k, {});
    if (place < 0) {
      if (touch.length > 0.0) stray = k;
      return;
    }
    FloorProfile(touch.length, touch.tension).save(numbers_of(system, own.reals, place));
  });
  return stray;
}

}  // namespace sheave
