#pragma once
// Reads the value of one field.

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "engine/field.h"
#include "scenes/json/document.h"

namespace sheave {

/// The bodies to which references are allowed.
struct BodyNames {
  std::unordered_map<std::string_view, int> indices;
  std::vector<std::string_view> in_order;  ///< may contain bodies that were removed
};

/// Reads `node` into a slot of `field`; reports values that the field does not accept.
void read_value(const json::Document& document, json::Faults& faults, const BodyNames& bodies,
                const Field& field, json::NodeId node, const FieldSlot& slot);

/// Adds a fault of a value, with its position, pointer and text.
void report(const json::Document& document, json::Faults& faults, json::NodeId node, FaultCode code,
            std::string message, std::string allowed);

}  // namespace sheave
