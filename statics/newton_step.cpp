#include "statics/newton_step.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "engine/index.h"
#include "statics/decompositions.h"
#include "statics/islands.h"

namespace sheave {
namespace {

/// Number of tries in which all wrong rows change sides at once; later tries change one row.
constexpr int tries_at_once = 8;
constexpr int most_tries = 200;

/// Which of the wrong rows change sides.
enum class Change : char { all, worst, first };

/// State of a row in the linear problem.
enum class Side : char { off, free, lower, upper };

class StepProblem {
 public:
  StepProblem(const ConfigurationRows& rows, MatrixX stiffness, const VectorX& before, double size)
      : rows_(rows), before_(before), size_(size), stiffness_(std::move(stiffness)) {
    gradients_ = rows.gradients;
    actions_ = rows.actions;
    values_.resize(static_cast<Eigen::Index>(rows.unknowns.size()));
    for (Eigen::Index g = 0; g < values_.size(); ++g) {
      values_[g] = rows.unknowns[static_cast<std::size_t>(g)].value;
    }
    sides_.assign(rows.unknowns.size(), Side::off);
    for (std::size_t g = 0; g < sides_.size(); ++g) sides_[g] = first_side(g);
    bounds_.resize(sides_.size());
    unknowns_ = before;
    motion_ = VectorX::Zero(rows.loads.size());
    give_ = VectorX::Zero(values_.size());
    gave_.assign(sides_.size(), 0);
    turn_friction();
  }

  NewtonStep solve() {
    find_sides();
    // Features do not accept forces that exceed a bound by rounding.
    for (std::size_t g = 0; finite_ && g < sides_.size(); ++g) {
      double& force = unknowns_[static_cast<Eigen::Index>(g)];
      if (sides_[g] != Side::off) force = std::clamp(force, bounds_[g][0], bounds_[g][1]);
    }
    turn_back();
    NewtonStep step{motion_, unknowns_, std::vector<char>(sides_.size(), 0),
                    false,   finite_,   solutions_};
    for (std::size_t g = 0; g < sides_.size(); ++g) {
      const bool bound = sides_[g] == Side::lower || sides_[g] == Side::upper;
      step.acts[g] = sides_[g] == Side::free ? 1 : 0;
      step.slips = step.slips || (bound && rows_.unknowns[g].dry_friction());
    }
    return step;
  }

 private:
  /// Looks for sides of all rows that agree with forces and motions. If sides return, the order of the
  /// changes may be the reason: changes by the least index have no cycles with constant bounds (Murty
  /// 1974). If sides return again, bounds of friction follow a pressure that follows the friction, and
  /// may grow without limit. The bounds are then those of the pressure before the step, and the next
  /// Newton step corrects them.
  void find_sides() {
    std::set<std::vector<Side>> seen;
    Change change = Change::all;
    bool follows = true;
    constexpr int free_rounds = 4;
    constexpr int most_given = 20;
    int exceeded = 0;
    int given = 0;
    double last_excess = 0.0;
    for (int i = 0; i < most_tries; ++i) {
      if (follows) follow_pressure();
      solve_linear();
      if (i == 0) {
        turn_friction();
        follow_pressure();
      }
      if (i == tries_at_once) change = Change::worst;
      if (!finite_) return;
      const bool gives = change_give();
      if (!change_sides(change)) {
        if (gives && ++given <= most_given) continue;
        const double excess = follows ? exceed_friction() : 0.0;
        // Friction may grow with the pressure that it gives.
        if (excess == 0.0 || (++exceeded > free_rounds && excess > 0.5 * last_excess)) return;
        last_excess = excess;
        continue;
      }
      if (change == Change::all || seen.insert(sides_).second) continue;
      if (!follows) return;
      seen.clear();
      if (change == Change::first) {
        follows = false;
        unknowns_ = before_;
        for (const Turn& turn : turns_) turn_forces(turn);
        follow_pressure();
      }
      change = Change::first;
    }
  }

  [[nodiscard]] Side first_side(std::size_t g) const {
    const ForceUnknown& unknown = rows_.unknowns[g];
    const double force = before_[static_cast<Eigen::Index>(g)];
    if (unknown.damper) return Side::off;
    if (unknown.given()) return Side::lower;
    if (unknown.lower == 0.0) {
      return force > 0.0 || unknown.value <= rounding() ? Side::free : Side::lower;
    }
    if (unknown.upper == 0.0) {
      return force < 0.0 || unknown.value >= -rounding() ? Side::free : Side::upper;
    }
    return Side::free;
  }
  [[nodiscard]] double rounding() const { return 1e-14 * size_; }

  /// Updates the bounds of friction from the pressing forces.
  void follow_pressure() {
    for (std::size_t g = 0; g < sides_.size(); ++g) {
      const ForceUnknown& unknown = rows_.unknowns[g];
      bounds_[g] = {unknown.lower, unknown.upper};
      if (!unknown.is_pressed()) continue;
      const double bound = unknown.largest_friction(unknowns_);
      bounds_[g] = {-bound, bound};
    }
    // Friction in several directions has a common bound on its vector. The first direction is along
    // the force, and has the bound that the others leave. Across it friction holds; the next step
    // turns the directions again.
    for (std::size_t g = 0; g < sides_.size(); ++g) {
      const int count = rows_.unknowns[g].shares;
      if (count < 2) continue;
      constexpr double most_across = 0.7;  // of the bound
      const double bound = bounds_[g][1];
      const VectorX across = unknowns_.segment(static_cast<Eigen::Index>(g) + 1, count - 1);
      const double taken = std::min(across.norm(), most_across * bound);
      const double along = std::sqrt(bound * bound - taken * taken);
      bounds_[g] = {-along, along};
      const double each = most_across * bound / std::sqrt(count - 1.0);
      for (int k = 1; k < count; ++k) bounds_[g + static_cast<std::size_t>(k)] = {-each, each};
    }
  }

  /// The directions of a friction in several directions, as rows of an orthogonal matrix.
  struct Turn {
    Eigen::Index first = 0;  ///< of its unknowns
    MatrixX directions;
  };

  /// Turns the rows of each such friction so that the first one is along its present force.
  void turn_friction() {
    for (std::size_t g = 0; g < rows_.unknowns.size(); ++g) {
      if (rows_.unknowns[g].shares > 1) turn_friction(g);
    }
  }
  void turn_friction(std::size_t g) {
    const int count = rows_.unknowns[g].shares;
    const auto first = static_cast<Eigen::Index>(g);
    const VectorX force = unknowns_.segment(first, count);
    const double size = force.norm();
    if (!(size > 0.0) || !std::isfinite(size)) return;
    // The reflection that turns the force to the first direction.
    VectorX mirror = force / size;
    mirror[0] -= 1.0;
    const double square = mirror.squaredNorm();
    if (!(square > 0.0)) return;
    Turn turn{first, MatrixX::Identity(count, count) - 2.0 / square * mirror * mirror.transpose()};
    apply(turn);
    turns_.push_back(std::move(turn));
  }
  /// The largest friction beyond its bound by the present pressure. Friction in several directions
  /// whose force is far from its first direction is turned along the force, and is at its bound.
  double exceed_friction() {
    constexpr double rounding = 1e-12;
    constexpr double turned_share = 0.9;
    double most = 0.0;
    int count = 1;
    for (std::size_t g = 0; g < rows_.unknowns.size(); g += static_cast<std::size_t>(count)) {
      const ForceUnknown& unknown = rows_.unknowns[g];
      count = std::max(unknown.shares, 1);
      if (sides_[g] == Side::off || !unknown.dry_friction()) continue;
      const double force = unknowns_.segment(static_cast<Eigen::Index>(g), count).norm();
      const double bound = unknown.largest_friction(unknowns_);
      if (!(force > (1.0 + rounding) * bound)) continue;
      most = std::max(most, force - bound);
      // Little force across the direction only lowers the bound along it.
      const double along = std::abs(unknowns_[static_cast<Eigen::Index>(g)]);
      if (count == 1 || along > turned_share * force) continue;
      turn_friction(g);
      sides_[g] = Side::upper;
      for (int k = 1; k < count; ++k) sides_[g + static_cast<std::size_t>(k)] = Side::free;
    }
    return most;
  }
  /// Friction at its bound b is opposite to the slip: l = -b s / |s|. Across the direction of the slip
  /// the force is b / |s| times the slip there, so the row gives by |s| / b (engine/friction_rows.h). A
  /// row that has come to its bound begins with the slip of a long step. Returns whether the slip of
  /// any friction has changed much.
  bool change_give() {
    constexpr double settled = 0.1;
    constexpr double first_slip = 0.01;  // of the scene's size
    bool changed = false;
    for (std::size_t g = 0; g < rows_.unknowns.size(); ++g) {
      const int count = rows_.unknowns[g].shares;
      if (count < 2) continue;
      const auto first = static_cast<Eigen::Index>(g);
      const bool slides = sides_[g] == Side::lower || sides_[g] == Side::upper;
      const double bound = rows_.unknowns[g].largest_friction(unknowns_);
      const double before = give_[first + 1];
      double give = 0.0;
      if (slides && bound > 0.0 && motion_.size() > 0) {
        const double slip =
            gave_[g] == 0 ? first_slip * size_ : std::abs(gradients_.row(first).dot(motion_));
        give = slip > rounding() ? slip / bound : 0.0;
        gave_[g] = 1;
      }
      if (std::abs(give - before) <= settled * std::max(give, before)) continue;
      changed = true;
      give_.segment(first + 1, count - 1).setConstant(give);
    }
    return changed;
  }
  void apply(const Turn& turn) {
    const Eigen::Index count = turn.directions.rows();
    if (motion_.size() > 0) {
      gradients_.middleRows(turn.first, count) =
          (turn.directions * gradients_.middleRows(turn.first, count)).eval();
      actions_.middleRows(turn.first, count) =
          (turn.directions * actions_.middleRows(turn.first, count)).eval();
    }
    values_.segment(turn.first, count) =
        (turn.directions * values_.segment(turn.first, count)).eval();
    turn_forces(turn);
  }
  void turn_forces(const Turn& turn) {
    const Eigen::Index count = turn.directions.rows();
    unknowns_.segment(turn.first, count) =
        (turn.directions * unknowns_.segment(turn.first, count)).eval();
  }
  /// Turns the forces to the rows as they were given. Reflections are their own inverses.
  void turn_back() {
    for (auto turn = turns_.rbegin(); turn != turns_.rend(); ++turn) turn_forces(*turn);
  }

  void solve_linear() {
    ++solutions_;
    const Eigen::Index n = stiffness_.rows();
    std::vector<Eigen::Index> free;
    VectorX loads = rows_.loads;
    for (std::size_t g = 0; g < sides_.size(); ++g) {
      const auto i = static_cast<Eigen::Index>(g);
      if (sides_[g] == Side::free) {
        free.push_back(i);
        continue;
      }
      unknowns_[i] = sides_[g] == Side::off     ? 0.0
                     : sides_[g] == Side::lower ? bounds_[g][0]
                                                : bounds_[g][1];
      if (n > 0) loads += unknowns_[i] * actions_.row(i).transpose();
    }
    const auto m = static_cast<Eigen::Index>(free.size());
    MatrixX matrix = MatrixX::Zero(n + m, n + m);
    VectorX right = VectorX::Zero(n + m);
    matrix.topLeftCorner(n, n) = stiffness_;
    right.head(n) = loads;
    for (Eigen::Index r = 0; r < m; ++r) {
      const Eigen::Index g = free[static_cast<std::size_t>(r)];
      const ForceUnknown& unknown = rows_.unknowns[static_cast<std::size_t>(g)];
      if (n > 0) {
        matrix.block(0, n + r, n, 1) = -actions_.row(g).transpose();
        matrix.block(n + r, 0, 1, n) = gradients_.row(g);
      }
      matrix(n + r, n + r) = unknown.compliance + give_[g];
      right[n + r] = -values_[g];
    }
    const VectorX solution = solve_scaled(matrix, right);
    finite_ = solution.allFinite();
    motion_ = solution.head(n);
    for (Eigen::Index r = 0; r < m; ++r) {
      unknowns_[free[static_cast<std::size_t>(r)]] = solution[n + r];
    }
  }

  /// Solves with rows and columns scaled to a largest entry of 1, so that units have no influence.
  static VectorX solve_scaled(MatrixX& matrix, VectorX& right) {
    const Eigen::Index n = matrix.rows();
    if (n == 0) return right;
    VectorX rows = VectorX::Ones(n);
    VectorX columns = VectorX::Ones(n);
    constexpr int rounds = 12;
    for (int i = 0; i < rounds; ++i) {
      for (Eigen::Index k = 0; k < n; ++k) {
        const double largest =
            std::max(matrix.row(k).cwiseAbs().maxCoeff(), matrix.col(k).cwiseAbs().maxCoeff());
        if (!(largest > 0.0)) continue;
        const double factor = 1.0 / std::sqrt(largest);
        matrix.row(k) *= factor;
        matrix.col(k) *= factor;
        rows[k] *= factor;
        columns[k] *= factor;
      }
    }
    return columns.cwiseProduct(refined_solution(matrix, rows.cwiseProduct(right)));
  }

  /// Changes the sides of rows. Returns whether any has changed.
  bool change_sides(Change which) {
    double worst = 0.0;
    std::size_t found = sides_.size();
    Side wanted = Side::free;
    bool changed = false;
    double largest_force = unknowns_.size() > 0 ? unknowns_.cwiseAbs().maxCoeff() : 0.0;
    largest_force =
        std::max(largest_force, rows_.loads.size() > 0 ? rows_.loads.cwiseAbs().maxCoeff() : 0.0);
    for (std::size_t g = 0; g < sides_.size(); ++g) {
      if (sides_[g] == Side::off || rows_.unknowns[g].given()) continue;
      const auto [side, excess] = wrong_side(g, largest_force);
      if (side == sides_[g]) continue;
      if (which != Change::worst) sides_[g] = side;
      if (which == Change::first) return true;
      changed = true;
      if (excess < worst) continue;
      worst = excess;
      found = g;
      wanted = side;
    }
    if (changed && which == Change::worst) sides_[found] = wanted;
    return changed;
  }

  /// The side that the row should have, and the relative error of its present side.
  [[nodiscard]] std::pair<Side, double> wrong_side(std::size_t g, double largest_force) const {
    const auto i = static_cast<Eigen::Index>(g);
    const double force = unknowns_[i];
    const auto [lower, upper] = bounds_[g];
    constexpr double force_rounding = 1e-12;
    if (sides_[g] == Side::free) {
      const double slop = force_rounding * largest_force;
      if (force < lower - slop) return {Side::lower, (lower - force) / largest_force};
      if (force > upper + slop) return {Side::upper, (force - upper) / largest_force};
      return {Side::free, 0.0};
    }
    const ForceUnknown& unknown = rows_.unknowns[g];
    const double moved = motion_.size() > 0 ? gradients_.row(i).dot(motion_) : 0.0;
    const double value = values_[i] + moved + unknown.compliance * force;
    const bool violated = sides_[g] == Side::lower ? value < -rounding() : value > rounding();
    if (violated) return {Side::free, std::abs(value) / size_};
    return {sides_[g], 0.0};
  }

  const ConfigurationRows& rows_;
  const VectorX& before_;
  double size_;
  MatrixX stiffness_;
  // The rows, with the directions of friction turned.
  MatrixX gradients_;
  MatrixX actions_;
  VectorX values_;
  VectorX give_;            ///< of rows across friction at its bound [m/N]
  std::vector<char> gave_;  ///< per unknown: friction has been at its bound
  std::vector<Turn> turns_;
  std::vector<Side> sides_;
  std::vector<std::array<double, 2>> bounds_;
  VectorX unknowns_;
  VectorX motion_;
  bool finite_ = false;
  int solutions_ = 0;
};

}  // namespace

NewtonStep solve_step(const ConfigurationRows& rows, const ForceTurn& turn, const MatrixX& mass,
                      const VectorX& before, double shift, double size) {
  const MatrixX stiffness = shift * mass - turn.forces;
  NewtonStep step{VectorX::Zero(rows.loads.size()),
                  before,
                  std::vector<char>(rows.unknowns.size(), 0),
                  false,
                  true,
                  0};
  for (const Island& island : islands_of(rows, stiffness)) {
    const ConfigurationRows part = rows_of(island, rows);
    const VectorX start = before(island.unknowns);
    const NewtonStep own =
        StepProblem(part, stiffness(island.freedoms, island.freedoms), start, size).solve();
    step.motion(island.freedoms) = own.motion;
    step.unknowns(island.unknowns) = own.unknowns;
    for (std::size_t g = 0; g < island.unknowns.size(); ++g) {
      step.acts[at(island.unknowns[g])] = own.acts[g];
    }
    step.slips = step.slips || own.slips;
    step.finite = step.finite && own.finite;
    step.solutions = std::max(step.solutions, own.solutions);
  }
  return step;
}

}  // namespace sheave
