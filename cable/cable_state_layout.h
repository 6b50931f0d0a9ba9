#pragma once

#include <cstddef>

#include "cable/stored_strain.h"

namespace sheave {

/// Where in the state of the feature "cables" the parts are, with the spans and links of all cables
/// in order:
///
/// reals: rest length per span [m], stored length per link [m], tension per span [N], transport
/// below the quantum per span end (first, second) [m], which rows count as rest length, slip per
/// link [m]: cable that has slid over it towards the next span, of an attachment cable that was
/// fed, angle of a hybrid end's attachment per link [rad], plane per place for a wrap: centre [m]
/// and normal, own frame of the body. Then per link on which cable of a material can lie what
/// StoredStrain saves, and what has been lost there by creep since time 0 [J]. Then per wheel with
/// inertia that loses tension the torque of its bearing on it about its axle [N m].
///
/// integers: per link with friction which way the cable slides: +1 towards the next span, -1
/// towards the last, 0 not at all; per link its mode: 0 as defined, 1 wound the other way round, 2
/// attached (hybrid ends), 3 left by the cable, 4 left and passed to the other side; per link the
/// next one along the cable, counted within it, -1 at its end and where the cable does not touch;
/// per place for a wrap +-(candidate + 1), the sign being its winding, 0 unused; per cable 0, or 1
/// + the span where it is cut; if a cable has driven links, per link which way its drive has
/// stalled because all cable was drawn: the sign of the drive's turn about its axis, 0 it has not.
class CableStateLayout {
 public:
  // Where the parts of the state begin in FeatureState::reals.
  [[nodiscard]] std::size_t rest_length_index(int span) const {
    return static_cast<std::size_t>(span);
  }
  [[nodiscard]] std::size_t stored_length_index(int link) const {
    return spans_in_state + static_cast<std::size_t>(link);
  }
  [[nodiscard]] std::size_t tension_index(int span) const {
    return spans_in_state + links_in_state + static_cast<std::size_t>(span);
  }
  [[nodiscard]] std::size_t remainder_index(int span, int end) const {
    return 2 * spans_in_state + links_in_state + 2 * static_cast<std::size_t>(span) +
           static_cast<std::size_t>(end);
  }
  [[nodiscard]] std::size_t slip_index(int link) const {
    return 4 * spans_in_state + links_in_state + static_cast<std::size_t>(link);
  }
  [[nodiscard]] std::size_t angle_index(int link) const {
    return 4 * spans_in_state + 2 * links_in_state + static_cast<std::size_t>(link);
  }
  /// Six numbers, of the place `plane` for a wrap, counted over all cables.
  [[nodiscard]] std::size_t plane_index(int plane) const {
    return 4 * spans_in_state + 3 * links_in_state + 6 * static_cast<std::size_t>(plane);
  }
  /// StoredStrain::real_count numbers, of the strain place `place` (see strain_places_).
  [[nodiscard]] std::size_t strain_index(int place) const {
    return plane_index(planes_in_state) +
           (StoredStrain::real_count + 1) * static_cast<std::size_t>(place);
  }
  [[nodiscard]] std::size_t creep_index(int place) const {
    return strain_index(place) + StoredStrain::real_count;
  }
  /// Of the bearing that is the `bearing`th of those that brake wheels.
  [[nodiscard]] std::size_t bearing_index(int bearing) const {
    return strain_index(strains_in_state) + static_cast<std::size_t>(bearing);
  }
  // And in FeatureState::integers.
  [[nodiscard]] static std::size_t slip_state_index(int link) {
    return static_cast<std::size_t>(link);
  }
  [[nodiscard]] std::size_t mode_index(int link) const {
    return links_in_state + static_cast<std::size_t>(link);
  }
  [[nodiscard]] std::size_t next_index(int link) const {
    return 2 * links_in_state + static_cast<std::size_t>(link);
  }
  [[nodiscard]] std::size_t wrap_index(int link) const {
    return 3 * links_in_state + static_cast<std::size_t>(link);
  }
  [[nodiscard]] std::size_t cut_index(int cable) const {
    return 4 * links_in_state + static_cast<std::size_t>(cable);
  }
  [[nodiscard]] std::size_t stall_index(int link) const {
    return cut_index(cables_in_state) + static_cast<std::size_t>(link);
  }

 protected:
  CableStateLayout() = default;

  std::size_t spans_in_state = 0;
  std::size_t links_in_state = 0;
  int planes_in_state = 0;
  int strains_in_state = 0;
  int cables_in_state = 0;
};

}  // namespace sheave
