#include "scenes/annotation.h"

#include <algorithm>

#include <fmt/format.h>

namespace sheave {

std::span<const Field> AnnotationDef::field_table() {
  static const std::array table{
      choice_field<&AnnotationDef::kind>("kind", kind_names, required,
                                         "title: upper left, in place of the scene's name; "
                                         "caption: below the machine; arrow: beside a point, with "
                                         "an arrow to it"),
      field<&AnnotationDef::text>("text", "", {}, required,
                                  "one line of at most 400 bytes; a long title or caption is "
                                  "broken between words"),
      field<&AnnotationDef::body>("body", "", {}, optional, "arrow: the body with the point"),
      field<&AnnotationDef::point>("point", "m", any_number(), optional,
                                   "arrow: the point, in the frame of the body"),
      field<&AnnotationDef::from>("from", "s", at_least(0.0), optional, "first time of the text"),
      field<&AnnotationDef::to>("to", "s", at_least(0.0), optional,
                                "last time of the text; default: the end"),
  };
  return table;
}

Errors AnnotationDef::validate(const std::string& path) const {
  Errors errors;
  const auto fail = [&](std::string_view field, const std::string& message) {
    errors.push_back({fmt::format("{}/{}", path, field), "annotation: " + message});
  };
  if (text.empty() || text.size() > most_bytes) {
    fail("text", fmt::format("text has {} bytes; 1 to {} are allowed", text.size(), most_bytes));
  }
  const auto controls = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
  if (std::any_of(text.begin(), text.end(), controls)) {
    fail("text", "text has a line break or another control character; give one line");
  }
  if (to && *to < from) {
    fail("to",
         fmt::format("to is {} s, before from, {} s; the text would never be shown", *to, from));
  }
  if (kind != Kind::arrow && (!body.is_world() || point != Vector3::Zero())) {
    fail(body.is_world() ? "point" : "body",
         fmt::format("only an arrow has a body and a point, not a {}",
                     kind_names[static_cast<std::size_t>(kind)]));
  }
  return errors;
}

bool AnnotationDef::is_shown(double time) const {
  // Times of frames are sums of steps, so they have rounding errors.
  constexpr double rounding = 1e-9;
  return time >= from - rounding && (!to || time <= *to + rounding);
}

std::string_view shown_text(std::span<const AnnotationDef> annotations, AnnotationDef::Kind kind,
                            double time) {
  std::string_view text;
  for (const AnnotationDef& annotation : annotations) {
    if (annotation.kind == kind && annotation.is_shown(time)) text = annotation.text;
  }
  return text;
}

}  // namespace sheave
