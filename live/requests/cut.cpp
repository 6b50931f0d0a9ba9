// Cuts a cable.

#include <array>
#include <optional>

#include "live/control.h"
#include "live/request.h"
#include "live/session_state.h"

namespace sheave::live {
namespace {

class Cut final : public Request {
 public:
  std::string cable;
  std::optional<double> place;

  static constexpr std::string_view type_name = "cut";
  static constexpr std::string_view type_meaning =
      "cuts a cable now, at a place or in the span with the largest tension; without a place a "
      "cable without tension is cut once it carries tension, unless its control breaking_tension "
      "is cleared before";
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&Cut::cable>("cable", "", {}, required, "name of the cable"),
        field<&Cut::place>("place", "m", above(0.0), optional,
                           "unstretched length from the first link on, cable on wheels and drums "
                           "included, in a free span"),
    };
    return table;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Errors run(SessionState& session, Json& /*answer*/) const override {
    const Result<CableHandle> handle = session.names.cable(cable);
    if (!handle) return handle.errors();
    return place ? at_pointer(session.world.cut(*handle, *place), "/place")
                 : at_pointer(session.world.cut(*handle), "/cable");
  }
};

}  // namespace

TypeEntry<Request> cut_request() { return request_entry<Cut>(); }

}  // namespace sheave::live
