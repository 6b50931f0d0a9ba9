#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "cable/cable.h"
#include "cable/wrap_candidate.h"
#include "engine/body_frames.h"
#include "engine/vector.h"

namespace sheave {

/// Constants of one cable.
struct CompiledCable {
  std::string name;
  bool closed = false;
  /// Its links and spans within those of all cables. Span k begins at link k; behind the links that
  /// the user listed there are places for wraps on bodies that the cable comes to touch.
  int first_link = 0;
  int listed_links = 0;
  int link_count = 0;
  int first_span = 0;
  int listed_spans = 0;
  int span_count = 0;
  double compliance = 0.0;         ///< [m/N]; 0 if rigid or of a material
  double inverse_stiffness = 0.0;  ///< 1/EA [1/N]; 0 if not of a material
  double damping = 0.0;            ///< [N s/m]
  double breaking_tension = std::numeric_limits<double>::infinity();  ///< [N]
  double cut_time = std::numeric_limits<double>::infinity();          ///< [s]
  double wrap_friction = 0.0;             ///< capstan coefficient on wrappable bodies
  double added_length = 0.0;              ///< that placements have put in [m]
  std::vector<WrapCandidate> candidates;  ///< bodies it can come to touch
  int first_plane = 0;                    ///< of its places for wraps within those of all cables
  bool course_changes = false;            ///< it leaves or touches bodies, or can be cut
  bool planar = false;                    ///< all links stay in one plane
  Vector3 normal = Vector3::UnitZ();      ///< of that plane
  std::vector<double> senses;  ///< per link: +1 if its normal is `normal`, -1 if opposite
  /// Of its listed links those whose body a drive turns, and those that feed.
  std::vector<int> driven_links;
  std::vector<int> grips;     ///< attachments between its ends, of all links
  bool may_lock = false;      ///< rigid, and drives alone may decide how long some of its spans are
  bool has_outlines = false;  ///< one of its links is no circle or point
  bool shares = false;        ///< cable can pass at one of its links other than by rolling
  bool has_friction = false;  ///< and at one of them with friction
  TangentUpdate tangent_update = TangentUpdate::iteration;
  /// In this substep attachments keep their places on the bodies: `tangent_update` says so, and no
  /// span ends on an outline or leans to the plane of a wheel.
  bool frozen = false;
  double start_length = 0.0;  ///< rest and stored lengths at time 0 [m]
  /// How far a length of now is from what it was at the start and what was fed since, relative to
  /// the start, or to now where all of it has been fed.
  [[nodiscard]] double length_error(double total, double fed) const {
    const double all = start_length > 0.0 ? start_length : total;
    return all > 0.0 ? (total - start_length - fed) / all : 0.0;
  }
  BodyFrames defined_in;  ///< where bodies were when it was defined
  /// Power of two that all rest and stored lengths are multiples of [m], about 1e-15 of the cable.
  /// Sums and differences of such numbers are exact, so moving cable from span to wheel to span
  /// cannot lose any: the length invariant holds to the last bit, for ever.
  double quantum = 0.0;
  std::vector<std::string_view> link_types;

  [[nodiscard]] bool is_rigid() const { return compliance == 0.0 && inverse_stiffness == 0.0; }
  [[nodiscard]] int last_listed_link() const { return first_link + listed_links - 1; }
  /// The multiple of the quantum nearest to `length` [m].
  [[nodiscard]] double quantised(double length) const {
    return quantised(length, quantum, 1.0 / quantum);  // exact, as is its inverse
  }
  [[nodiscard]] static double quantised(double length, double quantum, double inverse_quantum) {
    if (is_small(std::abs(length), inverse_quantum)) {
      return quantised_small(length, quantum, inverse_quantum);
    }
    return std::round(length * inverse_quantum) * quantum;
  }
  /// Of a length that is_small(): any that a machine has.
  [[nodiscard]] static double quantised_small(double length, double quantum,
                                              double inverse_quantum) {
    return ((length * inverse_quantum + whole) - whole) * quantum;
  }
  [[nodiscard]] static bool is_small(double length, double inverse_quantum) {
    return length * inverse_quantum < 0.25 * whole;
  }

 private:
  // Numbers of this size have no fractions: adding one rounds.
  static constexpr double whole = 6755399441055744.0;  // 1.5 x 2^52
};

}  // namespace sheave
