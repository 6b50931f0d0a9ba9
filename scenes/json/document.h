#pragma once
// A JSON text as a tree with the position of every value, so that errors can give line and column.
// The grammar is that of nlohmann-json; only positions are added here (scenes/json/parser.cpp).

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/fault_code.h"

namespace sheave::json {

enum class Kind : std::uint8_t { null, boolean, number, string, array, object };
/// "null", "a number", "an object", ... for messages.
[[nodiscard]] std::string_view name_of(Kind kind);

/// Limits of accepted texts, which are far above any sensible scene and protect memory and stack.
struct Limits {
  std::size_t bytes = std::size_t{64} << 20U;  ///< of the text
  std::size_t depth = 64;                      ///< of nested arrays and objects
  std::size_t values = 8'000'000;              ///< number of values; 8 million need 0.5 GB
  std::size_t faults = 1000;                   ///< number of faults that are listed one by one
};

/// One fault of a document.
struct Fault {
  std::uint32_t offset = 0;  ///< position in the document's text
  std::string pointer;       ///< JSON pointer of the setting, which may be missing
  std::string message;
  std::string value;    ///< the faulty text, shortened; empty if there is none
  std::string allowed;  ///< the allowed values; empty if the message contains them
  FaultCode code = FaultCode::meaning;
};

/// The faults found so far. Keeps at most Limits::faults of them and counts the others.
class Faults {
 public:
  explicit Faults(std::size_t limit = Limits{}.faults) : limit_(limit) {}
  void add(Fault fault);
  [[nodiscard]] bool empty() const { return list_.empty(); }
  /// Whether further faults are only counted, so that searching suggestions is useless.
  [[nodiscard]] bool full() const { return list_.size() >= limit_; }
  [[nodiscard]] std::size_t omitted() const { return omitted_; }
  /// All kept faults in the order of the text.
  [[nodiscard]] std::vector<Fault> in_order() const;

 private:
  std::size_t limit_;
  std::size_t omitted_ = 0;
  std::vector<Fault> list_;
};

/// A value of a document.
using NodeId = std::int32_t;
inline constexpr NodeId no_node = -1;

/// Line and column, both from 1; columns count characters (UTF-8 code points).
struct Location {
  std::string_view file;
  int line = 0;
  int column = 0;
};

/// A parsed text and the values that were set on top of it. Values are never removed, so ids stay
/// valid.
class Document {
 public:
  /// Parses JSON with // and /* */ comments. The document has no root if the text is not JSON or
  /// exceeds a limit. Duplicate keys (the first counts) and numbers too small for a double are
  /// faults, too, but the document stays usable.
  static Document parse(std::string_view text, std::string name, const Limits& limits,
                        Faults& faults);

  /// Sets the value at `pointer` to the JSON in `value`; a bare word counts as a string. The parent
  /// must exist. A member of an object may be new, an element of an array may not. Elements of an
  /// array can be given by their "name" (/bodies/drum/mass); a number is an index. Objects named in
  /// `implied`, pointers of one level, are created if they are missing. `origin` is the name of the
  /// text's source in errors.
  void set(std::string_view pointer, std::string_view value, std::string origin,
           std::span<const std::string_view> implied, const Limits& limits, Faults& faults);

  /// Removes a member from its object; its value stays valid.
  void remove(NodeId member);

  [[nodiscard]] NodeId root() const { return root_; }
  [[nodiscard]] Kind kind(NodeId id) const { return node(id).kind; }
  [[nodiscard]] bool boolean(NodeId id) const { return node(id).number != 0.0; }
  [[nodiscard]] double number(NodeId id) const { return node(id).number; }
  [[nodiscard]] const std::string& string(NodeId id) const { return strings_[node(id).first]; }
  /// Elements of an array or members of an object, in order.
  [[nodiscard]] std::span<const NodeId> children(NodeId id) const;
  /// Key of a member of an object.
  [[nodiscard]] const std::string& key(NodeId id) const { return strings_[node(id).key]; }
  /// The member with this key, or no_node.
  [[nodiscard]] NodeId member(NodeId object, std::string_view key) const;

  [[nodiscard]] std::string pointer(NodeId id) const;
  /// The value at `pointer`, or the innermost existing value that contains it.
  struct Target {
    NodeId node = no_node;
    bool exact = false;
    std::size_t steps = 0;  ///< number of steps of the pointer that exist
  };
  [[nodiscard]] Target find(std::string_view pointer) const;

  /// Position in the text of the begin of a value, or of the key of a member.
  [[nodiscard]] std::uint32_t offset(NodeId id) const { return node(id).begin; }
  /// Position behind the value's last character.
  [[nodiscard]] std::uint32_t end_offset(NodeId id) const { return node(id).end; }
  [[nodiscard]] std::uint32_t key_offset(NodeId id) const { return node(id).key_begin; }
  [[nodiscard]] Location location(std::uint32_t offset) const;
  /// The text of the value, shortened for a message; empty for long containers.
  [[nodiscard]] std::string excerpt(NodeId id) const;

 private:
  friend class Builder;
  static constexpr std::uint32_t no_key = 0xffffffff;

  struct Node {
    double number = 0.0;  // value of a number or boolean
    NodeId parent = no_node;
    std::uint32_t begin = 0;  // [begin, end) in text_
    std::uint32_t end = 0;
    std::uint32_t key_begin = 0;
    std::uint32_t key = no_key;  // index into strings_
    std::uint32_t first = 0;     // string: index into strings_; container: index of the first child
    std::uint32_t count = 0;     // number of children
    std::uint32_t index = 0;     // index among the parent's children
    Kind kind = Kind::null;
  };
  struct Source {
    std::uint32_t begin;
    std::string name;
  };

  Document() = default;
  [[nodiscard]] const Node& node(NodeId id) const { return nodes_[static_cast<std::size_t>(id)]; }
  [[nodiscard]] Node& node(NodeId id) { return nodes_[static_cast<std::size_t>(id)]; }
  NodeId parse_source(std::string_view text, std::string name, const Limits& limits,
                      Faults& faults);
  /// The element of an array that this step of a pointer selects, by index or name, or no_node.
  [[nodiscard]] NodeId element(NodeId array, const std::string& step) const;
  /// The names of an array's elements that have one.
  [[nodiscard]] std::vector<std::string_view> names(NodeId array) const;
  /// The fault of a pointer that ends at `target`.
  [[nodiscard]] std::string missing(std::string_view path, const Target& target) const;
  void add_child(NodeId parent, std::string key, NodeId child);
  void replace_child(NodeId old_child, NodeId child);

  std::string text_;  // all sources, one after the other
  std::vector<Source> sources_;
  std::vector<std::uint32_t> lines_;  // begin of each line of text_; every source begins a line
  std::vector<Node> nodes_;
  std::vector<NodeId> children_;  // of all containers; each has a contiguous range
  std::vector<std::string> strings_;
  NodeId root_ = no_node;
};

/// `text` on one line and at most `length` bytes long, cut between characters.
[[nodiscard]] std::string shortened(std::string_view text, std::size_t length);

}  // namespace sheave::json
