// Lets the world step by itself, and pauses it.

#include <array>
#include <vector>

#include <fmt/format.h>

#include "live/request.h"
#include "live/session_state.h"

namespace sheave::live {
namespace {

class Run final : public Request {
 public:
  std::optional<double> pace;

  static constexpr std::string_view type_name = "run";
  static constexpr std::string_view type_meaning =
      "from now on the world steps by itself, between requests, until it is told to pause or goes "
      "no further";
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&Run::pace>("pace", "", above(0.0), optional,
                          "simulated seconds per second of the clock; default: that of "
                          "`--realtime`, or as fast as possible"),
    };
    return table;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] bool is_logged() const override { return false; }
  [[nodiscard]] std::vector<AnswerKey> answer_keys() const override {
    return {{"running", {AnswerValue::Kind::boolean}, "whether it steps by itself"}};
  }
  [[nodiscard]] Errors run(SessionState& session, Json& answer) const override {
    if (const auto trigger = session.stopped_by()) {
      return {{"", fmt::format("trigger \"{}\" has stopped the run; restore a snapshot from before",
                               *trigger)}};
    }
    session.running = true;
    session.pace = pace;
    answer["running"] = true;
    return {};
  }
};

class Pause final : public Request {
 public:
  static constexpr std::string_view type_name = "pause";
  static constexpr std::string_view type_meaning = "the world no longer steps by itself";
  static std::span<const Field> field_table() { return {}; }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] bool is_logged() const override { return false; }
  [[nodiscard]] std::vector<AnswerKey> answer_keys() const override {
    return {{"running", {AnswerValue::Kind::boolean}, "whether it steps by itself"}};
  }
  [[nodiscard]] Errors run(SessionState& session, Json& answer) const override {
    session.running = false;
    session.pace.reset();
    answer["running"] = false;
    return {};
  }
};

}  // namespace

TypeEntry<Request> run_request() { return request_entry<Run>(); }
TypeEntry<Request> pause_request() { return request_entry<Pause>(); }

}  // namespace sheave::live
