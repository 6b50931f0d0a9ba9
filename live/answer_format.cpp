#include "live/answer_format.h"

#include <array>

#include "cable/cable_report.h"
#include "live/session_state.h"
#include "scenes/fault_code.h"

namespace sheave::live {
namespace {

using ValueKind = AnswerValue::Kind;

/// The codes of faults; warnings have no answers.
std::span<const std::string_view> code_names() {
  static const std::vector<std::string_view> names = [] {
    std::vector<std::string_view> made;
    for (const CodeEntry& entry : code_table()) {
      if (entry.severity == "error") made.push_back(entry.code);
    }
    return made;
  }();
  return names;
}

const AnswerFormat& fault_format() {
  static const AnswerFormat format{
      "fault",
      "a fault of a request",
      {{"pointer",
        {ValueKind::text},
        "JSON pointer into the request; the key may be missing there"},
       {"column", {ValueKind::integer}, "column in the line, from 1"},
       {"code", {ValueKind::text, {}, code_names()}, "kind of the fault"},
       {"message", {ValueKind::text}, "the fault as a text"},
       {"value", {ValueKind::text}, "value in the line, shortened", optional},
       {"allowed", {ValueKind::text}, "allowed values", optional}}};
  return format;
}

const AnswerFormat& pose_format() {
  static const AnswerFormat format{
      "pose",
      "pose and velocity of a body",
      {{"position", {ValueKind::vector, "m"}, "of the origin of its frame"},
       {"orientation", {ValueKind::quaternion}, "of its frame"},
       {"velocity", {ValueKind::vector, "m/s"}, "of that origin"},
       {"angular_velocity", {ValueKind::vector, "rad/s"}, "of the body"}}};
  return format;
}

constexpr AnswerKey step_key{"step", {ValueKind::integer}, "at which the world is"};
constexpr AnswerKey time_key{"time", {ValueKind::number, "s"}, "of the world"};
constexpr AnswerKey subscription_key{"subscription", {ValueKind::text}, "for which it comes"};

std::vector<AnswerFormat> make_events() {
  static constexpr std::array<std::string_view, 1> joint_events{"break"};
  std::vector<AnswerKey> values{step_key, time_key, subscription_key};
  for (const AnswerKey& key : reading_keys()) values.push_back(key);
  return {
      {"values", "at steps that are multiples of a subscription's `every`", std::move(values)},
      {"cable",
       "something has happened to a cable; of a subscription to events",
       {step_key,
        {"time", {ValueKind::number, "s"}, "at which it happened, within the step"},
        subscription_key,
        {"cable", {ValueKind::text}, "its name"},
        {"kind", {ValueKind::text, {}, cable_event_names}, "kind of the event"},
        {"link", {ValueKind::integer}, "at which of its links; -1: a body that no list names"},
        {"body", {ValueKind::text}, "name of the link's body, or \"world\""}}},
      {"joint",
       "something has happened to a joint; of a subscription to events",
       {step_key,
        time_key,
        subscription_key,
        {"joint", {ValueKind::text}, "its name"},
        {"kind", {ValueKind::text, {}, joint_events}, "kind of the event"}}},
      {"warning",
       "something could not be done as asked, a warning of `sheave run`; of a subscription to "
       "events",
       {step_key,
        time_key,
        subscription_key,
        {"kind", {ValueKind::text}, "never changes its meaning, e.g. \"unconverged\""},
        {"subject", {ValueKind::text}, "a cable, a span; empty: the step as a whole"},
        {"message", {ValueKind::text}, "the same as a text"}}},
      {"omitted",
       "a step had more events of cables than are reported",
       {step_key,
        time_key,
        subscription_key,
        {"count", {ValueKind::integer}, "number of events that are not reported"}}},
      {"ended",
       "a world that runs by itself has stopped",
       {step_key,
        time_key,
        {"ended", {ValueKind::text, {}, std::span(ending_names).subspan(1)}, "why"},
        {"reason", {ValueKind::text}, "the same as a text"}}},
      {"dropped",
       "events were left out here, because they were not read",
       {{"count", {ValueKind::integer}, "how many"}}},
  };
}

}  // namespace

const AnswerFormat& answer_head_format() {
  static const AnswerFormat format{
      "answer",
      "keys with which every answer begins",
      {{"id", {ValueKind::number}, "as in the request, if it is there", optional},
       {"ok", {ValueKind::boolean}, "whether the request was done; otherwise nothing has changed"},
       step_key,
       time_key}};
  return format;
}

const AnswerFormat& refusal_format() {
  static const AnswerFormat format{
      "refusal",
      "further keys of an answer with `\"ok\":false`",
      {{"errors", {ValueKind::objects, {}, {}, &fault_format()}, "at least one"},
       {"omitted", {ValueKind::integer}, "further faults, which are not listed", optional}}};
  return format;
}

const AnswerFormat& length_change_format() {
  static const AnswerFormat format{"length change",
                                   "a cable whose length has changed, or that has come or gone",
                                   {{"cable", {ValueKind::text}, "its name"},
                                    {"added", {ValueKind::number, "m"}, "change of its length"}}};
  return format;
}

std::vector<AnswerKey> reading_keys() {
  return {
      {"values", {ValueKind::numbers_by_name}, "values of quantities; null: not known", optional},
      {"poses",
       {ValueKind::objects_by_name, {}, {}, &pose_format()},
       "poses of bodies; null: the body no longer exists",
       optional}};
}

std::vector<AnswerKey> consequence_keys() {
  return {{"energy",
           {ValueKind::number_or_null, "J"},
           "increase; null if the value before is beyond the range of numbers"},
          {"cables",
           {ValueKind::objects, {}, {}, &length_change_format()},
           "cables whose lengths have changed"}};
}

std::span<const AnswerFormat> event_formats() {
  static const std::vector<AnswerFormat> events = make_events();
  return events;
}

}  // namespace sheave::live
