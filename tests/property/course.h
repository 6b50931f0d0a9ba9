#pragma once
// Runs of machines, compared step by step, and how far apart two runs may be.
//
// Two runs that ought to agree differ by rounding, and by what a solver leaves over; the machine
// makes more of it. How much more is measured: twins of the machine, every number of which is
// changed by about as much, are run beside it. The other run may differ by 72 times the largest
// difference of 8 twins from the machine. The factor follows from two facts. A twin's change has a
// random direction, so its difference is a standard deviation s times a normal number Z. The other
// run rounds anew in each of n substeps, so its difference has a standard deviation of s sqrt(n) at
// most. It exceeds f times the largest of 8 normal numbers with a probability of about
// (0.8 sqrt(n) / f)^8 E Z^8, where E Z^8 = 105. For n = 120 substeps that is 5e-6, a twentieth in
// 10,000 machines, if f = 72.
//
// The comparison ends, and its other steps count as dropped, where
// - twins differ by 1e-4 of the machine's size;
// - a run tells that rows contradict each other, that a drive or a joint asks for an impossible
//   motion, or that a substep has not converged: the result then depends on the order of rows;
// - a joint that can break is one of several that hold a body: its share of the load is open;
// - one run does a substep in other parts than the other run, which is another time step.
// A run that tells of an impossible motion where the other run and all twins do not is a fault.

#include <cstdint>
#include <functional>
#include <vector>

#include "tests/property/campaign.h"

namespace sheave::test {

/// What is compared after each step.
struct Moment {
  std::vector<BodyState> bodies;
  std::vector<std::vector<double>> tensions;  ///< of each cable, its spans in order [N]
  /// Some rows depended on each other: which of them carries how much is open.
  bool redundant = false;
  std::int64_t parts = 0;  ///< into which substeps were cut
};

struct Course {
  std::vector<Moment> moments;  ///< after each step
  bool failed = false;          ///< it diverged after them
  bool lost = false;            ///< a span had no tangent after them
  bool told = false;            ///< it told that what came after them depends on the order of rows
  bool impossible = false;      ///< it told that something asked for what cannot be
};
[[nodiscard]] Course follow(const Machine& machine, int steps);

/// Between two moments: of motion in shares of the machine's size, turns and velocities times a
/// step included; of tension in shares of the largest so far.
struct Apart {
  double motion = 0.0;
  double tension = 0.0;
};

/// How another machine's course is told in terms of the first one's.
struct Retold {
  std::function<BodyState(BodyState)> body = [](BodyState b) { return b; };
  double tension = 1.0;            ///< factor
  bool tensions_reversed = false;  ///< spans of each cable are counted from the other end
  /// What impacts leave in spans that hold each other within the cones of their links depends on
  /// the order of rows: tensions are compared where no rows depend on each other.
  bool compares_shared_loads = true;
};

/// Whether two machines move alike. `noise`: relative, what their runs differ by in each substep.
[[nodiscard]] Finding alike(const Machine& machine, const Machine& other, const Retold& retold,
                            int steps, double noise, std::uint64_t seed);

}  // namespace sheave::test
