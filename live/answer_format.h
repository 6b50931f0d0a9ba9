#pragma once
// Formats of the output, answers and events, for the schema and the reference. Later versions may
// add keys to objects, so readers must ignore keys that they do not know.

#include <span>
#include <string_view>
#include <vector>

#include "engine/field.h"

namespace sheave::live {

struct AnswerFormat;

/// The value of a key of an answer.
struct AnswerValue {
  enum class Kind {
    number,
    number_or_null,  ///< null if it is beyond the range of numbers
    integer,
    boolean,
    text,             ///< one of `words`, if there are any
    vector,           ///< [x, y, z]
    quaternion,       ///< [w, x, y, z]
    texts,            ///< a list of strings
    object,           ///< of `format`
    objects,          ///< a list of objects of `format`
    numbers_by_name,  ///< an object with numbers; null for an unknown one
    objects_by_name,  ///< an object with objects of `format`; null for a removed one
  };
  Kind kind = Kind::text;
  std::string_view unit{};
  std::span<const std::string_view> words{};
  const AnswerFormat* format = nullptr;
};

/// A key of an answer, an event, or an object in one.
struct AnswerKey {
  std::string_view name;
  AnswerValue value;
  std::string_view meaning;
  Presence presence = required;  ///< whether it is always there
};

/// An object of the output.
struct AnswerFormat {
  std::string_view name;
  std::string_view meaning;
  std::vector<AnswerKey> keys;
};

/// The keys with which every answer begins; "ok" says whether the request was done.
[[nodiscard]] const AnswerFormat& answer_head_format();
/// The additional keys of an answer with "ok": false.
[[nodiscard]] const AnswerFormat& refusal_format();
/// Change of a cable's length.
[[nodiscard]] const AnswerFormat& length_change_format();
/// "values" and "poses", as far as they were requested.
[[nodiscard]] std::vector<AnswerKey> reading_keys();
/// Effects of a placement or an edit: "energy" and "cables".
[[nodiscard]] std::vector<AnswerKey> consequence_keys();
/// All events, each with all its keys; their names are the values of "event".
[[nodiscard]] std::span<const AnswerFormat> event_formats();

}  // namespace sheave::live
