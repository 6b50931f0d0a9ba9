#include "tests/support/scene_texts.h"

#include <optional>
#include <string_view>
#include <variant>

namespace sheave::test {
namespace {

using Json = nlohmann::json;

bool holds_text(const FieldSlot& slot) {
  return std::holds_alternative<std::string*>(slot) || std::holds_alternative<BodyId*>(slot) ||
         std::holds_alternative<std::optional<BodyId>*>(slot) ||
         std::holds_alternative<ChoiceSlot>(slot);
}

/// Walks the tree of formats, each of which it sees once.
class TextKeys {
 public:
  void visit(const ObjectFormat& format) {
    if (!seen_.insert(&format).second) return;
    for (const TableFormat& table : format.tables) add(format, nullptr, table);
    if (!format.variants.empty()) {
      keys.push_back({std::string(format.name) + ".type", &format, nullptr, "type", false});
    }
    for (const Variant& variant : format.variants) {
      add(format, &variant, variant.table);
      for (const Member& member : variant.members) visit(*member.format);
    }
    for (const Member& member : format.members) visit(*member.format);
  }

  std::vector<TextKey> keys;

 private:
  void add(const ObjectFormat& format, const Variant* variant, const TableFormat& table) {
    for (const Field& field : table.fields) {
      const FieldSlot slot = slot_of(field, table.defaults.get());
      const bool list = std::holds_alternative<std::vector<std::string>*>(slot);
      if (!list && !holds_text(slot)) continue;
      std::string name(format.name);
      if (variant != nullptr) name.append(" ").append(variant->name);
      keys.push_back(
          {name.append(".").append(field.name), &format, variant, std::string(field.name), list});
    }
  }

  std::set<const ObjectFormat*> seen_;
};

}  // namespace

std::vector<TextKey> text_keys() {
  TextKeys walk;
  walk.visit(scene_format());
  return std::move(walk.keys);
}

void TextPlaces::add(Json scene) {
  scenes_.push_back(std::move(scene));
  look(scenes_.back(), scene_format(), Json::json_pointer());
}

void TextPlaces::look(const Json& value, const ObjectFormat& format,
                      const Json::json_pointer& place) {
  if (!value.is_object()) return;
  const std::size_t scene = scenes_.size() - 1;
  places_.try_emplace(Kind{&format, nullptr}, scene, place);
  const Variant* variant = nullptr;
  if (!format.variants.empty()) variant = format.variant(value.value("type", ""));
  if (variant != nullptr) places_.try_emplace(Kind{&format, variant}, scene, place);
  const auto look_at = [&](const Member& member) {
    const auto found = value.find(std::string(member.name));
    if (found == value.end()) return;
    const Json::json_pointer there = place / std::string(member.name);
    if (!member.list) return look(*found, *member.format, there);
    for (std::size_t i = 0; i < found->size(); ++i) {
      look(found->at(i), *member.format, there / i);
    }
  };
  for (const Member& member : format.members) look_at(member);
  if (variant == nullptr) return;
  for (const Member& member : variant->members) look_at(member);
}

Json TextPlaces::with(const TextKey& key, const std::string& text) const {
  const auto found = places_.find(Kind{key.format, key.variant});
  if (found == places_.end()) return nullptr;
  Json scene = scenes_[found->second.first];
  Json& place = scene.at(found->second.second)[key.key];
  if (key.list) {
    place = Json::array({text});
  } else {
    place = text;
  }
  return scene;
}

}  // namespace sheave::test
