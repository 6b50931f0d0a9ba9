#include "scenes/import/log.h"

#include <algorithm>
#include <tuple>

#include <fmt/format.h>

namespace sheave::import {

namespace {

/// A text from the model must not add lines to a report.
std::string in_one_line(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  }
  return text;
}

}  // namespace

std::string label(const xml::Element& element) {
  constexpr std::size_t most = 100;
  for (const xml::Attribute& attribute : element.attributes) {
    if (attribute.name != "name" && attribute.name != "model") continue;
    return in_one_line(
        fmt::format("{} \"{}\"", element.tag.substr(0, most), attribute.value.substr(0, most)));
  }
  return in_one_line(element.tag.substr(0, most));
}

void Log::error(const xml::Element& at, std::string message, std::string value, FaultCode code) {
  if (outcome_.errors.size() >= limits_.faults) {
    ++omitted_;
    return;
  }
  constexpr std::size_t most = 60;
  if (value.size() > most) value = value.substr(0, most) + "...";
  value = in_one_line(std::move(value));
  outcome_.errors.push_back({*at.file,
                             at.line,
                             1,
                             {},
                             in_one_line(label(at) + ": " + std::move(message)),
                             std::move(value),
                             {},
                             code});
}

void Log::note(Taken kind, const xml::Element& at, std::string text) {
  text = in_one_line(std::move(text));
  const auto [place, fresh] = noted_.emplace(&at, outcome_.notes.size());
  if (fresh) {
    outcome_.notes.push_back({kind, *at.file, at.line, label(at), std::move(text)});
    return;
  }
  Note& old = outcome_.notes[place->second];
  old.taken = std::max(old.taken, kind);
  if (old.text.find(text) == std::string::npos) old.text += "; " + text;
}

void Log::origin(const xml::Element& at, std::string pointer) {
  outcome_.origins.push_back({std::move(pointer), *at.file, at.line});
}

Outcome Log::take() {
  std::stable_sort(outcome_.notes.begin(), outcome_.notes.end(), [](const Note& a, const Note& b) {
    return std::tie(a.file, a.line) < std::tie(b.file, b.line);
  });
  if (omitted_ > 0) {
    SceneError last = outcome_.errors.back();
    last.message = fmt::format("{} further faults are not listed", omitted_);
    last.value.clear();
    outcome_.errors.push_back(std::move(last));
  }
  return std::move(outcome_);
}

}  // namespace sheave::import
