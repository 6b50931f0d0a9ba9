// Releases and locks joints.

#include <array>

#include "live/control.h"
#include "live/request.h"
#include "live/session_state.h"

namespace sheave::live {
namespace {

class Release final : public Request {
 public:
  std::string joint;

  static constexpr std::string_view type_name = "release";
  static constexpr std::string_view type_meaning = "releases a joint, as if it had broken now";
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&Release::joint>("joint", "", {}, required, "name of the joint"),
    };
    return table;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Errors run(SessionState& session, Json& /*answer*/) const override {
    const Result<JointHandle> handle = session.names.joint(joint);
    return handle ? at_pointer(session.world.release_joint(*handle), "/joint") : handle.errors();
  }
};

class Lock final : public Request {
 public:
  std::string joint;

  static constexpr std::string_view type_name = "lock";
  static constexpr std::string_view type_meaning =
      "locks a joint that was released or has broken, at the present places of its bodies; speed "
      "against it ends as in an inelastic impact";
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&Lock::joint>("joint", "", {}, required, "name of the joint"),
    };
    return table;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Errors run(SessionState& session, Json& /*answer*/) const override {
    const Result<JointHandle> handle = session.names.joint(joint);
    return handle ? at_pointer(session.world.lock_joint(*handle), "/joint") : handle.errors();
  }
};

}  // namespace

TypeEntry<Request> release_request() { return request_entry<Release>(); }
TypeEntry<Request> lock_request() { return request_entry<Lock>(); }

}  // namespace sheave::live
