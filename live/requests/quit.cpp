// Ends a session.

#include "live/request.h"
#include "live/session_state.h"

namespace sheave::live {
namespace {

class Quit final : public Request {
 public:
  static constexpr std::string_view type_name = "quit";
  static constexpr std::string_view type_meaning = "ends the session";
  static std::span<const Field> field_table() { return {}; }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Errors run(SessionState& session, Json& /*answer*/) const override {
    session.running = false;
    session.has_quit = true;
    return {};
  }
};

}  // namespace

TypeEntry<Request> quit_request() { return request_entry<Quit>(); }

}  // namespace sheave::live
