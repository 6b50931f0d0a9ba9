#pragma once
// The formats of what comes out: answers and events, for the schema and for the reference. Objects
// that come out may get further keys in later versions of the program, so what reads them ignores
// those that it does not know.

#include <span>
#include <string_view>
#include <vector>

#include "engine/field.h"

namespace sheave::live {

struct AnswerFormat;

/// What a key of an answer may hold.
struct AnswerValue {
  enum class Kind {
    number,
    number_or_null,  ///< null where it is beyond the range of numbers
    integer,
    boolean,
    text,             ///< one of `words`, if there are any
    vector,           ///< [x, y, z]
    quaternion,       ///< [w, x, y, z]
    texts,            ///< a list of strings
    object,           ///< of `format`
    objects,          ///< a list of them
    numbers_by_name,  ///< an object with numbers, or null for what is not known
    objects_by_name,  ///< an object with objects of `format`, or null for what is no more
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

/// An object that comes out.
struct AnswerFormat {
  std::string_view name;
  std::string_view meaning;
  std::vector<AnswerKey> keys;
};

/// What every answer begins with; "ok" says whether the request was done.
[[nodiscard]] const AnswerFormat& answer_head_format();
/// What an answer with "ok": false has besides.
[[nodiscard]] const AnswerFormat& refusal_format();
/// By how much a cable is longer.
[[nodiscard]] const AnswerFormat& length_change_format();
/// "values" and "poses", as far as they were asked for.
[[nodiscard]] std::vector<AnswerKey> reading_keys();
/// What a change of place or of what there is does: "energy" and "cables".
[[nodiscard]] std::vector<AnswerKey> consequence_keys();
/// All events, each with all its keys; their names are the values of "event".
[[nodiscard]] std::span<const AnswerFormat> event_formats();

}  // namespace sheave::live
