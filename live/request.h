#pragma once
// Interface of all requests. A new request is a file in live/requests/ and a line in
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

/// The keys and values of an answer.
using Json = nlohmann::ordered_json;

/// A request to a session. Derived types add its settings.
class Request {
 public:
  virtual ~Request() = default;
  Request(const Request&) = delete;
  Request& operator=(const Request&) = delete;

  std::optional<double> id;       ///< the answer repeats it
  std::optional<double> at_step;  ///< the request is refused unless the world is at this step
  /// Of a line of a log: its number and the checksum of it and of all lines before, "7
  /// 0123456789abcdef". The request is refused unless the lines with one are as they were written.
  std::string checksum;

  static std::span<const Field> common_field_table();
  [[nodiscard]] virtual std::string_view type() const = 0;  ///< key in the registry, e.g. "step"
  /// this, as a pointer to the derived type
  [[nodiscard]] virtual const void* settings() const = 0;
  /// The members that are lists of objects.
  [[nodiscard]] virtual std::span<const Member> members() const { return {}; }
  /// Pairs of keys that exclude each other.
  [[nodiscard]] virtual std::span<const std::pair<std::string_view, std::string_view>> exclusive()
      const {
    return {};
  }
  /// Reads the lists from the object `node`, for a world with these names.
  virtual void read_members(json::NodeId node, PartReader& reader, const Names& names) {
    static_cast<void>(node), static_cast<void>(reader), static_cast<void>(names);
  }
  /// The keys of its answer in addition to those of all answers.
  [[nodiscard]] virtual std::vector<AnswerKey> answer_keys() const { return {}; }
  /// Carries out the request and adds its results to the answer. Faults have pointers within the
  /// request; after a fault nothing has changed.
  [[nodiscard]] virtual Errors run(SessionState& session, Json& answer) const = 0;
  /// Whether the request belongs in a log. Requests that only advance the world are not logged; the
  /// log contains the number of steps instead.
  [[nodiscard]] virtual bool is_logged() const { return true; }

 protected:
  Request() = default;
};

/// All types of requests, in the order of the documentation.
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
[[nodiscard]] TypeEntry<Request> cut_request();
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
