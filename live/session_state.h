#pragma once
// The state of a session, on which requests act.

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
#include "scenes/json/checksum_chain.h"
#include "scenes/scene.h"

namespace sheave::live {

/// Callbacks of a session into its program. All may be empty.
struct Hooks {
  /// Takes an event, a line without line break. An event that is not `needed` may be dropped if the
  /// reader is too slow.
  std::function<void(const std::string& line, bool needed)> event{};
  /// Takes a line of the log: a request without line break.
  std::function<void(const std::string& line)> log{};
  /// Called before each step of a request with the time that the world will have [s]; false
  /// interrupts the request.
  std::function<bool(double time)> before_step{};
  /// Interrupts a step that has begun; its effect is undone.
  StopRequest stop{};
};

/// A subscription to readings and events while the world steps.
struct Subscription {
  int every = 1;      ///< interval in steps: at step numbers that are multiples of it
  Readings readings;  ///< may be empty
  bool events = false;
};

/// A kept snapshot.
struct KeptSnapshot {
  LiveSnapshot snapshot;
  std::int64_t revision = 0;  ///< SessionState::revision
  std::size_t parts = 0;      ///< number of parts of the world
};

/// Why a world cannot go on.
enum class Ending {
  none,
  trigger,      ///< a trigger has stopped the run
  divergence,   ///< the state would be invalid
  interrupted,  ///< Hooks::stop or before_step ended it
};
inline constexpr std::array<std::string_view, 4> ending_names{"none", "trigger", "divergence",
                                                              "interrupted"};

struct SessionState {
  SessionState(const Scene& scene, Simulation simulation, Hooks called, const Limits& bounds,
               std::vector<Warning> at_start);

  /// The quantities of the world. Their index is built at the first call, since that takes time and
  /// memory.
  [[nodiscard]] const QuantityIndexPointer& quantities();

  /// To be called after the world has been edited or replaced.
  void refresh();
  /// A snapshot of the present state.
  [[nodiscard]] KeptSnapshot keep() const;
  /// Number of bodies with their shapes, joints, and cables with their links.
  [[nodiscard]] std::size_t part_count() const;
  /// Does one step and informs subscribers. `reason`: why the run ended, if it did.
  [[nodiscard]] Ending step(std::string& reason);
  /// The name of the trigger that has stopped the run, if one has.
  [[nodiscard]] std::optional<std::string> stopped_by() const;
  /// Writes the steps that are not in the log yet.
  void log_steps();
  /// Writes the text of a request, which must have its end, into the log, with its checksum.
  void log(std::string_view request);

  /// Information about the scene that the world does not contain.
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
  std::int64_t revision = 0;   ///< number of the edit that made the present world
  std::int64_t revisions = 1;  ///< number of revisions so far
  std::map<std::string, Subscription> subscriptions;
  bool running = false;        ///< the world steps by itself
  std::optional<double> pace;  ///< world time per clock time of a run; none: the program's default
  bool has_quit = false;
  std::int64_t unlogged_steps = 0;  ///< that were begun and not interrupted
  std::int64_t logged_to = 0;  ///< the step that the world was at after the last that is in the log
  json::ChecksumChain log_written;
  json::ChecksumChain log_read;  ///< of lines of another session's log that have come as requests

 private:
  QuantityIndexPointer quantities_;

  void tell(const LiveReport& report);
  void tell_events(const std::string& name, const LiveReport& report) const;
  [[nodiscard]] Json event(std::string_view kind) const;
  void send(const Json& event, bool needed) const;
};

/// The text of an answer or an event: one line, always valid UTF-8.
[[nodiscard]] std::string line_of(const Json& json);

/// Checks a new name of a snapshot or a subscription.
[[nodiscard]] Errors check_name(const std::string& name);

}  // namespace sheave::live
