// Changes of a cable's length and links.

#include <array>

#include "live/change.h"

namespace sheave::live {
namespace {

class PayOut final : public CableChange {
 public:
  int span = 0;
  double length = 0.0;

  static constexpr std::string_view type_name = "pay_out";
  static constexpr std::string_view type_meaning = "adds cable to a span, or removes cable";
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&PayOut::cable, PayOut>("cable", "", {}, required, cable_meaning),
        field<&PayOut::span>("span", "", at_least(0.0), required,
                             "the span behind this link, counted from 0"),
        field<&PayOut::length>("length", "m", any_number(), required,
                               "length added; below 0: removed"),
    };
    return table;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }

 protected:
  [[nodiscard]] Errors change(Edit& edit, CableHandle handle, EditNames& /*names*/) const override {
    edit.pay_out(handle, span, length);
    return {};
  }
};

class RemoveLink final : public CableChange {
 public:
  int link = 0;

  static constexpr std::string_view type_name = "remove_link";
  static constexpr std::string_view type_meaning =
      "removes a link between the ends of a cable; the cable on it comes to the span";
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&RemoveLink::cable, RemoveLink>("cable", "", {}, required, cable_meaning),
        field<&RemoveLink::link>("link", "", at_least(0.0), required, "number of the link, from 0"),
    };
    return table;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }

 protected:
  [[nodiscard]] Errors change(Edit& edit, CableHandle handle, EditNames& /*names*/) const override {
    edit.remove_link(handle, link);
    return {};
  }
};

}  // namespace

TypeEntry<EditChange> pay_out_change() { return change_entry<PayOut>(); }
TypeEntry<EditChange> remove_link_change() { return change_entry<RemoveLink>(); }

}  // namespace sheave::live
