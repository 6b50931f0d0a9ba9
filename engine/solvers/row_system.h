#pragma once
// All rows of a substep as one linear problem: what one round of Newton's method solves.
//
// With the rows linearised at the current positions, C(x + dx) = C + J dx, motion dx = W K^T dl for
// a change dl of the unknowns l, and compliance and damping by one of two rules, the unknowns l +
// dl satisfy
//
//   r = c + A dl = 0,   A = J W K^T + a',   c = S value + a' l,   a' = S sum of k a~
//
// where a row is free, and l + dl at its bound with r >= 0 (lower bound) or r <= 0 (upper) where it
// is not: a linear complementarity problem (engine/solvers/active_set.h). Per row, with compliance
// a and damping b:
//
//   backward (XPBD, engine/row.h):  value = C + g C',              a~ = a / h^2,    g = a b / h,    S = 1 / (1 + g)
//   midpoint:                       value = (1 + g) C + (1 - g) C0, a~ = 4 a / h^2,  g = 2 a b / h,  S = 1 / (1 + g)
//
// The second is a F + C = 0 with force and value at the middle of the substep, F = 2 l / h^2 and C0
// the value at its start: it conserves the energy of a linear spring for any step. A unilateral
// spring that was slack counts with C0 = 0: the force then does less work than it stores, so no
// transition makes energy. Rigid rows have value = C.
//
// Rows that share an unknown l have a damper each, and what moves between them (cable that slides
// over a link, or runs over a wheel) moves these, too. Each has its force k l by the rule above,
// which gives its value, and only the sum of the values is known. With C0, the value at the start
// (Row::past), backward (1 + g) C - g C0 + a~ k l = 0, and so, summed over the rows with a g each,
//
//   backward:  sum of C - C0 g / (1 + g)            +  l sum of k a~ / (1 + g)  =  0
//   midpoint:  sum of C + C0 (1 - g) / (1 + g)      +  l sum of k a~ / (1 + g)  =  0,    S = 1
//
// Bounds of a row are those of force x h^2. The midpoint rule acts with F = 2 l / h^2 for half a
// substep and so has half of them, and an impulse m of the velocities, for the other half, has the
// bounds over 2 h.
//
// J and K are the gradients of the rows now and those along which multipliers act: the same for
// XPBD, those at the start of the substep for `rattle`. Rows that share an unknown are added in J
// and weighted in K, with the weights of the same time: a ratio of friction that belonged to the
// end would make `rattle` one of first order.
//
// Every round puts the bodies at x* + W K^T l from the predicted x* anew, so K is that of the last
// round throughout, and c has J (x* + W K^T l - x) besides. XPBD then ends where implicit Euler
// does, with the gradients of the end: what rests has exactly its static forces. (Corrections added
// up along the gradients of each round would keep those of x*, which is off by g h^2 and tensions
// with it, by 1e-4 in a crane of 8 m at 1/120 s.) That is a fixed point in K: its error shrinks by
// h^2 F / (m L) per round, with the force F of a row that turns a body m over the length L, the
// square of what the body's swing at F does in a substep. Newton's method on all equations has the
// turn of K besides: with the derivative H of K^T l along a motion (engine/solvers/curvature.h),
// the motion of a round is dx = r + W K^T dl + W H dx, r the way from x to x* + W K^T l. bend()
// solves that within the round, as a fixed point in H dx whose steps take a sweep to and fro over
// the factors and evaluate no row; the bounds of friction, which follow pressures that depend on
// them, are found with it. What is left is of second order. Where bodies swing too far for that,
// corrections can be added up instead (`from_here`): Newton's method on C alone, which converges
// however fast they swing, with gradients between those of x* and of the end. From there rounds
// with those of the end alone mostly converge, too (DirectSolver::confirm()).

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "engine/constraint_batch.h"
#include "engine/followed_pressure.h"
#include "engine/solvers/active_set.h"
#include "engine/solvers/curvature.h"
#include "engine/solvers/row_slots.h"
#include "engine/substep.h"

namespace sheave {

using Features = std::span<const std::unique_ptr<ConstraintBatch>>;

/// Rows, unknowns and matrix, with their scratch; what it keeps between substeps is only the
/// pattern of the matrix.
class RowSystem {
 public:
  /// What rounding leaves of a row's value, relative to the scene's size, or to the longest span,
  /// slack ones among them, if that is longer: lengths are sums of some ten numbers of that size.
  /// Without it rows that only a wheel between walls can move, taut by rounding on either side of
  /// it, would have no solution: no turn of the wheel is good for both.
  static constexpr double value_rounding = 1e-14;

  enum class Rule { backward, midpoint };

  /// Keeps the rows at the start of the substep, whose gradients the midpoint rule lets multipliers
  /// act along.
  void remember_start(Substep& substep, Features features);
  /// The problem at the current positions. `from_here`: bodies will move from these positions by
  /// what the unknowns gain; otherwise from those of the last call with it, or of move_on(). In the
  /// first round, with multipliers of 0 at the predicted positions, one of these it must be. False
  /// if a row touches other bodies than at the remembered start.
  bool linearise(Substep& substep, Features features, Rule rule, bool from_here);
  /// Keeps the predicted positions, from which bodies will move, and puts the bodies where they
  /// would be if they went on as they move at the start of the substep: constraints have the same
  /// forces from one substep to the next, more or less, and without them bodies are much farther
  /// from the solution. So the first round has better gradients.
  void move_on(Substep& substep);
  /// By how much move_on() has turned bodies that rows hold elsewhere than on an axle, at most
  /// [rad].
  [[nodiscard]] double swing() const { return swing_; }
  /// Energy that the rows have made in the substep with the multipliers and positions of the last
  /// linearise(), but for what springs, drives and prescribed motion give, as a share of the
  /// kinetic energy; 0 where rounding hides it. Implicit Euler makes none. To be called after
  /// begin_adding_up().
  [[nodiscard]] double energy_gain(const Substep& substep) const;
  /// What the multipliers would have to change by on a body, as a share of all that they do to it,
  /// for it to be where it is: the worst of all bodies. To be called after linearise() that was not
  /// from here, before solve().
  [[nodiscard]] double imbalance(const Substep& substep) const;
  /// Keeps the predicted positions, before the first round from here.
  void begin_adding_up() { prediction_ = origin_; }
  /// Rounds are again from what begin_adding_up() has kept.
  void end_adding_up() { origin_ = prediction_; }
  /// Puts bodies back to where they are at the start of the substep, with multipliers of 0, and
  /// returns the violation there: for rounds that have run away. Rows are met at the start, so that
  /// those that depend on each other do so exactly; where bodies that nothing lets move would be if
  /// they went on, that is so but for the square of the way, and forces are beyond all measure.
  double begin_at_start(Substep& substep, Features features, Rule rule);
  // Rounds that lessen what rounds do not bring to nothing: engine/solvers/least_violation.h.

  /// Puts bodies where begin_adding_up() has found them, with multipliers of 0, and forgets what
  /// rows weigh. `geometry_alone`: until end_lessening() friction, and all else that yields to
  /// enough force, counts for nothing, so that forces act along the gradients.
  void begin_lessening(Substep& substep, Features features, bool geometry_alone = false);
  void end_lessening() { geometry_alone_ = false; }
  /// The sum of r^2 / w of what is violated, with the most that each unknown would have yielded
  /// since then if all motion were along its gradients, w. To be called after linearise() from
  /// here.
  double misfit(const Substep& substep);
  /// Finds the unknowns of the problem whose rows yield by `damping` x w more. False if no active
  /// set was found; it may be called again with more damping.
  bool solve_damped(Substep& substep, double damping);
  /// How far the machine would have to move [m] for all rows to be met, if they went on to
  /// change at the rates of now: at least so far. 0 where none are violated that cannot give.
  [[nodiscard]] double way_out(const Substep& substep);
  /// Puts bodies back to what move_on() has kept, with multipliers of 0.
  void start_again(Substep& substep, Features features);
  /// The problem at the current positions, of features among others that have moved the bodies,
  /// too, since the last round: their motion counts as part of what bodies move from.
  void linearise_among_others(Substep& substep, Features features, bool first_round);
  /// To be called after apply(), if the next round is one among others.
  void remember_places(const Substep& substep);
  /// The problem of the velocities in substep.next, with K = J at the current positions: the
  /// impulses m [N s] for which dC/dt = 0 (or >= 0) on rows that have acted or are closed. Springs
  /// have acted and get none, but dampers that act at the end do (Row::settling). Rows are those of `positions`, whose last linearise() must have been
  /// at the current positions; it takes them from there.
  void linearise_velocities(Substep& substep, RowSystem& positions);

  /// Lets features choose anew between what rows do not tell, by the impulses just found. Whether
  /// that changes any row: then the problem is that of the velocities with the rows of now.
  [[nodiscard]] bool revise_impulses(Substep& substep, Features features,
                                     const RowSystem& positions);

  /// Finds the impulses, by sweeps unless `direct`. Friction is bounded by the impulses of its
  /// normals, not by their forces in the first half (an impact may be over then), so there are
  /// rounds until these agree. False if no active set was found.
  bool solve_velocities(Substep& substep, bool direct, int sweeps);

  /// The largest violation [m or rad] of what the problem asks for, before it is solved, as far as
  /// bounds let unknowns make up for it; infinite if a row's value is not finite.
  [[nodiscard]] double violation() const;
  /// How far what is violated would move anything [m or rad], where violation() has just told
  /// `violation`: springs and dampers have a part of theirs, and would move it alone by what
  /// violation() tells.
  [[nodiscard]] double displacement(double violation) const;
  /// The largest violation [m or rad], above `least`, of rows that no unknown moves: prescribed
  /// motion alone decides them. violation() leaves them out.
  [[nodiscard]] double unyielding(double least) const;
  /// Counts them, as what the substep ends with.
  void count_impossible(Substep& substep) const;
  /// Moves the bodies to where the multipliers put them along the gradients of the last
  /// linearise(), which was not from here: the next round would, if its multipliers did not change.
  /// violation() is that of this place; it does not see how far across the rows it is from where
  /// bodies are.
  void follow_gradients(Substep& substep) const;
  /// Finds the unknowns; false if no active set was found, or Substep::work allows no more. Counts
  /// into the substep's statistics.
  bool solve(Substep& substep, bool compromise = false);
  /// Counts in, after solve(), how the forces turn with the motion that it has found
  /// (engine/solvers/curvature.h), and how friction follows the pressure: one round of Newton's
  /// method on all equations, by a few more solutions with the same matrix, each a fraction of a
  /// round's work. By the midpoint rule forces do not turn, but values do. Turns that move nothing
  /// by more than `negligible` [m or rad] are left out.
  void bend(const Substep& substep, double negligible);
  /// What the motion that solve() has found would leave for another round to do [m or rad]: by how
  /// much it turns rows, in their values and in the motion. Infinite where rows do not tell.
  [[nodiscard]] double remainder(const Substep& substep);
  /// How far the bodies are from where the multipliers of before solve() put them along the
  /// gradients of now [m or rad].
  [[nodiscard]] double astray() const;
  /// What rows are left off by because they share a load [m]; another round closes it.
  [[nodiscard]] double yielded() const;
  /// Whether in the last solve() some rows contradicted each other, so that nothing satisfies them
  /// all. `compromise` makes all of them give way, where otherwise some are left out.
  [[nodiscard]] bool contradicts() const { return active_set_.contradicts(); }
  /// What rounding leaves of the rows' values [m].
  [[nodiscard]] double rounding() const { return rounding_; }
  /// Sweeps over the unknowns instead: projected Gauss-Seidel.
  void relax(Substep& substep, int sweeps);
  /// Moves the bodies and the multipliers.
  void apply(Substep& substep, Features features);
  /// Energy that the rows whose forces do no work have made in the substep, or taken, with the
  /// impulses just found and the multipliers of `positions` [J]; of rows that may take energy, only
  /// what they have made.
  [[nodiscard]] double work_error(const Substep& substep, const RowSystem& positions) const;
  /// Changes the velocities and adds h m to the multipliers, whose mean force over the substep is l
  /// / h^2 + m / h.
  void apply_impulses(Substep& substep, Features features);

  /// Forgets what rounds of this substep leave for the next one.
  void begin_rounds() {
    knows_sides_ = false;
    finds_least_ = true;
    rounding_ = 0.0;
    shared_.clear();
  }
  [[nodiscard]] int row_count() const { return static_cast<int>(rows_.size()); }

 private:
  /// Rows that share an unknown.
  struct Group {
    int first_row = 0;
    int row_count = 0;
    double multiplier = 0.0;  ///< l
    double scale = 1.0;       ///< S
    bool elastic = false;     ///< at least one of the rows has a compliance
    double lever = 1.0;       ///< Row::lever of its rows
  };
  /// Where a body is predicted to be.
  struct Pose {
    Vector3 position = Vector3::Zero();  ///< [m]
    Vector3 turn = Vector3::Zero();      ///< since the start of the substep [rad]
  };
  void collect_rows(Substep& substep, Features features);
  /// rounding_, of the bodies' extent and the longest length of any feature.
  void find_rounding(const Substep& substep, Features features);
  /// Takes from the rows what is no geometry.
  void leave_geometry_alone();
  /// Bounds what is friction by the impulses that were just found. Whether that makes a difference.
  [[nodiscard]] bool bound_friction(double h);
  /// Gives the rows the gradients and weights of the start to act along; false if they touch other
  /// bodies than there.
  bool match_start();
  /// Gradients of the rows and the bodies' responses along them.
  void fill_slots(const Substep& substep);
  void make_groups();
  /// Whether rows that share the group's unknown have dampers, of their own each.
  [[nodiscard]] bool damps_apart(const Group& group) const;
  /// Of one row without compliance: by either rule the same.
  void set_rigid(std::size_t group);
  void set_backward(const Substep& substep, std::size_t group);
  void set_midpoint(const Substep& substep, std::size_t group);
  /// Whether a row that was not active is likely to act: a first guess, which the active set
  /// corrects.
  [[nodiscard]] bool is_pushed(const Row& row, double value) const;
  void set_bounds(std::size_t group, bool pushed, bool active);
  /// Which bounds rows are at in the solution: what the next round of the substep begins with.
  void remember_sides(Features features);
  void recall_sides();
  /// What a unit of the group's unknown makes of its own value, were its rows not to move each
  /// other.
  [[nodiscard]] double yield(std::size_t group) const;
  /// Whether its unknown does nothing for what it asks for.
  [[nodiscard]] bool gives_nothing(std::size_t group) const;
  /// The largest of a motion along the degrees of freedom, by what it moves [m].
  [[nodiscard]] double longest(std::span<const double> motion) const;
  void remember_origin(const Substep& substep);
  void settle(const Substep& substep);
  void assemble();
  bool solve_assembled(Substep& substep, bool compromise);
  /// Adds what redundant rows share a load by to the matrix; false if nothing does.
  bool share_load();
  /// Adds what `motion_` changes of the groups' values to the constants of the problem.
  void count_motion();
  /// Friction in several directions (engine/friction_rows.h), and what rounds have found of it.
  struct SharedFriction {
    std::size_t feature = 0;
    int index = 0;  ///< of its first multiplier
    int first_row = 0;
    int count = 0;
    /// Directions that its rows are of now, as sums of those of the feature; the first is that of
    /// the slip.
    Matrix3 frame = Matrix3::Identity();
    bool turned = false;  ///< `frame` is no unit matrix
    bool slips = false;
    double softness = 0.0;  ///< by which the rows across the slip give
  };
  /// Of that which begins with `row`: `place` is its number among all.
  void note_shared(std::size_t feature, int row, std::size_t place);
  /// Turns the rows of friction in several directions to how it slips with the multipliers and
  /// positions of now.
  void follow_slip(const Substep& substep);
  /// Makes its rows those along its frame.
  void turn_rows(const SharedFriction& friction);
  /// The sides that slipping friction begins with.
  void set_slipping_sides();
  /// How far friction is beyond its bound, in what that moves [m or rad].
  [[nodiscard]] double excess_friction() const;
  /// Turns rows to how friction slips with the velocities just found. Whether that makes a
  /// difference.
  [[nodiscard]] bool turn_friction();
  bool turn_to_slip(double bound, SharedFriction& friction);
  /// Of the velocities: that of the positions goes on.
  void begin_shared_friction();
  /// Its rows again as the positions have left them.
  void turn_as_in(const RowSystem& positions);
  /// Makes `multipliers` of the feature what they are in its own directions.
  void turn_back(const SharedFriction& friction, std::span<double> multipliers) const;
  /// A row of friction whose bounds follow the pressure within a round.
  struct Rubbing {
    int row = 0;
    double bound = 0.0;
    double last_bound = 0.0;
    double off = 0.0;  ///< what the pressure wanted last, from what was there then
    double wanted = 0.0;
    double last_wanted = 0.0;
  };
  void begin_bending();
  void find_rubbing_rows();
  /// Bounds friction by the pressures just found; returns by how much that may move anything [m].
  /// `first`: without regard to the step before.
  double follow_pressure(bool first);
  void set_friction(const Rubbing& rubbing, std::size_t group);
  /// What the turn of the forces adds to the motion, into motion_; returns by how much it is
  /// another than in bend_. `straight`: it counts for nothing.
  double turn_forces(const Substep& substep, bool& straight);
  /// Solves with motion_ counted in. False if other rows would have to act.
  bool refine();
  /// The rows' multipliers, and the motion of the bodies from where they are, with the unknowns
  /// just found.
  void find_motion();
  void act_springs(Substep& substep);
  /// By how much a row of the velocities gives: Row::softness, and what its damper lets go on.
  [[nodiscard]] double yield_of_rate(std::size_t row) const;
  /// The problem of the velocities with the rows that there are.
  void pose_velocities(const Substep& substep, const RowSystem& positions);
  /// Multiplier of a row for the forces of both halves of the substep.
  [[nodiscard]] double whole_multiplier(double h, int row) const;
  /// Of a group, within its bounds [N s].
  [[nodiscard]] double impulse_of(std::size_t group) const;
  /// Counts the impulses in the groups' multipliers as given: the unknowns are what is added to
  /// them.
  void start_from_impulses();
  void take_redundant_parts(const RowSystem& positions);
  void move_velocities(Substep& substep);
  [[nodiscard]] double rate_of(const Substep& substep, const Row& row) const;

  RowList rows_;
  RowSlots slots_;
  std::vector<int> feature_rows_;  ///< first row of each feature, and their number
  std::vector<double> previous_;   ///< per row its multiplier
  RowList start_rows_;
  RowSlots start_slots_;
  std::span<const double> levers_;  ///< what a unit of each degree of freedom moves [m]
  /// Per feature and index of multiplier: the row at the start, -1 if there was none.
  std::vector<std::vector<int>> start_places_;
  std::vector<double> start_values_;  ///< per row
  RowList revised_rows_;              ///< of one feature
  std::vector<Group> groups_;
  std::vector<int> group_of_;
  /// Per feature and index of multiplier: ComplementarityProblem::free in the last round, -1 if
  /// there was none.
  std::vector<std::vector<char>> sides_;
  bool knows_sides_ = false;
  std::vector<Pose> origin_;  ///< per body: where it moves from, in the first round its prediction
  std::vector<Pose> prediction_;  ///< per body, where corrections are added up
  /// Per feature and index of multiplier: what it weighs since begin_lessening() [1/kg].
  std::vector<std::vector<double>> weights_;
  std::vector<double> weight_;  ///< per group
  double damping_ = 0.0;        ///< of what the matrix has
  bool geometry_alone_ = false;
  std::vector<Pose> placed_;  ///< per body: where the last round among others has left it
  bool from_here_ = true;
  std::vector<double> motion_;  ///< per degree of freedom: displacement or turn, or their rates
  double swing_ = 0.0;
  bool forces_turn_ = true;  ///< K is that of where the bodies are
  std::vector<Rubbing> rubbing_;
  std::vector<FollowedPressure> pressures_;  ///< per row, between rounds of the velocities
  std::vector<SharedFriction> shared_;
  Curvature curvature_;
  bool has_all_rows_ = false;  ///< ConstraintBatch::has_all_rows() of all features
  bool told_ = false;          ///< that, and all rows are Row::told
  bool bent_ = false;          ///< the last round has counted in how forces turn
  /// Per degree of freedom, of the round: from where bodies are to where they should be
  std::vector<double> residual_;
  std::vector<double> bend_;  ///< and what the turn of the forces adds
  std::vector<double> trial_;
  std::vector<double> row_multipliers_;
  std::vector<double> second_order_;
  std::vector<double> constant_;  ///< of the problem without the turn
  std::vector<double> change_;
  bool assembled_ = false;      ///< the matrix is that of the last linearise()
  bool symmetric_rows_ = true;  ///< K = J but for weights
  double bound_share_ = 1.0;    ///< of the rows' bounds, in the rule at work
  ComplementarityProblem problem_;
  ActiveSetSolver active_set_;
  /// An unknown that shares a load.
  struct Sharing {
    std::size_t group = 0;
    double yield = 0.0;  ///< e W [1/kg]
  };
  std::vector<Sharing> sharing_;  ///< of the last share_load()
  double rounding_ = 0.0;         ///< of the values of positions [m]; 0: not found yet
  bool shares_load_ = false;      ///< in the last solve(): rows were redundant
  bool shares_judged_ = false;    ///< among those that share are some that are Row::judged
  bool finds_least_ = true;       ///< forces, of share_load()
  bool of_velocities_ = false;    ///< since linearise_velocities()
  /// Per unknown whether it shares a load with rows that are redundant; empty: there are none.
  std::vector<char> redundant_part_;
};

}  // namespace sheave
