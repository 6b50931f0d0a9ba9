#pragma once
// Reads the value of one field.

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "engine/field.h"
#include "scenes/json/document.h"

namespace sheave {

/// The bodies that references may name.
struct BodyNames {
  std::unordered_map<std::string_view, int> indices;
  std::vector<std::string_view> in_order;  ///< some of which may not be there any more
};

/// Reads `node` into a slot of `field`; reports what the field does not accept.
void read_value(const json::Document& document, json::Faults& faults, const BodyNames& bodies,
                const Field& field, json::NodeId node, const FieldSlot& slot);

/// Adds a fault of a value, with its place, pointer and text.
void report(const json::Document& document, json::Faults& faults, json::NodeId node, FaultCode code,
            std::string message, std::string allowed);

}  // namespace sheave
