#pragma once

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "cable/cable.h"
#include "cable/rope_memory.h"
#include "cable/stored_strain.h"
#include "cable/tension_law.h"
#include "cable/wrap_candidate.h"
#include "engine/body_frames.h"
#include "engine/vector.h"

namespace sheave {

/// Constants of one cable.
struct CompiledCable {
  std::string name;
  bool closed = false;
  /// Index ranges of the cable's links and spans within those of all cables. Span k begins at link
  /// k. The listed links are followed by places for wraps on bodies that the cable comes to touch.
  int first_link = 0;
  int listed_links = 0;
  int link_count = 0;
  int first_span = 0;
  int listed_spans = 0;
  int span_count = 0;
  double compliance = 0.0;         ///< [m/N]; 0 if rigid or with a material
  double inverse_stiffness = 0.0;  ///< 1/EA [1/N]; 0 without a material
  /// Law of a material with a table, of which `inverse_stiffness` is a scale only; null: EA is
  /// constant.
  std::shared_ptr<const TensionLaw> law;
  /// Of a rope whose tension depends on how it was stretched before, beside `law`; null: another.
  std::shared_ptr<const RopeMemory> memory;
  double damping = 0.0;         ///< [N s/m]
  double axial_damping = 0.0;   ///< [N s]
  double linear_density = 0.0;  ///< mass per unstretched length [kg/m]
  bool axial_inertia = false;   ///< whether this mass has inertia
  /// Height of the floor along `floor_up` [m]; -infinity: none.
  double floor = -std::numeric_limits<double>::infinity();
  Vector3 floor_up = Vector3::UnitY();
  double floor_friction = 0.0;  ///< coefficient of Coulomb's law
  /// Whether the first and the last link are anchors on a floor with friction.
  std::array<bool, 2> anchored{};
  /// Whether a link, counted over all cables, is such an anchor.
  [[nodiscard]] bool is_anchor(int link) const {
    return (anchored[0] && link == first_link) || (anchored[1] && link == last_listed_link());
  }
  double breaking_tension = std::numeric_limits<double>::infinity();  ///< [N]
  double cut_time = std::numeric_limits<double>::infinity();          ///< [s]
  double wrap_friction = 0.0;             ///< capstan coefficient on wrappable bodies
  double added_length = 0.0;              ///< length that placements have added [m]
  std::vector<WrapCandidate> candidates;  ///< bodies that the cable can come to touch
  /// Per link: its place for a plane in the state, among those of all cables; -1: none.
  std::vector<int> planes;
  bool course_changes = false;        ///< the cable can leave or touch bodies, or be cut
  bool planar = false;                ///< all links stay in one plane
  Vector3 normal = Vector3::UnitZ();  ///< of that plane
  std::vector<double> senses;  ///< per link: +1 if its normal is `normal`, -1 if it is opposite
  /// Listed links whose body a drive turns, and listed links that feed.
  std::vector<int> driven_links;
  std::vector<int> grips;      ///< attachments between the cable's ends, among all links
  bool may_lock = false;       ///< rigid, and drives alone may fix the length of some spans
  bool has_outlines = false;   ///< a link is neither a circle nor a point
  bool has_geodesics = false;  ///< a link or candidate is a smooth body on which it slides sideways
  bool knotted = false;        ///< an end is on a knot (cable/knots.h)
  bool has_sheaths = false;    ///< it runs through sheaths (cable/sheaths.h)
  std::vector<int> openings;   ///< links that are openings, among all links (cable/opening.h)
  bool shares = false;         ///< cable can pass a link other than by rolling
  bool has_friction = false;   ///< cable can pass a link with friction
  TangentUpdate tangent_update = TangentUpdate::iteration;
  /// In this substep the contacts keep their places on the bodies: `tangent_update` asks for it,
  /// and no span ends on an outline or leans out of the plane of a wheel.
  bool frozen = false;
  double start_length = 0.0;  ///< rest and stored lengths at time 0 [m]
  /// (length now - length at the start - fed length) / length at the start. The divisor is the
  /// length now if there was no cable at the start.
  [[nodiscard]] double length_error(double total, double fed) const {
    const double all = start_length > 0.0 ? start_length : total;
    return all > 0.0 ? (total - start_length - fed) / all : 0.0;
  }
  BodyFrames defined_in;  ///< poses of the bodies when the cable was defined
  /// Power of two of which all rest and stored lengths are multiples [m], about 1e-15 of the cable.
  /// Sums and differences of such numbers are exact. Moving cable from a span to a wheel and back
  /// therefore loses nothing, and the length invariant holds to the last bit.
  double quantum = 0.0;
  std::vector<std::string_view> link_types;

  [[nodiscard]] bool has_floor() const { return floor > -std::numeric_limits<double>::infinity(); }
  [[nodiscard]] bool is_damped() const { return damping > 0.0 || axial_damping > 0.0; }
  /// Damper of a span [N s/m].
  [[nodiscard]] double damper(double rest_length) const {
    return axial_damping > 0.0 && rest_length > 0.0 ? damping + axial_damping / rest_length
                                                    : damping;
  }
  /// Strain of a material under a tension [N], >= 0, without dampers.
  [[nodiscard]] double strain_under(double tension) const {
    if (memory) return memory->first_strain(tension);
    return law ? law->strain(tension) : tension * inverse_stiffness;
  }
  /// Tension of a span without dampers [N]; `yield`: compliance of a span without a law [m/N], > 0;
  /// `remembered`: the strain that a rope with `memory` remembers there.
  [[nodiscard]] double spring_tension(double stretch, double rest_length, double yield,
                                      double remembered) const {
    if (!law) return stretch / yield;
    const double strain = rest_length > 0.0 ? stretch / rest_length : 0.0;
    return memory ? memory->tension(strain, remembered) : law->tension(strain);
  }
  [[nodiscard]] StrainEnergy strain_energy() const {
    return law ? StrainEnergy(*law, inverse_stiffness) : StrainEnergy();
  }
  [[nodiscard]] bool is_rigid() const { return compliance == 0.0 && inverse_stiffness == 0.0; }
  [[nodiscard]] int last_listed_link() const { return first_link + listed_links - 1; }
  /// The multiple of the quantum nearest to `length` [m].
  [[nodiscard]] double quantised(double length) const {
    // the quantum is a power of two, so the inverse is exact
    return quantised(length, quantum, 1.0 / quantum);
  }
  [[nodiscard]] static double quantised(double length, double quantum, double inverse_quantum) {
    if (is_small(std::abs(length), inverse_quantum)) {
      return quantised_small(length, quantum, inverse_quantum);
    }
    return std::round(length * inverse_quantum) * quantum;
  }
  /// For a length that is_small(), as any length of a machine is.
  [[nodiscard]] static double quantised_small(double length, double quantum,
                                              double inverse_quantum) {
    return ((length * inverse_quantum + whole) - whole) * quantum;
  }
  [[nodiscard]] static bool is_small(double length, double inverse_quantum) {
    return length * inverse_quantum < 0.25 * whole;
  }

 private:
  // Doubles of this size have no fraction, so adding one rounds to an integer.
  static constexpr double whole = 6755399441055744.0;  // 1.5 x 2^52
};

/// Energy that cable loses which comes off a link into a span with the mean strain `strain` [J]:
/// cable/cable_material.cpp.
[[nodiscard]] double creep_loss(const CompiledCable& cable, const StoredStrain::Piece& off,
                                double strain);

}  // namespace sheave
