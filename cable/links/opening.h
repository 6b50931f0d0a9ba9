#pragma once

#include "cable/link.h"

namespace sheave {

/// The cable passes an opening of a body, a ball or a cylinder, freely and by the shortest way: a
/// straight line if that line meets the shape, else a way that turns at the point of its surface at
/// which it is shortest. MuJoCo calls it an inside wrap. The links beside it must be points:
/// attachments or pinholes. A cylinder has no ends; a run warns where the cable passes beyond them.
class OpeningLink final : public LinkDef {
 public:
  /// Which of the body's shapes, from 0; it must be a sphere or a cylinder.
  int shape = 0;

  static constexpr std::string_view type_name = "opening";
  static constexpr std::string_view type_meaning =
      "the cable passes the inside of a ball or a cylinder, freely and by the shortest way";
  static std::span<const Field> field_table();

  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Result<LinkGeometry> compile(const BodySet& bodies,
                                             const std::string& path) const override;
};

}  // namespace sheave
