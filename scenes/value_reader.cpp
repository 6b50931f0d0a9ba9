#include "scenes/value_reader.h"

#include <array>
#include <cmath>

#include <fmt/format.h>

#include "scenes/format.h"
#include "scenes/suggestion.h"

namespace sheave {
namespace {

using json::Kind;
using json::NodeId;

// Comparing a word with more names than this takes longer than a user waits for a suggestion.
constexpr std::size_t max_suggestions = 5000;

/// Reads one value into the slot of its field; one overload per type of slot.
struct ValueReader {
  const json::Document& source;
  json::Faults& faults;
  const BodyNames& bodies;
  const Field& field;
  NodeId node;

  [[nodiscard]] bool is(Kind kind) const { return source.kind(node) == kind; }

  void fail(NodeId at, FaultCode code, std::string message, std::string allowed = {}) const {
    report(source, faults, at, code, std::move(message), std::move(allowed));
  }
  void wrong_type(const FieldSlot& slot) const {
    const std::string wanted = describe(field, slot);
    fail(node, FaultCode::wrong_type, "must be " + wanted, wanted);
  }

  /// Reads a number within the field's range; after a fault `target` is unchanged.
  void number(NodeId at, double& target) const {
    const std::string unit = field.unit.empty() ? "" : fmt::format(" [{}]", field.unit);
    const std::string range = range_text(field.range);
    const std::string wanted = "a number" + (range.empty() ? "" : " " + range) + unit;
    if (source.kind(at) != Kind::number) {
      fail(at, FaultCode::wrong_type, "must be " + wanted, wanted);
    } else if (!field.range.contains(source.number(at))) {
      fail(at, FaultCode::out_of_range, "must be " + range + unit, range + unit);
    } else {
      target = source.number(at);
    }
  }
  bool vector(NodeId at, Vector3& target) const {
    const auto parts = source.children(at);
    if (source.kind(at) != Kind::array || parts.size() != 3) return false;
    for (int i = 0; i < 3; ++i) number(parts[static_cast<std::size_t>(i)], target[i]);
    return true;
  }

  void operator()(double* slot) const { number(node, *slot); }
  void operator()(std::optional<double>* slot) const { number(node, slot->emplace(0.0)); }
  void operator()(int* slot) const {
    double value = 0.5;
    if (is(Kind::number)) value = source.number(node);
    if (value != std::floor(value) || std::abs(value) > 2147483647.0) return wrong_type(slot);
    value = 0.0;
    number(node, value);
    *slot = static_cast<int>(value);
  }
  void operator()(bool* slot) const {
    if (!is(Kind::boolean)) return wrong_type(slot);
    *slot = source.boolean(node);
  }
  void operator()(std::string* slot) const {
    if (!is(Kind::string)) return wrong_type(slot);
    *slot = source.string(node);
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
    slot->clear();
    for (const NodeId element : source.children(node)) {
      number(element, slot->emplace_back(0.0));
    }
  }
  void operator()(std::vector<Vector3>* slot) const {
    if (!is(Kind::array)) return wrong_type(slot);
    if (too_long()) return;
    slot->clear();
    for (const NodeId element : source.children(node)) {
      if (!vector(element, slot->emplace_back(Vector3::Zero()))) {
        fail(element, FaultCode::wrong_type, "must be [x, y, z], numbers");
      }
    }
  }
  void operator()(std::vector<std::string>* slot) const {
    if (!is(Kind::array)) return wrong_type(slot);
    if (too_long()) return;
    slot->clear();
    for (const NodeId element : source.children(node)) {
      if (source.kind(element) != Kind::string) {
        fail(element, FaultCode::wrong_type, "must be a string");
        continue;
      }
      slot->push_back(source.string(element));
    }
  }
  [[nodiscard]] bool too_long() const {
    const std::size_t count = source.children(node).size();
    if (count <= max_list_length) return false;
    fail(node, FaultCode::too_large,
         fmt::format("must not have more than {} elements, has {}", max_list_length, count));
    return true;
  }
  void operator()(Quaternion* slot) const {
    const auto parts = source.children(node);
    if (!is(Kind::array) || parts.size() != 4) return wrong_type(slot);
    std::array<double, 4> wxyz{};
    for (std::size_t i = 0; i < 4; ++i) {
      if (source.kind(parts[i]) != Kind::number) return wrong_type(slot);
      wxyz[i] = source.number(parts[i]);
    }
    Quaternion q(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
    const double norm = q.norm();
    if (!(std::abs(norm - 1.0) <= quaternion_tolerance)) {
      return fail(node, FaultCode::out_of_range,
                  fmt::format("must be a unit quaternion [w, x, y, z]; its length is {:.9g}", norm),
                  fmt::format("a length of 1 within {}", quaternion_tolerance));
    }
    // A quaternion that is unit to rounding keeps its bits; otherwise writing and reading would not
    // be exact.
    if (std::abs(q.squaredNorm() - 1.0) > 4e-15) q.normalize();
    *slot = q;
  }
  void operator()(BodyId* slot) const { body(*slot, slot); }
  void operator()(std::optional<BodyId>* slot) const { body(slot->emplace(), slot); }
  void body(BodyId& target, const FieldSlot& slot) const {
    if (!is(Kind::string)) return wrong_type(slot);
    const std::string& name = source.string(node);
    if (name == "world") {
      target = BodyId::world();
      return;
    }
    const auto found = bodies.indices.find(name);
    if (found != bodies.indices.end()) {
      target = {found->second};
      return;
    }
    Suggestion suggestion(name);
    if (bodies.in_order.size() <= max_suggestions && !faults.full()) {
      for (const std::string_view candidate : bodies.in_order) {
        if (bodies.indices.contains(candidate)) suggestion.consider(candidate);
      }
      suggestion.consider("world");
    }
    fail(node, FaultCode::unknown_body, "there is no body of this name" + suggestion.question(),
         "the name of a body, or \"world\"");
  }
  void operator()(const ChoiceSlot& slot) const {
    if (!is(Kind::string)) return wrong_type(slot);
    std::string_view name = source.string(node);
    for (const auto& [longer, choice] : longer_choices) {
      if (name == longer) name = choice;
    }
    Suggestion suggestion(source.string(node));
    for (std::size_t i = 0; i < field.choices.size(); ++i) {
      if (field.choices[i] == name) return slot.set(slot.object, static_cast<int>(i));
      suggestion.consider(field.choices[i]);
    }
    fail(node, FaultCode::unknown_choice, "unknown choice" + suggestion.question(),
         describe(field, slot));
  }
};

}  // namespace

void report(const json::Document& document, json::Faults& faults, NodeId node, FaultCode code,
            std::string message, std::string allowed) {
  faults.add({document.offset(node), document.pointer(node), std::move(message),
              document.excerpt(node), std::move(allowed), code});
}

void read_value(const json::Document& document, json::Faults& faults, const BodyNames& bodies,
                const Field& field, NodeId node, const FieldSlot& slot) {
  std::visit(ValueReader{document, faults, bodies, field, node}, slot);
}

}  // namespace sheave
