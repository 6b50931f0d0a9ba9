#pragma once

#include "cable/links/wheel_link.h"

namespace sheave {

/// A cable end that is wound onto a wheel as long as cable is stored there. When the cable is used
/// up, the end is fixed to its point of the rim. When the wheel or the span turns so far that the
/// cable would pass through the wheel, the cable is wound up again, to either side (paper, section
/// 4.1).
class HybridLink final : public WheelLink {
 public:
  double stored_length = 0.0;  ///< cable on the wheel at time 0 [m], >= 0

  static constexpr std::string_view type_name = "hybrid";
  static constexpr std::string_view type_meaning =
      "an end of the cable is wound onto a round wheel until it is used up, then fixed to its rim";
  static std::span<const Field> field_table();

  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Result<LinkGeometry> compile(const BodySet& bodies,
                                             const std::string& path) const override;
};

}  // namespace sheave
