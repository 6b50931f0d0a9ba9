// Keeps, restores and forgets states.

#include <array>
#include <set>

#include <fmt/format.h>

#include "live/names.h"
#include "live/request.h"
#include "live/session_state.h"

namespace sheave::live {
namespace {

constexpr std::string_view start = "start";

/// Approximate size of a state [bytes].
std::size_t bytes_of(const State& state) {
  const Controls& controls = state.controls;
  std::size_t bytes = sizeof(State) + state.bodies.size() * sizeof(BodyState) +
                      state.memory.size() * sizeof(double) +
                      controls.body_drives.entries().size() * sizeof(DriveControl) +
                      controls.forces.entries().size() * sizeof(ForceControl) +
                      controls.motions.entries().size() * sizeof(MotionControl) +
                      controls.joint_drives.entries().size() * sizeof(DriveControl) +
                      controls.cables.entries().size() * sizeof(CableControl) +
                      controls.links.entries().size() * sizeof(LinkControl);
  for (const FeatureState& feature : state.features) {
    bytes += feature.reals.size() * sizeof(double) + feature.integers.size() * sizeof(std::int64_t);
  }
  return bytes;
}

/// Approximate size of all snapshots [bytes], with `kept` in place of the one called `name`.
std::size_t bytes_with(const SessionState& session, const std::string& name,
                       const KeptSnapshot& kept) {
  constexpr std::size_t bytes_of_part = 1024;
  std::size_t bytes = bytes_of(kept.snapshot.state());
  // The present revision exists anyway; each other revision is kept once.
  std::set<std::int64_t> revisions{kept.revision};
  for (const auto& [known, other] : session.snapshots) {
    if (known == name) continue;
    bytes += bytes_of(other.snapshot.state());
    if (revisions.insert(other.revision).second) bytes += other.parts * bytes_of_part;
  }
  return bytes;
}

Error no_such_snapshot(const SessionState& session, const std::string& name) {
  std::vector<std::string_view> names;
  for (const auto& [known, state] : session.snapshots) names.push_back(known);
  return no_such("snapshot", name, names, "/name");
}

class Snapshot final : public Request {
 public:
  std::string name;

  static constexpr std::string_view type_name = "snapshot";
  static constexpr std::string_view type_meaning =
      "keeps the state under a name, and replaces a snapshot of that name; \"start\" is that of "
      "the "
      "beginning";
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&Snapshot::name>("name", "", {}, required, "of the snapshot; not \"start\""),
    };
    return table;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Errors run(SessionState& session, Json& /*answer*/) const override {
    Errors errors = check_name(name);
    if (name == start) errors.push_back({"/name", "this name belongs to the state at the start"});
    const bool is_new = !session.snapshots.contains(name);
    if (is_new && session.snapshots.size() >= session.limits.snapshots) {
      errors.push_back({"", fmt::format("there are {} snapshots, and no more are allowed; forget "
                                        "one",
                                        session.limits.snapshots)});
    }
    KeptSnapshot kept = session.keep();
    const std::size_t bytes = bytes_with(session, name, kept);
    if (bytes > session.limits.snapshot_bytes) {
      errors.push_back({"", fmt::format("all snapshots would have {} bytes; at most {} are "
                                        "allowed; forget one",
                                        bytes, session.limits.snapshot_bytes)});
    }
    if (errors.empty()) session.snapshots.insert_or_assign(name, std::move(kept));
    return errors;
  }
};

class Restore final : public Request {
 public:
  std::string name;

  static constexpr std::string_view type_name = "restore";
  static constexpr std::string_view type_meaning =
      "restores a snapshot, earlier or later, with time, controls and the memory of controllers "
      "and triggers; subscriptions stay";
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&Restore::name>("name", "", {}, required, "of the snapshot"),
    };
    return table;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Errors run(SessionState& session, Json& /*answer*/) const override {
    const auto found = session.snapshots.find(name);
    if (found == session.snapshots.end()) return {no_such_snapshot(session, name)};
    Errors errors = session.world.restore(found->second.snapshot);
    if (!errors.empty()) return errors;
    session.revision = found->second.revision;
    session.refresh();
    return {};
  }
};

class Forget final : public Request {
 public:
  std::string name;

  static constexpr std::string_view type_name = "forget";
  static constexpr std::string_view type_meaning = "deletes a snapshot";
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&Forget::name>("name", "", {}, required, "of the snapshot; not \"start\""),
    };
    return table;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Errors run(SessionState& session, Json& /*answer*/) const override {
    if (name == start) return {{"/name", "the state at the start is always kept"}};
    if (session.snapshots.erase(name) > 0) return {};
    return {no_such_snapshot(session, name)};
  }
};

}  // namespace

TypeEntry<Request> snapshot_request() { return request_entry<Snapshot>(); }
TypeEntry<Request> restore_request() { return request_entry<Restore>(); }
TypeEntry<Request> forget_request() { return request_entry<Forget>(); }

}  // namespace sheave::live
