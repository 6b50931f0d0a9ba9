#pragma once
// A world that is held by lines of text.
//
//   auto simulation = sheave::create_simulation(scene);
//   sheave::live::Session session(scene, std::move(*simulation));
//   session.answer(R"({"id": 1, "type": "step", "count": 10})");
//   // {"id":1,"ok":true,"step":10,"time":0.1,"steps":10}

#include <memory>
#include <string>
#include <string_view>

#include "live/session_state.h"

namespace sheave::live {

class Session {
 public:
  /// `simulation` is one of `scene`, at its start or where a saved state has it; a snapshot of it
  /// has the name "start".
  Session(const Scene& scene, Simulation simulation, Hooks hooks = {}, const Limits& limits = {});
  ~Session();
  Session(Session&&) noexcept;
  Session& operator=(Session&&) noexcept;

  /// The answer to a request: one JSON object, without the end of a line. Whatever `line` is, there
  /// is one; if it says "ok": false nothing has changed.
  [[nodiscard]] std::string answer(std::string_view line);
  /// The answer to a line that is longer than the limit and was not kept.
  [[nodiscard]] std::string answer_to_long_line() const;

  /// Whether the world is to step by itself, between requests.
  [[nodiscard]] bool is_running() const;
  /// The world's seconds per second of the clock that such a run asked for, if it did.
  [[nodiscard]] std::optional<double> pace() const;
  /// One step of such a run. If the world goes no further, that is an event and the run is over;
  /// false if it was interrupted.
  bool advance();
  /// Whether a request has asked for the end.
  [[nodiscard]] bool has_quit() const;
  /// Writes what is not in the log yet into it: the steps of a run.
  void finish_log();

  [[nodiscard]] const LiveWorld& world() const;
  /// For a program that holds the world itself, too; what it edits it tells with refresh().
  [[nodiscard]] SessionState& state();

 private:
  [[nodiscard]] Json head(const std::optional<double>& id, bool ok) const;

  std::unique_ptr<SessionState> state_;
};

}  // namespace sheave::live
