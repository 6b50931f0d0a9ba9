#pragma once
// Interface of all link types. A new link type is a file in cable/links/ and a line in
// cable/link_registry.cpp.

#include <array>
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

/// Settings of one link of a cable; derived types add their own.
class LinkDef {
 public:
  virtual ~LinkDef() = default;

  BodyId body;  ///< the body the cable touches; default: the world

  /// The field table of the settings above.
  static std::span<const Field> common_field_table();
  [[nodiscard]] virtual std::string_view type() const = 0;  ///< key in the registry, e.g. "rolling"
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

/// All link types, in the order of the documentation.
[[nodiscard]] std::span<const TypeEntry<LinkDef>> link_types();

}  // namespace sheave
