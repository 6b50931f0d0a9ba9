#pragma once
// Detects bodies that touch too many others.

#include <string>
#include <vector>

#include "engine/contacts/contact.h"

namespace sheave {

/// Finds bodies that occupy one place. If all of n bodies touch each other, their n^2 rows give a
/// dense matrix, whose memory grows as n^4: a gigabyte for 40 boxes. In a heap, no body touches
/// more than 26 others of its size; one large body may touch any number of small ones.
class Crowd {
 public:
  /// A body that touches more others than this is crowded if many of these others are crowded, too.
  static constexpr std::size_t most_neighbours = 32;
  /// The largest allowed number of pairs of crowded bodies that touch each other.
  static constexpr int most_pairs = 32;

  void begin(int bodies);
  /// Adds a pair that touches. A pair with an immovable body is ignored: it couples no rows.
  void add(const Substep& substep, int body_a, int body_b);
  [[nodiscard]] bool too_many() const { return crowded_ > most_pairs; }
  /// The message that names the bodies; empty unless there are too many.
  [[nodiscard]] std::string fault() const;

 private:
  std::vector<std::vector<int>> neighbours_;  // per body
  int crowded_ = 0;
  int worst_ = 0;
  const BodySet* bodies_ = nullptr;
};

}  // namespace sheave
