#pragma once

#include <span>
#include <vector>

#include "engine/contacts/contact.h"

namespace sheave {

/// Velocities after impacts, for substeps of `xpbd`: positions have already been moved apart, and velocities follow from
/// that; but what a bounce leaves is not what the way of a substep says. Impulses m [N s], found by sweeps, bring the normal
/// velocity of points that bounce to Contact::rebound_stored and keep that of points that are pressed from falling; friction
/// takes its share of them. With those of the positions, l / h, no impulse pulls.
class Rebound {
 public:
  /// Changes the velocities in substep.next, and adds h m to the multipliers, three per contact.
  void run(Substep& substep, std::span<const Contact> contacts, std::span<double> multipliers);

 private:
  struct Impact {
    std::size_t contact = 0;
    double wanted = 0.0;  ///< normal velocity [m/s]
    std::vector<Row> rows;
    std::vector<RowResponse> responses;
  };
  std::vector<Impact> impacts_;
};

}  // namespace sheave
