#include "engine/contacts/crowd.h"

#include <algorithm>

#include "engine/index.h"

namespace sheave {
namespace {

bool is_moved(const Substep& substep, int body) {
  const MovingBody& moving = substep.moving[at(body)];
  return moving.translates || moving.rotates || substep.bodies[body].mount >= 0;
}

}  // namespace

void Crowd::begin(int bodies) {
  neighbours_.resize(at(bodies));
  for (std::vector<int>& others : neighbours_) others.clear();
  crowded_ = 0;
}

void Crowd::add(const Substep& substep, int body_a, int body_b) {
  if (!is_moved(substep, body_a) || !is_moved(substep, body_b)) return;
  std::vector<int>& of_a = neighbours_[at(body_a)];
  std::vector<int>& of_b = neighbours_[at(body_b)];
  const bool fewer = of_a.size() < of_b.size();
  const std::vector<int>& shorter = fewer ? of_a : of_b;
  const int other = fewer ? body_b : body_a;
  if (std::find(shorter.begin(), shorter.end(), other) != shorter.end()) return;
  of_a.push_back(body_b);
  of_b.push_back(body_a);
  if (std::min(of_a.size(), of_b.size()) <= most_neighbours) return;
  bodies_ = &substep.bodies;
  worst_ = of_a.size() < of_b.size() ? body_b : body_a;
  ++crowded_;
}

std::string Crowd::fault() const {
  if (!too_many()) return {};
  constexpr std::size_t most_names = 3;
  const std::vector<int>& others = neighbours_[at(worst_)];
  std::string names;
  for (std::size_t i = 0; i < std::min(most_names, others.size()); ++i) {
    names += (i > 0 ? ", \"" : "\"") + bodies_->name(others[i]) + "\"";
  }
  return "too many bodies touch each other in one place: \"" + bodies_->name(worst_) +
         "\" touches " + std::to_string(others.size()) + " others or more (" + names +
         ", ...), and these touch each other; at most " + std::to_string(most_neighbours) +
         " can. Place them apart, or keep them from touching by \"groups\" and \"ignores\" of "
         "their colliders";
}

}  // namespace sheave
