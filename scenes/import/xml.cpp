// tinyxml2 does the grammar. The parser expands no entities but the five of XML and those by number,
// so a text cannot grow in memory beyond a multiple of its size.

#include "scenes/import/xml.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include <fmt/format.h>

#if SHEAVE_HAS_TINYXML2
#include <tinyxml2.h>
#endif

#include "scenes/import/file_within.h"
#include "scenes/json/text.h"

namespace sheave::import::xml {

const std::string* Element::value(std::string_view name) const {
  for (const Attribute& attribute : attributes) {
    if (attribute.name == name) return &attribute.value;
  }
  return nullptr;
}

#if SHEAVE_HAS_TINYXML2

namespace {

namespace fs = std::filesystem;

class Parser {
 public:
  Parser(const std::string& file_name, const Limits& limits, const std::string& folder, Tree& tree)
      : limits_(limits), tree_(tree), folder_(folder_of(file_name)), allowed_(folder) {}

  std::optional<Element> parse(std::string_view text, const std::string& file_name) {
    tree_.files.push_back(file_name);
    const std::string& file = tree_.files.back();
    bytes_ += text.size();
    if (bytes_ > limits_.bytes) {
      fail(file, 1, fmt::format("the model has more than {} MB", limits_.bytes >> 20U),
           FaultCode::too_large);
      return {};
    }
    if (const json::TextFault fault = json::find_text_fault(text); !fault.message.empty()) {
      const std::string_view before = text.substr(0, fault.offset);
      fail(file, 1 + static_cast<int>(std::count(before.begin(), before.end(), '\n')),
           fault.message, FaultCode::encoding);
      return {};
    }
    tinyxml2::XMLDocument document;
    if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
      const int last = 1 + static_cast<int>(std::count(text.begin(), text.end(), '\n'));
      fail(file, std::clamp(document.ErrorLineNum(), 1, last), syntax_message(document.ErrorID()),
           FaultCode::syntax);
      return {};
    }
    for (const auto* node = document.FirstChild(); node != nullptr; node = node->NextSibling()) {
      if (node->ToUnknown() == nullptr || names_a_schema(node->Value())) continue;
      fail(file, node->GetLineNum(),
           "a document type declaration or another \"<!\" is not allowed; leave it out",
           FaultCode::syntax);
      return {};
    }
    const tinyxml2::XMLElement* const root = document.RootElement();
    if (root == nullptr) {
      fail(file, 1, "the text has no element", FaultCode::syntax);
      return {};
    }
    Element element;
    if (!copy(*root, file, 1, element)) return {};
    return element;
  }

 private:
  void fail(const std::string& file, int line, std::string message, FaultCode code) {
    if (tree_.fault) return;
    tree_.fault = SceneError{file, std::max(line, 1), 1, {}, std::move(message), {}, {}, code};
  }

  /// Whether a declaration only names the file of a schema, which is not read, and declares nothing.
  static bool names_a_schema(std::string_view declaration) {
    return declaration.starts_with("DOCTYPE ") &&
           declaration.find_first_of("[<") == std::string_view::npos;
  }

  static std::string trimmed(const char* text) {
    const std::string_view all = text == nullptr ? "" : text;
    constexpr std::string_view blanks = " \t\r\n";
    const std::size_t first = all.find_first_not_of(blanks);
    if (first == std::string_view::npos) return {};
    return std::string(all.substr(first, all.find_last_not_of(blanks) - first + 1));
  }

  static std::string syntax_message(tinyxml2::XMLError error) {
    switch (error) {
      case tinyxml2::XML_ERROR_MISMATCHED_ELEMENT:
        return "not XML: an element is closed by another name than its own, or not at all";
      case tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED:
        return "elements are nested too deeply";
      case tinyxml2::XML_ERROR_PARSING_ATTRIBUTE:
        return "not XML: an attribute must be name=\"value\", and given once";
      case tinyxml2::XML_ERROR_EMPTY_DOCUMENT:
        return "the text has no element";
      default:
        return fmt::format("not XML ({})", tinyxml2::XMLDocument::ErrorIDToName(error));
    }
  }

  bool copy(const tinyxml2::XMLElement& from, const std::string& file, std::size_t depth,
            Element& to) {
    if (++elements_ > limits_.elements) {
      fail(file, from.GetLineNum(),
           fmt::format("the model has more than {} elements", limits_.elements),
           FaultCode::too_large);
      return false;
    }
    if (depth > limits_.depth) {
      fail(file, from.GetLineNum(),
           fmt::format("elements are nested more than {} deep", limits_.depth),
           FaultCode::too_large);
      return false;
    }
    to.tag = from.Name();
    to.text = trimmed(from.GetText());
    to.file = &file;
    to.line = std::max(from.GetLineNum(), 1);
    for (const auto* a = from.FirstAttribute(); a != nullptr; a = a->Next()) {
      to.attributes.push_back({a->Name(), a->Value()});
    }
    for (const auto* c = from.FirstChildElement(); c != nullptr; c = c->NextSiblingElement()) {
      if (std::string_view(c->Name()) == "include") {
        if (!include(*c, file, depth, to)) return false;
        continue;
      }
      to.children.emplace_back();
      if (!copy(*c, file, depth + 1, to.children.back())) return false;
    }
    return true;
  }

  bool include(const tinyxml2::XMLElement& from, const std::string& file, std::size_t depth,
               Element& into) {
    const int line = from.GetLineNum();
    const char* const named = from.Attribute("file");
    if (named == nullptr) {
      fail(file, line, "include: \"file\" is missing", FaultCode::missing_key);
      return false;
    }
    const std::optional<fs::path> path = allowed_path(named, file, line);
    if (!path) return false;
    const SceneText read = read_scene_text(path->string());
    if (!read.failure.errors.empty()) {
      fail(file, line, fmt::format("include \"{}\": {}", named, read.failure.errors[0].message),
           FaultCode::not_found);
      return false;
    }
    std::optional<Element> included = parse(read.text, path->lexically_normal().string());
    if (!included) return false;
    for (Element& child : included->children) into.children.push_back(std::move(child));
    if (depth + 1 > limits_.depth) {
      fail(file, line, "files are included too deeply", FaultCode::too_large);
      return false;
    }
    return true;
  }

  /// The path of an included file, if it lies in the folder of the model and was not yet included.
  std::optional<fs::path> allowed_path(const std::string& named, const std::string& file,
                                       int line) {
    std::optional<fs::path> path = path_within(folder_, named, allowed_);
    if (!path) {
      fail(file, line, fmt::format("include \"{}\": {}", named, file_place), FaultCode::unreadable);
      return {};
    }
    std::error_code code;
    const fs::path real = fs::weakly_canonical(*path, code);
    // A pipe or a device may be read without end.
    if (fs::exists(real, code) && !fs::is_regular_file(real, code)) {
      fail(file, line, fmt::format("include \"{}\": is no file; name a file of XML", named),
           FaultCode::unreadable);
      return {};
    }
    if (seen_.size() >= limits_.includes) {
      fail(file, line, fmt::format("more than {} files are included", limits_.includes),
           FaultCode::too_large);
      return {};
    }
    if (!seen_.insert(real.string()).second ||
        real == fs::weakly_canonical(tree_.files.front(), code)) {
      fail(file, line,
           fmt::format("include \"{}\": the file is included already; a file may be included once",
                       named),
           FaultCode::meaning);
      return {};
    }
    return path;
  }

  const Limits& limits_;
  Tree& tree_;
  fs::path folder_;   // of the model
  fs::path allowed_;  // in which files must lie; empty: folder_
  std::size_t bytes_ = 0;
  std::size_t elements_ = 0;
  std::set<std::string> seen_;  // canonical paths of the included files
};

}  // namespace

Tree parse(std::string_view text, const std::string& file_name, const Limits& limits,
           const std::string& folder) {
  Tree tree;
  tree.root = Parser(file_name, limits, folder, tree).parse(text, file_name);
  return tree;
}

#else

Tree parse(std::string_view, const std::string& file_name, const Limits&, const std::string&) {
  Tree tree;
  tree.fault = SceneError{file_name,
                          1,
                          1,
                          {},
                          "this build cannot read models in XML (tinyxml2 was not found)",
                          {},
                          {},
                          FaultCode::unreadable};
  return tree;
}

#endif

}  // namespace sheave::import::xml

namespace sheave::import {

bool is_available() { return SHEAVE_HAS_TINYXML2 != 0; }

}  // namespace sheave::import
