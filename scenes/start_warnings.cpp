#include "scenes/start_warnings.h"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "cable/cable_system.h"
#include "cable/start_warnings.h"
#include "engine/field_check.h"
#include "scenes/control/scene_supervisor.h"
#include "scenes/magnitude.h"
#include "statics/start_at_rest.h"

namespace sheave {
namespace {

bool is_elastic(const CableDef& cable) { return cable.is_elastic(); }

/// Whether the scene tells that the pose is meant, or does not start there.
bool has_meant_start(const Scene& scene) {
  return scene.start == Start::pose || scene.start_state != nullptr;
}

/// A warning about an elastic cable that starts far from its rest, unless the scene says where it
/// starts.
void append_unsettled_warning(const Scene& scene, std::vector<Warning>& warnings) {
  constexpr double share = 0.05;
  constexpr int digits = 4;
  if (scene.start || scene.start_state != nullptr) return;
  if (std::ranges::none_of(scene.cables, is_elastic)) return;
  Result<Simulation> simulation = create_in_pose(scene);
  if (!simulation) return;
  const std::optional<UnsettledSpan> span = find_unsettled_span(std::move(*simulation), share);
  if (!span) return;
  const std::string& name = scene.cables[static_cast<std::size_t>(span->cable)].name;
  warnings.push_back(
      {"unsettled_start", name,
       fmt::format("cable \"{}\" starts with {} N in span {} and has {} N at rest, so the run "
                   "begins with a bounce; \"start\": \"rest\" in the scene, or --from-rest, "
                   "starts at rest, and \"start\": \"pose\" tells that the bounce is meant",
                   name, number_text(span->start, digits), span->span,
                   number_text(span->rest, digits))});
}

void append_strains(const Scene& scene, std::vector<Warning>& warnings) {
  const auto may_be_strained = [](const CableDef& cable) {
    return is_elastic(cable) && !cable.rest_lengths.empty();
  };
  if (scene.start_state != nullptr || std::ranges::none_of(scene.cables, may_be_strained)) return;
  const Result<Simulation> pose = Simulation::create(scene.model, scene.cables);
  if (!pose) return;
  append_uneven_warnings(*pose, warnings);
  if (!has_meant_start(scene)) append_strain_warnings(*pose, warnings);
}

}  // namespace

std::vector<Warning> magnitude_warnings(const Scene& scene) {
  constexpr std::size_t most = 10;
  std::vector<Warning> warnings;
  for (MagnitudeWarning& warning : check_magnitudes(scene, most)) {
    warnings.push_back({"magnitude", std::move(warning.pointer), std::move(warning.message)});
  }
  return warnings;
}

std::vector<Warning> strain_warnings(const Scene& scene) {
  std::vector<Warning> warnings;
  append_strains(scene, warnings);
  return warnings;
}

std::vector<Warning> scene_warnings(const Scene& scene) {
  std::vector<Warning> warnings = magnitude_warnings(scene);
  if (scene.cables.empty()) return warnings;
  const Result<Simulation> simulation = Simulation::create(scene.model, scene.cables);
  if (!simulation || simulation->cables == nullptr) return warnings;
  const auto& windings = simulation->cables->winding_warnings();
  std::vector<Warning> of_cables;
  append_winding_warnings(*simulation->cables, of_cables);
  for (std::size_t i = 0; i < of_cables.size(); ++i) {
    // There is one warning per winding, in the same order. The warning gets the position in the
    // scene.
    const auto cable =
        std::find_if(scene.cables.begin(), scene.cables.end(),
                     [&](const CableDef& own) { return own.name == windings[i].cable; });
    of_cables[i].subject =
        fmt::format("/cables/{}/links/{}", cable - scene.cables.begin(), windings[i].link);
    warnings.push_back(std::move(of_cables[i]));
  }
  append_uneven_warnings(*simulation, warnings);
  if (!has_meant_start(scene)) append_strain_warnings(*simulation, warnings);
  return warnings;
}

std::vector<Warning> start_warnings(const Scene& scene) {
  std::vector<Warning> warnings;
  if (scene.cables.empty()) return warnings;
  append_strains(scene, warnings);
  // A strained cable starts far from its rest, too.
  if (warnings.empty()) append_unsettled_warning(scene, warnings);
  const Result<Simulation> pose = Simulation::create(scene.model, scene.cables);
  if (pose && pose->cables != nullptr) append_winding_warnings(*pose->cables, warnings);
  return warnings;
}

}  // namespace sheave
