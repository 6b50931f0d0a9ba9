// Cuts a cable.

#include <array>

#include "live/control.h"
#include "live/request.h"
#include "live/session_state.h"

namespace sheave::live {
namespace {

class Cut final : public Request {
 public:
  std::string cable;

  static constexpr std::string_view type_name = "cut";
  static constexpr std::string_view type_meaning =
      "cuts a cable now, in the span with the largest tension; a cable without tension is cut once "
      "it carries tension, unless its control breaking_tension is cleared before";
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&Cut::cable>("cable", "", {}, required, "name of the cable"),
    };
    return table;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Errors run(SessionState& session, Json& /*answer*/) const override {
    const Result<CableHandle> handle = session.names.cable(cable);
    return handle ? at_pointer(session.world.cut(*handle), "/cable") : handle.errors();
  }
};

}  // namespace

TypeEntry<Request> cut_request() { return request_entry<Cut>(); }

}  // namespace sheave::live
