// Compliance, breaking tension and friction on wrappable bodies: numbers of a whole cable.

#include <array>

#include "live/control.h"
#include "live/names.h"

namespace sheave::live {
namespace {

struct Compliance {
  static constexpr std::string_view name = "compliance";
  static constexpr std::string_view meaning =
      "the compliance of each span of a cable that has a compliance";
  static constexpr std::string_view unit = "m/N";
  static constexpr auto set = &LiveWorld::set_compliance;
  static constexpr auto clear = &LiveWorld::clear_compliance;
};
struct BreakingTension {
  static constexpr std::string_view name = "breaking_tension";
  static constexpr std::string_view meaning = "the tension at which a cable breaks";
  static constexpr std::string_view unit = "N";
  static constexpr auto set = &LiveWorld::set_breaking_tension;
  static constexpr auto clear = &LiveWorld::clear_breaking_tension;
};
struct WrapFriction {
  static constexpr std::string_view name = "wrap_friction";
  static constexpr std::string_view meaning =
      "the friction on wrappable bodies of a cable that has one above 0";
  static constexpr std::string_view unit{};
  static constexpr auto set = &LiveWorld::set_wrap_friction;
  static constexpr auto clear = &LiveWorld::clear_wrap_friction;
};

template <class Setting>
class SetCable final : public Control {
 public:
  std::string cable;
  double value = 0.0;

  static constexpr std::string_view type_name = Setting::name;
  static constexpr std::string_view type_meaning = Setting::meaning;
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&SetCable::cable>("cable", "", {}, required, "name of the cable"),
        field<&SetCable::value>("value", Setting::unit, above(0.0), required, "its new value"),
    };
    return table;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Errors apply(LiveWorld& world, const Names& names) const override {
    const Result<CableHandle> handle = names.cable(cable);
    return handle ? at_pointer((world.*Setting::set)(*handle, value), "") : handle.errors();
  }
};

template <class Setting>
class ClearCable final : public Control {
 public:
  std::string cable;

  static constexpr std::string_view type_name = Setting::name;
  static constexpr std::string_view type_meaning = Setting::meaning;
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&ClearCable::cable>("cable", "", {}, required, "name of the cable"),
    };
    return table;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Errors apply(LiveWorld& world, const Names& names) const override {
    const Result<CableHandle> handle = names.cable(cable);
    return handle ? at_pointer((world.*Setting::clear)(*handle), "") : handle.errors();
  }
};

}  // namespace

TypeEntry<Control> set_compliance() { return control_entry<SetCable<Compliance>>(); }
TypeEntry<Control> clear_compliance() { return control_entry<ClearCable<Compliance>>(); }
TypeEntry<Control> set_breaking_tension() { return control_entry<SetCable<BreakingTension>>(); }
TypeEntry<Control> clear_breaking_tension() { return control_entry<ClearCable<BreakingTension>>(); }
TypeEntry<Control> set_wrap_friction() { return control_entry<SetCable<WrapFriction>>(); }
TypeEntry<Control> clear_wrap_friction() { return control_entry<ClearCable<WrapFriction>>(); }

}  // namespace sheave::live
