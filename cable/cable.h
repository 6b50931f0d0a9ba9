#pragma once
// Settings of one cable, as the user gives them.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cable/link.h"

namespace sheave {

/// When the tangent points, and with them the rest lengths, are computed again.
enum class TangentUpdate {
  iteration,  ///< in every iteration: accurate
  /// Once per substep, as in the paper. A cable that leaves the plane of a wheel or lies on an
  /// outline is computed in every iteration nevertheless: the forces of the paper would lose work
  /// there at any step size, or jump.
  substep,
};
inline constexpr std::array<std::string_view, 2> tangent_update_names{"iteration", "substep"};

/// Settings of one cable: an ordered list of links; span k joins link k and link k + 1.
struct CableDef {
  std::string name;     ///< unique among the cables
  bool closed = false;  ///< a last span joins the last link and the first: a belt
  /// Compliance of each span [m/N], >= 0; 0 is rigid. Excludes axial_stiffness. As in the paper, a
  /// span has this compliance whatever its length, so a cable becomes softer when it touches a body
  /// and one span becomes two. With axial_stiffness this does not happen. Cable stored on wheels
  /// and posts has no compliance.
  std::optional<double> compliance;
  /// Axial stiffness EA of the cable's material [N], > 0. A span then has the compliance rest
  /// length / EA. Cable that comes onto a wheel keeps its strain there, so a belt creeps
  /// (cable/cable_material.cpp). Where the cable slides over an arc, the arc is stretched together
  /// with the spans (cable/strained_arcs.cpp). At time 0 the cable stored on a wheel has the strain
  /// of the adjacent span, or the mean strain of two adjacent spans. Rest lengths and stored
  /// lengths are unstretched.
  std::optional<double> axial_stiffness;
  /// Tension of the cable's material over its strain, instead of `axial_stiffness`: the strains,
  /// which rise from 0, and as many tensions [N], which rise from 0 (cable/tension_law.h). 2 to
  /// 10000 points. Excludes friction of cable that slides over links, `linear_density`,
  /// `layer_pitch` of drums and `tangent_update` "substep".
  std::vector<double> strain_table;
  std::vector<double> tension_table;  ///< [N], one per strain
  /// A rope with a table that yields (cable/rope_memory.h): the slope of the line on which it is let
  /// off and stretched again [N], at least the steepest slope of the table's curve; default: the
  /// table holds both ways. The rope keeps the strain at which this line reaches the tension 0. Such a
  /// rope, and one with `unloading_table`, runs over attachments, and over pinholes, posts and smooth
  /// bodies without friction.
  std::optional<double> unloading_stiffness;
  /// Tensions of a rope with a table that is let off, one per strain of `strain_table` [N], at most
  /// those of `tension_table`; default: the table holds both ways. Excludes `unloading_stiffness`.
  std::vector<double> unloading_table;
  /// Strain over which the tension goes from the one curve to the other where the rope turns, > 0;
  /// required with `unloading_table`.
  std::optional<double> transition_strain;
  double damping = 0.0;  ///< damping of each free span [N s/m], >= 0; needs an elastic cable
  /// Damping of the cable's material [N s], >= 0: tension per rate of strain, so a span of rest
  /// length L has a damper of this / L, and so has the rope on an arc over which it slides, which must be
  /// without friction. Needs `axial_stiffness` or a table; excludes `damping`.
  double axial_damping = 0.0;
  /// Mass per unstretched length [kg/m], >= 0; 0 (default): the rope has no weight. A span then hangs
  /// as an elastic catenary (cable/catenary.h), and its tension differs between its ends by weight
  /// times height. Needs `axial_stiffness`, and links that are attachments, or wheels with inertia
  /// and drums in a vertical plane. Without `axial_inertia` the rope has weight, but no inertia.
  double linear_density = 0.0;
  /// Whether the mass of a rope with `linear_density` has inertia: spans move as straight lines whose
  /// velocity changes evenly from end to end, and rope on wheels moves with them
  /// (cable/rope_inertia.h). Links are attachments without feeds, and wheels with inertia and drums
  /// without losses. Excludes `breaking_tension`.
  bool axial_inertia = false;
  /// Height of a level floor above the origin, against gravity [m]; default: none. A rope with
  /// `linear_density` that would hang below the floor lies on it (cable/lying_rope.h). Its ends and
  /// wheels are not below the floor. Excludes `axial_inertia`.
  std::optional<double> floor;
  /// Coefficient of Coulomb's friction of the floor along the rope, 0 to 10; default: none. Friction
  /// holds the rope between an anchor and the next link (cable/floor_profile.h). An anchor is an
  /// attachment at an end of the cable, on the world or a static body, on the floor, without a feed. At
  /// time 0 the rope lies with one tension. Other spans stay above the floor. Excludes dampers.
  double floor_friction = 0.0;
  TangentUpdate tangent_update = TangentUpdate::iteration;
  /// Rest length of each span at time 0 [m], one per span; default: its length, so that the cable
  /// is just taut. Shorter than the length only for elastic cables. Where an elastic cable without
  /// damping slides over a link without friction, the start has one tension: lengths that would give
  /// several are shared, with the same sum (cable/cable_compile_strain.cpp).
  std::vector<double> rest_lengths;
  /// Tension of all spans at time 0 [N], > 0, instead of rest lengths, which follow from the
  /// elasticity and the poses of the bodies. Only for elastic cables. Of a rope with weight it is the
  /// component of the tension along the chord.
  std::optional<double> pretension;
  std::vector<double> pretensions;  ///< the same [N], >= 0, one per span
  /// Capstan coefficient on wrappable bodies that are not links of this cable, >= 0.
  double wrap_friction = 0.0;
  /// Largest number of simultaneous wraps on such bodies, 0 to 1000. The cable passes through any
  /// further ones.
  int most_wraps = 16;
  /// Tension at which the cable breaks [N], > 0; default: never. The break is at the instant of this
  /// tension; a jerk of a rigid cable counts as its impulse over a substep (cable/cable_cut.cpp).
  std::optional<double> breaking_tension;
  std::optional<double> cut_time;  ///< time at which the cable is cut [s], >= 0; default: never
  std::vector<std::shared_ptr<const LinkDef>> links;  ///< at least 2

  /// Every member but the links.
  static std::span<const Field> field_table();
  /// Whether the stretch of the cable is a strain: its rest lengths are those of a material.
  [[nodiscard]] bool has_material() const { return axial_stiffness || !tension_table.empty(); }
  /// Whether the tension depends on how the rope was stretched before (cable/rope_memory.h).
  [[nodiscard]] bool has_memory() const {
    return !unloading_table.empty() || unloading_stiffness || transition_strain;
  }
  [[nodiscard]] bool is_elastic() const { return has_material() || compliance.value_or(0.0) > 0.0; }
  [[nodiscard]] bool is_damped() const { return damping > 0.0 || axial_damping > 0.0; }
  [[nodiscard]] int span_count() const { return static_cast<int>(links.size()) - (closed ? 0 : 1); }
};

}  // namespace sheave
