// What the world is made of is changed, several things together.

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include <fmt/format.h>

#include "live/change.h"
#include "live/request.h"
#include "live/session_state.h"

namespace sheave::live {
namespace {

class EditRequest final : public Request {
 public:
  static constexpr std::string_view type_name = "edit";
  static constexpr std::string_view type_meaning =
      "changes what the world is made of, all of it or, if something cannot be, nothing; the "
      "answer "
      "tells what that does to energy and to the lengths of cables";
  static std::span<const Field> field_table() { return {}; }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] std::span<const Member> members() const override {
    static const std::array<Member, 1> lists{
        {{"changes", "what is changed, in order", true, &change_format(), true}}};
    return lists;
  }
  void read_members(const json::Document& document, json::NodeId node,
                    FieldReader& reader) override;
  [[nodiscard]] Errors run(SessionState& session, Json& answer) const override;

 private:
  std::vector<std::unique_ptr<EditChange>> changes_;
};

void EditRequest::read_members(const json::Document& /*document*/, json::NodeId node,
                               FieldReader& reader) {
  const Member& member = members().front();
  for (const json::NodeId element : reader.list(node, member)) {
    const Variant* variant = reader.read_type(element, *member.format);
    if (variant == nullptr) continue;
    for (const TypeEntry<EditChange>& type : change_types()) {
      if (type.name != variant->name) continue;
      std::unique_ptr<EditChange> made = type.make();
      // The change is ours and not constant; settings() is only the way to its own type.
      void* settings = const_cast<void*>(made->settings());  // NOLINT(*-const-cast)
      reader.read_object(element, *member.format, {}, variant, settings);
      changes_.push_back(std::move(made));
    }
  }
}

Errors EditRequest::run(SessionState& session, Json& answer) const {
  Errors faults;
  std::vector<CableHandle> before = session.world.cables();
  std::vector<std::string> names;
  for (const CableHandle cable : before) names.push_back(*session.world.name(cable));
  const Result<EditReport> done = session.world.edit([&](Edit& edit) {
    EditNames known{session.names};
    std::size_t told = 0;
    for (std::size_t i = 0; i < changes_.size(); ++i) {
      const std::string pointer = fmt::format("/changes/{}", i);
      for (Error& error : changes_[i]->apply(edit, known)) {
        faults.push_back({pointer + error.path, std::move(error.message)});
      }
      for (; told < edit.errors().size(); ++told) {
        faults.push_back({pointer, edit.errors()[told].message});
      }
    }
    if (!faults.empty()) edit.fail("not all of it can be done");
  });
  if (!faults.empty()) return faults;
  if (!done) {
    for (const Error& error : done.errors()) faults.push_back({"", error.message});
    return faults;
  }
  session.refresh();
  answer["energy"] = done->energy.total();
  Json cables = Json::array();
  for (const EditReport::Cable& cable : done->cables) {
    const auto gone = std::find(before.begin(), before.end(), cable.cable);
    const Result<std::string> name = session.world.name(cable.cable);
    cables.push_back(
        {{"cable", name ? *name : names[static_cast<std::size_t>(gone - before.begin())]},
         {"added", cable.added}});
  }
  answer["cables"] = std::move(cables);
  return {};
}

}  // namespace

TypeEntry<Request> edit_request() { return request_entry<EditRequest>(); }

}  // namespace sheave::live
