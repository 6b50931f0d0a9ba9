#pragma once
// Makes the tables of a format from field tables and registries.

#include <memory>
#include <span>
#include <vector>

#include "scenes/format.h"

namespace sheave {

/// The table of a plain struct.
template <class Type>
TableFormat table_of() {
  return {Type::field_table(), std::make_shared<const Type>()};
}

/// The types of a registry.
template <class Base>
std::vector<Variant> variants_of(std::span<const TypeEntry<Base>> types) {
  std::vector<Variant> variants;
  for (const TypeEntry<Base>& type : types) {
    const std::shared_ptr<const Base> made = type.make();
    // Shares ownership of the object but points to its derived type.
    const std::shared_ptr<const void> settings(made, made->settings());
    variants.push_back({type.name, type.meaning, {type.fields(), settings}});
  }
  return variants;
}

/// The table common to all types of a registry, with one of them as the default object.
template <class Base>
TableFormat common_table(std::span<const TypeEntry<Base>> types) {
  if (types.empty()) return {Base::common_field_table(), nullptr};
  const std::shared_ptr<const Base> made = types.front().make();
  return {Base::common_field_table(), made};
}

}  // namespace sheave
