// The hash of the state, for comparisons.

#include <array>
#include <vector>

#include <fmt/format.h>

#include "engine/state.h"
#include "live/request.h"
#include "live/session_state.h"

namespace sheave::live {
namespace {

class Hash final : public Request {
 public:
  static constexpr std::string_view type_name = "hash";
  static constexpr std::string_view type_meaning =
      "a number of 16 hexadecimal digits that depends on every bit of the state";
  static std::span<const Field> field_table() { return {}; }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] std::vector<AnswerKey> answer_keys() const override {
    return {{"hash", {AnswerValue::Kind::text}, "16 hexadecimal digits"}};
  }
  [[nodiscard]] Errors run(SessionState& session, Json& answer) const override {
    answer["hash"] = fmt::format("{:016x}", sheave::hash(session.world.state()));
    return {};
  }
};

}  // namespace

TypeEntry<Request> hash_request() { return request_entry<Hash>(); }

}  // namespace sheave::live
