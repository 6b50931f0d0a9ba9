// Subscriptions to readings and events while the world steps.

#include <array>

#include <fmt/format.h>

#include "live/names.h"
#include "live/request.h"
#include "live/session_state.h"

namespace sheave::live {
namespace {

class Subscribe final : public Request {
 public:
  std::string name;
  int every = 1;
  std::vector<std::string> quantities;
  std::vector<std::string> poses;
  bool events = false;

  static constexpr std::string_view type_name = "subscribe";
  static constexpr std::string_view type_meaning =
      "from now on lines that begin with {\"event\": report quantities and poses every so many "
      "steps, "
      "and events of cables and joints";
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&Subscribe::name>("name", "", {}, required,
                                "name of the subscription, which its lines repeat"),
        field<&Subscribe::every>("every", "", at_least(1.0), optional,
                                 "number of steps: a line comes at its multiples"),
        field<&Subscribe::quantities>(
            "quantities", "", {}, optional,
            "names of quantities, as checks and tables have them, and expressions"),
        field<&Subscribe::poses>("poses", "", {}, optional, "names of bodies"),
        field<&Subscribe::events>(
            "events", "", {}, optional,
            "whether events of cables and joints are reported, at every step"),
    };
    return table;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Errors run(SessionState& session, Json& answer) const override;
};

Errors Subscribe::run(SessionState& session, Json& /*answer*/) const {
  Errors errors = check_name(name);
  if (errors.empty() && session.subscriptions.contains(name)) {
    errors.push_back({"/name", "there is a subscription of this name; unsubscribe it first"});
  }
  const Result<Readings> readings =
      Readings::create(session.quantities(), session.names, quantities, poses);
  if (!readings) {
    errors.insert(errors.end(), readings.errors().begin(), readings.errors().end());
  } else if (readings->empty() && !events) {
    errors.push_back({"", "the request names nothing: name quantities or poses, or set events"});
  }
  if (session.subscriptions.size() >= session.limits.subscriptions) {
    errors.push_back({"", fmt::format("there are {} subscriptions, and no more are allowed",
                                      session.limits.subscriptions)});
  }
  if (errors.empty()) session.subscriptions.emplace(name, Subscription{every, *readings, events});
  return errors;
}

class Unsubscribe final : public Request {
 public:
  std::string name;

  static constexpr std::string_view type_name = "unsubscribe";
  static constexpr std::string_view type_meaning = "ends a subscription";
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&Unsubscribe::name>("name", "", {}, required, "of the subscription"),
    };
    return table;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Errors run(SessionState& session, Json& /*answer*/) const override {
    if (session.subscriptions.erase(name) > 0) return {};
    std::vector<std::string_view> names;
    for (const auto& [known, subscription] : session.subscriptions) names.push_back(known);
    return {no_such("subscription", name, names, "/name")};
  }
};

}  // namespace

TypeEntry<Request> subscribe_request() { return request_entry<Subscribe>(); }
TypeEntry<Request> unsubscribe_request() { return request_entry<Unsubscribe>(); }

}  // namespace sheave::live
