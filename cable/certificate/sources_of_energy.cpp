#include "cable/certificate/sources_of_energy.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "cable/link.h"
#include "engine/field.h"
#include "engine/joint.h"

namespace sheave::certify {
namespace {

// Settings that dissipate energy, by the ends of their field names.
constexpr std::array<std::string_view, 8> joint_takers{
    "damping", "friction", "limit", "lower", "upper", "backlash", "compliance", "stiffness"};
// "friction" is the ending of "bearing_friction", too.
constexpr std::array<std::string_view, 3> link_takers{"friction", "efficiency", "bending_loss"};

FieldSlot slot_in(const Field& field, const void* settings) {
  return field.slot(const_cast<void*>(settings));  // NOLINT(cppcoreguidelines-pro-type-const-cast)
}

/// Whether a field with this suffix is set: a number that is not 0, a choice that is not the first,
/// or an optional value that is given.
bool is_set(std::span<const Field> fields, const void* settings, std::string_view suffix) {
  for (const Field& field : fields) {
    if (!field.name.ends_with(suffix)) continue;
    // Nothing is written through the slot.
    const FieldSlot slot = slot_in(field, settings);
    if (const auto* choice = std::get_if<ChoiceSlot>(&slot)) {
      if (choice->get(choice->object) != 0) return true;
    } else if (const auto* number = std::get_if<double*>(&slot)) {
      if (**number != 0.0) return true;
    } else if (const auto* optional_number = std::get_if<std::optional<double>*>(&slot)) {
      if ((*optional_number)->has_value()) return true;
    }
  }
  return false;
}

template <std::size_t count>
bool is_any_set(std::span<const Field> fields, const void* settings,
                const std::array<std::string_view, count>& suffixes) {
  return std::any_of(suffixes.begin(), suffixes.end(),
                     [&](std::string_view suffix) { return is_set(fields, settings, suffix); });
}

/// The fields of an object's derived type, from the registry of its types.
template <class Object, class Types>
std::span<const Field> fields_of(const Object& object, const Types& types) {
  const auto type = std::find_if(types.begin(), types.end(),
                                 [&](const auto& entry) { return entry.name == object.type(); });
  return type == types.end() ? std::span<const Field>() : type->fields();
}

bool is_driven(const BodyDef& body) {
  return body.mobility == Mobility::kinematic || body.drive != DriveKind::none ||
         body.torque != Vector3::Zero();
}

bool is_fed(const CableDef& cable) {
  return std::any_of(cable.links.begin(), cable.links.end(), [](const auto& link) {
    return is_set(fields_of(*link, link_types()), link->settings(), "feed_speed");
  });
}

bool takes_energy(const JointDef& joint) {
  return joint.breaking_force || joint.breaking_torque ||
         is_any_set(fields_of(joint, joint_types()), joint.settings(), joint_takers);
}

bool takes_energy(const CableDef& cable) {
  if (cable.is_elastic() || cable.breaking_tension || cable.cut_time ||
      cable.tangent_update != CableDef().tangent_update) {
    return true;
  }
  return std::any_of(cable.links.begin(), cable.links.end(), [](const auto& link) {
    return is_any_set(fields_of(*link, link_types()), link->settings(), link_takers);
  });
}

}  // namespace

bool is_driven(const JointDef& joint) {
  return is_set(fields_of(joint, joint_types()), joint.settings(), "drive");
}

bool is_passive(const Model& model, const std::vector<CableDef>& cables) {
  return std::none_of(model.bodies.begin(), model.bodies.end(),
                      [](const BodyDef& body) { return is_driven(body); }) &&
         std::none_of(model.joints.begin(), model.joints.end(),
                      [](const auto& joint) { return is_driven(*joint); }) &&
         std::none_of(cables.begin(), cables.end(),
                      [](const CableDef& cable) { return is_fed(cable); });
}

double extreme_setting(const JointDef& joint, std::string_view suffix, bool smallest) {
  double extreme = 0.0;
  for (const Field& field : fields_of(joint, joint_types())) {
    if (!field.name.ends_with(suffix)) continue;
    const FieldSlot slot = slot_in(field, joint.settings());
    const auto* number = std::get_if<double*>(&slot);
    if (number == nullptr || !(**number > 0.0)) continue;
    const bool beyond = smallest ? **number < extreme : **number > extreme;
    if (extreme == 0.0 || beyond) extreme = **number;
  }
  return extreme;
}

bool keeps_energy(const Model& model, const std::vector<CableDef>& cables) {
  if (model.ground || !model.colliders.empty()) return false;
  return std::none_of(model.bodies.begin(), model.bodies.end(),
                      [](const BodyDef& body) {
                        return body.damping != 0.0 || body.angular_damping != 0.0 || body.wrappable;
                      }) &&
         std::none_of(model.joints.begin(), model.joints.end(),
                      [](const auto& joint) { return takes_energy(*joint); }) &&
         std::none_of(cables.begin(), cables.end(),
                      [](const CableDef& cable) { return takes_energy(cable); });
}

}  // namespace sheave::certify
