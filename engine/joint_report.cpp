#include "engine/joint_report.h"

#include <algorithm>
#include <unordered_map>

#include "engine/world.h"

namespace sheave {

std::vector<JointReport> joint_reports(const World& world) {
  std::vector<JointReport> reports;
  for (std::size_t i = 0; i < world.features().size(); ++i) {
    const auto* joints = dynamic_cast<const JointFeature*>(world.features()[i].get());
    if (joints == nullptr) continue;
    joints->append_reports(world.bodies(), world.state(), world.feature_state(i), reports);
  }
  // Features have them by type.
  std::unordered_map<std::string_view, std::size_t> place;
  for (const auto& joint : world.model().joints) place.emplace(joint->name, place.size());
  std::sort(reports.begin(), reports.end(), [&](const JointReport& a, const JointReport& b) {
    return place.at(a.name) < place.at(b.name);
  });
  return reports;
}

}  // namespace sheave
