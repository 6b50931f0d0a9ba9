#include "engine/dynamics/coordinates.h"

#include "engine/body_set.h"

namespace sheave {
namespace {

Freedom freedom_of(const BodyProperties& body) {
  switch (body.mobility) {
    case Mobility::fixed:
    case Mobility::kinematic:
    case Mobility::knot:
      break;
    case Mobility::slider:
      return Freedom::line;
    case Mobility::rotor:
      // No row turns a massless wheel; its cable turns it once the substep is complete.
      return body.axis_inertia > 0.0 && !body.prescribed() ? Freedom::angle : Freedom::none;
    case Mobility::planar:
      return Freedom::plane;
    case Mobility::free:
      return Freedom::space;
  }
  return Freedom::none;
}

}  // namespace

Coordinates::Coordinates(std::span<const BodyProperties> bodies) : levers_{1.0}, turns_{0} {
  for (const BodyProperties& body : bodies) {
    BodyFreedom& freedom = freedoms_.emplace_back();
    freedom.kind = freedom_of(body);
    freedom.body = static_cast<int>(freedoms_.size()) - 1;
    if (freedom.kind == Freedom::none) continue;
    freedom.first = count_;
    count_ += size_of(freedom.kind);
    for (int i = 0; i < size_of(freedom.kind); ++i) {
      const bool turns = is_rotation(freedom.kind, i);
      levers_.push_back(turns ? body.size : 1.0);
      turns_.push_back(turns ? 1 : 0);
    }
    if (freedom.kind == Freedom::line) freedom.along = body.axis;
    if (freedom.kind == Freedom::plane) {
      freedom.along = any_perpendicular(body.axis);
      freedom.across = body.axis.cross(freedom.along);
    }
    movable_.push_back(freedom);
  }
}

}  // namespace sheave
