#pragma once
// Receives the parse events of nlohmann-json and builds a Document from them.
//
// The parser reports values without their positions. Every event comes directly after the last
// token of its value, and only blanks, comments, commas and colons lie between two tokens. A cursor
// that skips these and then the token therefore stays in step with the parser. The parser has
// checked the token, so finding its end needs no grammar.

#include <string>
#include <unordered_map>
#include <vector>

#include <nlohmann/json.hpp>

#include "scenes/json/document.h"

namespace sheave::json {

/// A SAX handler (the interface is nlohmann's).
class Builder {
 public:
  /// Builds into `document`; the parser reads the text of `document` from `begin` on.
  Builder(Document& document, std::uint32_t begin, const Limits& limits, Faults& faults);

  bool null();
  bool boolean(bool value);
  bool number_integer(std::int64_t value);
  bool number_unsigned(std::uint64_t value);
  bool number_float(double value, const std::string& text);
  bool string(std::string& value);
  static bool binary(nlohmann::json::binary_t& value);
  bool key(std::string& value);
  bool start_object(std::size_t size);
  bool end_object();
  bool start_array(std::size_t size);
  bool end_array();
  bool parse_error(std::size_t position, const std::string& token,
                   const nlohmann::detail::exception& error);

  /// The outermost value; no_node if no value was read.
  [[nodiscard]] NodeId root() const { return root_; }

 private:
  struct Open {
    NodeId node;
    std::size_t first_child;  // index in pending_
  };

  [[nodiscard]] std::uint32_t next_token() const;
  [[nodiscard]] std::uint32_t token_end(std::uint32_t begin) const;
  /// Adds a node for the token that was just read; no_node if the limit of values is reached.
  NodeId add(Kind kind);
  bool open(Kind kind);
  bool close();
  bool number(double value);
  void report_duplicates(NodeId object);
  /// Pointer of the value being read.
  [[nodiscard]] std::string current_pointer() const;
  bool fail(std::uint32_t offset, FaultCode code, std::string message, std::string value = {});

  Document& document_;
  const Limits& limits_;
  Faults& faults_;
  std::uint32_t begin_;
  std::uint32_t cursor_;  // end of the last token
  NodeId root_ = no_node;
  std::vector<Open> open_;       // containers that are still open, outermost first
  std::vector<NodeId> pending_;  // their children so far
  std::vector<NodeId> by_key_;   // scratch of report_duplicates()
  // key text to its index in the document's strings
  std::unordered_map<std::string, std::uint32_t> known_keys_;
  std::uint32_t key_ = Document::no_key;  // key of the next value
  std::uint32_t key_begin_ = 0;
};

}  // namespace sheave::json
