#pragma once
// Every place of a scene that can hold a text, taken from the tables of the format: a new field or
// type needs no line here.

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "scenes/format.h"

namespace sheave::test {

/// A key of an object of a scene whose value is a text, or a list of texts.
struct TextKey {
  std::string name;  ///< "body.name", "link rolling.body", for messages
  const ObjectFormat* format = nullptr;
  const Variant* variant = nullptr;  ///< null: of all types
  std::string key;
  bool list = false;
};

/// All of them: free texts, names, references, choices and types.
[[nodiscard]] std::vector<TextKey> text_keys();

/// Scenes in which texts are put.
class TextPlaces {
 public:
  /// Takes the objects of a scene that are of a format or a type that no scene before had.
  void add(nlohmann::json scene);
  /// A scene with `text` at a key; null if no scene has such an object.
  [[nodiscard]] nlohmann::json with(const TextKey& key, const std::string& text) const;

 private:
  void look(const nlohmann::json& value, const ObjectFormat& format,
            const nlohmann::json::json_pointer& place);

  using Kind = std::pair<const ObjectFormat*, const Variant*>;
  std::vector<nlohmann::json> scenes_;
  std::map<Kind, std::pair<std::size_t, nlohmann::json::json_pointer>> places_;
};

}  // namespace sheave::test
