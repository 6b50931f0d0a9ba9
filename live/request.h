#pragma once
// What every type of request must provide. Adding one: a file in live/requests/ and a line in
// request_registry.cpp.

#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/field.h"
#include "engine/result.h"
#include "live/answer_format.h"
#include "live/names.h"
#include "scenes/format.h"
#include "scenes/part_reader.h"

namespace sheave::live {

struct SessionState;

/// What an answer says, key by key.
using Json = nlohmann::ordered_json;

/// Something that is asked of a session. Settings; derived types add their own.
class Request {
 public:
  virtual ~Request() = default;
  Request(const Request&) = delete;
  Request& operator=(const Request&) = delete;

  std::optional<double> id;       ///< the answer repeats it
  std::optional<double> at_step;  ///< the request is refused unless the world is at this step

  static std::span<const Field> common_field_table();
  [[nodiscard]] virtual std::string_view type() const = 0;  ///< key in the registry, e.g. "step"
  [[nodiscard]] virtual const void* settings() const = 0;   ///< this, as its own type
  /// The lists of objects that it has.
  [[nodiscard]] virtual std::span<const Member> members() const { return {}; }
  /// Keys that must not be given both.
  [[nodiscard]] virtual std::span<const std::pair<std::string_view, std::string_view>> exclusive()
      const {
    return {};
  }
  /// Reads its lists from the object `node`, for a world with these names.
  virtual void read_members(json::NodeId node, PartReader& reader, const Names& names) {
    static_cast<void>(node), static_cast<void>(reader), static_cast<void>(names);
  }
  /// What its answer has besides what all have.
  [[nodiscard]] virtual std::vector<AnswerKey> answer_keys() const { return {}; }
  /// Does it, and adds to the answer what there is to say. Faults have pointers within the request;
  /// then nothing has changed.
  [[nodiscard]] virtual Errors run(SessionState& session, Json& answer) const = 0;
  /// Whether it belongs into a log. What is not logged is how the world comes to its steps: of
  /// those the log has the number.
  [[nodiscard]] virtual bool is_logged() const { return true; }

 protected:
  Request() = default;
};

/// All types, in the order of the documentation.
[[nodiscard]] std::span<const TypeEntry<Request>> request_types();

/// The registry line of `Type`, which declares static type_name, type_meaning and field_table().
template <class Type>
[[nodiscard]] constexpr TypeEntry<Request> request_entry() {
  return type_entry<Request, Type>();
}

// One per file in live/requests/.
[[nodiscard]] TypeEntry<Request> hello_request();
[[nodiscard]] TypeEntry<Request> describe_request();
[[nodiscard]] TypeEntry<Request> step_request();
[[nodiscard]] TypeEntry<Request> run_request();
[[nodiscard]] TypeEntry<Request> pause_request();
[[nodiscard]] TypeEntry<Request> set_request();
[[nodiscard]] TypeEntry<Request> clear_request();
[[nodiscard]] TypeEntry<Request> place_request();
[[nodiscard]] TypeEntry<Request> release_request();
[[nodiscard]] TypeEntry<Request> lock_request();
[[nodiscard]] TypeEntry<Request> edit_request();
[[nodiscard]] TypeEntry<Request> observe_request();
[[nodiscard]] TypeEntry<Request> subscribe_request();
[[nodiscard]] TypeEntry<Request> unsubscribe_request();
[[nodiscard]] TypeEntry<Request> snapshot_request();
[[nodiscard]] TypeEntry<Request> restore_request();
[[nodiscard]] TypeEntry<Request> forget_request();
[[nodiscard]] TypeEntry<Request> hash_request();
[[nodiscard]] TypeEntry<Request> quit_request();

}  // namespace sheave::live
