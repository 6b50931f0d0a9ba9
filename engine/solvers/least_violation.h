#pragma once
// The place of least violation, for substeps in which Newton's method finds no solution or none
// exists.
//
// A winch draws a load along a rail, past the point nearest to the winch. No place of the load
// satisfies the rows. The linearised rows contradict each other only at the nearest point, a
// singular configuration, because the gradient of the length along the rail is 0 there. Near this
// point Newton's method takes steps without bound. The rounds here are those of Levenberg and
// Marquardt. With a damping d, and the effective inverse mass w of each row if all of its motion
// were along the row,
//
//   (A + d w) dl = -r   makes   |r + J dx|^2 / w + d |dx|^2 / W   least,
//
// and the minimum is below the value at dx = 0. With d large enough, the misfit, which is the sum
// of r^2 / w over the violated rows, falls in every round. The result is no farther from the
// prediction than necessary, so the bodies are not thrown. After good rounds d is reduced, and the
// rounds become Newton's.
//
// The rounds end with all rows satisfied, or at a stationary misfit: J^T (r / w) = 0. There the
// forces -r / w along the rows cause no motion, so at the present rates no motion reduces their
// sum: linearised, the rows contradict each other. A dead end has two more properties. Descents
// from places around it and from the start of the substep all end at stationary misfits, too, and
// the discrete states of features (links that slide) agree with the forces found. Then no near
// place satisfies the rows: the machine is in a singular configuration.
//
// These properties hold for forces along the gradients, K = J. Friction between spans that share an
// unknown makes K differ from J. The forces of a round may then fail to reduce a misfit that is not
// stationary, and they may balance at a misfit that is not the least. The existence of a solution
// is a question of geometry, not of forces, so the test of a dead end has K = J and leaves out rows
// that yield to enough force. Furthermore, the forces with one set of sliding links may require
// another set, whose forces require the first one. For a dead end, no near place may satisfy the
// rows with any of these sets.

#include "engine/solvers/kept_place.h"
#include "engine/solvers/row_system.h"

namespace sheave {

class LeastViolation {
 public:
  enum class Outcome {
    met,         ///< all rows are satisfied
    dead_end,    ///< no near place satisfies all rows; bodies are at the place of least misfit
    unresolved,  ///< the misfit has become less
    failed,      ///< no active set was found; no body has moved
  };
  /// Moves the bodies from their places at RowSystem::begin_adding_up(). Afterwards `system` is
  /// linearised at the new places.
  Outcome find(Substep& substep, Features features, RowSystem& system);

 private:
  /// Result of a descent.
  struct Place {
    double misfit = 0.0;
    double violation = 0.0;
    double way_out = 0.0;
    bool failed = false;  ///< no active set was found in the first round
    bool met = false;
  };
  /// Rounds from the present places until the misfit is least.
  Place descend(Substep& substep, Features features, RowSystem& system);
  /// descend() with revisions of the discrete states of features. Returns the number of sets of
  /// rows in the cycle of revisions: 1 if the states have settled, 0 if they neither settle nor
  /// repeat. `place` belongs to the last set.
  int descend_and_revise(Substep& substep, Features features, RowSystem& system, Place& place);
  static bool revise(Substep& substep, Features features);
  /// Whether rows are violated at a place, and no motion of the scene's size would repair them at
  /// the rates of that place.
  [[nodiscard]] static bool is_stationary(const Substep& substep, const Place& place);
  /// Whether no near place satisfies the rows, whatever the forces. The bodies are back at their
  /// places afterwards.
  bool nothing_is_near(Substep& substep, Features features, RowSystem& system);
  /// Whether a descent from other places ends with all rows satisfied, or does not end.
  bool escapes(Substep& substep, Features features, RowSystem& system);

  KeptPlace round_;
  KeptPlace result_;
  KeptPlace least_;
};

}  // namespace sheave
