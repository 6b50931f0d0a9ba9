#pragma once
// Reads the parts of a world in the form of scene files: bodies, joints, cables, links, colliders.
// All readers of such parts accept the same keys, have the same defaults and report the same
// faults.

#include <algorithm>
#include <array>
#include <memory>
#include <span>

#include "cable/cable.h"
#include "engine/body.h"
#include "engine/contacts/collider.h"
#include "engine/joint.h"
#include "scenes/field_reader.h"
#include "scenes/placement.h"

namespace sheave {

/// Reports faults of a part to the document; the returned value is then unusable. Combinations of
/// settings are not checked here. Bodies that parts refer to must have been declared:
/// fields().declare_body().
class PartReader {
 public:
  /// Both must outlive the reader.
  PartReader(const json::Document& document, json::Faults& faults)
      : document_(document), fields_(document, faults) {}

  [[nodiscard]] const json::Document& document() const { return document_; }
  [[nodiscard]] FieldReader& fields() { return fields_; }

  /// With `placement`, a body may be relative to another body, which is stored there and left to
  /// the caller (PlacementResolver). Otherwise a relative body is a fault.
  [[nodiscard]] BodyDef read_body(json::NodeId node, BodyPlacementDef* placement = nullptr);
  /// Reads the shapes of an object that has them as a body has. False if it has neither key.
  bool read_shapes(json::NodeId node, std::vector<PlacedShape>& shapes);
  /// Null if there is no such type. With `bodies`, in the order of their numbers, the joint may be
  /// relative to one of them. Otherwise a relative joint is a fault.
  [[nodiscard]] std::shared_ptr<JointDef> read_joint(json::NodeId node,
                                                     const std::vector<BodyDef>* bodies = nullptr);
  [[nodiscard]] CableDef read_cable(json::NodeId node);
  /// Null if there is no such type.
  [[nodiscard]] std::shared_ptr<LinkDef> read_link(json::NodeId node);
  [[nodiscard]] ColliderDef read_collider(json::NodeId node);

  /// A new object of the type that the node's key "type" chooses, with its settings; null if it
  /// chooses none. `common` returns the object of the table that all types share.
  template <class Base, class Common>
  std::shared_ptr<Base> read_typed(json::NodeId node, const ObjectFormat& format,
                                   std::span<const TypeEntry<Base>> types, const Common& common) {
    const Variant* variant = fields_.read_type(node, format);
    if (variant == nullptr) return nullptr;
    const auto entry = std::find_if(types.begin(), types.end(), [&](const TypeEntry<Base>& type) {
      return type.name == variant->name;
    });
    std::shared_ptr<Base> object = entry->make();
    const std::array<void*, 1> shared{common(*object)};
    fields_.read_object(node, format, shared, variant, settings_of(*object));
    return object;
  }

 private:
  /// The object was created here and is not constant; settings() only gives its derived type.
  template <class Base>
  static void* settings_of(const Base& object) {
    return const_cast<void*>(object.settings());  // NOLINT(*-const-cast)
  }
  void refuse_relative(json::NodeId node);
  void refuse_empty_tables(json::NodeId node);
  void read_shape(json::NodeId node, std::vector<PlacedShape>& shapes);

  const json::Document& document_;
  FieldReader fields_;
};

/// Pointer of a setting in a text, where a body's only shape may be written in two ways.
[[nodiscard]] std::string pointer_in_text(const json::Document& document, const std::string& path);

}  // namespace sheave
