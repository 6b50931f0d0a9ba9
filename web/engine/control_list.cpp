#include "web/engine/control_list.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "cable/links/attachment.h"
#include "engine/joints/coordinate.h"
#include "scenes/control/load_muscle.h"
#include "scenes/control/scene_supervisor.h"

namespace sheave::web {
namespace {

/// Collects the names that are controls.
class Collector {
 public:
  explicit Collector(const Simulation& simulation) : simulation_(simulation) {}

  void add(const std::string& name, const std::string& unit, const std::vector<double>& values,
           double least) {
    auto point = find_control(name, simulation_);
    if (!point) return;
    SliderControl control;
    control.name = name;
    control.unit = unit;
    control.value = values.empty() ? 0.0 : values.front();
    control.point = *point;
    double size = least;
    for (const double value : values) size = std::max(size, 2.0 * std::abs(value));
    control.minimum = -size;
    control.maximum = size;
    list.push_back(control);
  }

  std::vector<SliderControl> list;

 private:
  const Simulation& simulation_;
};

std::string unit_of(DriveKind kind) {
  if (kind == DriveKind::speed) return "rad/s";
  return kind == DriveKind::angle ? "rad" : "N m";
}

/// The numbers of the joint's field `name`, if it has such a field.
std::optional<std::vector<double>> numbers_of(const JointDef& joint, std::string_view name) {
  for (const auto& entry : joint_types()) {
    if (entry.name != joint.type()) continue;
    for (const Field& field : entry.fields()) {
      if (field.name != name) continue;
      // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast): only read
      const FieldSlot slot = field.slot(const_cast<void*>(joint.settings()));
      if (const auto* list = std::get_if<std::vector<double>*>(&slot)) return **list;
      if (const auto* one = std::get_if<std::optional<double>*>(&slot)) {
        return *one && **one ? std::vector<double>{***one} : std::vector<double>{};
      }
    }
  }
  return std::nullopt;
}

void add_joint(const JointDef& joint, Collector& controls) {
  std::vector<std::string> prefixes{""};
  for (const JointCoordinateInfo& coordinate : joint.coordinates()) {
    prefixes.push_back(std::string(coordinate.name) + "_");
  }
  for (const std::string& prefix : prefixes) {
    const auto values = numbers_of(joint, prefix + "drive_values");
    if (!values) continue;
    controls.add(joint.name + "." + prefix + "drive", "", *values, 1.0);
    const auto limit = numbers_of(joint, prefix + "drive_limit");
    if (!limit || limit->empty()) continue;
    const std::size_t before = controls.list.size();
    controls.add(joint.name + "." + prefix + "drive_limit", "", *limit, 1.0);
    if (controls.list.size() > before) controls.list.back().minimum = 0.0;
  }
}

}  // namespace

std::vector<SliderControl> slider_controls(const Scene& scene, const Simulation& simulation) {
  Collector controls(simulation);
  for (const BodyDef& body : scene.model.bodies) {
    if (body.drive == DriveKind::none) continue;
    controls.add(body.name + ".drive", unit_of(body.drive), body.drive_values, 1.0);
  }
  for (const auto& joint : scene.model.joints) add_joint(*joint, controls);
  for (const CableDef& cable : scene.cables) {
    for (std::size_t k = 0; k < cable.links.size(); ++k) {
      const auto* end = dynamic_cast<const AttachmentLink*>(cable.links[k].get());
      if (end == nullptr || !end->feed_speed) continue;
      controls.add(cable.name + ".link" + std::to_string(k) + ".feed_speed", "m/s",
                   {*end->feed_speed}, 0.2);
    }
  }
  for (const auto& load : scene.loads) {
    const auto* muscle = dynamic_cast<const MuscleLoad*>(load.get());
    if (muscle == nullptr) continue;
    const std::size_t before = controls.list.size();
    controls.add(muscle->name + ".excitation", "", muscle->excitations, 1.0);
    if (controls.list.size() == before) continue;
    controls.list.back().minimum = 0.0;
    controls.list.back().maximum = 1.0;
  }
  return controls.list;
}

}  // namespace sheave::web
