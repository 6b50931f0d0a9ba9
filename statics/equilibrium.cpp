#include "statics/equilibrium.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "cable/cable_system.h"
#include "engine/body_set.h"
#include "engine/field_check.h"
#include "engine/index.h"
#include "statics/decompositions.h"
#include "statics/newton_step.h"
#include "statics/refined_rows.h"
#include "statics/residual.h"
#include "statics/slipping_link.h"

namespace sheave {
namespace {

/// Largest motion in one step: translation relative to the scene's size, rotation, and spin of a
/// rotor [rad]. Beyond that the gradients are not valid.
constexpr double longest_step = 0.1;
constexpr double largest_turn = 0.2;
constexpr double largest_spin = 3.0;
/// Residual that is acceptable if rounding prevents a smaller one.
constexpr double acceptable = 1e-8;
constexpr int patience = 6;
constexpr int most_revisions = 20;
/// Number of times that cables may leave wheels at balanced forces before the search is given up.
constexpr int most_let_go = 100;

class EquilibriumSearch {
 public:
  EquilibriumSearch(Simulation& simulation, const EquilibriumSettings& settings)
      : simulation_(simulation),
        settings_(settings),
        size_(simulation.world.bodies().scale()),
        state_(simulation.world.state()) {
    for (BodyState& body : state_.bodies) {
      body.velocity.setZero();
      body.angular_velocity.setZero();
    }
  }

  Equilibrium find() {
    Equilibrium result;
    const std::size_t before = events().size();
    const auto noted = features_with<NotedFeature>(simulation_.world.features());
    for (NotedFeature* feature : noted) feature->mark_notes(NoteMark::step);
    for (int i = 1; i <= settings_.load_steps; ++i) {
      load_ = static_cast<double>(i) / settings_.load_steps;
      if (!settle(result)) break;
    }
    describe(result);
    tell_events(before, result);
    // Events during the search are not events of the machine.
    for (NotedFeature* feature : noted) feature->return_to(NoteMark::step);
    return result;
  }

 private:
  [[nodiscard]] std::vector<CableEvent> events() const {
    return simulation_.cables == nullptr ? std::vector<CableEvent>{} : simulation_.cables->events();
  }

  void tell_events(std::size_t before, Equilibrium& result) const {
    using Kind = CableEvent::Kind;
    const auto undone = [](Kind kind) {
      return kind == Kind::leave    ? Kind::touch
             : kind == Kind::touch  ? Kind::leave
             : kind == Kind::attach ? Kind::wind
             : kind == Kind::wind   ? Kind::attach
                                    : kind;
    };
    const std::vector<CableEvent> all = events();
    for (std::size_t i = before; i < all.size(); ++i) {
      const CableEvent& event = all[i];
      const bool lasts = event.kind == Kind::cut || event.kind == Kind::slip;
      if (undone(event.kind) == event.kind && !lasts) continue;
      const auto same = [&](const CableEvent& one) {
        return one.cable == event.cable && one.link == event.link && one.body == event.body &&
               one.kind == undone(event.kind) && one.kind != event.kind;
      };
      const auto found = std::find_if(result.events.begin(), result.events.end(), same);
      if (found == result.events.end()) {
        result.events.push_back(event);
      } else {
        result.events.erase(found);
      }
    }
  }

  /// Newton's method with the present loads.
  bool settle(Equilibrium& result) {
    double best = std::numeric_limits<double>::infinity();
    int since_best = 0;
    shift_ = 0.0;
    for (int i = 0; i < settings_.iterations; ++i) {
      ++result.iterations;
      const bool advanced = advance();
      result.solutions = solutions_;
      if (!advanced) {
        result.message = "no equilibrium was found: the forces are not finite";
        return false;
      }
      result.force_error = residual_.force;
      result.length_error = residual_.length;
      const double left = residual_.worst() + step_;
      ++since_best;
      if (left < 0.5 * best) {
        best = left;
        since_best = 0;
      }
      const bool rests = step_ <= settings_.tolerance && residual_.worst() <= settings_.tolerance;
      // Only rounding is left.
      const bool rounded =
          since_best >= patience && residual_.worst() <= acceptable && step_ <= acceptable;
      if (!rests && !rounded) continue;
      if (!let_go()) return result.converged = true;
      best = std::numeric_limits<double>::infinity();
      since_best = 0;
      if (++let_go_ > most_let_go) break;
    }
    result.converged = false;
    result.message = let_go_ > most_let_go
                         ? "no equilibrium was found: a cable does not settle between lying on a "
                           "wheel and leaving it"
                         : unbalanced();
    return false;
  }

  /// One step; false if it is not finite.
  bool advance() {
    Configuration configuration(simulation_, state_, load_);
    ConfigurationRows rows = configuration.rows();
    if (forces_.empty()) forces_ = configuration.no_forces();
    mass_ = configuration.mass();
    find_limits();
    NewtonStep step;
    for (int i = 0; i < most_revisions; ++i) {
      const VectorX before = Configuration::unknowns_of(rows, forces_);
      const ForceTurn turn = turn_of_forces(configuration, before, size_);
      step = limited_step(configuration, rows, turn, before);
      if (!step.finite) return false;
      line_search(configuration, rows, before, step);
      configuration.place(step.motion);
      const bool changed = configuration.revise(configuration.forces_of(rows, step.unknowns));
      if (!changed || i + 1 == most_revisions) break;
      configuration.place(VectorX::Zero(configuration.freedoms()));
      rows = configuration.rows();
    }
    const Configuration::Reach reach = configuration.reach(step.motion);
    step_ = std::max({reach.translation / size_, reach.turn, reach.spin});
    forces_ = configuration.forces_of(rows, step.unknowns);
    configuration.place(step.motion);
    const ConfigurationRows there = configuration.rows();
    residual_ = residual_of(there, step.unknowns, step.acts);
    remember_unbalanced(there, step.unknowns);
    state_ = configuration.finish(forces_);
    return true;
  }

  /// Where all forces balance, cables leave wheels that they only touch, used-up ends are attached,
  /// and overloaded cables break. Returns whether any of these happened.
  bool let_go() {
    if (simulation_.cables == nullptr) return false;
    const std::size_t before = simulation_.cables->events().size();
    Configuration configuration(simulation_, state_, load_);
    static_cast<void>(configuration.rows());
    State next = configuration.finish(forces_, true);
    if (simulation_.cables->events().size() == before) return false;
    state_ = std::move(next);
    return true;
  }

  /// A step of limited length, with the shift that this needs.
  NewtonStep limited_step(Configuration& configuration, const ConfigurationRows& rows,
                          const ForceTurn& turn, const VectorX& before) {
    double shift = std::max(wanted_shift(configuration, rows, turn, before), shift_ / 8.0);
    const double least = least_shift(rows);
    if (shift < 1e-3 * least) shift = 0.0;
    NewtonStep step;
    constexpr int tries = 40;
    for (int i = 0; i < tries; ++i) {
      step = solve_step(rows, turn, mass_, before, shift, size_);
      solutions_ += step.solutions;
      if (step.finite && excess(configuration, step.motion) <= 1.0) break;
      shift = std::max(4.0 * shift, least);
    }
    shift_ = shift;
    if (!step.finite) return step;
    // Motions that rows require are not shortened by the shift.
    const double over = excess(configuration, step.motion);
    if (over > 1.0) step.motion /= over;
    return step;
  }

  /// Largest motion of the ends of a span at a wheel in one step. A longer step could move the span
  /// to the wheel's other side, and its path would be undetermined.
  struct SpanLimit {
    std::array<int, 2> bodies{};   // at its two ends
    std::array<double, 2> arms{};  // of the ends [m]
    double most = 0.0;             // [m]
  };

  void find_limits() {
    constexpr double share = 0.5;
    limits_.clear();
    if (simulation_.cables == nullptr) return;
    const BodySet& bodies = simulation_.world.bodies();
    const auto arm = [&](const LinkReport& link) {
      if (link.body.is_world()) return 0.0;
      const int mount = bodies[link.body.index].mount;
      const int carrier = mount >= 0 ? mount : link.body.index;
      return (link.center - state_.bodies[at(carrier)].position).norm() + link.radius;
    };
    for (const CableReport& whole :
         simulation_.cables->report(bodies, state_, state_.features.back())) {
      const CableReport cable = whole.with_wraps_in_place();
      const std::size_t count = cable.links.size();
      for (std::size_t k = 0; k < cable.spans.size(); ++k) {
        if (!cable.links[k].touched) continue;
        std::size_t end = k + 1;
        while (end < k + count && !cable.links[end % count].touched) ++end;
        const LinkReport& first = cable.links[k];
        const LinkReport& second = cable.links[end % count];
        const double radius = first.radius + second.radius;
        if (!(radius > 0.0) || (end >= count && !cable.closed)) continue;
        const auto index = [&](BodyId body) {
          return body.is_world() ? bodies.count() : body.index;
        };
        limits_.push_back({{index(first.body), index(second.body)},
                           {arm(first), arm(second)},
                           share * (cable.spans[k].length + radius)});
      }
    }
  }

  [[nodiscard]] static double part(double value, double most) { return value / most; }
  [[nodiscard]] double excess(const Configuration& configuration, const VectorX& motion) const {
    const Configuration::Reach reach = configuration.reach(motion);
    double most = std::max({part(reach.translation, longest_step * size_),
                            part(reach.turn, largest_turn), part(reach.spin, largest_spin)});
    for (const SpanLimit& limit : limits_) {
      const double moved = configuration.moved(limit.bodies[0], limit.arms[0], motion) +
                           configuration.moved(limit.bodies[1], limit.arms[1], motion);
      most = std::max(most, part(moved, limit.most));
    }
    return most;
  }

  /// Shift with which free fall moves by 100 times the scene [1/s2]: the smallest that counts.
  [[nodiscard]] double least_shift(const ConfigurationRows& rows) const {
    constexpr double share = 0.01;
    double fastest = 0.0;
    for (Eigen::Index i = 0; i < rows.loads.size(); ++i) {
      fastest = std::max(fastest, std::abs(rows.loads[i]) / mass_(i, i));
    }
    return fastest > 0.0 ? share * fastest / size_ : share;
  }

  /// The shift with which no motion that rows allow diverges: motions that give energy, and motions
  /// with a force but no stiffness.
  double wanted_shift(const Configuration& configuration, const ConfigurationRows& rows,
                      const ForceTurn& turn, const VectorX& before) const {
    std::vector<char> acts(rows.unknowns.size(), 0);
    for (std::size_t g = 0; g < acts.size(); ++g) {
      const ForceUnknown& unknown = rows.unknowns[g];
      const double force = before[static_cast<Eigen::Index>(g)];
      const bool closed = (unknown.lower == 0.0 && unknown.value <= 0.0) ||
                          (unknown.upper == 0.0 && unknown.value >= 0.0);
      acts[g] = unknown.bilateral() || force != 0.0 || closed ? 1 : 0;
    }
    const Tangent tangent = make_tangent(configuration, rows, turn, acts);
    if (tangent.motions.cols() == 0) return 0.0;
    const auto [values, vectors] = symmetric_eigen(tangent.reduced_stiffness());
    const VectorX push = vectors.transpose() * (tangent.motions.transpose() * rows.loads);
    double pushed = 0.0;  // largest possible effect of the loads
    for (Eigen::Index i = 0; i < rows.loads.size(); ++i) {
      pushed = std::hypot(pushed, rows.loads[i] / std::sqrt(mass_(i, i)));
    }
    double shift = 0.0;
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      const bool stiff = values[i] > tangent.rounding;
      const bool idle =
          std::abs(values[i]) <= tangent.rounding && std::abs(push[i]) <= acceptable * pushed;
      if (stiff || idle) continue;
      shift = std::max({shift, -2.0 * values[i], least_shift(rows)});
    }
    return shift;
  }

  /// Shortens a Newton step after which the residual would be larger than before.
  void line_search(Configuration& configuration, const ConfigurationRows& rows,
                   const VectorX& before, NewtonStep& step) {
    if (shift_ > 0.0 || (before.size() > 0 && before.isZero(0.0))) return;
    const double start = residual_of(rows, before, step.acts).worst();
    constexpr int halvings = 5;
    double share = 1.0;
    for (int i = 0; i < halvings; ++i, share *= 0.5) {
      configuration.place(share * step.motion);
      const VectorX unknowns = before + share * (step.unknowns - before);
      const Residual there = residual_of(configuration.rows(), unknowns, step.acts);
      if (there.worst() <= (1.0 - 1e-4 * share) * start || there.worst() <= acceptable) {
        step.motion *= share;
        step.unknowns = unknowns;
        return;
      }
    }
    // No descent along the step: the next step is one of implicit Euler.
    step.motion *= share;
    step.unknowns = before + share * (step.unknowns - before);
    shift_ = 8.0 * least_shift(rows);
  }

  [[nodiscard]] Residual residual_of(const ConfigurationRows& rows, const VectorX& unknowns,
                                     const std::vector<char>& acts) const {
    return sheave::residual_of(rows, unknowns, acts, {mass_, size_});
  }

  void remember_unbalanced(const ConfigurationRows& rows, const VectorX& unknowns) {
    const VectorX sum = rows.loads + rows.actions.transpose() * unknowns;
    double worst = -1.0;
    for (const BodyFreedom& freedom : simulation_.world.bodies().coordinates().movable()) {
      for (int k = 0; k < size_of(freedom.kind); ++k) {
        const int i = freedom.first - 1 + k;
        const double share = std::abs(sum[i]) / std::sqrt(mass_(i, i));
        if (share <= worst) continue;
        worst = share;
        worst_body_ = freedom.body;
        worst_force_ = std::abs(sum[i]);
      }
    }
  }

  [[nodiscard]] std::string unbalanced() const {
    if (worst_body_ < 0) return "nothing was found";
    if (residual_.force <= acceptable) {
      const double off = std::max(residual_.length, step_) * size_;
      return "no equilibrium was found: the forces balance, but the search does not settle, and "
             "cables, joints or contacts are off by up to " +
             number_text(off, 3) +
             " m; it is to begin nearer to where it rests, or with more load steps";
    }
    const std::string slip = slipping_text(simulation_, state_);
    return "no equilibrium was found: on \"" + simulation_.world.bodies().name(worst_body_) +
           "\" " + number_text(worst_force_) + " N or N m are left that nothing balances" +
           (slip.empty() ? "; either nothing holds it, or it is to begin nearer to where it rests, "
                           "or with more load steps"
                         : ": " + slip);
  }

  /// Describes the pose in which the search has ended.
  void describe(Equilibrium& result) {
    load_ = 1.0;
    Configuration configuration(simulation_, state_, load_);
    if (forces_.empty()) forces_ = configuration.no_forces();
    configuration.assume(forces_);
    ConfigurationRows rows = configuration.rows();
    const VectorX unknowns = Configuration::unknowns_of(rows, forces_);
    refine_rows(configuration, unknowns, size_, rows);
    std::vector<char> acts(rows.unknowns.size(), 0);
    for (std::size_t g = 0; g < acts.size(); ++g) {
      const ForceUnknown& unknown = rows.unknowns[g];
      const double force = unknowns[static_cast<Eigen::Index>(g)];
      const bool closed = unknown.lower == 0.0 && std::abs(unknown.value) <= acceptable * size_;
      acts[g] = unknown.bilateral() || force != 0.0 || (closed && unknown.compliance == 0.0);
      if (unknown.given()) acts[g] = 0;
      if (unknown.dry_friction() && force != 0.0) {
        result.friction_holds = true;
        const double bound = unknown.largest_friction(unknowns);
        // A slipping row does not resist further motion.
        acts[g] = std::abs(force) < (1.0 - acceptable) * bound ? 1 : 0;
      }
    }
    const ForceTurn turn = turn_of_forces(configuration, unknowns, size_);
    const Tangent tangent = make_tangent(configuration, rows, turn, acts);
    result.freedoms = configuration.freedoms();
    result.constraints = static_cast<int>(tangent.constraints.rows());
    result.redundant = tangent.redundant();
    for (const double value : symmetric_eigen(tangent.reduced_stiffness()).values) {
      result.eigenvalues.push_back(value);
      if (std::abs(value) <= tangent.rounding) ++result.neutral_motions;
      if (value < -tangent.rounding) ++result.unstable_motions;
    }
    result.stability = result.unstable_motions > 0  ? Stability::unstable
                       : result.neutral_motions > 0 ? Stability::neutral
                                                    : Stability::stable;
    state_.steps = simulation_.world.state().steps;
    if (const Errors errors = simulation_.world.restore(state_); !errors.empty()) {
      result.converged = false;
      result.message = errors.front().message;
      return;
    }
    result.forces = forces_;
    find_slack(result);
  }

  void find_slack(Equilibrium& result) const {
    const std::vector<CableReport> reports = simulation_.cable_reports();
    for (std::size_t c = 0; c < reports.size(); ++c) {
      int index = 0;
      const auto look = [&](const SpanReport& span) {
        if (span.tension <= 0.0 && span.length > 0.0) {
          result.slack_spans.push_back(
              {static_cast<int>(c), index, span.rest_length - span.length});
        }
        ++index;
      };
      for (const SpanReport& span : reports[c].spans) look(span);
      for (const WrapReport& wrap : reports[c].wraps) look(wrap.span);
    }
  }

  Simulation& simulation_;
  EquilibriumSettings settings_;
  double size_;
  State state_;
  double load_ = 1.0;
  double shift_ = 0.0;
  double step_ = 0.0;
  int let_go_ = 0;
  int solutions_ = 0;
  RowForces forces_;
  Residual residual_;
  MatrixX mass_;
  int worst_body_ = -1;
  double worst_force_ = 0.0;
  std::vector<SpanLimit> limits_;
};

}  // namespace

Equilibrium find_equilibrium(Simulation& simulation, const EquilibriumSettings& settings) {
  return EquilibriumSearch(simulation, settings).find();
}

}  // namespace sheave
