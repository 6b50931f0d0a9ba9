#pragma once
// The looks of a machine for a page: JSON that web/src/machine.ts describes.

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "render/camera.h"
#include "render/view_builder.h"
#include "scenes/scene.h"
#include "view/frame_channels.h"

namespace sheave::view {

using Json = nlohmann::ordered_json;

/// What is known of how a run is seen.
struct MachineLook {
  const render::ViewBuilder& builder;
  render::Camera camera;
  Eigen::AlignedBox3d bounds;  ///< of all that the run shows [m]; may be empty
  double tension_max = 1.0;    ///< the top of the colour scale [N], > 0
};

/// `reports` are of a state of the scene's simulation.
[[nodiscard]] Json machine_json(const Scene& scene, const std::vector<CableReport>& reports,
                                const FrameChannels& channels, const MachineLook& look);

/// Name, unit, hidden.
[[nodiscard]] Json channel_json(const FrameChannel& channel);

/// "#rrggbb".
[[nodiscard]] std::string color_text(const render::Color& color);

}  // namespace sheave::view
