#include "scenes/field_reader.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "scenes/suggestion.h"

namespace sheave {
namespace {

using json::Kind;
using json::NodeId;
using json::no_node;

// Comparing a word with more names than this takes longer than a user waits for a hint.
constexpr std::size_t max_suggestions = 5000;

std::string quoted(std::string_view text) { return fmt::format("\"{}\"", text); }

}  // namespace

/// Reads one value into the slot of its field; one overload per type of slot.
struct FieldReader::Value {
  FieldReader& reader;
  const Field& field;
  NodeId node;

  [[nodiscard]] const json::Document& document() const { return reader.document_; }
  [[nodiscard]] bool is(Kind kind) const { return document().kind(node) == kind; }

  void wrong_type(const FieldSlot& slot) const {
    const std::string wanted = describe(field, slot);
    reader.fail(node, "must be " + wanted, wanted);
  }

  /// Reads a number inside the field's range; on a fault `target` stays as it was.
  void number(NodeId at, double& target) const {
    const std::string unit = field.unit.empty() ? "" : fmt::format(" [{}]", field.unit);
    const std::string range = range_text(field.range);
    const std::string wanted = "a number" + (range.empty() ? "" : " " + range) + unit;
    if (document().kind(at) != Kind::number) {
      reader.fail(at, "must be " + wanted, wanted);
    } else if (!field.range.contains(document().number(at))) {
      reader.fail(at, "must be " + range + unit, range + unit);
    } else {
      target = document().number(at);
    }
  }
  bool vector(NodeId at, Vector3& target) const {
    const auto parts = document().children(at);
    if (document().kind(at) != Kind::array || parts.size() != 3) return false;
    for (int i = 0; i < 3; ++i) number(parts[static_cast<std::size_t>(i)], target[i]);
    return true;
  }

  void operator()(double* slot) const { number(node, *slot); }
  void operator()(std::optional<double>* slot) const { number(node, slot->emplace(0.0)); }
  void operator()(int* slot) const {
    double value = 0.5;
    if (is(Kind::number)) value = document().number(node);
    if (value != std::floor(value) || std::abs(value) > 2147483647.0) return wrong_type(slot);
    value = 0.0;
    number(node, value);
    *slot = static_cast<int>(value);
  }
  void operator()(bool* slot) const {
    if (!is(Kind::boolean)) return wrong_type(slot);
    *slot = document().boolean(node);
  }
  void operator()(std::string* slot) const {
    if (!is(Kind::string)) return wrong_type(slot);
    *slot = document().string(node);
  }
  void operator()(Vector3* slot) const {
    if (!vector(node, *slot)) wrong_type(slot);
  }
  void operator()(std::optional<Vector3>* slot) const {
    if (!vector(node, slot->emplace(Vector3::Zero()))) wrong_type(slot);
  }
  void operator()(std::vector<double>* slot) const {
    if (!is(Kind::array)) return wrong_type(slot);
    if (too_long()) return;
    for (const NodeId element : document().children(node)) {
      number(element, slot->emplace_back(0.0));
    }
  }
  void operator()(std::vector<Vector3>* slot) const {
    if (!is(Kind::array)) return wrong_type(slot);
    if (too_long()) return;
    for (const NodeId element : document().children(node)) {
      if (!vector(element, slot->emplace_back(Vector3::Zero()))) {
        reader.fail(element, "must be [x, y, z], numbers");
      }
    }
  }
  [[nodiscard]] bool too_long() const {
    const std::size_t count = document().children(node).size();
    if (count <= max_list_length) return false;
    reader.fail(node, fmt::format("must not have more than {} elements, has {}", max_list_length,
                                  count));
    return true;
  }
  void operator()(Quaternion* slot) const {
    const auto parts = document().children(node);
    if (!is(Kind::array) || parts.size() != 4) return wrong_type(slot);
    std::array<double, 4> wxyz{};
    for (std::size_t i = 0; i < 4; ++i) {
      if (document().kind(parts[i]) != Kind::number) return wrong_type(slot);
      wxyz[i] = document().number(parts[i]);
    }
    Quaternion q(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
    const double norm = q.norm();
    if (!(std::abs(norm - 1.0) <= quaternion_tolerance)) {
      return reader.fail(node,
                         fmt::format("must be a unit quaternion [w, x, y, z]; its length is {:.9g}",
                                     norm),
                         fmt::format("a length of 1 within {}", quaternion_tolerance));
    }
    // What is unit to rounding stays bit for bit, or writing and reading would not be exact.
    if (std::abs(q.squaredNorm() - 1.0) > 4e-15) q.normalize();
    *slot = q;
  }
  void operator()(BodyId* slot) const { body(*slot, slot); }
  void operator()(std::optional<BodyId>* slot) const { body(slot->emplace(), slot); }
  void body(BodyId& target, const FieldSlot& slot) const {
    if (!is(Kind::string)) return wrong_type(slot);
    const std::string& name = document().string(node);
    if (name == "world") {
      target = BodyId::world();
      return;
    }
    const auto found = reader.bodies_.find(name);
    if (found != reader.bodies_.end()) {
      target = {found->second};
      return;
    }
    Suggestion suggestion(name);
    if (reader.body_names_.size() <= max_suggestions && !reader.faults_.full()) {
      for (const std::string_view candidate : reader.body_names_) suggestion.consider(candidate);
      suggestion.consider("world");
    }
    reader.fail(node, "there is no body of this name" + suggestion.question(),
                "the name of a body, or \"world\"");
  }
  void operator()(const ChoiceSlot& slot) const {
    if (!is(Kind::string)) return wrong_type(slot);
    const std::string& name = document().string(node);
    Suggestion suggestion(name);
    for (std::size_t i = 0; i < field.choices.size(); ++i) {
      if (field.choices[i] == name) return slot.set(slot.object, static_cast<int>(i));
      suggestion.consider(field.choices[i]);
    }
    reader.fail(node, "unknown choice" + suggestion.question(), describe(field, slot));
  }
};

void FieldReader::fail(NodeId node, std::string message, std::string allowed) {
  faults_.add({document_.offset(node), document_.pointer(node), std::move(message),
               document_.excerpt(node), std::move(allowed)});
}

bool FieldReader::read_object(NodeId node, const ObjectFormat& format,
                              std::span<void* const> objects, const Variant* variant,
                              void* settings) {
  if (document_.kind(node) != Kind::object) {
    fail(node, fmt::format("must be an object ({})", format.meaning), "an object");
    return false;
  }
  check_keys(node, format, variant);
  for (std::size_t i = 0; i < objects.size(); ++i) {
    read_table(node, format.tables[i].fields, objects[i]);
  }
  if (variant != nullptr) read_table(node, variant->table.fields, settings);
  if (format.named) check_name(document_.member(node, "name"));
  return true;
}

void FieldReader::check_keys(NodeId node, const ObjectFormat& format, const Variant* variant) {
  std::vector<std::string_view> known;
  if (!format.variants.empty()) known.emplace_back("type");
  const auto add_fields = [&](std::span<const Field> fields) {
    for (const Field& field : fields) known.push_back(field.name);
  };
  for (const TableFormat& table : format.tables) add_fields(table.fields);
  if (variant != nullptr) add_fields(variant->table.fields);
  for (const Member& member : format.members) known.push_back(member.name);
  for (const auto& [one, other] : format.exclusive) {
    const NodeId second = document_.member(node, other);
    if (document_.member(node, one) == no_node || second == no_node) continue;
    fail(second, fmt::format("{} and {} exclude each other; leave one out", one, other));
  }
  for (const NodeId child : document_.children(node)) {
    const std::string& key = document_.key(child);
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    Suggestion suggestion(key);
    for (const std::string_view candidate : known) suggestion.consider(candidate);
    faults_.add({document_.key_offset(child), document_.pointer(child),
                 fmt::format("unknown key in a {}{}", variant != nullptr ? variant->name : format.name,
                             suggestion.question()),
                 {}, fmt::format("{}", fmt::join(known, ", "))});
  }
}

void FieldReader::read_table(NodeId node, std::span<const Field> fields, void* object) {
  for (const Field& field : fields) {
    const NodeId value = document_.member(node, field.name);
    if (value != no_node) {
      std::visit(Value{*this, field, value}, field.slot(object));
    } else if (field.presence == Presence::required) {
      faults_.add({document_.offset(node),
                   fmt::format("{}/{}", document_.pointer(node), field.name), "required key is missing",
                   {}, describe(field, field.slot(object))});
    }
  }
}

void FieldReader::check_name(NodeId node) {
  if (node == no_node || document_.kind(node) != Kind::string) return;  // reported already
  const std::string& name = document_.string(node);
  if (!is_name(name)) {
    fail(node, fmt::format("a name must consist of {}", name_rule));
  } else if (name == "world") {
    fail(node, "the name \"world\" belongs to the immovable world");
  }
}

const Variant* FieldReader::read_type(NodeId node, const ObjectFormat& format) {
  if (document_.kind(node) != Kind::object) {
    fail(node, fmt::format("must be an object ({})", format.meaning), "an object");
    return nullptr;
  }
  std::string allowed;
  for (const Variant& variant : format.variants) {
    allowed += (allowed.empty() ? "" : ", ") + quoted(variant.name);
  }
  const NodeId type = document_.member(node, "type");
  if (type == no_node) {
    faults_.add({document_.offset(node), document_.pointer(node) + "/type",
                 "required key is missing", {}, allowed});
    return nullptr;
  }
  if (document_.kind(type) != Kind::string) {
    fail(type, "must be one of " + allowed, allowed);
    return nullptr;
  }
  const Variant* variant = format.variant(document_.string(type));
  if (variant == nullptr) {
    Suggestion suggestion(document_.string(type));
    for (const Variant& candidate : format.variants) suggestion.consider(candidate.name);
    fail(type, fmt::format("unknown type of {}{}", format.name, suggestion.question()), allowed);
  }
  return variant;
}

std::span<const NodeId> FieldReader::list(NodeId object, const Member& member) {
  const NodeId node = document_.member(object, member.name);
  if (node == no_node) return {};
  const std::string wanted = fmt::format("a list of objects ({})", member.meaning);
  if (document_.kind(node) != Kind::array) {
    fail(node, "must be " + wanted, wanted);
    return {};
  }
  const auto elements = document_.children(node);
  if (elements.size() > max_list_length) {
    fail(node, fmt::format("must not have more than {} elements, has {}", max_list_length,
                           elements.size()));
    return {};
  }
  return elements;
}

std::unordered_map<std::string_view, int> FieldReader::unique_names(
    std::span<const NodeId> entities, std::string_view what) {
  std::unordered_map<std::string_view, int> first;
  for (std::size_t i = 0; i < entities.size(); ++i) {
    const NodeId name = document_.member(entities[i], "name");
    if (name == no_node || document_.kind(name) != Kind::string) continue;
    const auto [entry, is_new] = first.emplace(document_.string(name), static_cast<int>(i));
    if (is_new) continue;
    const NodeId other = document_.member(entities[static_cast<std::size_t>(entry->second)], "name");
    fail(name, fmt::format("names of {} must differ; this one is first given in line {}", what,
                           document_.location(document_.offset(other)).line));
  }
  return first;
}

void FieldReader::declare_bodies(std::span<const NodeId> bodies) {
  bodies_ = unique_names(bodies, "bodies");
  body_names_.clear();
  for (const NodeId body : bodies) {
    const NodeId name = document_.member(body, "name");
    if (name != no_node && document_.kind(name) == Kind::string) {
      body_names_.push_back(document_.string(name));
    }
  }
}

}  // namespace sheave
