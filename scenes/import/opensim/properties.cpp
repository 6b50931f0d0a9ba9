#include "scenes/import/opensim/properties.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "scenes/import/attributes.h"

namespace sheave::import::opensim {
namespace {

/// Elements that concern pictures or bookkeeping alone.
bool is_silent(std::string_view tag) {
  static constexpr std::array<std::string_view, 18> silent{"Appearance",
                                                           "FrameGeometry",
                                                           "frame_geometry",
                                                           "SurfaceProperties",
                                                           "groups",
                                                           "credits",
                                                           "publications",
                                                           "display_preference",
                                                           "motion_type",
                                                           "is_free_to_satisfy_constraints",
                                                           "prescribed_function",
                                                           "min_control",
                                                           "max_control",
                                                           "scale_factors",
                                                           "default_acceleration_value",
                                                           "display",
                                                           "default_color",
                                                           "VisibleObject"};
  return std::find(silent.begin(), silent.end(), tag) != silent.end();
}

bool is_look(std::string_view tag) {
  return tag == "attached_geometry" || tag == "GeometrySet" || tag == "geometry_files";
}

/// Whether a value says that a property has no effect.
bool is_nothing(std::string_view text) {
  return text.empty() || text == "false" || text == "NaN" || text == "0" || text == "Unassigned";
}

}  // namespace

void Properties::set_defaults(const xml::Element& defaults) {
  for (const xml::Element& object : defaults.children) defaults_.emplace(object.tag, &object);
  log_.same(defaults, "values of properties that an object does not give");
}

const xml::Element* Properties::child(const xml::Element& of, std::string_view tag) {
  const auto find = [&](const xml::Element& in) {
    const auto found = std::find_if(in.children.begin(), in.children.end(),
                                    [&](const xml::Element& child) { return child.tag == tag; });
    return found == in.children.end() ? nullptr : &*found;
  };
  const xml::Element* found = find(of);
  if (found == nullptr) {
    const auto other = defaults_.find(of.tag);
    if (other != defaults_.end()) found = find(*other->second);
    if (found != nullptr && !found->children.empty()) found = nullptr;  // values, no parts
  }
  if (found != nullptr) mark(*found);
  return found;
}

const xml::Element* Properties::child(const xml::Element& of,
                                      std::initializer_list<std::string_view> tags) {
  for (const std::string_view tag : tags) {
    if (const xml::Element* found = child(of, tag)) return found;
  }
  return nullptr;
}

void Properties::error(const xml::Element& property, const std::string& rule, FaultCode code) {
  log_.error(property, "must be " + rule, property.text, code);
}

std::string Properties::text(const xml::Element& of, std::string_view tag) {
  const xml::Element* const found = child(of, tag);
  return found == nullptr ? std::string() : found->text;
}

std::vector<double> Properties::numbers(const xml::Element& of, std::string_view tag,
                                        std::size_t least, std::size_t most) {
  const xml::Element* const found = child(of, tag);
  if (found == nullptr) return {};
  std::optional<std::vector<double>> list = parse_numbers(found->text, most);
  if (list && list->size() >= least) return std::move(*list);
  const std::string count =
      least == most ? fmt::format("{}", most) : fmt::format("{} to {}", least, most);
  error(*found, fmt::format("{} finite number{} with blanks between", count, most == 1 ? "" : "s"),
        FaultCode::wrong_type);
  return {};
}

std::optional<double> Properties::number(const xml::Element& of, std::string_view tag) {
  const std::vector<double> list = numbers(of, tag, 1, 1);
  return list.empty() ? std::optional<double>() : list.front();
}

std::optional<double> Properties::positive(const xml::Element& of, std::string_view tag) {
  const std::optional<double> value = number(of, tag);
  if (!value || *value > 0.0) return value;
  error(*child(of, tag), "> 0", FaultCode::out_of_range);
  return {};
}

std::optional<Vector3> Properties::vector(const xml::Element& of, std::string_view tag) {
  const std::vector<double> list = numbers(of, tag, 3, 3);
  if (list.empty()) return {};
  return Vector3(list[0], list[1], list[2]);
}

bool Properties::flag(const xml::Element& of, std::string_view tag, bool otherwise) {
  const xml::Element* const found = child(of, tag);
  if (found == nullptr) return otherwise;
  std::string word = found->text;
  for (char& c : word) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  if (word == "true" || word == "1") return true;
  if (word == "false" || word == "0") return false;
  error(*found, "true or false", FaultCode::unknown_choice);
  return otherwise;
}

std::vector<const xml::Element*> Properties::objects(const xml::Element& of, std::string_view tag) {
  std::vector<const xml::Element*> list;
  const xml::Element* const set = child(of, tag);
  if (set == nullptr) return list;
  const xml::Element* const inner = child(*set, "objects");
  for (const xml::Element& object : (inner == nullptr ? set : inner)->children) {
    if (object.tag == "groups" || object.tag == "objects") continue;
    mark(object);
    list.push_back(&object);
  }
  return list;
}

void Properties::note_property(const xml::Element& property, std::string& unread) {
  if (is_silent(property.tag) || log_.has(property)) return;
  if (property.children.empty()) {
    if (is_nothing(property.text)) return;
    constexpr std::size_t longest = 300;
    if (unread.size() > longest) return;
    unread += (unread.empty() ? "" : ", ") + property.tag.substr(0, longest);
    return;
  }
  if (is_look(property.tag)) {
    log_.skipped(property, "looks have no counterpart");
    return;
  }
  // The objects of a set that was not read.
  const bool holds_set = property.children.front().tag == "objects";
  const xml::Element& set = holds_set ? property.children.front() : property;
  if (!holds_set && !property.tag.ends_with("Set")) {
    log_.skipped(property, "it has no counterpart");
    return;
  }
  for (const xml::Element& object : set.children) {
    if (object.tag != "groups" && object.tag != "objects") {
      log_.skipped(object, "it has no counterpart");
    }
  }
}

void Properties::note_unread(const xml::Element& root) {
  std::vector<const xml::Element*> open{&root};
  while (!open.empty()) {
    const xml::Element& element = *open.back();
    open.pop_back();
    std::string unread;
    for (const xml::Element& child : element.children) {
      if (read_.contains(&child)) {
        open.push_back(&child);
      } else {
        note_property(child, unread);
      }
    }
    if (!unread.empty()) log_.changed(element, "not taken: " + unread);
  }
}

}  // namespace sheave::import::opensim
