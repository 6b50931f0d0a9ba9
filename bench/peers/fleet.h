#pragma once
// Many worlds of one machine in some engine, stepped on all cores, and how far from right they are.

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "bench/peers/mujoco_machine.h"
#include "bench/peers/problem.h"

namespace sheave::peers {

/// One engine with one setting.
class Fleet {
 public:
  virtual ~Fleet() = default;
  [[nodiscard]] virtual std::size_t size() const = 0;
  /// All worlds, back to the start. False if that failed.
  virtual bool restart() = 0;
  /// So many steps of every world. False if the state of one means nothing any more.
  virtual bool step(int steps) = 0;
  /// Machine::read() of the last world, so that errors are those of what has been timed.
  virtual void read(std::vector<double>& positions, std::vector<double>& rates) const = 0;

 protected:
  Fleet() = default;
  Fleet(const Fleet&) = default;
  Fleet& operator=(const Fleet&) = default;
};

/// `sheave.Batch` of a scene; `coordinates` are what read() tells.
[[nodiscard]] Result<std::shared_ptr<Fleet>> sheave_fleet(const Scene& scene, std::size_t count,
                                                          std::size_t threads,
                                                          std::vector<Coordinate> coordinates = {});

/// Worlds of MuJoCo, each with data of its own, on as many threads, which take one world after the
/// other for all steps that are asked for: as it is done in programs that sample many runs.
[[nodiscard]] Result<std::shared_ptr<Fleet>> mujoco_fleet(const Problem& problem,
                                                          const MujocoSettings& settings,
                                                          std::size_t count, std::size_t threads);

/// error_of() the last world.
[[nodiscard]] MachineError error_of(const Problem& problem, const std::shared_ptr<Fleet>& fleet);

}  // namespace sheave::peers
