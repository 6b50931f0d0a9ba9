// Does a number of steps, or steps until a time.

#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "engine/field_check.h"
#include "live/request.h"
#include "live/session_state.h"

namespace sheave::live {
namespace {

class Step final : public Request {
 public:
  int count = 1;
  std::optional<double> until;

  static constexpr std::string_view type_name = "step";
  static constexpr std::string_view type_meaning =
      "steps the world; ends early when a trigger stops the run or the world diverges, and says so "
      "in `ended`";
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&Step::count>("count", "", at_least(1.0), optional, "number of steps"),
        field<&Step::until>("until", "s", any_number(), optional,
                            "in place of count: to the first step at or after this time"),
    };
    return table;
  }
  [[nodiscard]] std::span<const std::pair<std::string_view, std::string_view>> exclusive()
      const override {
    static constexpr std::array<std::pair<std::string_view, std::string_view>, 1> pairs{
        {{"count", "until"}}};
    return pairs;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] bool is_logged() const override { return false; }
  [[nodiscard]] std::vector<AnswerKey> answer_keys() const override {
    using Kind = AnswerValue::Kind;
    return {{"steps", {Kind::integer}, "number of steps done"},
            {"ended",
             {Kind::text, {}, std::span(ending_names).subspan(1)},
             "reason why the world has stopped, if it has",
             optional},
            {"reason", {Kind::text}, "the same as a text", optional},
            {"doubtful",
             {Kind::text},
             "the item of the certificate that makes the run doubtful, if there is one: "
             "docs/explanation/certificate.md",
             optional}};
  }
  [[nodiscard]] Errors run(SessionState& session, Json& answer) const override;

 private:
  [[nodiscard]] Result<std::int64_t> steps_to_do(const SessionState& session) const;
};

Result<std::int64_t> Step::steps_to_do(const SessionState& session) const {
  double steps = count;
  if (until) {
    // Times of steps have rounding errors.
    constexpr double rounding = 1e-6;
    const double dt = session.world.simulation().world.model().step.dt;
    steps = std::ceil((*until - session.world.time()) / dt - rounding);
    if (steps < 0.0) {
      return Error{"/until", fmt::format("this time is over: the world is at {} s",
                                         number_text(session.world.time()))};
    }
  }
  if (!(steps <= static_cast<double>(session.limits.steps))) {
    return Error{until ? "/until" : "/count",
                 fmt::format("{} steps are too many for one request: at most {} are allowed",
                             number_text(steps), session.limits.steps)};
  }
  return static_cast<std::int64_t>(steps);
}

Errors Step::run(SessionState& session, Json& answer) const {
  const Result<std::int64_t> steps = steps_to_do(session);
  if (!steps) return steps.errors();
  if (const auto trigger = session.stopped_by()) {
    return {{"", fmt::format("trigger \"{}\" has stopped the run; restore a snapshot from before",
                             *trigger)}};
  }
  const std::int64_t before = session.world.state().steps;
  Ending ending = Ending::none;
  std::string reason;
  const double dt = session.world.simulation().world.model().step.dt;
  for (std::int64_t i = 0; i < *steps && ending == Ending::none; ++i) {
    const auto& may_go_on = session.hooks.before_step;
    const bool goes_on = !may_go_on || may_go_on(session.world.time() + dt);
    ending = goes_on ? session.step(reason) : Ending::interrupted;
  }
  answer["steps"] = session.world.state().steps - before;
  const Certificate certificate = session.world.run_certificate();
  if (!certificate.clean()) answer["doubtful"] = certificate.worst()->sentence();
  if (ending == Ending::none) return {};
  answer["ended"] = ending_names[static_cast<std::size_t>(ending)];
  if (!reason.empty()) answer["reason"] = reason;
  return {};
}

}  // namespace

TypeEntry<Request> step_request() { return request_entry<Step>(); }

}  // namespace sheave::live
