#include "cable/certificate/grooves.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cable/certificate/evidence.h"
#include "cable/links/spool.h"
#include "engine/math/portable.h"

namespace sheave::certify {

std::shared_ptr<const GrooveLaw> GrooveLaw::of(const LinkDef& link, const BodySet& bodies,
                                               int body) {
  const auto* drum = dynamic_cast<const SpoolLink*>(&link);
  if (drum == nullptr || !drum->has_groove()) return nullptr;
  auto law = std::make_shared<GrooveLaw>();
  law->radius_ = drum->radius.value_or(0.0);
  if (!drum->radius && body < bodies.count()) {
    for (const PlacedShape& placed : bodies.definition(body).shapes) {
      if (law->radius_ == 0.0) law->radius_ = placed.shape->wheel_radius();
    }
  }
  constexpr double endless = std::numeric_limits<double>::infinity();
  law->along_ = drum->lead.value_or(0.0) / (2.0 * pi);
  law->whole_ = 2.0 * pi * drum->turns_per_layer.value_or(endless);
  law->height_ = drum->layer_height.value_or(0.0);
  return law;
}

GrooveLaw::Place GrooveLaw::place(double angle) const {
  constexpr double change = pi;  // angle of a change of layers
  constexpr int most = 20000;
  Place now;
  double begin = 0.0;
  for (int k = 0; k < most; ++k) {
    const double gain = portable::hypot(radius_ + k * height_, along_);
    const double slope = k % 2 == 0 ? along_ : -along_;
    const double plain_end = (k + 1) * whole_ - 0.5 * change;
    now.gain = gain;
    now.slope = slope;
    const double plain = std::min(angle, plain_end) - begin;
    now.length += gain * plain;
    now.axial += slope * plain;
    if (!(angle > plain_end)) return now;
    // Rates that go evenly to those of the next layer have the mean of both ends.
    const double part = std::min(angle - plain_end, change);
    const double next = portable::hypot(radius_ + (k + 1) * height_, along_);
    now.gain = gain + (next - gain) * part / change;
    now.slope = slope * (1.0 - 2.0 * part / change);
    now.length += 0.5 * (gain + now.gain) * part;
    now.axial += 0.5 * (slope + now.slope) * part;
    begin = plain_end + change;
    if (!(angle > begin)) return now;
  }
  return now;
}

double GrooveLaw::angle(double length) const {
  constexpr int most_rounds = 100;
  double angle = length / portable::hypot(radius_, along_);
  for (int round = 0; round < most_rounds; ++round) {
    const Place now = place(angle);
    const double step = (length - now.length) / now.gain;
    angle += step;
    if (!(std::abs(step) > 1e-15 * (1.0 + std::abs(angle)))) break;
  }
  return angle;
}

void follow_groove(const BodySet& bodies, const CableEvidence& cable, End when, SpanSide& side) {
  if (side.winding == 0) return;
  if (!side.groove) {
    side.groove = GrooveLaw::of(*cable.definition->links[at(side.place)], bodies, side.body);
  }
  side.wound[at(when)] = side.groove->angle(side.lies[at(when)]);
}

}  // namespace sheave::certify
