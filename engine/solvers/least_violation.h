#pragma once
// What is left to do where Newton's method does not find how rows can be met, or where they cannot.
//
// A winch draws a load along a rail, past the point that is nearest to the winch: no place of the
// load is good enough, yet the rows do not contradict each other anywhere but there, where the
// gradient of the length along the rail is 0, and before it Newton's method takes steps without
// bound. The rounds here are those of Levenberg and Marquardt: with the yields w of the rows, were
// all of their motion along them, and a damping d,
//
//   (A + d w) dl = -r   makes   |r + J dx|^2 / w + d |dx|^2 / W   least,
//
// which is less than at dx = 0. So with d large enough the misfit, the sum of r^2 / w of what is
// violated, becomes less in every round, and what comes out is no farther from the prediction than
// that takes: it throws nothing. Where rounds are good d becomes less, and they become Newton's.
//
// The rounds end where rows are met, or where the misfit is stationary: J^T (r / w) = 0. There the
// forces -r / w along the rows cause no motion, so of the rates of now no motion mends their sum:
// linearised, the rows contradict each other. Where, besides, descents from places around it and
// from the start of the substep all end at such places, too, with what the features decide (links
// that slide) as it is right for the forces found, nothing near satisfies the rows: the machine is
// asked for more than there is.
//
// All this holds where forces act along the gradients, K = J. Friction between spans that share an
// unknown makes K another one: then the forces of a round may lessen nothing where the misfit is
// not stationary, and be in balance where it is. Whether places satisfy rows is a question of
// geometry and not of forces, so it is asked with K = J, and without what yields to enough force.
// And the forces that hold where one set of links slides may ask for another one, whose forces ask
// for the first: then nothing may be near with any of these sets.

#include "engine/solvers/kept_place.h"
#include "engine/solvers/row_system.h"

namespace sheave {

class LeastViolation {
 public:
  enum class Outcome {
    met,         ///< all rows are satisfied
    dead_end,    ///< nothing near satisfies them; bodies are where the misfit is least
    unresolved,  ///< it has become less
    failed,      ///< no active set was found; nothing has moved
  };
  /// Moves the bodies from where RowSystem::begin_adding_up() has found them. `system` has been
  /// linearised where they are then.
  Outcome find(Substep& substep, Features features, RowSystem& system);

 private:
  /// How far a descent has come.
  struct Place {
    double misfit = 0.0;
    double violation = 0.0;
    double way_out = 0.0;
    bool failed = false;  ///< no active set was found in the first round
    bool met = false;
  };
  /// Rounds from where the bodies are until the misfit is least.
  Place descend(Substep& substep, Features features, RowSystem& system);
  /// The same with what the features decide. Returns between how many sets of rows that goes on to
  /// change in a circle, the last of which `place` is of: 1 if it has settled, 0 if it does neither.
  int descend_and_revise(Substep& substep, Features features, RowSystem& system, Place& place);
  static bool revise(Substep& substep, Features features);
  /// Whether rows are violated there that no way of the scene's size mends at the rates there.
  [[nodiscard]] static bool is_stationary(const Substep& substep, const Place& place);
  /// Whether no place near satisfies the rows, whatever forces it takes. Nothing has moved then.
  bool nothing_is_near(Substep& substep, Features features, RowSystem& system);
  /// Whether a descent from other places leads to where rows are met, or to no end.
  bool escapes(Substep& substep, Features features, RowSystem& system);

  KeptPlace round_;
  KeptPlace result_;
  KeptPlace least_;
};

}  // namespace sheave
