// Sets or clears several controls together.

#include <array>
#include <memory>
#include <vector>

#include <fmt/format.h>

#include "live/control.h"
#include "live/request.h"
#include "live/session_state.h"

namespace sheave::live {
namespace {

/// A request with a list of changes, all of which are made, or none.
class Change : public Request {
 public:
  void read_members(json::NodeId node, PartReader& parts, const Names& names) override;
  [[nodiscard]] std::vector<AnswerKey> answer_keys() const override {
    return {{"controls", {AnswerValue::Kind::integer}, "how many"}};
  }
  [[nodiscard]] Errors run(SessionState& session, Json& answer) const override;

 protected:
  [[nodiscard]] virtual std::span<const TypeEntry<Control>> controls() const = 0;

 private:
  std::vector<std::unique_ptr<Control>> changes_;
};

void Change::read_members(json::NodeId node, PartReader& parts, const Names& /*names*/) {
  FieldReader& reader = parts.fields();
  const Member& member = members().front();
  for (const json::NodeId element : reader.list(node, member)) {
    const Variant* variant = reader.read_type(element, *member.format);
    if (variant == nullptr) continue;
    for (const TypeEntry<Control>& type : controls()) {
      if (type.name != variant->name) continue;
      std::unique_ptr<Control> made = type.make();
      // The control was created here and is not constant; settings() only gives its derived type.
      void* settings = const_cast<void*>(made->settings());  // NOLINT(*-const-cast)
      reader.read_object(element, *member.format, {}, variant, settings);
      changes_.push_back(std::move(made));
    }
  }
}

Errors Change::run(SessionState& session, Json& answer) const {
  Errors errors = session.world.set_together([&] {
    Errors faults;
    for (std::size_t i = 0; i < changes_.size(); ++i) {
      for (Error& error : changes_[i]->apply(session.world, session.names)) {
        error.path.insert(0, fmt::format("/controls/{}", i));
        faults.push_back(std::move(error));
      }
    }
    return faults;
  });
  if (errors.empty()) answer["controls"] = changes_.size();
  return errors;
}

class Set final : public Change {
 public:
  static constexpr std::string_view type_name = "set";
  static constexpr std::string_view type_meaning =
      "sets controls, all of them or, if one cannot be, none; they hold until they are set again "
      "or cleared, and are part of the state";
  static std::span<const Field> field_table() { return {}; }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] std::span<const Member> members() const override {
    static const std::array<Member, 1> lists{
        {{"controls", "the controls, in order", true, &set_format(), true}}};
    return lists;
  }

 protected:
  [[nodiscard]] std::span<const TypeEntry<Control>> controls() const override {
    return set_types();
  }
};

class Clear final : public Change {
 public:
  static constexpr std::string_view type_name = "clear";
  static constexpr std::string_view type_meaning =
      "clears controls, all of them or none: they return to the values of the scene";
  static std::span<const Field> field_table() { return {}; }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] std::span<const Member> members() const override {
    static const std::array<Member, 1> lists{
        {{"controls", "the controls, in order", true, &clear_format(), true}}};
    return lists;
  }

 protected:
  [[nodiscard]] std::span<const TypeEntry<Control>> controls() const override {
    return clear_types();
  }
};

}  // namespace

TypeEntry<Request> set_request() { return request_entry<Set>(); }
TypeEntry<Request> clear_request() { return request_entry<Clear>(); }

}  // namespace sheave::live
