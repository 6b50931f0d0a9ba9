#pragma once
// A text in XML as a tree that owns its content, with the file and the line of each element.

#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/import/import.h"

namespace sheave::import::xml {

struct Attribute {
  std::string name;
  std::string value;
};

/// One element.
struct Element {
  std::string tag;
  /// The text before the first child, without blanks at its ends; MJCF and URDF have none.
  std::string text;
  const std::string* file = nullptr;  ///< name of its file; owned by the Tree
  int line = 0;                       ///< of its first character, from 1
  std::vector<Attribute> attributes;  ///< in the order of the text
  std::vector<Element> children;      ///< in the order of the text

  /// The value of an attribute; null if there is none.
  [[nodiscard]] const std::string* value(std::string_view name) const;
};

/// The tree of a text, or the first fault of the text.
struct Tree {
  std::deque<std::string> files;  ///< names, for the elements
  std::optional<Element> root;    ///< none if there is a fault
  std::optional<SceneError> fault;
};

/// Parses a text and the files that it includes by <include file="..."/>, each of which is replaced
/// by the content of the root element of its file. The names of files count from the folder of
/// `file_name` and must not lead out of `folder`, or out of that one if it is empty; a file is included at most once.
[[nodiscard]] Tree parse(std::string_view text, const std::string& file_name, const Limits& limits,
                         const std::string& folder = {});

}  // namespace sheave::import::xml
