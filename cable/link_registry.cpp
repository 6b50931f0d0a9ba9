// The link types: one line each.

#include "cable/links/attachment.h"
#include "cable/links/hybrid.h"
#include "cable/links/opening.h"
#include "cable/links/pinhole.h"
#include "cable/links/rolling.h"
#include "cable/links/sheath.h"
#include "cable/links/spool.h"
#include "cable/links/surface.h"

namespace sheave {

std::span<const TypeEntry<LinkDef>> link_types() {
  static const std::array types{
      type_entry<LinkDef, AttachmentLink>(), type_entry<LinkDef, RollingLink>(),
      type_entry<LinkDef, PinholeLink>(),    type_entry<LinkDef, HybridLink>(),
      type_entry<LinkDef, SpoolLink>(),      type_entry<LinkDef, SurfaceLink>(),
      type_entry<LinkDef, SheathLink>(),     type_entry<LinkDef, OpeningLink>(),
  };
  return types;
}

}  // namespace sheave
