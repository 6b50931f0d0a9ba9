// Openings of a cable at time 0: the links beside them, and the place at which the cable passes.

#include "cable/cable_compiler.h"
#include "cable/opening.h"
#include "engine/index.h"

namespace sheave {

void CableCompiler::check_openings(const CableDef& def) {
  const std::size_t count = links_.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (!links_[i].opening) continue;
    const std::string field = "/links/" + std::to_string(i);
    const std::string name = link_name(static_cast<int>(i));
    for (const std::size_t beside : {(i + count - 1) % count, (i + 1) % count}) {
      const LinkGeometry& other = links_[beside];
      if (!other.wraps() && !other.hybrid && !other.sheath && !other.opening) continue;
      fail(field, name +
                      " is an opening, and the links beside it must be points; put a "
                      "\"pinhole\" between it and " +
                      link_name(static_cast<int>(beside)));
      break;
    }
    if (def.most_wraps > 0 && any_wrappable()) {
      fail("/most_wraps", "a cable through an opening, such as " + name +
                              ", does not come to touch wrappable bodies; set most_wraps to 0");
    }
  }
}

void CableCompiler::lay_openings() {
  const std::size_t count = links_.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (!links_[i].opening) continue;
    settle_opening(*now_, links_[(i + count - 1) % count], links_[(i + 1) % count], links_[i]);
  }
}

}  // namespace sheave
