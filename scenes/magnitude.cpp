#include "scenes/magnitude.h"

#include <cmath>

#include <fmt/format.h>

#include "engine/body_mass.h"
#include "engine/field_check.h"
#include "scenes/format.h"

namespace sheave {
namespace {

bool is_vouched_for(double value) {
  const double size = std::abs(value);
  return size == 0.0 || !std::isfinite(size) ||
         (size >= smallest_magnitude && size <= largest_magnitude);
}

/// Walks over a scene by the tables with which it is read.
class MagnitudeCheck {
 public:
  MagnitudeCheck(std::vector<MagnitudeWarning>& warnings, std::size_t most)
      : warnings_(warnings), most_(most) {}

  /// `path` composes the pointer of the object; it is called only for a warning.
  template <class Path>
  void fields(std::span<const Field> table, const void* object, const Path& path) {
    for (const Field& field : table) {
      // Slots serve reading and writing; this code only reads.
      // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast)
      const FieldSlot slot = field.slot(const_cast<void*>(object));
      const auto tell = [&](double value, std::string_view item) {
        if (!is_vouched_for(value)) add(fmt::format("{}/{}{}", path(), field.name, item), value);
      };
      if (const auto* real = std::get_if<double*>(&slot)) tell(**real, "");
      if (const auto* real = std::get_if<std::optional<double>*>(&slot)) {
        if (**real) tell(***real, "");
      }
      if (const auto* vector = std::get_if<Vector3*>(&slot)) components(**vector, "", tell);
      if (const auto* vector = std::get_if<std::optional<Vector3>*>(&slot)) {
        if (**vector) components(***vector, "", tell);
      }
      if (const auto* list = std::get_if<std::vector<double>*>(&slot)) {
        for (std::size_t i = 0; i < (*list)->size(); ++i) tell((**list)[i], fmt::format("/{}", i));
      }
      if (const auto* list = std::get_if<std::vector<Vector3>*>(&slot)) {
        for (std::size_t i = 0; i < (*list)->size(); ++i) {
          components((**list)[i], fmt::format("/{}", i), tell);
        }
      }
    }
  }

  void add(std::string pointer, double value) {
    if (warnings_.size() >= most_) return;
    std::string message = fmt::format(
        "{} is {}: results are reliable for numbers from {} to {} only, because products beyond "
        "them are too large or too small for a double; choose other units",
        pointer, number_text(value), number_text(smallest_magnitude),
        number_text(largest_magnitude));
    warnings_.push_back({std::move(pointer), value, std::move(message)});
  }

 private:
  template <class Tell>
  static void components(const Vector3& vector, const std::string& item, const Tell& tell) {
    for (int i = 0; i < 3; ++i) {
      if (!is_vouched_for(vector[i])) tell(vector[i], fmt::format("{}/{}", item, i));
    }
  }

  std::vector<MagnitudeWarning>& warnings_;
  std::size_t most_;
};

void check_body(const BodyDef& body, std::size_t index, MagnitudeCheck& check) {
  const auto path = [&] { return fmt::format("/bodies/{}", index); };
  check.fields(BodyDef::field_table(), &body, path);
  for (std::size_t k = 0; k < body.shapes.size(); ++k) {
    const PlacedShape& placed = body.shapes[k];
    const auto shape_path = [&] {
      return body.shapes.size() == 1 ? path() + "/shape" : fmt::format("{}/shapes/{}", path(), k);
    };
    check.fields(shape_format().tables[0].fields, &placed, shape_path);
    const Variant* variant = shape_format().variant(placed.shape->type());
    if (variant != nullptr) {
      check.fields(variant->table.fields, placed.shape->settings(), shape_path);
    }
  }
  // An infinite mass is too large, too.
  const double mass = body.density ? defined_mass_properties(body).mass : 0.0;
  if (body.density && !(is_vouched_for(mass) && std::isfinite(mass))) {
    check.add(path() + "/density", *body.density);
  }
}

}  // namespace

std::vector<MagnitudeWarning> check_magnitudes(const Scene& scene, std::size_t most) {
  std::vector<MagnitudeWarning> warnings;
  MagnitudeCheck check(warnings, most);
  const Model& model = scene.model;
  check.fields(Scene::field_table(), &scene, [] { return ""; });
  check.fields(StepSettings::field_table(), &model.step, [] { return "/step"; });
  if (model.ground) {
    check.fields(GroundDef::field_table(), &*model.ground, [] { return "/ground"; });
  }
  for (std::size_t i = 0; i < model.bodies.size(); ++i) check_body(model.bodies[i], i, check);
  const auto typed = [&](const ObjectFormat& format, std::string_view type, const void* common,
                         const void* settings, const auto& path) {
    check.fields(format.tables[0].fields, common, path);
    const Variant* variant = format.variant(type);
    if (variant != nullptr) check.fields(variant->table.fields, settings, path);
  };
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    const JointDef& joint = *model.joints[i];
    typed(joint_format(), joint.type(), &joint, joint.settings(),
          [&] { return fmt::format("/joints/{}", i); });
  }
  for (std::size_t i = 0; i < scene.cables.size(); ++i) {
    const CableDef& cable = scene.cables[i];
    check.fields(CableDef::field_table(), &cable, [&] { return fmt::format("/cables/{}", i); });
    for (std::size_t k = 0; k < cable.links.size(); ++k) {
      const LinkDef& link = *cable.links[k];
      typed(link_format(), link.type(), &link, link.settings(),
            [&] { return fmt::format("/cables/{}/links/{}", i, k); });
    }
  }
  for (std::size_t i = 0; i < model.colliders.size(); ++i) {
    check.fields(ColliderDef::field_table(), &model.colliders[i],
                 [&] { return fmt::format("/colliders/{}", i); });
  }
  return warnings;
}

}  // namespace sheave
