#pragma once
// A problem in some engine, and how far from the exact motion it gets.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bench/peers/problem.h"
#include "engine/state.h"
#include "measure/timing.h"

namespace sheave::peers {

/// One engine with one setting, simulating one problem.
class Machine {
 public:
  virtual ~Machine() = default;
  virtual void restart() = 0;
  /// One step of Problem::dt; false if the state means nothing any more.
  virtual bool step() = 0;
  /// Coordinates [m] and their rates [m/s], in the problem's order.
  virtual void read(std::vector<double>& positions, std::vector<double>& rates) const = 0;

 protected:
  Machine() = default;
  Machine(const Machine&) = default;
  Machine& operator=(const Machine&) = default;
};

/// Errors against the exact motion, the largest of the frames told; root mean square over
/// coordinates.
struct MachineError {
  double position = 0.0;  ///< of all frames, relative to the scene's size
  /// Of speeds in the second half of the run, when what the start stirred up should be over;
  /// relative to the exact speed at the end, in balance to that of a free fall. So the error of the
  /// acceleration.
  double speed = 0.0;
  double stretch =
      0.0;  ///< largest s_(i+1) - s_i of a span in any frame, relative to the scene's size
};

/// Largest speed error of settings that count as right.
inline constexpr double right_error = 1e-3;

/// Runs it once; infinite if it fails.
[[nodiscard]] MachineError error_of(const Problem& problem, Machine& machine);

/// Coordinates and their rates, as Machine::read() gives them, of a state of the problem's scene
/// that began as `start`.
void read_coordinates(const State& now, const State& start,
                      const std::vector<Coordinate>& coordinates, std::vector<double>& positions,
                      std::vector<double>& rates);

/// For timing; keeps the machine alive.
[[nodiscard]] measure::Contender contender_of(std::string name, const Problem& problem,
                                              std::shared_ptr<Machine> machine);

/// The problem in this engine.
[[nodiscard]] Result<std::shared_ptr<Machine>> sheave_machine(const Problem& problem,
                                                              const StepSettings& settings);

}  // namespace sheave::peers
