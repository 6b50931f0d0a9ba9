#pragma once
// The appearance of a machine for a page, as the JSON that web/src/machine.ts describes.

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "render/camera_path.h"
#include "render/view_builder.h"
#include "scenes/scene.h"
#include "view/frame_channels.h"

namespace sheave::view {

using Json = nlohmann::ordered_json;

/// Properties of the view of a run.
struct MachineLook {
  const render::ViewBuilder& builder;
  render::CameraPath camera;
  Eigen::AlignedBox3d bounds;  ///< of everything that the run shows [m]; may be empty
  double tension_max = 1.0;    ///< the top of the colour scale [N], > 0
};

/// `reports` belong to a state of the scene's simulation.
[[nodiscard]] Json machine_json(const Scene& scene, const std::vector<CableReport>& reports,
                                const FrameChannels& channels, const MachineLook& look);

/// Name, unit and hidden flag.
[[nodiscard]] Json channel_json(const FrameChannel& channel);

/// "#rrggbb".
[[nodiscard]] std::string color_text(const render::Color& color);

}  // namespace sheave::view
