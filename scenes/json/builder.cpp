#include "scenes/json/builder.h"

#include <algorithm>

#include <fmt/format.h>

#include "scenes/json/pointer.h"

namespace sheave::json {
namespace {

bool is_blank_or_separator(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == ',' || c == ':';
}

bool is_word(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '+' ||
         c == '-' || c == '.';
}

/// The message of nlohmann without its own position. From "[json.exception.parse_error.101] parse
/// error at line 1, column 2: syntax error while parsing object - invalid literal; last read: '{x';
/// expected '}'" it takes the part behind the colon, without the text that was last read, which our
/// value shows better.
std::string complaint(std::string message) {
  const std::size_t column = message.find(", column ");
  const std::size_t start = message.find(": ", column == std::string::npos ? 0 : column);
  if (start != std::string::npos) message = message.substr(start + 2);
  const std::size_t last_read = message.find("; last read: '");
  if (last_read != std::string::npos) {
    const std::size_t expected = message.rfind("; expected ");
    const bool behind = expected != std::string::npos && expected > last_read;
    message = message.substr(0, last_read) + (behind ? message.substr(expected) : "");
  }
  // Between two members a comma is allowed as well as the closing bracket, and is more often
  // missing.
  for (const std::string_view close : {"'}'", "']'"}) {
    const std::string ending = fmt::format("; expected {}", close);
    if (message.ends_with(ending)) {
      message.replace(message.size() - ending.size(), std::string::npos,
                      fmt::format("; expected ',' or {}", close));
    }
  }
  return message;
}

}  // namespace

Builder::Builder(Document& document, std::uint32_t begin, const Limits& limits, Faults& faults)
    : document_(document), limits_(limits), faults_(faults), begin_(begin), cursor_(begin) {
  // The parser skips a byte order mark, which some editors write before UTF-8.
  if (document.text_.compare(begin, 3, "\xEF\xBB\xBF") == 0) cursor_ += 3;
}

bool Builder::null() { return add(Kind::null) != no_node; }

bool Builder::boolean(bool value) {
  const NodeId id = add(Kind::boolean);
  if (id == no_node) return false;
  document_.node(id).number = value ? 1.0 : 0.0;
  return true;
}

bool Builder::number(double value) {
  const NodeId id = add(Kind::number);
  if (id == no_node) return false;
  document_.node(id).number = value;
  return true;
}

bool Builder::number_integer(std::int64_t value) { return number(static_cast<double>(value)); }

bool Builder::number_unsigned(std::uint64_t value) { return number(static_cast<double>(value)); }

bool Builder::number_float(double value, const std::string& text) {
  const std::string_view digits = std::string_view(text).substr(0, text.find_first_of("eE"));
  if (value == 0.0 && digits.find_first_of("123456789") != std::string_view::npos) {
    faults_.add({next_token(), current_pointer(), "number too small for a double", text,
                 "0 or a magnitude of at least 5e-324", FaultCode::number_range});
  }
  return number(value);
}

bool Builder::string(std::string& value) {
  const NodeId id = add(Kind::string);
  if (id == no_node) return false;
  document_.node(id).first = static_cast<std::uint32_t>(document_.strings_.size());
  document_.strings_.push_back(std::move(value));
  return true;
}

// does not occur in JSON texts
bool Builder::binary(nlohmann::json::binary_t& /*value*/) { return false; }

bool Builder::key(std::string& value) {
  key_begin_ = next_token();
  cursor_ = token_end(key_begin_);
  // A scene has few different keys, but may have millions of them, so equal keys share one string.
  const auto next = static_cast<std::uint32_t>(document_.strings_.size());
  const auto [known, is_new] = known_keys_.try_emplace(value, next);
  key_ = known->second;
  if (is_new) document_.strings_.push_back(std::move(value));
  return true;
}

bool Builder::start_object(std::size_t /*size*/) { return open(Kind::object); }
bool Builder::start_array(std::size_t /*size*/) { return open(Kind::array); }
bool Builder::end_array() { return close(); }

bool Builder::end_object() {
  report_duplicates(open_.back().node);
  return close();
}

bool Builder::open(Kind kind) {
  if (open_.size() >= limits_.depth) {
    return fail(
        next_token(), FaultCode::too_large,
        fmt::format("arrays and objects must not be nested more than {} deep", limits_.depth));
  }
  const NodeId id = add(kind);
  if (id == no_node) return false;
  open_.push_back({id, pending_.size()});
  return true;
}

bool Builder::close() {
  const Open open = open_.back();
  open_.pop_back();
  cursor_ = next_token() + 1;
  Document::Node& node = document_.node(open.node);
  node.end = cursor_;
  node.first = static_cast<std::uint32_t>(document_.children_.size());
  node.count = static_cast<std::uint32_t>(pending_.size() - open.first_child);
  const auto first = pending_.begin() + static_cast<std::ptrdiff_t>(open.first_child);
  document_.children_.insert(document_.children_.end(), first, pending_.end());
  pending_.erase(first, pending_.end());
  return true;
}

bool Builder::parse_error(std::size_t position, const std::string& /*token*/,
                          const nlohmann::detail::exception& error) {
  // `position` counts the characters read so far; the faulty token begins before the last of them,
  // unless that is a second separator, which the cursor would skip.
  const std::size_t last_read = begin_ + (position > 0 ? position - 1 : 0);
  const std::size_t start = std::min<std::size_t>(next_token(), last_read);
  const std::size_t offset = std::min(start, document_.text_.size());
  const std::size_t end =
      std::max<std::size_t>(token_end(static_cast<std::uint32_t>(offset)), last_read + 1);
  std::string value = shortened(document_.text_.substr(offset, end - offset), 40);
  if (error.id == 406) {
    return fail(static_cast<std::uint32_t>(offset), FaultCode::number_range,
                "number too large for a double", std::move(value));
  }
  const std::string what = error.what();
  // "unexpected ..." already names the token.
  if (what.find(" - unexpected ") != std::string::npos) value.clear();
  return fail(static_cast<std::uint32_t>(offset), FaultCode::syntax, complaint(what),
              std::move(value));
}

std::uint32_t Builder::next_token() const {
  const std::string& text = document_.text_;
  std::size_t at = cursor_;
  while (at < text.size()) {
    if (is_blank_or_separator(text[at])) {
      ++at;
    } else if (text.compare(at, 2, "//") == 0) {
      at = std::min(text.find('\n', at), text.size());
    } else if (text.compare(at, 2, "/*") == 0) {
      const std::size_t end = text.find("*/", at + 2);
      if (end == std::string::npos) break;  // the parser reports the beginning of the comment
      at = end + 2;
    } else {
      break;
    }
  }
  return static_cast<std::uint32_t>(at);
}

std::uint32_t Builder::token_end(std::uint32_t begin) const {
  const std::string& text = document_.text_;
  std::size_t at = begin;
  if (at < text.size() && text[at] == '"') {
    ++at;
    while (at < text.size() && text[at] != '"') at += text[at] == '\\' ? 2 : 1;
    ++at;
  } else if (at < text.size() && is_word(text[at])) {
    while (at < text.size() && is_word(text[at])) ++at;
  } else {
    ++at;
  }
  return static_cast<std::uint32_t>(std::min(at, text.size()));
}

NodeId Builder::add(Kind kind) {
  const std::uint32_t begin = next_token();
  if (document_.nodes_.size() >= limits_.values) {
    fail(begin, FaultCode::too_large,
         fmt::format("a scene must not have more than {} values", limits_.values));
    return no_node;
  }
  const auto id = static_cast<NodeId>(document_.nodes_.size());
  Document::Node node;
  node.kind = kind;
  node.parent = open_.empty() ? no_node : open_.back().node;
  node.begin = begin;
  node.end = cursor_ = token_end(begin);
  node.key = key_;
  node.key_begin = key_ == Document::no_key ? begin : key_begin_;
  if (!open_.empty()) {
    node.index = static_cast<std::uint32_t>(pending_.size() - open_.back().first_child);
  }
  key_ = Document::no_key;
  document_.nodes_.push_back(node);
  if (open_.empty()) {
    root_ = id;
  } else {
    pending_.push_back(id);
  }
  return id;
}

void Builder::report_duplicates(NodeId object) {
  by_key_.assign(pending_.begin() + static_cast<std::ptrdiff_t>(open_.back().first_child),
                 pending_.end());
  const auto key = [&](NodeId id) -> const std::string& { return document_.key(id); };
  std::stable_sort(by_key_.begin(), by_key_.end(),
                   [&](NodeId a, NodeId b) { return key(a) < key(b); });
  for (std::size_t i = 1, first = 0; i < by_key_.size(); ++i) {
    if (key(by_key_[i]) != key(by_key_[first])) {
      first = i;
      continue;
    }
    const Location other = document_.location(document_.key_offset(by_key_[first]));
    faults_.add({document_.key_offset(by_key_[i]),
                 document_.pointer(object) + "/" + escape(key(by_key_[i])),
                 fmt::format("duplicate key, first given in line {}", other.line),
                 {},
                 {},
                 FaultCode::duplicate_key});
  }
}

std::string Builder::current_pointer() const {
  if (open_.empty()) return {};
  const Open& open = open_.back();
  std::string pointer = document_.pointer(open.node);
  if (key_ != Document::no_key) {
    pointer += "/" + escape(document_.strings_[key_]);
  } else if (document_.kind(open.node) == Kind::array) {
    pointer += fmt::format("/{}", pending_.size() - open.first_child);
  }
  return pointer;
}

bool Builder::fail(std::uint32_t offset, FaultCode code, std::string message, std::string value) {
  faults_.add({offset, current_pointer(), std::move(message), std::move(value), {}, code});
  return false;
}

}  // namespace sheave::json
