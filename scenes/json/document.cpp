#include "scenes/json/document.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include "scenes/json/builder.h"
#include "scenes/json/pointer.h"
#include "scenes/json/text.h"
#include "scenes/suggestion.h"

namespace sheave::json {
namespace {

bool continues_character(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

/// Whether a value of an override is a string without quotes. Words that begin like a number, such
/// as 1e3, are not.
bool is_bare_word(std::string_view text) {
  if (text.empty() || text == "true" || text == "false" || text == "null") return false;
  const auto letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; };
  const auto inside = [&](char c) {
    return letter(c) || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == ' ' || c == '.';
  };
  return letter(text.front()) && std::all_of(text.begin(), text.end(), inside);
}

}  // namespace

std::string_view name_of(Kind kind) {
  switch (kind) {
    case Kind::null:
      return "null";
    case Kind::boolean:
      return "a boolean";
    case Kind::number:
      return "a number";
    case Kind::string:
      return "a string";
    case Kind::array:
      return "an array";
    case Kind::object:
      return "an object";
  }
  return "";
}

void Faults::add(Fault fault) {
  if (full()) {
    ++omitted_;
  } else {
    list_.push_back(std::move(fault));
  }
}

std::vector<Fault> Faults::in_order() const {
  std::vector<Fault> result = list_;
  std::stable_sort(result.begin(), result.end(),
                   [](const Fault& a, const Fault& b) { return a.offset < b.offset; });
  return result;
}

Document Document::parse(std::string_view text, std::string name, const Limits& limits,
                         Faults& faults) {
  Document document;
  document.root_ = document.parse_source(text, std::move(name), limits, faults);
  return document;
}

NodeId Document::parse_source(std::string_view text, std::string name, const Limits& limits,
                              Faults& faults) {
  const auto begin = static_cast<std::uint32_t>(text_.size());
  sources_.push_back({begin, std::move(name)});
  lines_.push_back(begin);
  if (text.size() > limits.bytes || text_.size() + text.size() > 0xf0000000U) {
    faults.add(
        {begin,
         "",
         fmt::format("{} bytes are too many: at most {} are allowed", text.size(), limits.bytes),
         {},
         {},
         FaultCode::too_large});
    return no_node;
  }
  text_ += text;
  for (std::size_t at = begin; at < text_.size(); ++at) {
    if (text_[at] == '\n') lines_.push_back(static_cast<std::uint32_t>(at + 1));
  }
  // nlohmann takes a null character for the end of the text and would ignore the rest, and it does
  // not check comments.
  if (TextFault fault = find_text_fault(text); !fault.message.empty()) {
    faults.add({begin + static_cast<std::uint32_t>(fault.offset),
                "",
                std::move(fault.message),
                {},
                {},
                FaultCode::encoding});
    return no_node;
  }
  Builder builder(*this, begin, limits, faults);
  const bool complete =
      nlohmann::json::sax_parse(text_.data() + begin, text_.data() + text_.size(), &builder,
                                nlohmann::json::input_format_t::json, true, true);
  nodes_.shrink_to_fit();  // the largest part of a large scene
  children_.shrink_to_fit();
  return complete ? builder.root() : no_node;
}

std::span<const NodeId> Document::children(NodeId id) const {
  const Node& n = node(id);
  if (n.kind != Kind::array && n.kind != Kind::object) return {};
  return {children_.data() + n.first, n.count};
}

NodeId Document::member(NodeId object, std::string_view key) const {
  if (kind(object) != Kind::object) return no_node;
  for (const NodeId child : children(object)) {
    if (this->key(child) == key) return child;
  }
  return no_node;
}

void Document::add_child(NodeId parent, std::string key, NodeId child) {
  // The ranges of children cannot grow in place: the parent's moves to the end.
  Node& container = node(parent);
  const std::size_t first = children_.size();
  for (std::uint32_t i = 0; i < container.count; ++i) {
    children_.push_back(children_[container.first + i]);
  }
  children_.push_back(child);
  container.first = static_cast<std::uint32_t>(first);
  node(child).parent = parent;
  node(child).index = container.count++;
  node(child).key = static_cast<std::uint32_t>(strings_.size());
  strings_.push_back(std::move(key));
}

void Document::replace_child(NodeId old_child, NodeId child) {
  const NodeId parent = node(old_child).parent;
  node(child).parent = parent;
  node(child).index = node(old_child).index;
  node(child).key = node(old_child).key;
  if (parent == no_node) {
    root_ = child;
  } else {
    children_[node(parent).first + node(child).index] = child;
  }
}

void Document::set(std::string_view pointer, std::string_view value, std::string origin,
                   std::span<const std::string_view> implied, const Limits& limits,
                   Faults& faults) {
  const std::string text = is_bare_word(value) ? fmt::format("\"{}\"", value) : std::string(value);
  const NodeId child = parse_source(text, std::move(origin), limits, faults);
  if (child == no_node) return;
  const std::uint32_t at = node(child).begin;
  const auto fail = [&](std::string message) {
    faults.add({at, std::string(pointer), std::move(message), {}, {}, FaultCode::bad_pointer});
  };
  const auto steps = split(pointer);
  if (!steps) return fail("not a JSON pointer: it must begin with \"/\", as in /step/dt");
  Target target = find(pointer);
  if (target.exact) return replace_child(target.node, child);
  const std::string_view parent = pointer.substr(0, pointer.rfind('/'));
  target = find(parent);
  if (!target.exact && std::find(implied.begin(), implied.end(), parent) != implied.end()) {
    Node object;
    object.kind = Kind::object;
    object.begin = object.end = object.key_begin = at;
    nodes_.push_back(object);
    const auto id = static_cast<NodeId>(nodes_.size() - 1);
    add_child(target.node, unescape(parent.substr(1)), id);
    target = {id, true, 1};
  }
  if (!target.exact) return fail(missing(parent, target));
  if (kind(target.node) == Kind::array) return fail(missing(pointer, target));
  if (kind(target.node) != Kind::object) {
    return fail(fmt::format("{} is {} and has no members", parent, name_of(kind(target.node))));
  }
  add_child(target.node, steps->back(), child);
}

void Document::remove(NodeId member) {
  Node& container = node(node(member).parent);
  for (std::uint32_t i = node(member).index; i + 1 < container.count; ++i) {
    const NodeId next = children_[container.first + i + 1];
    children_[container.first + i] = next;
    node(next).index = i;
  }
  --container.count;
}

NodeId Document::element(NodeId array, const std::string& step) const {
  const std::span<const NodeId> elements = children(array);
  if (const auto index = array_index(step)) {
    return *index < elements.size() ? elements[*index] : no_node;
  }
  for (const NodeId id : elements) {
    const NodeId name = member(id, "name");
    if (name != no_node && kind(name) == Kind::string && string(name) == step) return id;
  }
  return no_node;
}

std::vector<std::string_view> Document::names(NodeId array) const {
  std::vector<std::string_view> result;
  for (const NodeId id : children(array)) {
    const NodeId name = member(id, "name");
    if (name != no_node && kind(name) == Kind::string) result.push_back(string(name));
  }
  return result;
}

std::string Document::missing(std::string_view path, const Target& target) const {
  if (kind(target.node) != Kind::array) return fmt::format("there is no {} in the scene", path);
  const std::string step = split(path)->at(target.steps);
  const std::string place = pointer(target.node);
  const std::size_t count = children(target.node).size();
  const std::vector<std::string_view> known = names(target.node);
  if (array_index(step) || known.empty()) {
    return fmt::format("there is no {} in the scene: {} has {} elements, counted from 0", path,
                       place, count);
  }
  constexpr std::size_t most = 8;  // as many as a user reads
  std::vector<std::string_view> near = nearest(step, known, most);
  const bool some = near.empty();
  if (some) near.assign(known.begin(), known.begin() + std::min(known.size(), most));
  return fmt::format("{} has nothing called \"{}\"; {} \"{}\"{}", place, step,
                     some ? "there are" : "near it are", fmt::join(near, "\", \""),
                     some && known.size() > most ? ", ..." : "");
}

std::string Document::pointer(NodeId id) const {
  std::vector<NodeId> path;
  for (; node(id).parent != no_node; id = node(id).parent) path.push_back(id);
  std::reverse(path.begin(), path.end());
  std::string result;
  for (const NodeId step : path) {
    const Node& n = node(step);
    result += '/';
    result += n.key != no_key ? escape(strings_[n.key]) : std::to_string(n.index);
  }
  return result;
}

Document::Target Document::find(std::string_view pointer) const {
  Target target{root_, true};
  const auto steps = split(pointer);
  if (!steps) return {root_, false};
  for (const std::string& step : *steps) {
    const bool array = kind(target.node) == Kind::array;
    const NodeId next = array ? element(target.node, step) : member(target.node, step);
    if (next == no_node) {
      target.exact = false;
      return target;
    }
    target.node = next;
    ++target.steps;
  }
  return target;
}

Location Document::location(std::uint32_t offset) const {
  const auto line = std::upper_bound(lines_.begin(), lines_.end(), offset) - 1;
  const auto source =
      std::upper_bound(sources_.begin(), sources_.end(), offset,
                       [](std::uint32_t at, const Source& s) { return at < s.begin; }) -
      1;
  // The last line of the source before may be empty and then begins at the same offset.
  const auto first_line = std::upper_bound(lines_.begin(), lines_.end(), source->begin) - 1;
  const std::size_t end = std::min<std::size_t>(offset, text_.size());
  // Texts of one huge line are not read by users; there the column counts bytes, which costs
  // nothing.
  std::size_t characters = end - *line;
  if (characters < 0x10000) {
    const std::string_view before = std::string_view(text_).substr(*line, characters);
    characters = static_cast<std::size_t>(std::count_if(
        before.begin(), before.end(), [](char c) { return !continues_character(c); }));
  }
  return {source->name, static_cast<int>(line - first_line) + 1, static_cast<int>(characters) + 1};
}

std::string Document::excerpt(NodeId id) const {
  const Node& n = node(id);
  const std::string_view text = std::string_view(text_).substr(n.begin, n.end - n.begin);
  const bool container = n.kind == Kind::array || n.kind == Kind::object;
  if (container && (text.size() > 60 || text.find('\n') != std::string_view::npos)) return {};
  return shortened(text, 60);
}

std::string shortened(std::string_view text, std::size_t length) {
  const bool cut = text.size() > length;
  if (cut) {
    std::size_t end = length > 3 ? length - 3 : 0;
    while (end > 0 && continues_character(text[end])) --end;
    text = text.substr(0, end);
  }
  std::string result;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    result += byte < 0x20 || byte == 0x7f ? ' ' : c;
  }
  return cut ? result + "..." : result;
}

}  // namespace sheave::json
