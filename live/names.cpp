#include "live/names.h"

#include <algorithm>

#include <fmt/format.h>

#include "engine/index.h"
#include "scenes/json/document.h"
#include "scenes/suggestion.h"

namespace sheave::live {
namespace {

// Comparing a word with more names than this takes longer than a user waits for a suggestion.
constexpr std::size_t most_suggestions = 5000;
constexpr std::size_t most_shown = 80;  // of a name

}  // namespace

Error no_such(const std::string& what, const std::string& name,
              const std::vector<std::string_view>& names, const std::string& pointer) {
  const std::string start =
      fmt::format("there is no {} \"{}\"", what, json::shortened(name, most_shown));
  Suggestion suggestion(name);
  if (names.size() <= most_suggestions && name.size() <= most_shown) {
    for (const std::string_view candidate : names) suggestion.consider(candidate);
  }
  if (!suggestion.best().empty()) return {pointer, start + suggestion.question()};
  if (names.empty()) return {pointer, start + "; there is none"};
  constexpr std::size_t enough = 20;
  const auto end = names.begin() + static_cast<std::ptrdiff_t>(std::min(names.size(), enough));
  return {pointer, fmt::format("{}; allowed: {}{}", start, fmt::join(names.begin(), end, ", "),
                               names.size() > enough ? ", ..." : "")};
}

template <class Handle>
Result<Handle> Names::Index<Handle>::find(const char* what, const std::string& name,
                                          const std::string& pointer) const {
  const auto found = handles.find(name);
  if (found != handles.end()) return found->second;
  return no_such(what, name, {names.begin(), names.end()}, pointer);
}

Names::Names(const LiveWorld& world) : world_(world) { refresh(); }

void Names::refresh() {
  bodies_ = {};
  joints_ = {};
  cables_ = {};
  body_slots_ = 0;
  for (const BodyHandle body : world_.bodies()) {
    bodies_.add(*world_.name(body), body);
    body_slots_ = std::max(body_slots_, body.slot + 1);
  }
  for (const JointHandle joint : world_.joints()) joints_.add(*world_.name(joint), joint);
  for (const CableHandle cable : world_.cables()) cables_.add(*world_.name(cable), cable);
}

Result<BodyHandle> Names::body(const std::string& name, const std::string& pointer) const {
  return bodies_.find("body", name, pointer);
}

Result<JointHandle> Names::joint(const std::string& name, const std::string& pointer) const {
  return joints_.find("joint", name, pointer);
}

Result<CableHandle> Names::cable(const std::string& name, const std::string& pointer) const {
  return cables_.find("cable", name, pointer);
}

Result<int> Names::coordinate(JointHandle joint, const std::string& name) const {
  if (name.empty()) return 0;
  const auto coordinates = world_.definition(joint)->coordinates();
  std::vector<std::string_view> names;
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    if (coordinates[i].name == name) return static_cast<int>(i);
    names.push_back(coordinates[i].name);
  }
  return no_such("coordinate", name, names, "/coordinate");
}

}  // namespace sheave::live
