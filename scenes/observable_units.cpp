// Units of observables, from the tables of their names.

#include <span>

#include "scenes/observables.h"
#include "scenes/quantities.h"

namespace sheave {
namespace {

/// Unit of a length or an angle, for each quantity of `coordinate_quantities`.
std::string_view coordinate_unit(int quantity, bool angle) {
  // The table has both, "m, rad", with that of angles second.
  const std::string_view both = coordinate_quantities[static_cast<std::size_t>(quantity)].unit;
  const std::size_t comma = both.find(", ");
  return angle ? both.substr(comma + 2) : both.substr(0, comma);
}

std::string_view joint_drive_unit(int quantity, bool angle) {
  if (quantity == 0) return joint_drive_quantities[0].unit;
  return angle ? "rad, rad/s" : "m, m/s";
}

}  // namespace

std::string_view ObservableSet::unit(int index) const {
  const Source& source = sources_[static_cast<std::size_t>(index)];
  const auto of = [&](std::span<const Quantity> quantities) {
    return quantities[static_cast<std::size_t>(source.quantity)].unit;
  };
  switch (source.group) {
    case Group::time:
      return "s";
    case Group::body:
      return of(body_quantities);
    case Group::span:
      return of(span_quantities);
    case Group::link:
      return of(link_quantities);
    case Group::cable:
      return of(cable_quantities);
    case Group::joint:
      return of(joint_quantities);
    case Group::coordinate:
      return coordinate_unit(source.quantity, source.angle);
    case Group::muscle:
      return of(muscle_quantities);
    case Group::fibre:
      return of(fibre_quantities);
    case Group::energy:
      return of(energy_quantities);
    case Group::momentum:
      return of(momentum_quantities);
    case Group::bearing:
      return of(bearing_quantities);
    case Group::drive:
      return of(body_drive_quantities);
    case Group::direction:
      return of(requested_span_quantities);
    case Group::link_friction:
      return of(link_friction_quantities);
    case Group::groove:
      return of(groove_quantities);
    case Group::memory:
      return of(memory_quantities);
    case Group::joint_friction:
      return of(joint_friction_quantities);
    case Group::joint_drive:
      return joint_drive_unit(source.quantity, source.angle);
    case Group::scene_momentum:
      return of(scene_momentum_quantities);
    case Group::power:
      return of(power_quantities);
  }
  return {};
}

}  // namespace sheave
