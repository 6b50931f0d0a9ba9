#pragma once
// Texts that a scene puts into its pictures, films and pages.

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/body_id.h"
#include "engine/field.h"
#include "engine/result.h"
#include "engine/vector.h"

namespace sheave {

struct AnnotationDef {
  enum class Kind {
    title,    ///< upper left, in place of the scene's name
    caption,  ///< below the machine, in several lines if it is long
    arrow,    ///< beside a point, with an arrow to it
  };
  static constexpr std::array<std::string_view, 3> kind_names{"title", "caption", "arrow"};

  Kind kind = Kind::caption;
  std::string text;                 ///< UTF-8, one line of 1 to most_bytes bytes
  BodyId body;                      ///< arrow: the body with the point
  Vector3 point = Vector3::Zero();  ///< arrow: in the frame of the body [m]
  double from = 0.0;                ///< first time of the text [s], >= 0
  std::optional<double> to;         ///< last time [s], >= from; default: the end

  static constexpr std::size_t most_bytes = 400;

  static std::span<const Field> field_table();
  /// Faults; `path` is the JSON pointer of the annotation.
  [[nodiscard]] Errors validate(const std::string& path) const;
  [[nodiscard]] bool is_shown(double time) const;
};

/// The title (or caption) at a time [s]: the last one in the list that is shown; empty: none.
[[nodiscard]] std::string_view shown_text(std::span<const AnnotationDef> annotations,
                                          AnnotationDef::Kind kind, double time);

}  // namespace sheave
