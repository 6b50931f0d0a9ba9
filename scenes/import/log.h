#pragma once
// Faults and notes of one import, as they are found.

#include <string>
#include <unordered_map>
#include <utility>

#include "scenes/import/import.h"
#include "scenes/import/xml.h"

namespace sheave::import {

/// Collects errors up to a limit, notes and origins. There is one note per element, with the worst
/// kind and all texts.
class Log {
 public:
  explicit Log(const Limits& limits) : limits_(limits) {}

  void error(const xml::Element& at, std::string message, std::string value = {},
             FaultCode code = FaultCode::meaning);
  void same(const xml::Element& at, std::string text) { note(Taken::same, at, std::move(text)); }
  void changed(const xml::Element& at, std::string text) {
    note(Taken::changed, at, std::move(text));
  }
  void skipped(const xml::Element& at, std::string text) {
    note(Taken::skipped, at, std::move(text));
  }
  /// Records that the part of the scene at `pointer` is made from the element.
  void origin(const xml::Element& at, std::string pointer);

  /// Whether there is a note about the element.
  [[nodiscard]] bool has(const xml::Element& at) const { return noted_.contains(&at); }
  [[nodiscard]] bool failed() const { return !outcome_.errors.empty(); }
  /// The outcome so far, with its notes in the order of the text.
  [[nodiscard]] Outcome take();

 private:
  void note(Taken kind, const xml::Element& at, std::string text);

  Limits limits_;
  std::size_t omitted_ = 0;
  Outcome outcome_;
  std::unordered_map<const xml::Element*, std::size_t> noted_;  // to the index of the note
};

/// The element with its name, for messages: joint "elbow", or its tag alone.
[[nodiscard]] std::string label(const xml::Element& element);

}  // namespace sheave::import
