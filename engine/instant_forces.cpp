// Forces of an instant by trial motions.
//
// The multipliers of a substep are mean forces. At an instant the state determines the forces of
// rigid rows: with the loads f, the inverse masses W and the rows J,
//
//   J W J^T F = -(J W f + J' v),   F >= 0 and J v' >= 0 for rows that pull one way,
//
// with friction within its bound, the least forces of redundant rows, and springs, dampers and
// drives by their laws. A short substep of `rattle` of the length e solves just these equations:
// its mean force is the force at its middle, but for terms of e^2, and all features take part in it
// with their own code. So the forces at t are the limit of mean forces of short parts that begin at
// t.
//
// Three parts follow each other. The first one begins with the velocities of the state, which need
// not satisfy the rows: its impulse makes them do so, and takes away the residuals of the state.
// Its force is no force of the instant. The other two have the forces G at t + 3/2 e and H at t +
// 5/2 e, so that
//
//   F(t) = 5/2 G - 3/2 H + 15/8 e^2 F'' + ...
//
// With e = h / 8 the error is below (h / 5)^2 F'', of the order of `rattle`.
//
// The velocities of `xpbd` are means: v1 = (x1 - x0) / p in a part of the length p, so v1 is the
// velocity of p / 2 before, to second order, and v0, at the start of the part, that of q / 2 before
// its start, q being the length of the part before. The velocity that belongs to the poses is
// v1 + p / 2 (v1 - v0) / ((p + q) / 2), to second order (World::Course::state_at_instant()). So it
// satisfies the rows to second order, whether loads or prescribed motion determine it; a rope that it
// made slack would have no tension. (A trial motion that begins with v1 does not tell the
// acceleration: a rope that a prescribed motion draws with its present velocity would be slack or
// jerked there.) In a part that is shorter than the one before, bodies of `xpbd` lag: loads change
// v1 during p only. This lag is an error of the motion.
//
// An impact within the last two parts changes v1 - v0, but not the acceleration that follows it,
// which the trial motion shows. So where that acceleration is less than half of (v1 - v0) / ((p + q)
// / 2) for some body, the mean force of the last part counts if it is the lesser one. So the change
// of velocities by an impact breaks no rope, and a rope that the motion after the impact breaks
// does so at most two parts late.
//
// An impact within the three parts gives forces that depend on e. A force that changes by more than
// a fifth between G and H would change by more than itself in a substep. Then the smaller one is
// taken: the impact belongs to the next substep.
//
// Redundant rows share a load by the least forces, or as friction lets them: then the shares of two
// parts need not be near each other, although each is one that can be. An extrapolation of such
// shares is none: a rope over lossy sheaves that stands still had 1.1 times the most that friction
// allows. So where rows are redundant, forces stay between the means: G, H and that of the last part.
//
// Rounding moves poses by r = 3e-16 of the scene's size, and forces by m r / e^2. The parts are so
// long that an acceleration has an error of at most 1e-5 m/s2 by that.

#include "engine/instant_forces.h"

#include <algorithm>
#include <cmath>

#include "engine/index.h"

namespace sheave {
namespace {

/// The model of trial motions.
Model trial_model(Model model) {
  // Rounds of Newton's method; they end where they have converged.
  constexpr int enough = 30;
  model.step.integrator = IntegratorKind::rattle;
  model.step.solver = SolverKind::direct;
  model.step.iterations = std::max(model.step.iterations, enough);
  model.step.tolerance = 0.0;
  return model;
}

constexpr double rounding_acceleration = 1e-5;  // [m/s2]

/// Where rounding hides the forces, parts are longer than a share of a substep [s].
double shortest_part(const BodySet& bodies) {
  constexpr double rounding = 3e-16;
  return std::sqrt(rounding * bodies.scale() / rounding_acceleration);
}

/// The force at the present instant, from its means over the second and third part.
double extrapolated(double second, double third) {
  constexpr double jump = 0.2;
  const double most = std::max(std::abs(second), std::abs(third));
  if (std::abs(third - second) > jump * most) return std::min(second, third);
  return 2.5 * second - 1.5 * third;
}

}  // namespace

World::InstantForces::InstantForces(const Content& own) {
  std::vector<std::unique_ptr<ConstraintBatch>> features = model_features(own.model, *own.bodies);
  for (std::size_t i = features.size(); i < own.features.size(); ++i) {
    features.push_back(own.features[i]->copy());
    if (features.back() == nullptr) return;
  }
  trial_ =
      std::make_unique<Content>(trial_model(own.model), own.bodies, std::move(features), own.state);
  trial_->substep.breakage = Breakage::never;
  for (NotedFeature* feature : trial_->noted) feature->mark_notes(NoteMark::step);
}

void World::InstantForces::begin(const State& state) {
  Content& c = *trial_;
  c.state = state;
  c.state.history = {};
  c.substep.next = c.state;
  c.driver.forget();
}

bool World::InstantForces::run(double length) {
  Content& c = *trial_;
  for (const Content::Watching& w : c.watching) w.feature->expect(nullptr);
  if (c.driver.run_to(c.state.time + length)) return false;
  const StepStatistics& did = c.substep.statistics;
  return did.unconverged + did.dead_ends + did.exhausted + did.solver_fallbacks == 0;
}

void World::InstantForces::collect(const Content& content, Forces& forces) {
  forces.resize(content.watching.size());
  for (std::size_t i = 0; i < forces.size(); ++i) {
    forces[i].clear();
    content.watching[i].feature->append_forces(forces[i]);
  }
}

void World::InstantForces::extrapolate() {
  now_ = second_;
  for (std::size_t i = 0; i < now_.size(); ++i) {
    for (std::size_t k = 0; k < now_[i].size(); ++k) {
      now_[i][k] = extrapolated(second_[i][k], third_[i][k]);
    }
  }
}

void World::InstantForces::compare(const std::vector<BodyState>& before, double length) {
  accelerations_.resize(before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    const BodyState& after = trial_->state.bodies[i];
    accelerations_[i] = {(after.velocity - before[i].velocity) / length,
                         (after.angular_velocity - before[i].angular_velocity) / length};
  }
}

bool World::InstantForces::find(const State& state, double length) {
  if (trial_ == nullptr) return false;
  const double part = std::max(share * length, shortest_part(*trial_->bodies));
  trial_->substep.work.begin_step(nullptr);
  trial_->substep.statistics = {};
  begin(state);
  bool found = run(part) && run(part);
  if (found) collect(*trial_, second_);
  const std::vector<BodyState> before = trial_->state.bodies;
  found = found && run(part);
  for (NotedFeature* feature : trial_->noted) feature->return_to(NoteMark::step);
  if (!found) return false;
  collect(*trial_, third_);
  extrapolate();
  compare(before, part);
  return true;
}

bool World::InstantForces::has_jumped(std::span<const Acceleration> means) const {
  // An acceleration that is less beside the largest one moves nothing to speak of.
  constexpr double small = 0.05;
  double linear = rounding_acceleration / small;
  double angular = linear / trial_->bodies->scale();
  for (const Acceleration& mean : means) {
    linear = std::max(linear, mean.linear.norm());
    angular = std::max(angular, mean.angular.norm());
  }
  const auto jumps = [](double now, double mean, double most) {
    return mean > small * most && now < 0.5 * mean;
  };
  for (std::size_t i = 0; i < means.size(); ++i) {
    const Acceleration& now = accelerations_[i];
    if (jumps(now.linear.norm(), means[i].linear.norm(), linear) ||
        jumps(now.angular.norm(), means[i].angular.norm(), angular)) {
      return true;
    }
  }
  return false;
}

bool World::InstantForces::shares_are_open() const {
  return trial_->substep.statistics.redundant_rows > 0;
}

void World::InstantForces::keep_within_means(const Content& own) {
  collect(own, last_);
  for (std::size_t i = 0; i < now_.size(); ++i) {
    for (std::size_t k = 0; k < now_[i].size(); ++k) {
      const auto [least, most] = std::minmax({second_[i][k], third_[i][k], last_[i][k]});
      now_[i][k] = std::clamp(now_[i][k], least, most);
    }
  }
}

void World::InstantForces::lower_to_means(const Content& own) {
  collect(own, last_);
  for (std::size_t i = 0; i < now_.size(); ++i) {
    for (std::size_t k = 0; k < now_[i].size(); ++k) {
      now_[i][k] = std::min(now_[i][k], last_[i][k]);
    }
  }
}

}  // namespace sheave
