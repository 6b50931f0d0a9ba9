#pragma once
// Interface of all link types. A new link type is a file in cable/links/ and a line in
// cable/link_registry.cpp.

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "engine/body_id.h"
#include "engine/field.h"
#include "engine/result.h"

namespace sheave {

class BodySet;
struct LinkGeometry;

/// Direction in which a cable runs round a wheel, from the cable's first link to its last, as seen
/// from the tip of the normal of the link's plane.
enum class Winding { counter_clockwise, clockwise };
inline constexpr std::array<std::string_view, 2> winding_names{"counter-clockwise", "clockwise"};

/// Side of the cable's way on which a wheel lies, as seen from the tip of the normal of the link's
/// plane, with the way from the cable's first link to its last.
enum class Side {
  left,      ///< the cable runs counter-clockwise
  right,     ///< the cable runs clockwise
  shortest,  ///< the side on which the whole cable is shortest at time 0; not of surface links
};
inline constexpr std::array<std::string_view, 3> side_names{"left", "right", "shortest"};

/// The directions in which a link lets cable slide over it.
enum class Passage {
  both,
  forward,   ///< only from the cable's first link towards its last: a ratchet, a rope clutch
  backward,  ///< only from the last link towards the first
};
inline constexpr std::array<std::string_view, 3> passage_names{"both", "forward", "backward"};

/// Settings of one link of a cable; derived types add their own.
class LinkDef {
 public:
  virtual ~LinkDef() = default;

  BodyId body;  ///< the body the cable touches; default: the world

  /// The field table of the settings above.
  static std::span<const Field> common_field_table();
  [[nodiscard]] virtual std::string_view type() const = 0;  ///< key in the registry, e.g. "rolling"
  /// The body that the cable leaves behind the link: `body`, unless the link ends on another one.
  [[nodiscard]] virtual BodyId exit_body() const { return body; }
  /// this, as a pointer to the derived type
  [[nodiscard]] virtual const void* settings() const = 0;
  /// The link's geometry, or its faults. `path` is the prefix of their paths.
  [[nodiscard]] virtual Result<LinkGeometry> compile(const BodySet& bodies,
                                                     const std::string& path) const = 0;

 protected:
  LinkDef() = default;
  LinkDef(const LinkDef&) = default;
  LinkDef& operator=(const LinkDef&) = default;
};

/// The way that a passage blocks: +1 towards the cable's last link, -1 towards its first, 0 none.
[[nodiscard]] constexpr int blocked_way(Passage passes) {
  return passes == Passage::forward ? -1 : passes == Passage::backward ? 1 : 0;
}

/// +1 if the cable runs counter-clockwise, -1 if clockwise; +1 also for the shortest side, which
/// only the whole cable knows. An error unless exactly one of the two is given; `path` is that of
/// the link.
[[nodiscard]] Result<int> given_side(const std::optional<Winding>& winding,
                                     const std::optional<Side>& side, const std::string& path);

/// All link types, in the order of the documentation.
[[nodiscard]] std::span<const TypeEntry<LinkDef>> link_types();

}  // namespace sheave
