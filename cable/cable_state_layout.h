#pragma once

#include <cstddef>

#include "cable/floor_profile.h"
#include "cable/sheath_profile.h"
#include "cable/stored_strain.h"

namespace sheave {

/// Layout of the state of the feature "cables". Spans and links are those of all cables, in order.
///
/// reals, in this order:
///   per span: rest length [m]
///   per link: stored length [m]
///   per span: tension [N]
///   per span end (first, second): transport below the quantum [m]; rows count it as rest length
///   per link: slip [m], the cable that has slid over the link towards the next span; for an
///     attachment the cable that was fed
///   per link: angle of a hybrid end's attachment [rad]
///   per place for a wrap, in the body's own frame: its plane, centre [m] and normal; for a
///     geodesic its entry point [m] and the unit tangent of the surface normal to the cable there
///   per link on which cable with a material can lie: the numbers that StoredStrain saves, and the
///     energy lost there by creep since time 0 [J]
///   per wheel with inertia that loses tension: torque of its bearing on it about its axle [N m]
///   per sheath: the numbers that SheathProfile saves, and the energy lost there by friction since
///     time 0 [J]
///   per span of a rope with memory: the strain that it remembers (cable/rope_memory.h), and the
///     energy lost there by its law since time 0 [J]
///   per span at an anchor on a floor with friction: the numbers that FloorProfile saves, and the
///     energy lost there by friction since time 0 [J]
///
/// integers, in this order:
///   per link: direction in which cable slides over a link with friction, +1 towards the next
///     span, -1 towards the last, 0 not at all; of a sheath that of the whole rope in it
///   per link: its mode, 0 as defined, 1 wound the other way round, 2 attached (hybrid ends), 3
///     left by the cable, 4 left and passed to the other side
///   per link: the next link along the cable, counted within it; -1 at the cable's end and for a
///     link that the cable does not touch
///   per place for a wrap: +-(candidate + 1), the sign is the winding; 0 unused
///   per cable: 0, or the code of the place where the cable is cut (cable/cut_place.h)
///   per link, if a cable has driven links: direction of the drive's turn about its axis in which
///     it has stalled because all cable was drawn; 0 it has not stalled
class CableStateLayout {
 public:
  // Indices in FeatureState::reals.
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
  /// First of six numbers of the place `plane` for a wrap, counted over all cables.
  [[nodiscard]] std::size_t plane_index(int plane) const {
    return 4 * spans_in_state + 3 * links_in_state + 6 * static_cast<std::size_t>(plane);
  }
  /// First of StoredStrain::real_count numbers of the strain place `place` (see strain_places_).
  [[nodiscard]] std::size_t strain_index(int place) const {
    return plane_index(planes_in_state) +
           (StoredStrain::real_count + 1) * static_cast<std::size_t>(place);
  }
  [[nodiscard]] std::size_t creep_index(int place) const {
    return strain_index(place) + StoredStrain::real_count;
  }
  /// `bearing` counts the bearings that brake wheels.
  [[nodiscard]] std::size_t bearing_index(int bearing) const {
    return strain_index(strains_in_state) + static_cast<std::size_t>(bearing);
  }
  /// First of SheathProfile::real_count numbers of a sheath.
  [[nodiscard]] std::size_t sheath_index(std::size_t sheath) const {
    return bearing_index(bearings_in_state) + (SheathProfile::real_count + 1) * sheath;
  }
  [[nodiscard]] std::size_t sheath_loss_index(std::size_t sheath) const {
    return sheath_index(sheath) + SheathProfile::real_count;
  }
  /// First of two numbers of the memory place `place` (see memory_places_).
  [[nodiscard]] std::size_t memory_index(int place) const {
    return sheath_index(sheaths_in_state) + 2 * static_cast<std::size_t>(place);
  }
  /// First of FloorProfile::real_count numbers of the floor place `place` (see floor_places_).
  [[nodiscard]] std::size_t floor_index(int place) const {
    return memory_index(memories_in_state) +
           (FloorProfile::real_count + 1) * static_cast<std::size_t>(place);
  }
  [[nodiscard]] std::size_t floor_loss_index(int place) const {
    return floor_index(place) + FloorProfile::real_count;
  }
  // Indices in FeatureState::integers.
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
  int bearings_in_state = 0;
  std::size_t sheaths_in_state = 0;
  int memories_in_state = 0;
  int cables_in_state = 0;
};

}  // namespace sheave
