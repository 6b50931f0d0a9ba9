#pragma once
// What requests act on.

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cable/live_world.h"
#include "live/protocol.h"
#include "live/readings.h"
#include "scenes/scene.h"

namespace sheave::live {

/// What a session asks of the program that it is in. All of them may be empty.
struct Hooks {
  /// Takes an event, a line without its end. One that is not needed may be left out where nobody
  /// takes it in time.
  std::function<void(const std::string& line, bool needed)> event{};
  /// Takes a line of the log: a request without the end of its line.
  std::function<void(const std::string& line)> log{};
  /// Called before each step of a request, with the time that the world will have [s], and whether
  /// it may go on.
  std::function<bool(double time)> before_step{};
  /// Ends a step that has begun, which then has not been.
  StopRequest stop{};
};

/// What somebody wants to be told while the world steps.
struct Subscription {
  int every = 1;      ///< steps: at those that are multiples of it
  Readings readings;  ///< may be empty
  bool events = false;
};

/// A state that is kept, with what it is a state of.
struct KeptSnapshot {
  LiveSnapshot snapshot;
  std::int64_t revision = 0;  ///< SessionState::revision
  std::size_t parts = 0;      ///< that the world had
};

/// Why a world goes no further.
enum class Ending {
  none,
  trigger,      ///< a trigger has stopped the run
  divergence,   ///< the state would mean nothing
  interrupted,  ///< Hooks::stop or before_step said so
};
inline constexpr std::array<std::string_view, 4> ending_names{"none", "trigger", "divergence",
                                                              "interrupted"};

struct SessionState {
  SessionState(const Scene& scene, Simulation simulation, Hooks called, const Limits& bounds);

  /// Those of the world, named when they are first asked for: that takes time and memory.
  [[nodiscard]] const QuantityIndex& quantities();

  /// To be called when the world has been edited or is another one.
  void refresh();
  /// The state as it is now, to be kept.
  [[nodiscard]] KeptSnapshot keep() const;
  /// Bodies with their shapes, joints, cables with their links.
  [[nodiscard]] std::size_t part_count() const;
  /// Steps once, and tells subscribers. `reason` is why it ended, if it did.
  [[nodiscard]] Ending step(std::string& reason);
  /// The name of the trigger that has stopped the run, if one has.
  [[nodiscard]] std::optional<std::string> stopped_by() const;
  /// Writes steps that are not in the log yet into it.
  void log_steps();

  /// What of the scene is told that is not in the world.
  struct About {
    std::string name;
    double duration = 0.0;  ///< [s]
    std::vector<std::string> controllers;
    std::vector<std::string> triggers;
  };
  About about;
  LiveWorld world;
  Names names;
  const Hooks hooks;
  const Limits limits;
  std::map<std::string, KeptSnapshot> snapshots;
  std::int64_t revision = 0;   ///< what the world is made of: one number for each edit
  std::int64_t revisions = 1;  ///< that have been
  std::map<std::string, Subscription> subscriptions;
  bool running = false;        ///< steps by itself
  std::optional<double> pace;  ///< of a run, the world's seconds per second; none: the program's
  bool has_quit = false;
  std::int64_t unlogged_steps = 0;  ///< that were begun and not interrupted
  std::int64_t logged_to = 0;  ///< the step that the world was at after the last that is in the log

 private:
  std::unique_ptr<const QuantityIndex> quantities_;

  void tell(const LiveReport& report);
  void tell_events(const std::string& name, const LiveReport& report) const;
  [[nodiscard]] Json event(std::string_view kind) const;
  void send(const Json& event, bool needed) const;
};

/// The text of an answer or an event: one line, valid UTF-8 whatever is in it.
[[nodiscard]] std::string line_of(const Json& json);

/// A new name of a snapshot or a subscription: the fault, or nothing.
[[nodiscard]] Errors check_name(const std::string& name);

}  // namespace sheave::live
