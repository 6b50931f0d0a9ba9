#pragma once
// All rows of a substep as equations of the positions, the problem of a round of Newton's method.
//
// The rows are linearised at the current positions, C(x + dx) = C + J dx with dx = W K^T dl. The
// constants of the problem (engine/solvers/row_problem.h) are
//
//   c = S value + a' l,   D = a' = S sum of k a~
//
// for rows of weight k. Compliance and damping follow one of two rules. For a row with compliance a
// and damping b, the rules are
//
//   backward (XPBD, engine/row.h):  value = C + g C',              a~ = a / h^2,    g = a b / h,    S = 1 / (1 + g)
//   midpoint:                       value = (1 + g) C + (1 - g) C0, a~ = 4 a / h^2,  g = 2 a b / h,  S = 1 / (1 + g)
//
// The midpoint rule is a F + C = 0 with force and value at the middle of the substep, F = 2 l / h^2
// and C0 the value at its start. The rule conserves the energy of a linear spring for any step. A
// unilateral spring has the energy U = min(C, 0)^2 / 2a (pressing below 0). In a substep in which the
// spring begins or ceases to press, its force is the discrete gradient
//
//   F = (U0 - U) / (C - C0),
//
// which is the midpoint rule if both values are below 0. So no transition makes or takes energy,
// whatever the step. F is convex in C, and Newton's method, with -F' = 1 / (2 s a), value = -2 s a F
// and a~ = 4 s a / h^2, approaches the solution from one side. A damper acts on the part of the way on
// which the spring presses. The compliance of U0 is that of the start. Rows that share an unknown are one
// spring, with the sums of their values and of k a. With dampers they keep the midpoint rule, and so
// does a single spring that decides on the friction of a link or a contact: C0 of a slack start is 0,
// and a force that would pull is 0, so the force does less work than the spring stores.
// Rigid rows have value = C.
//
// Rows that share an unknown l have one damper each. Cable that moves between the rows (over a link
// by sliding, or with a wheel) moves the dampers, too. Each row has its force k l by the rule
// above, and this force determines its value, but only the sum of the values is known. With C0, the
// value at the start (Row::past), the backward rule is (1 + g) C - g C0 + a~ k l = 0. The sums over
// the rows, with g of each row, are
//
//   backward:  sum of C - C0 g / (1 + g)            +  l sum of k a~ / (1 + g)  =  0
//   midpoint:  sum of C + C0 (1 - g) / (1 + g)      +  l sum of k a~ / (1 + g)  =  0,    S = 1
//
// Bounds of a row are those of force x h^2. The force F = 2 l / h^2 of the midpoint rule acts for
// half a substep, so l has half of the bounds.
//
// J are the gradients of the rows now, K the gradients along which multipliers act. In XPBD the two
// are the same; in `rattle` K is that of the start of the substep. A contact that was open at the
// start has not acted there, so its K is J. If it presses at the end, K is J for all contacts of its
// bodies, because its pressure relieves them. (With K of the start, a corner that comes to bear would
// push a rolling prism back from ahead of the axle, in each substep.) Rows that share an unknown are
// added in J and weighted in K, both with weights of the same time. A friction ratio of the end in K
// would make `rattle` a scheme of first order.
//
// Every round puts the bodies at x* + W K^T l, starting again from the predicted x*. K is thus the
// gradient of the last round for the whole correction, and c contains J (x* + W K^T l - x). XPBD
// then ends at the solution of implicit Euler, with the gradients of the end, and bodies at rest
// have exactly their static forces. (Corrections added up along the gradients of each round would
// keep the gradients of x*. Their error is g h^2, and that of tensions 1e-4 in a crane of 8 m at
// 1/120 s.) The rounds are a fixed-point iteration in K: its error shrinks by h^2 F / (m L) per
// round, for the force F of a row that turns a body m over the length L. This factor is the square
// of the body's swing at F in a substep.
//
// Newton's method on all equations also contains the turning of K, the geometric stiffness. With
// the derivative H of K^T l along a motion (engine/solvers/curvature.h), the motion of a round is
// dx = r + W K^T dl + W H dx, where r leads from x to x* + W K^T l. bend() solves this equation
// within the round, as a fixed-point iteration in H dx. Each of its steps takes one forward and
// backward substitution with the factors, and evaluates no row. The bounds of friction, which
// follow pressures that depend on them, are found in the same iteration. The residual is of second
// order. If bodies swing too far for this method, corrections can be added up instead
// (`from_here`): Newton's method on C alone. Added-up corrections converge for any speed of swing,
// but their gradients are between those of x* and of the end. From their result, rounds with the
// gradients of the end alone usually converge, too (DirectSolver::confirm()).

#include <optional>
#include <utility>
#include <vector>

#include "engine/index.h"
#include "engine/solvers/curvature.h"
#include "engine/solvers/row_problem.h"

namespace sheave {

class RowSystem : public RowProblem {
 public:
  RowSystem() : RowProblem(Of::positions) {}

  /// Rounding error of a row's value, relative to the scene's size or to the longest span if that
  /// is longer (slack spans included), because lengths are sums of some ten numbers of that size.
  /// Without this allowance, rows that only a wheel between walls can move would have no solution
  /// if rounding makes the rows on both of its sides taut: no angle of the wheel satisfies both.
  static constexpr double value_rounding = 1e-14;

  enum class Rule { backward, midpoint };

  /// Keeps the rows at the start of the substep, along whose gradients the multipliers of the
  /// midpoint rule act.
  void remember_start(Substep& substep, Features features);
  /// The row at the start of the multiplier `index` of a feature, which must have had one.
  [[nodiscard]] const Row& start_row(std::size_t feature, int index) const {
    return start_rows_[at(start_places_[feature][at(index)])];
  }
  /// Sets up the problem at the current positions. `from_here`: bodies move from the current
  /// positions by the changes of the unknowns. Otherwise bodies move from the positions of the last
  /// call with `from_here`, or of move_on(). In the first round one of these two must hold
  /// multipliers of 0 and the predicted positions. False if a row touches other bodies than at the
  /// remembered start.
  bool linearise(Substep& substep, Features features, Rule rule, bool from_here);
  /// The part of linearise() by the midpoint rule that violation() needs, for bodies that apply()
  /// has put along the gradients of the start: no gradients. False if linearise() has to be called
  /// instead.
  [[nodiscard]] bool look(Substep& substep, Features features);
  /// The other part, after look(). False as for linearise().
  [[nodiscard]] bool look_closer(const Substep& substep);
  /// Keeps the predicted positions, from which bodies will move. Then moves the bodies to the guess
  /// of engine/motion_history.h, or as far as their velocities at the start of the substep would.
  /// These places are much nearer to the solution than the predicted ones, and the first round has
  /// better gradients (warm start).
  void move_on(Substep& substep);
  /// Largest turn by move_on() of a body that is not on an axle [rad].
  [[nodiscard]] double swing() const { return swing_; }
  /// Energy made by the rows in the substep, with the multipliers and positions of the last
  /// linearise(), as a share of the kinetic energy; 0 if rounding hides it. Energy from springs,
  /// drives and prescribed motion is left out. Implicit Euler makes no energy. To be called after
  /// begin_adding_up().
  [[nodiscard]] double energy_gain(const Substep& substep) const;
  /// Unbalanced part of the multipliers' effect on a body at its place, as a share of their whole
  /// effect: the largest of all bodies. To be called after linearise() without `from_here`, before
  /// solve().
  [[nodiscard]] double imbalance(const Substep& substep) const;
  /// Keeps the predicted positions, before the first round with `from_here`.
  void begin_adding_up() { prediction_ = origin_; }
  /// Makes rounds start again from the positions of begin_adding_up().
  void end_adding_up() { origin_ = prediction_; }
  /// For rounds that have diverged: puts bodies back to their places at the start of the substep,
  /// with multipliers of 0, and returns the violation there. At the start all rows are satisfied,
  /// so redundant rows depend on each other exactly. At the places of move_on() redundant rows
  /// differ by the square of the motion, and bodies that no row lets move would get forces without
  /// bound.
  double begin_at_start(Substep& substep, Features features, Rule rule);
  // Parts of the descent to the least violation: engine/solvers/least_violation.h.

  /// Puts bodies to their places at begin_adding_up(), with multipliers of 0, and clears the
  /// weights of rows. `geometry_alone`: until end_lessening() friction and all other rows that
  /// yield to enough force are left out, so that forces act along the gradients.
  void begin_lessening(Substep& substep, Features features, bool geometry_alone = false);
  void end_lessening() { geometry_alone_ = false; }
  /// The sum of r^2 / w over the violated rows. w is the largest value since begin_lessening() of
  /// the effective inverse mass that an unknown would have if all motion were along its gradients.
  /// To be called after linearise() with `from_here`.
  double misfit(const Substep& substep);
  /// Solves the problem with a regularisation of `damping` x w per row. False if no active set was
  /// found; a second call with more damping is allowed.
  bool solve_damped(Substep& substep, double damping);
  /// Lower bound of the distance [m] that the machine would have to move for all rows to be
  /// satisfied, if the rows kept their present rates. 0 if no violated row is rigid and without a
  /// finite bound on the side that it needs.
  [[nodiscard]] double way_out(const Substep& substep);
  /// Puts bodies back to their places at move_on(), with multipliers of 0.
  void start_again(Substep& substep, Features features);
  /// Sets up the problem at the current positions for some of the features. The motion by other
  /// features since the last round counts as part of the starting places of the bodies.
  void linearise_among_others(Substep& substep, Features features, bool first_round);
  /// To be called after apply(), if linearise_among_others() follows.
  void remember_places(const Substep& substep);

  /// The largest violation [m or rad] before the problem is solved, as far as bounds let the
  /// unknowns correct it; infinite if a row's value is not finite.
  [[nodiscard]] double violation() const;
  /// Largest displacement [m or rad] that a correction of the violations would cause. `violation`:
  /// the result of violation(), which is returned unless some rows have a compliance. Springs and
  /// dampers take part of a correction, and only the rest moves bodies.
  [[nodiscard]] double displacement(double violation) const;
  /// The largest violation [m or rad], above `least`, of rows to which no body yields, so that only
  /// prescribed motion could satisfy them. violation() leaves these rows out.
  [[nodiscard]] double unyielding(double least) const;
  /// Counts such rows in the statistics, for the state at the end of the substep.
  void count_impossible(Substep& substep) const;
  /// Moves the bodies to the place that the multipliers give along the gradients of the last
  /// linearise(), which must have been without `from_here`. The next round would do the same if its
  /// multipliers did not change. violation() refers to this place, but does not contain the
  /// distance of the bodies from it across the rows.
  void follow_gradients(Substep& substep) const;
  /// To be called after solve(): adds the geometric stiffness, which is the turning of the forces
  /// with the motion just found (engine/solvers/curvature.h), and the dependence of friction on
  /// pressure. With bend(), a round is one of Newton's method on all equations. The call takes a
  /// few more solutions with the same factors, each a fraction of the work of a round. By the
  /// midpoint rule forces do not turn, but values do. Turns that move no body by more than
  /// `negligible` [m or rad] are left out. Returns whether a further round would find a residual
  /// below `negligible`, so that no other look at the rows is needed; only after a guess.
  bool bend(const Substep& substep, double negligible);
  /// Whether a guess of the motion is of use. The guess saves the second look at rows that are told.
  /// Other rows, among them those with friction, need this look; by the backward rule the guess
  /// saves them rounds. With redundant rows that share a load the motion found by solve() depends
  /// on the place where the rounds begin by more than their residual.
  [[nodiscard]] bool suits_guess() const { return (told_ || forces_turn_) && !shares_load_; }
  /// Whether the first round may be the last one, without another look at the rows.
  [[nodiscard]] bool may_end_first(const Substep& substep) const {
    return substep.guessed && told_;
  }
  /// To be called after bend() in round number `round`, counted from 0: tells whether a guess of the
  /// next motion would save work (Substep::asks_for_guess).
  void ask_for_guess(Substep& substep, int round) const {
    const bool useful = substep.guessed || substep.asks_for_guess || round > 0 || bent_;
    substep.asks_for_guess = useful && suits_guess();
  }
  /// Undoes the rounds of a substep whose rows no longer suit a guess: bodies return to the
  /// prediction, and the rounds have to begin again. False: there is nothing to undo.
  bool take_back_guess(Substep& substep, Features features);
  /// Residual of a further round after the motion found by solve() [m or rad]: the effect of the
  /// turning of rows on their values and on the motion. Infinite if rows do not supply their
  /// turning.
  [[nodiscard]] double remainder(const Substep& substep);
  /// Whether contacts act along their gradients of the end by the midpoint rule, or did in the last
  /// round. Only then can astray() differ from 0 by this rule.
  [[nodiscard]] bool turns_contacts() const { return turns_contacts_; }
  /// Distance of the bodies from the place that the multipliers before solve() give along the
  /// present gradients [m or rad].
  [[nodiscard]] double astray() const;
  /// Moves the bodies and sets the multipliers.
  void apply(Substep& substep, Features features);

  /// To be called before the first round of a substep: clears the memory of rounds.
  void begin_rounds() {
    knows_sides_ = false;
    presses_anew_ = turns_contacts_ = false;
    closing_.clear();
    finds_least_ = true;
    rounding_ = 0.0;
    shared_.clear();
  }

 private:
  /// Predicted place of a body.
  struct Pose {
    Vector3 position = Vector3::Zero();  ///< [m]
    Vector3 turn = Vector3::Zero();      ///< since the start of the substep [rad]
  };
  void collect_rows(Substep& substep, Features features);
  /// Sets rounding_ from the extent of the bodies and the longest length of any feature.
  void find_rounding(const Substep& substep, Features features);
  /// Leaves only the geometry in the rows: no friction, no weights, no bounded forces.
  void leave_geometry_alone();
  /// Finds the values of the rows at the start, and lets rows act with their weights of the start;
  /// false if there are other rows than at the start.
  bool match_values();
  /// Lets rows act along their gradients of the start, but for the contacts of which
  /// contact_at_start() tells otherwise. False if rows touch other bodies than at the start.
  bool match_gradients();
  enum class StartOfContact {
    none,     ///< the row is no contact's, or acts along its gradient of the start
    open,     ///< the contact was open
    relieved  ///< the contact was closed, and one that was open presses on the same body
  };
  /// `row`: a row of normal force or friction; `place`: of the same row at the start.
  [[nodiscard]] StartOfContact contact_at_start(int row, int place) const;
  /// Finds the bodies on which contacts press that were open at the start.
  void note_new_pressure(const Substep& substep);
  /// Sets up the unknowns, their values and bounds, without gradients.
  void pose_values(const Substep& substep, Rule rule);
  /// Whether a damper belongs to one of several rows that share the group's unknown.
  [[nodiscard]] bool damps_apart(const Group& group) const;
  /// For one row without compliance, for which both rules are the same.
  void set_rigid(std::size_t group);
  void set_backward(const Substep& substep, std::size_t group);
  void set_midpoint(const Substep& substep, std::size_t group);
  /// C0 of the midpoint rule.
  [[nodiscard]] double start_of(int index) const;
  /// A unilateral spring that begins or ceases to press in the substep; see the head.
  struct Crossing {
    double start = 0.0;  ///< sum of the values, below 0 while the spring presses
    double end = 0.0;
    double compliance = 0.0;  ///< of the unknown
    double damping = 0.0;     ///< g, 0 without a damper
    double softness = 0.0;
    bool active = false;
  };
  [[nodiscard]] std::optional<Crossing> crossing_of(const Substep& substep,
                                                    const Group& group) const;
  void set_crossing(const Substep& substep, std::size_t group, const Crossing& spring);
  /// Whether a row that was not active is likely to act. The active set corrects this guess.
  [[nodiscard]] bool is_pushed(const Row& row, double value) const;
  void set_bounds(std::size_t group, bool pushed, bool active);
  /// Keeps the sides of the unknowns in the solution, with which the next round of the substep
  /// begins.
  void remember_sides(Features features);
  void recall_sides();
  /// Whether the unknown of the group has no effect on the group's own value.
  [[nodiscard]] bool gives_nothing(std::size_t group) const;
  /// Largest displacement of a motion along the degrees of freedom [m].
  [[nodiscard]] double longest(std::span<const double> motion) const;
  void remember_origin(const Substep& substep);
  void settle(const Substep& substep);
  /// Notes the friction whose first row is `row`; `place` is its index in shared_.
  void note_shared(std::size_t feature, int row, std::size_t place);
  /// Turns friction in several directions to the slip at the present multipliers and positions.
  void follow_slip(const Substep& substep);
  /// Replaces the rows of the friction by those along its frame.
  void turn_rows(const SharedFriction& friction);
  /// Largest excess of friction over its bound, as a displacement [m or rad].
  [[nodiscard]] double excess_friction() const;
  /// A friction row whose bounds follow the pressure within a round.
  struct Rubbing {
    int row = 0;
    double bound = 0.0;
    double last_bound = 0.0;
    double off = 0.0;  ///< last difference between the bound by the pressure and the bound in force
    double wanted = 0.0;
    double last_wanted = 0.0;
  };
  /// An upper bound of the second-order terms of all rows for the motion found by solve() [m or
  /// rad].
  [[nodiscard]] double most_second_order();
  /// About the largest residual [m or rad] after the motion that bend() has found, by terms that
  /// the derivatives of rows leave out.
  [[nodiscard]] double left_out(const Substep& substep) const;
  void begin_bending();
  void find_rubbing_rows();
  /// Bounds friction by the pressures just found; returns the largest displacement that this may
  /// cause [m]. `first`: the step before is not used for a prediction.
  double follow_pressure(bool first);
  void set_friction(const Rubbing& rubbing, std::size_t group);
  /// Computes the motion by the turning of the forces into motion_; returns the change against
  /// bend_. `straight`: no force turns.
  double turn_forces(const Substep& substep, bool& straight);
  /// Solves again, with motion_ added to the constants. False if other rows would have to act, which
  /// is examined if this is the `last` time.
  bool refine(bool last);
  /// Computes the rows' multipliers, and the motion of the bodies from their present places, with
  /// the unknowns just found.
  void find_motion();

  RowList start_rows_;
  RowSlots start_slots_;
  std::vector<int> closing_;        ///< normal rows of contacts that were open at the start
  std::vector<char> pressed_anew_;  ///< per body: such a contact presses on it
  bool presses_anew_ = false;       ///< on any body
  bool turns_contacts_ = false;     ///< the same, or before the last round
  double open_ = 0.0;               ///< gap above which a contact counts as open [m]
  /// Per feature and index of multiplier: the row at the start, -1 if there was none.
  std::vector<std::vector<int>> start_places_;
  /// Per feature and index of multiplier: ComplementarityProblem::free in the last round, -1 if
  /// there was none.
  std::vector<std::vector<char>> sides_;
  bool knows_sides_ = false;
  std::vector<Pose> origin_;  ///< per body: where it moves from; in the first round, its prediction
  std::vector<Pose> prediction_;  ///< per body: origin_ at begin_adding_up()
  /// Per feature and index of multiplier: w since begin_lessening() [1/kg].
  std::vector<std::vector<double>> weights_;
  std::vector<double> weight_;  ///< per group
  double damping_ = 0.0;        ///< damping that the matrix contains
  bool geometry_alone_ = false;
  std::vector<Pose> placed_;  ///< per body: its place at the end of the last round among others
  bool from_here_ = true;
  double swing_ = 0.0;
  bool forces_turn_ = true;   ///< K belongs to the present places of the bodies
  double bound_share_ = 1.0;  ///< share of the rows' bounds in the present rule
  std::vector<Rubbing> rubbing_;
  Curvature curvature_;
  bool bent_ = false;  ///< the last round contains the turning of the forces
  /// Per degree of freedom, in a round: from the places of the bodies to those by the multipliers.
  std::vector<double> residual_;
  std::vector<double> bend_;  ///< motion by the turning of the forces
  std::vector<double> trial_;
  std::vector<double> row_multipliers_;
  std::vector<double> second_order_;
  std::vector<double> constant_;  ///< of the problem without the turning of forces
  std::vector<double> change_;
};

}  // namespace sheave
