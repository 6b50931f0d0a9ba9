// Carries out several changes of an edit together.

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
      "changes the parts of the world: all of the changes or, if one is impossible, none; the "
      "answer "
      "has the effects on energy and on the lengths of cables";
  static std::span<const Field> field_table() { return {}; }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] std::span<const Member> members() const override {
    static const std::array<Member, 1> lists{
        {{"changes", "the changes, in order", true, &change_format(), true}}};
    return lists;
  }
  void read_members(json::NodeId node, PartReader& parts, const Names& names) override;
  [[nodiscard]] std::vector<AnswerKey> answer_keys() const override { return consequence_keys(); }
  [[nodiscard]] Errors run(SessionState& session, Json& answer) const override;

 private:
  /// Applies all changes to the edit; returns the faults of single ones.
  [[nodiscard]] Errors apply(Edit& edit, EditNames& names) const;

  std::vector<std::unique_ptr<EditChange>> changes_;
};

void EditRequest::read_members(json::NodeId node, PartReader& parts, const Names& names) {
  EditReader reader(parts, names);
  const Member& member = members().front();
  for (const json::NodeId element : reader.fields().list(node, member)) {
    const Variant* variant = reader.fields().read_type(element, *member.format);
    if (variant == nullptr) continue;
    for (const TypeEntry<EditChange>& type : change_types()) {
      if (type.name != variant->name) continue;
      std::unique_ptr<EditChange> made = type.make();
      // The change was created here and is not constant; settings() only gives its derived type.
      void* settings = const_cast<void*>(made->settings());  // NOLINT(*-const-cast)
      reader.fields().read_object(element, *member.format, {}, variant, settings);
      made->read(element, reader);
      changes_.push_back(std::move(made));
    }
  }
}

Errors EditRequest::apply(Edit& edit, EditNames& names) const {
  Errors faults;
  std::size_t told = 0;
  for (std::size_t i = 0; i < changes_.size(); ++i) {
    const std::string pointer = fmt::format("/changes/{}", i);
    names.begin(pointer);
    for (Error& error : changes_[i]->apply(edit, names)) {
      faults.push_back({pointer + error.path, std::move(error.message)});
    }
    for (; told < edit.errors().size(); ++told) {
      faults.push_back({pointer, edit.errors()[told].message});
    }
  }
  for (Error& error : names.shared_names()) {
    faults.push_back({names.pointer_of(error.path), std::move(error.message)});
  }
  return faults;
}

Errors EditRequest::run(SessionState& session, Json& answer) const {
  std::size_t added = 0;
  for (const auto& change : changes_) added += change->parts();
  if (added > 0 && session.part_count() + added > session.limits.parts) {
    return {{"/changes", fmt::format("the world would have {} parts: at most {} are allowed",
                                     session.part_count() + added, session.limits.parts)}};
  }
  Errors faults;
  std::vector<CableHandle> before = session.world.cables();
  std::vector<std::string> cable_names;
  for (const CableHandle cable : before) cable_names.push_back(*session.world.name(cable));
  EditNames names(session.world, session.names);
  const Result<EditReport> done = session.world.edit([&](Edit& edit) {
    faults = apply(edit, names);
    if (!faults.empty()) edit.fail("not all changes are possible, so none was made");
  });
  if (!faults.empty()) return faults;
  if (!done) {
    for (const Error& error : done.errors()) {
      faults.push_back({names.pointer_of(error.path), error.message});
    }
    return faults;
  }
  session.revision = session.revisions++;
  session.refresh();
  answer["energy"] = done->energy.total();
  Json cables = Json::array();
  for (const EditReport::Cable& cable : done->cables) {
    const auto gone = std::find(before.begin(), before.end(), cable.cable);
    const Result<std::string> name = session.world.name(cable.cable);
    cables.push_back(
        {{"cable", name ? *name : cable_names[static_cast<std::size_t>(gone - before.begin())]},
         {"added", cable.added}});
  }
  answer["cables"] = std::move(cables);
  return {};
}

}  // namespace

TypeEntry<Request> edit_request() { return request_entry<EditRequest>(); }

}  // namespace sheave::live
