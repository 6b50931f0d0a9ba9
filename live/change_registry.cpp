// The changes: one line each.

#include <array>

#include "live/change.h"
#include "scenes/format_tables.h"

namespace sheave::live {

std::span<const TypeEntry<EditChange>> change_types() {
  static const std::array types{
      remove_body_change(), remove_joint_change(), remove_cable_change(),
      detach_change(),      attach_change(),       split_change(),
      join_change(),        pay_out_change(),      remove_link_change(),
  };
  return types;
}

const ObjectFormat& change_format() {
  static const ObjectFormat format{
      "change", "a change of what the world is made of", false, {}, variants_of(change_types()), {},
      {}};
  return format;
}

}  // namespace sheave::live
