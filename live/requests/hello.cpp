// What protocol is spoken, and of which scene.

#include <array>

#include "live/request.h"
#include "live/session_state.h"

namespace sheave::live {
namespace {

class Hello final : public Request {
 public:
  Protocol protocol = Protocol::v1;

  static constexpr std::string_view type_name = "hello";
  static constexpr std::string_view type_meaning =
      "what protocol is spoken, and of which scene; an error if it is not the one that is asked "
      "for";
  static std::span<const Field> field_table() {
    static const std::array table{
        choice_field<&Hello::protocol>("protocol", protocol_names, optional,
                                       "the version that the caller knows"),
    };
    return table;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Errors run(SessionState& session, Json& answer) const override {
    const Limits& limits = session.limits;
    answer["protocol"] = protocol_names[static_cast<std::size_t>(Protocol::v1)];
    answer["scene"] = session.about.name;
    answer["dt"] = session.world.simulation().world.model().step.dt;
    answer["duration"] = session.about.duration;
    answer["limits"] = {{"line_bytes", limits.line_bytes},
                        {"steps", limits.steps},
                        {"snapshots", limits.snapshots},
                        {"snapshot_bytes", limits.snapshot_bytes},
                        {"subscriptions", limits.subscriptions}};
    return {};
  }
};

}  // namespace

TypeEntry<Request> hello_request() { return request_entry<Hello>(); }

}  // namespace sheave::live
