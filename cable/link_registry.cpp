// The link types: one line each.

#include "cable/links/attachment.h"
#include "cable/links/pinhole.h"
#include "cable/links/rolling.h"

namespace sheave {

std::span<const TypeEntry<LinkDef>> link_types() {
  static const std::array types{
      type_entry<LinkDef, AttachmentLink>(),
      type_entry<LinkDef, RollingLink>(),
      type_entry<LinkDef, PinholeLink>(),
  };
  return types;
}

}  // namespace sheave
