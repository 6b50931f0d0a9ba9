// Starting points of Newton's rounds, and the rows at the start of a substep:
// engine/solvers/row_system.h.

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/dynamics/motion_guess.h"
#include "engine/index.h"
#include "engine/solvers/direct.h"
#include "engine/solvers/row_system.h"

namespace sheave {
namespace {

void clear_multipliers(Features features) {
  for (const auto& feature : features) {
    std::fill(feature->multipliers().begin(), feature->multipliers().end(), 0.0);
  }
}

}  // namespace

void RowSystem::move_on(Substep& substep) {
  begin_rounds();
  remember_origin(substep);
  double fastest = 0.0;
  for (std::size_t i = 0; i + 1 < substep.moving.size(); ++i) {
    if (!substep.moving[i].translates || !substep.moving[i].rotates) continue;
    const Vector3& velocity = substep.start.bodies[i].angular_velocity;
    fastest = std::max(fastest, dot(velocity, velocity));
  }
  swing_ = substep.h * std::sqrt(fastest);
  if (guess_motion(substep)) return;
  for (std::size_t i = 0; i + 1 < substep.moving.size(); ++i) {
    const BodyState& start = substep.start.bodies[i];
    MovingBody& body = substep.moving[i];
    if (body.translates) body.position = sum(body.start_position, substep.h, start.velocity);
    if (body.rotates) body.rotate_to(substep.h * start.angular_velocity);
  }
}

bool RowSystem::take_back_guess(Substep& substep, Features features) {
  if (!substep.guessed || suits_guess()) return false;
  start_again(substep, features);
  substep.may_guess = false;
  return true;
}

void RowSystem::start_again(Substep& substep, Features features) {
  begin_rounds();
  clear_multipliers(features);
  for (std::size_t b = 0; b < origin_.size(); ++b) {
    MovingBody& body = substep.moving[b];
    if (body.translates) body.position = origin_[b].position;
    if (body.rotates) body.rotate_to(origin_[b].turn);
  }
}

double RowSystem::begin_at_start(Substep& substep, Features features, Rule rule) {
  begin_rounds();
  clear_multipliers(features);
  for (MovingBody& body : substep.moving) {
    if (body.translates) body.position = body.start_position;
    if (body.rotates) body.rotate_to(Vector3::Zero());
  }
  constexpr double none = std::numeric_limits<double>::infinity();
  return linearise(substep, features, rule, false) ? violation() : none;
}

void RowSystem::remember_start(Substep& substep, Features features) {
  begin_rounds();
  collect_rows(substep, features);
  open_ = DirectSolver::closed * substep.bodies.scale();
  std::swap(start_rows_, rows_);  // each round collects rows_ again
  const Coordinates& coordinates = substep.bodies.coordinates();
  start_slots_.fill(coordinates, start_rows_, substep.moving);
  start_places_.resize(features.size());
  for (std::size_t f = 0; f < features.size(); ++f) {
    start_places_[f].assign(features[f]->multipliers().size(), -1);
    for (int i = feature_rows_[f]; i < feature_rows_[f + 1]; ++i) {
      start_places_[f][at(start_rows_[at(i)].index)] = i;
    }
  }
}

bool RowSystem::match_values() {
  starts_.resize(rows_.size());
  for (std::size_t f = 0; f + 1 < feature_rows_.size(); ++f) {
    for (int i = feature_rows_[f]; i < feature_rows_[f + 1]; ++i) {
      Row& row = rows_[at(i)];
      const int place = start_places_[f][at(row.index)];
      if (place < 0) return false;
      const Row& start = start_rows_[at(place)];
      starts_[at(i)] = {start.value, start.compliance};
      std::swap(row.weight, row.start_weight);
    }
  }
  return true;
}

RowSystem::StartOfContact RowSystem::contact_at_start(int row, int place) const {
  const int normal = rows_[at(row)].pressed_by;
  const Row& start = start_rows_[at(place - normal)];
  if (!start.contact) return StartOfContact::none;
  if (start.value > open_) return StartOfContact::open;
  const auto relieved = [&](const RowTerm& term) { return pressed_anew_[at(term.body)] != 0; };
  const auto terms = rows_[at(row - normal)].active_terms();
  const bool any = presses_anew_ && std::any_of(terms.begin(), terms.end(), relieved);
  return any ? StartOfContact::relieved : StartOfContact::none;
}

bool RowSystem::match_gradients() {
  closing_.clear();
  for (std::size_t f = 0; f + 1 < feature_rows_.size(); ++f) {
    for (int i = feature_rows_[f]; i < feature_rows_[f + 1]; ++i) {
      const int place = start_places_[f][at(rows_[at(i)].index)];
      const StartOfContact contact = contact_at_start(i, place);
      if (contact == StartOfContact::open && rows_[at(i)].contact) closing_.push_back(i);
      if (contact != StartOfContact::none) continue;
      if (slots_.is_copy_as_in(i, start_slots_, place)) continue;
      if (!slots_.act_along(i, start_slots_, place)) return false;
    }
  }
  for (const SharedFriction& friction : shared_) {
    if (!friction.turned) continue;
    const int place = start_places_[friction.feature][at(friction.index)];
    // Rows that act along their own gradients have been turned with them.
    if (contact_at_start(friction.first_row, place) != StartOfContact::none) continue;
    slots_.mix(friction.first_row, friction.count, friction.frame, false);
  }
  return true;
}

void RowSystem::note_new_pressure(const Substep& substep) {
  turns_contacts_ = presses_anew_;
  presses_anew_ = false;
  if (closing_.empty()) return;
  pressed_anew_.assign(substep.moving.size(), 0);
  for (const int r : closing_) {
    const auto g = at(group_of_[at(r)]);
    if (groups_[g].multiplier + active_set_.solution()[g] == 0.0) continue;
    presses_anew_ = turns_contacts_ = true;
    for (const RowTerm& term : rows_[at(r)].active_terms()) {
      if (term.body == substep.bodies.count()) continue;
      const BodyProperties& body = substep.bodies[term.body];
      if (yields(body.mobility) && !body.prescribed()) pressed_anew_[at(term.body)] = 1;
    }
  }
}

}  // namespace sheave
