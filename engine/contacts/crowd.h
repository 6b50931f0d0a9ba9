#pragma once
// Bodies of which too many touch each other.

#include <string>
#include <vector>

#include "engine/contacts/contact.h"

namespace sheave {

/// Finds bodies that are in one place. The rows of n bodies that all touch each other are n^2 and a
/// dense matrix, which needs memory as n^4: a gigabyte for 40 boxes. In a heap nobody touches more
/// than 26 others of its size; one large body may touch any number of small ones.
class Crowd {
 public:
  /// A body that touches more others than this is crowded if many of these are, too.
  static constexpr std::size_t most_neighbours = 32;
  /// The most pairs of crowded bodies that touch each other.
  static constexpr int most_pairs = 32;

  void begin(int bodies);
  /// Bodies that cannot move couple nothing.
  void add(const Substep& substep, int body_a, int body_b);
  [[nodiscard]] bool too_many() const { return crowded_ > most_pairs; }
  /// Which bodies these are; empty unless there are too many.
  [[nodiscard]] std::string fault() const;

 private:
  std::vector<std::vector<int>> neighbours_;  // per body
  int crowded_ = 0;
  int worst_ = 0;
  const BodySet* bodies_ = nullptr;
};

}  // namespace sheave
