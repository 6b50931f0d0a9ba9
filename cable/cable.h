#pragma once
// What a user says about one cable.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cable/link.h"

namespace sheave {

/// When the tangents, and with them the rest lengths, follow the bodies.
enum class TangentUpdate {
  iteration,  ///< in every iteration: accurate
  substep,    ///< once per substep, as in the paper; of a cable that leaves the plane of a
              ///< wheel or lies on an outline in every iteration all the same: the paper's forces
              ///< would lose work there at any step size, or jump
};
inline constexpr std::array<std::string_view, 2> tangent_update_names{"iteration", "substep"};

/// Settings of one cable: an ordered list of links; span k joins link k and link k + 1.
struct CableDef {
  std::string name;     ///< unique among the cables
  bool closed = false;  ///< a last span joins the last link and the first: a belt
  /// Of each span [m/N], >= 0, 0 is rigid. Excludes axial_stiffness. As in the paper a span has it
  /// whatever its length, so a cable that touches a body and is divided becomes softer; a
  /// material's does not. What lies on wheels and posts has none.
  std::optional<double> compliance;
  /// Of the cable's material, EA [N], > 0: a span then has the compliance rest length / EA, and
  /// what comes onto a wheel keeps its strain there, so that a belt creeps
  /// (cable/cable_material.cpp); where it slides over an arc, that is stretched with the spans
  /// (cable/strained_arcs.cpp). At time 0 what lies on a wheel has the strain of the spans beside
  /// it, of two their mean. Rest lengths and stored lengths are unstretched.
  std::optional<double> axial_stiffness;
  double damping = 0.0;  ///< of each free span [N s/m], >= 0; needs an elastic cable
  TangentUpdate tangent_update = TangentUpdate::iteration;
  /// Rest length of each span at time 0 [m], one per span; default: its length, so that the cable
  /// is just taut. Shorter than the length only for elastic cables.
  std::vector<double> rest_lengths;
  /// Capstan coefficient on bodies that are wrappable and no links of this cable, >= 0.
  double wrap_friction = 0.0;
  int most_wraps = 16;  ///< on such bodies at the same time, 0 to 1000; 0: it goes through them
  /// Mean tension over a substep at which the cable breaks [N], > 0; default: never.
  std::optional<double> breaking_tension;
  std::optional<double> cut_time;                     ///< when it is cut [s], >= 0; default: never
  std::vector<std::shared_ptr<const LinkDef>> links;  ///< at least 2

  /// Every member but the links.
  static std::span<const Field> field_table();
  [[nodiscard]] int span_count() const { return static_cast<int>(links.size()) - (closed ? 0 : 1); }
};

}  // namespace sheave
