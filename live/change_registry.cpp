// The changes: one line each.

#include <array>

#include "live/change.h"
#include "scenes/format_tables.h"

namespace sheave::live {

std::span<const TypeEntry<EditChange>> change_types() {
  static const std::array types{
      add_body_change(),     add_joint_change(),    add_cable_change(),
      add_collider_change(), change_body_change(),  remove_body_change(),
      remove_joint_change(), remove_cable_change(), remove_collider_change(),
      detach_change(),       attach_change(),       split_change(),
      open_change(),         join_change(),         pay_out_change(),
      insert_link_change(),  remove_link_change(),  set_step_change(),
  };
  return types;
}

const ObjectFormat& change_format() {
  static const ObjectFormat format = [] {
    ObjectFormat made{"change", "a change of the parts of the world", false, {}, {}, {}, {}};
    for (Variant& variant : made.variants = variants_of(change_types())) {
      for (const TypeEntry<EditChange>& type : change_types()) {
        if (type.name != variant.name) continue;
        const std::unique_ptr<EditChange> change = type.make();
        variant.members.assign(change->members().begin(), change->members().end());
      }
    }
    return made;
  }();
  return format;
}

}  // namespace sheave::live
