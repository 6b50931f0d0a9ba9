// Reports the version of the protocol and the scene.

#include <array>
#include <vector>

#include "live/request.h"
#include "live/session_state.h"

namespace sheave::live {
namespace {

const AnswerFormat& limits_format() {
  using Kind = AnswerValue::Kind;
  static const AnswerFormat format{
      "limits",
      "limits of requests",
      {{"line_bytes", {Kind::integer}, "of a request"},
       {"steps", {Kind::integer}, "of a request"},
       {"parts", {Kind::integer}, "bodies, joints, cables and their links, all together"},
       {"snapshots", {Kind::integer}, "that are kept"},
       {"snapshot_bytes", {Kind::integer}, "of all of them together"},
       {"subscriptions", {Kind::integer}, "at a time"}}};
  return format;
}

class Hello final : public Request {
 public:
  Protocol protocol = Protocol::v1;

  static constexpr std::string_view type_name = "hello";
  static constexpr std::string_view type_meaning =
      "gives the protocol and the scene; an error if the caller asks for another protocol";
  static std::span<const Field> field_table() {
    static const std::array table{
        choice_field<&Hello::protocol>("protocol", protocol_names, optional,
                                       "the version that the caller knows"),
    };
    return table;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] std::vector<AnswerKey> answer_keys() const override {
    using Kind = AnswerValue::Kind;
    return {{"protocol", {Kind::text, {}, protocol_names}, "the version in use"},
            {"scene", {Kind::text}, "its title"},
            {"dt", {Kind::number, "s"}, "time of a step"},
            {"duration", {Kind::number, "s"}, "duration of the scene; a session may go on"},
            {"limits", {Kind::object, {}, {}, &limits_format()}, "bounds of requests"}};
  }
  [[nodiscard]] Errors run(SessionState& session, Json& answer) const override {
    const Limits& limits = session.limits;
    answer["protocol"] = protocol_names[static_cast<std::size_t>(Protocol::v1)];
    answer["scene"] = session.about.name;
    answer["dt"] = session.world.simulation().world.model().step.dt;
    answer["duration"] = session.about.duration;
    answer["limits"] = {{"line_bytes", limits.line_bytes},
                        {"steps", limits.steps},
                        {"parts", limits.parts},
                        {"snapshots", limits.snapshots},
                        {"snapshot_bytes", limits.snapshot_bytes},
                        {"subscriptions", limits.subscriptions}};
    return {};
  }
};

}  // namespace

TypeEntry<Request> hello_request() { return request_entry<Hello>(); }

}  // namespace sheave::live
