#include "live/names.h"

#include <algorithm>

#include <fmt/format.h>

#include "engine/index.h"
#include "scenes/json/document.h"
#include "scenes/suggestion.h"

namespace sheave::live {
namespace {

// Comparing a word with more names than this takes longer than a user waits for a hint.
constexpr std::size_t most_suggestions = 5000;
constexpr std::size_t most_shown = 80;  // of a name

template <class List, class NameOf>
std::vector<std::string_view> names_of(const List& list, const NameOf& name_of) {
  std::vector<std::string_view> names;
  names.reserve(list.size());
  for (const auto& element : list) names.push_back(name_of(element));
  return names;
}

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

Result<BodyHandle> body_named(const LiveWorld& world, const std::string& name,
                              const std::string& pointer) {
  Result<BodyHandle> found = world.body(name);
  if (found) return found;
  return no_such("body", name,
                 names_of(world.simulation().world.model().bodies,
                          [](const BodyDef& body) -> std::string_view { return body.name; }),
                 pointer);
}

Result<JointHandle> joint_named(const LiveWorld& world, const std::string& name,
                                const std::string& pointer) {
  Result<JointHandle> found = world.joint(name);
  if (found) return found;
  return no_such("joint", name,
                 names_of(world.simulation().world.model().joints,
                          [](const auto& joint) -> std::string_view { return joint->name; }),
                 pointer);
}

Result<CableHandle> cable_named(const LiveWorld& world, const std::string& name,
                                const std::string& pointer) {
  Result<CableHandle> found = world.cable(name);
  if (found) return found;
  return no_such("cable", name,
                 names_of(*world.simulation().cable_definitions,
                          [](const CableDef& cable) -> std::string_view { return cable.name; }),
                 pointer);
}

Result<int> coordinate_named(const LiveWorld& world, JointHandle joint, const std::string& name) {
  const auto coordinates = world.simulation().world.model().joints[at(joint.slot)]->coordinates();
  if (name.empty()) return 0;
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    if (coordinates[i].name == name) return static_cast<int>(i);
  }
  return no_such("coordinate", name,
                 names_of(coordinates, [](const JointCoordinateInfo& info) { return info.name; }),
                 "/coordinate");
}

}  // namespace sheave::live
