// Changes of cable ends: detach, attach, split, open and join.

#include <array>

#include "live/change.h"
#include "live/session_state.h"

namespace sheave::live {
namespace {

constexpr std::array<std::string_view, 2> end_names{"first", "last"};

class Detach final : public CableChange {
 public:
  CableEnd end = CableEnd::last;

  static constexpr std::string_view type_name = "detach";
  static constexpr std::string_view type_meaning =
      "detaches an end; at the end of the edit a loose end has left all links that do not hold it";
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&Detach::cable, Detach>("cable", "", {}, required, cable_meaning),
        choice_field<&Detach::end>("end", end_names, required, "the end"),
    };
    return table;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }

 protected:
  [[nodiscard]] Errors change(Edit& edit, CableHandle handle, EditNames& /*names*/) const override {
    edit.detach(handle, end);
    return {};
  }
};

class Attach final : public CableChange {
 public:
  CableEnd end = CableEnd::last;
  std::string body;
  Vector3 point = Vector3::Zero();

  static constexpr std::string_view type_name = "attach";
  static constexpr std::string_view type_meaning = "fixes a loose end to a point of a body";
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&Attach::cable, Attach>("cable", "", {}, required, cable_meaning),
        choice_field<&Attach::end>("end", end_names, required, "the end"),
        field<&Attach::body>("body", "", {}, required, "name of the body, or \"world\""),
        field<&Attach::point>("point", "m", any_number(), optional, "in the body's frame"),
    };
    return table;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }

 protected:
  [[nodiscard]] Errors change(Edit& edit, CableHandle handle, EditNames& names) const override {
    BodyId id = BodyId::world();
    if (body != "world") {
      const Result<BodyHandle> found = names.body(body);
      if (!found) return found.errors();
      id = edit.id(*found);
    }
    edit.attach(handle, end, id, point);
    return {};
  }
};

class Split final : public CableChange {
 public:
  int span = 0;
  double share = 0.5;
  std::string name;

  static constexpr std::string_view type_name = "split";
  static constexpr std::string_view type_meaning =
      "makes two of a cable; one that is cut splits where it was cut";
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&Split::cable, Split>("cable", "", {}, required,
                                    "name of the cable; the piece from its first link on keeps it"),
        field<&Split::span>("span", "", at_least(0.0), required,
                            "the span in which it is split, behind this link, counted from 0"),
        field<&Split::share>("share", "", between(0.0, 1.0), optional,
                             "share of that span before the split; default: 0.5"),
        field<&Split::name>("name", "", {}, required, "name of the other piece"),
    };
    return table;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }

 protected:
  [[nodiscard]] Errors change(Edit& edit, CableHandle handle, EditNames& names) const override {
    Errors errors = check_name(name);
    if (!errors.empty()) return errors;
    const CableHandle rest = edit.split(handle, span, share, name);
    names.add(rest, name);
    names.tell_part(part_path("cables", rest), "", false);
    return {};
  }
};

class Open final : public CableChange {
 public:
  int span = 0;
  double share = 0.5;

  static constexpr std::string_view type_name = "open";
  static constexpr std::string_view type_meaning =
      "makes an open cable with two loose ends of a belt; one that is cut opens where it was cut";
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&Open::cable, Open>("cable", "", {}, required, "name of the belt"),
        field<&Open::span>("span", "", at_least(0.0), required,
                           "the span in which it is opened, behind this link, counted from 0"),
        field<&Open::share>("share", "", between(0.0, 1.0), optional,
                            "share of that span before the opening; default: 0.5"),
    };
    return table;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }

 protected:
  [[nodiscard]] Errors change(Edit& edit, CableHandle handle, EditNames& /*names*/) const override {
    edit.open(handle, span, share);
    return {};
  }
};

class Join final : public CableChange {
 public:
  std::string next;

  static constexpr std::string_view type_name = "join";
  static constexpr std::string_view type_meaning =
      "joins the loose last end of a cable to the loose first end of another, which is then part "
      "of it; a cable that is joined to itself becomes a belt";
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&Join::cable, Join>("cable", "", {}, required, cable_meaning),
        field<&Join::next>("next", "", {}, required, "name of the other cable, or of the same"),
    };
    return table;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }

 protected:
  [[nodiscard]] Errors change(Edit& edit, CableHandle handle, EditNames& names) const override {
    const Result<CableHandle> second = names.cable(next, "/next");
    if (!second) return second.errors();
    edit.join(handle, *second);
    return {};
  }
};

}  // namespace

TypeEntry<EditChange> detach_change() { return change_entry<Detach>(); }
TypeEntry<EditChange> attach_change() { return change_entry<Attach>(); }
TypeEntry<EditChange> split_change() { return change_entry<Split>(); }
TypeEntry<EditChange> open_change() { return change_entry<Open>(); }
TypeEntry<EditChange> join_change() { return change_entry<Join>(); }

}  // namespace sheave::live
