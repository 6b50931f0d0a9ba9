// Friction and feed speed: settings of one link of a cable.

#include <array>

#include "live/control.h"
#include "live/names.h"

namespace sheave::live {
namespace {

/// Names a link.
class LinkedControl : public Control {
 public:
  std::string cable;
  int link = 0;

 protected:
  template <class Set>
  [[nodiscard]] Errors with_cable(const Names& names, const Set& set) const {
    const Result<CableHandle> handle = names.cable(cable);
    return handle ? at_pointer(set(*handle), "") : handle.errors();
  }
  static constexpr std::string_view cable_meaning = "name of the cable";
  static constexpr std::string_view link_meaning = "number of the link, from 0";
};

class SetFriction final : public LinkedControl {
 public:
  double value = 0.0;

  static constexpr std::string_view type_name = "friction";
  static constexpr std::string_view type_meaning =
      "the friction of a link that has friction above 0";
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&SetFriction::cable, SetFriction>("cable", "", {}, required, cable_meaning),
        field<&SetFriction::link, SetFriction>("link", "", at_least(0.0), required, link_meaning),
        field<&SetFriction::value>("value", "", above(0.0), required, "capstan coefficient"),
    };
    return table;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Errors apply(LiveWorld& world, const Names& names) const override {
    return with_cable(names,
                      [&](CableHandle handle) { return world.set_friction(handle, link, value); });
  }
};

class SetFeedSpeed final : public LinkedControl {
 public:
  double value = 0.0;
  std::optional<double> over;

  static constexpr std::string_view type_name = "feed_speed";
  static constexpr std::string_view type_meaning =
      "feed speed of an attachment that has one, which may be 0";
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&SetFeedSpeed::cable, SetFeedSpeed>("cable", "", {}, required, cable_meaning),
        field<&SetFeedSpeed::link, SetFeedSpeed>("link", "", at_least(0.0), required, link_meaning),
        field<&SetFeedSpeed::value>("value", "m/s", any_number(), required, "speed"),
        field<&SetFeedSpeed::over>("over", "s", at_least(0.0), optional,
                                   "time to reach it; default: a step"),
    };
    return table;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Errors apply(LiveWorld& world, const Names& names) const override {
    DriveTarget wanted(value);
    wanted.over = over;
    return with_cable(
        names, [&](CableHandle handle) { return world.set_feed_speed(handle, link, wanted); });
  }
};

struct Friction {
  static constexpr std::string_view name = "friction";
  static constexpr std::string_view meaning = "the friction of a link";
  static constexpr auto clear = &LiveWorld::clear_friction;
};
struct FeedSpeed {
  static constexpr std::string_view name = "feed_speed";
  static constexpr std::string_view meaning = "the feed speed of an attachment";
  static constexpr auto clear = &LiveWorld::clear_feed_speed;
};

template <class Setting>
class ClearLink final : public LinkedControl {
 public:
  static constexpr std::string_view type_name = Setting::name;
  static constexpr std::string_view type_meaning = Setting::meaning;
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&ClearLink::cable, ClearLink>("cable", "", {}, required, cable_meaning),
        field<&ClearLink::link, ClearLink>("link", "", at_least(0.0), required, link_meaning),
    };
    return table;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Errors apply(LiveWorld& world, const Names& names) const override {
    return with_cable(names,
                      [&](CableHandle handle) { return (world.*Setting::clear)(handle, link); });
  }
};

}  // namespace

TypeEntry<Control> set_friction() { return control_entry<SetFriction>(); }
TypeEntry<Control> clear_friction() { return control_entry<ClearLink<Friction>>(); }
TypeEntry<Control> set_feed_speed() { return control_entry<SetFeedSpeed>(); }
TypeEntry<Control> clear_feed_speed() { return control_entry<ClearLink<FeedSpeed>>(); }

}  // namespace sheave::live
