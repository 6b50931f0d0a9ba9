#include "cable/machine_layout.h"

namespace sheave {
namespace {

/// The length tells where a name ends that contains spaces.
void add_named(std::string_view kind, std::string_view name, std::string& text) {
  text += kind;
  text += ' ' + std::to_string(name.size()) + ':';
  text += name;
  text += '\n';
}

void add_numbered(std::string_view kind, int index, std::string& text) {
  text += kind;
  text += ' ' + std::to_string(index) + '\n';
}

}  // namespace

std::string machine_layout_text(const Model& model, const std::vector<CableDef>& cables) {
  std::string text;
  for (const BodyDef& body : model.bodies) {
    add_named(mobility_names[static_cast<std::size_t>(body.mobility)], body.name, text);
  }
  for (const auto& joint : model.joints) {
    if (joint != nullptr) add_named(joint->type(), joint->name, text);
  }
  for (const CableDef& cable : cables) {
    add_named(cable.closed ? "belt" : "cable", cable.name, text);
    for (const auto& link : cable.links) {
      add_numbered(link->type(), link->body.index, text);
      if (link->exit_body() != link->body) add_numbered("to", link->exit_body().index, text);
    }
  }
  for (const ColliderDef& collider : model.colliders) {
    add_numbered("collider", collider.body.index, text);
  }
  return text;
}

std::uint64_t layout_of(const Model& model, const std::vector<CableDef>& cables) {
  return hash_of_text(machine_layout_text(model, cables));
}

std::uint64_t hash_of_text(std::string_view text) {
  std::uint64_t value = 0xcbf29ce484222325;
  for (const char c : text) {
    value = (value ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  }
  return value == 0 ? 1 : value;
}

}  // namespace sheave
