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

void Names::Index::add(std::string_view name) {
  places.emplace(name, static_cast<int>(names.size()));
  names.push_back(name);
}

int Names::Index::find(std::string_view name) const {
  const auto found = places.find(name);
  return found == places.end() ? -1 : found->second;
}

Names::Names(const LiveWorld& world) : world_(world) {
  const Model& model = world.simulation().world.model();
  for (const BodyDef& body : model.bodies) bodies_.add(body.name);
  for (const auto& joint : model.joints) joints_.add(joint->name);
  for (const CableDef& cable : *world.simulation().cable_definitions) cables_.add(cable.name);
}

Result<BodyHandle> Names::body(const std::string& name, const std::string& pointer) const {
  const int place = bodies_.find(name);
  if (place >= 0) return world_.body_at(place);
  return no_such("body", name, bodies_.names, pointer);
}

Result<JointHandle> Names::joint(const std::string& name, const std::string& pointer) const {
  const int place = joints_.find(name);
  if (place >= 0) return world_.joint_at(place);
  return no_such("joint", name, joints_.names, pointer);
}

Result<CableHandle> Names::cable(const std::string& name, const std::string& pointer) const {
  const int place = cables_.find(name);
  if (place >= 0) return world_.cable_at(place);
  return no_such("cable", name, cables_.names, pointer);
}

Result<int> Names::coordinate(JointHandle joint, const std::string& name) const {
  if (name.empty()) return 0;
  const auto coordinates = world_.simulation().world.model().joints[at(joint.slot)]->coordinates();
  std::vector<std::string_view> names;
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    if (coordinates[i].name == name) return static_cast<int>(i);
    names.push_back(coordinates[i].name);
  }
  return no_such("coordinate", name, names, "/coordinate");
}

}  // namespace sheave::live
