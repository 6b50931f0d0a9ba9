#pragma once
// Space and range of tensions of a whole run, for its view.
//
//   ViewSurvey survey;
//   for each step that will be a frame: survey.add(world, reports);
//   options.run_bounds = survey.bounds();
//   if (!options.tension_max) options.tension_max = survey.tension_max();

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "cable/cable_report.h"
#include "engine/world.h"
#include "render/camera.h"
#include "render/draw_list.h"
#include "render/joint_view.h"

namespace sheave::render {

class ViewSurvey {
 public:
  /// Adds a state; cheap compared with a step of the simulation.
  void add(const World& world, std::span<const CableReport> cables);
  /// Adds only the tensions of a state.
  void add_tensions(const World& world, std::span<const CableReport> cables);
  /// Looks for the largest tension in a state, without adding it to the scale.
  void look_for_highest(const World& world, std::span<const CableReport> cables);
  /// Adds only the space of a state.
  void add_room(const World& world, std::span<const CableReport> cables);

  /// Box round all bodies and cables in all states added [m]; empty if there were none.
  [[nodiscard]] const Eigen::AlignedBox3d& bounds() const { return bounds_; }

  /// A round number [N] that 98 % of all tensions above zero do not exceed, so that a short peak
  /// does not make all others look slack. Without such a tension the weight of all bodies, or 1.
  [[nodiscard]] double tension_max() const;
  /// Time of the state with the largest tension among those of look_for_highest() [s]; nothing
  /// without a tension. Of equal tensions the first one counts.
  [[nodiscard]] std::optional<double> highest() const { return highest_; }
  /// Travels of sliders in all added states.
  [[nodiscard]] const std::vector<JointTravel>& travels() const { return travels_; }

 private:
  /// Tensions are counted in 16 classes per factor of two; exact quantiles would need the whole
  /// run.
  static constexpr int classes_per_octave = 16;
  static constexpr int lowest_exponent = -64;
  static constexpr int octaves = 192;

  Eigen::AlignedBox3d bounds_;
  std::vector<JointTravel> travels_;
  std::array<std::int64_t, static_cast<std::size_t>(classes_per_octave* octaves)> counts_{};
  double largest_ = 0.0;  ///< of the scale [N]
  double peak_ = 0.0;     ///< at highest_ [N]
  std::optional<double> highest_;
  double weight_ = 0.0;  ///< of all bodies [N]
};

/// A camera that shows the box of a whole run, clear of the texts of a typical frame: along the
/// plane's normal for scenes that move in a plane, from the side and above for others; up is
/// against gravity. width, height: of the picture [pixels].
[[nodiscard]] Camera automatic_camera(const Model& model, std::span<const CableReport> cables,
                                      const Eigen::AlignedBox3d& run_bounds,
                                      const DrawList& typical, int width, int height);

}  // namespace sheave::render
