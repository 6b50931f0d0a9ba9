// Present values of quantities and poses.

#include <array>
#include <vector>

#include "live/request.h"
#include "live/session_state.h"

namespace sheave::live {
namespace {

class Observe final : public Request {
 public:
  std::vector<std::string> quantities;
  std::vector<std::string> poses;

  static constexpr std::string_view type_name = "observe";
  static constexpr std::string_view type_meaning =
      "gives the present quantities and poses; an unknown value, such as a force before the first "
      "step, is null";
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&Observe::quantities>(
            "quantities", "", {}, optional,
            "names of quantities, as checks and tables have them, and expressions"),
        field<&Observe::poses>("poses", "", {}, optional, "names of bodies"),
    };
    return table;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] std::vector<AnswerKey> answer_keys() const override { return reading_keys(); }
  [[nodiscard]] Errors run(SessionState& session, Json& answer) const override {
    const Result<Readings> readings =
        Readings::create(session.quantities(), session.names, quantities, poses);
    if (!readings) return readings.errors();
    if (readings->empty()) return {{"", "the request names nothing: name quantities or poses"}};
    readings->read(session.world, answer);
    return {};
  }
};

}  // namespace

TypeEntry<Request> observe_request() { return request_entry<Observe>(); }

}  // namespace sheave::live
