#pragma once
// A world that is controlled by lines of text.
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
  /// `simulation` belongs to `scene`, at its start or in a saved state. A snapshot of it gets the
  /// name "start". Subscribers to events get the warnings `at_start` (scenes/start_warnings.h) with
  /// the first step.
  Session(const Scene& scene, Simulation simulation, Hooks hooks = {}, const Limits& limits = {},
          std::vector<Warning> at_start = {});
  ~Session();
  Session(Session&&) noexcept;
  Session& operator=(Session&&) noexcept;

  /// The answer to a request: one JSON object, without a line break. Every line gets an answer;
  /// with "ok": false nothing has changed.
  [[nodiscard]] std::string answer(std::string_view line);
  /// The answer to a line that exceeds the limit and was discarded.
  [[nodiscard]] std::string answer_to_long_line() const;

  /// Whether the world should step by itself, between requests.
  [[nodiscard]] bool is_running() const;
  /// World time per clock time that the run has requested, if it has.
  [[nodiscard]] std::optional<double> pace() const;
  /// One step of such a run. If the world cannot go on, an event reports it and the run ends. False
  /// if the step was interrupted.
  bool advance();
  /// Whether a request has ended the session.
  [[nodiscard]] bool has_quit() const;
  /// Writes the steps of a run that are not in the log yet.
  void finish_log();

  [[nodiscard]] const LiveWorld& world() const;
  /// For programs that also use the world themselves; after an edit they call refresh().
  [[nodiscard]] SessionState& state();

 private:
  [[nodiscard]] Json head(const std::optional<double>& id, bool ok) const;

  std::unique_ptr<SessionState> state_;
};

}  // namespace sheave::live
