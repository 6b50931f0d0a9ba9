// Default classes and childclass.

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "scenes/import/mjcf/reader.h"

namespace sheave::import::mjcf {
namespace {

constexpr std::array<std::string_view, 12> actuator_kinds{
    "general",  "motor",  "position", "velocity", "intvelocity", "damper",
    "cylinder", "muscle", "adhesion", "plugin",   "pid",         "dcmotor"};

/// Settings of an actuator that all its kinds share; MuJoCo keeps one default for all of them.
constexpr std::array<std::string_view, 10> shared_settings{
    "ctrllimited", "ctrlrange",   "forcelimited", "forcerange", "gear",
    "group",       "lengthrange", "actlimited",   "actrange",   "cranklength"};

void enter(const xml::Element& from, DefaultValues& values) {
  for (const xml::Attribute& attribute : from.attributes) {
    if (attribute.name != "class") values[attribute.name] = attribute.value;
  }
}

}  // namespace

void Defaults::read(const xml::Element& element, Log& log) {
  const std::string* const name = element.value("class");
  const auto main = classes_.find("main");
  read_class(element, name == nullptr ? "main" : *name,
             main == classes_.end() ? Class() : main->second, log);
}

void Defaults::read_class(const xml::Element& element, const std::string& name, const Class& outer,
                          Log& log) {
  Class own = outer;
  for (const xml::Element& child : element.children) {
    if (child.tag == "default") continue;
    const bool actuator =
        std::find(actuator_kinds.begin(), actuator_kinds.end(), child.tag) != actuator_kinds.end();
    enter(child, own[child.tag]);
    if (!actuator) continue;
    for (const xml::Attribute& attribute : child.attributes) {
      if (std::find(shared_settings.begin(), shared_settings.end(), attribute.name) ==
          shared_settings.end())
        continue;
      for (const std::string_view kind : actuator_kinds) {
        own[std::string(kind)][attribute.name] = attribute.value;
      }
    }
  }
  if (name != "main" && classes_.contains(name)) {
    log.error(element, fmt::format("there is another class \"{}\"", name), {},
              FaultCode::duplicate_name);
    return;
  }
  classes_[name] = own;
  log.same(element, fmt::format("class \"{}\"", name));
  for (const xml::Element& child : element.children) {
    if (child.tag != "default") continue;
    const std::string* const inner = child.value("class");
    if (inner == nullptr) {
      log.error(child, "\"class\" is missing; a class within another one needs a name", {},
                FaultCode::missing_key);
      continue;
    }
    read_class(child, *inner, own, log);
  }
}

const DefaultValues* Defaults::of(const xml::Element& element, std::string_view kind,
                                  const std::string& child_class, Log& log) const {
  const std::string* const given = element.value("class");
  const std::string& name = given != nullptr ? *given : child_class;
  const auto found = classes_.find(name.empty() ? "main" : name);
  if (found == classes_.end()) {
    if (name.empty() || name == "main") return nullptr;
    log.error(element, fmt::format("there is no default class \"{}\"", name), {},
              FaultCode::meaning);
    return nullptr;
  }
  const auto values = found->second.find(kind);
  return values == found->second.end() ? nullptr : &values->second;
}

int Reader::find(const std::unordered_map<std::string, int>& names, const xml::Element& element,
                 std::string_view attribute, std::string_view kind) const {
  const std::string* const name = element.value(attribute);
  if (name == nullptr) {
    log.error(element, fmt::format("\"{}\" is missing", attribute), {}, FaultCode::missing_key);
    return -1;
  }
  const auto found = names.find(*name);
  if (found != names.end()) return found->second;
  log.error(element, fmt::format("there is no {} of this name", kind), *name, FaultCode::meaning);
  return -1;
}

void Reader::enter(std::unordered_map<std::string, int>& names, const std::string& name, int number,
                   const xml::Element& element) const {
  if (name.empty() || names.emplace(name, number).second) return;
  log.error(element, "another element of its kind has the same name", name,
            FaultCode::duplicate_name);
}

std::optional<std::array<double, 2>> read_range(Attributes& attributes, bool automatic,
                                                std::string_view range_name,
                                                std::string_view limited_name) {
  const auto limited = attributes.choice(limited_name, {"true", "false", "auto"});
  const auto numbers = attributes.numbers(range_name, 2, 2);
  const bool counts = limited == "true" || (limited != "false" && automatic);
  if (!counts) return {};
  if (numbers.empty()) {
    if (limited == "true" && !attributes.has(range_name)) {
      attributes.error(range_name, "given, because the element is limited", FaultCode::missing_key);
    }
    return {};
  }
  if (!(numbers[0] < numbers[1])) {
    attributes.error(range_name, "two numbers, the smaller one first", FaultCode::out_of_range);
    return {};
  }
  return std::array<double, 2>{numbers[0], numbers[1]};
}

}  // namespace sheave::import::mjcf
