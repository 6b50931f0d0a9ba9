#pragma once
// What a whole run needs to be seen well: the room it takes and the forces that occur.
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
  /// Takes note of a state; cheap compared with a step of the simulation.
  void add(const World& world, std::span<const CableReport> cables);
  /// Only of its forces.
  void add_tensions(const World& world, std::span<const CableReport> cables);
  /// Only of the room that it takes.
  void add_room(const World& world, std::span<const CableReport> cables);

  /// Box round all bodies and cables in all states added [m]; empty if there were none.
  [[nodiscard]] const Eigen::AlignedBox3d& bounds() const { return bounds_; }

  /// A round number [N] that 98 % of all tensions other than zero do not exceed, so that a short
  /// peak does not make all else look slack. The weight of all bodies, or 1, if there was none
  /// worth showing.
  [[nodiscard]] double tension_max() const;
  /// How far sliders went in all states added.
  [[nodiscard]] const std::vector<JointTravel>& travels() const { return travels_; }

 private:
  /// Tensions counted by size, 16 classes to a factor of two; exact counts would need the whole
  /// run.
  static constexpr int classes_per_octave = 16;
  static constexpr int lowest_exponent = -64;
  static constexpr int octaves = 192;

  Eigen::AlignedBox3d bounds_;
  std::vector<JointTravel> travels_;
  std::array<std::int64_t, static_cast<std::size_t>(classes_per_octave* octaves)> counts_{};
  double largest_ = 0.0;  ///< [N]
  double weight_ = 0.0;   ///< of all bodies [N]
};

/// A camera that shows the box of a whole run, clear of the texts of a typical frame: along the
/// plane's normal for scenes that move in a plane, from the side and above for others; up is
/// against gravity. width, height: of the picture [pixels].
[[nodiscard]] Camera automatic_camera(const Model& model, std::span<const CableReport> cables,
                                      const Eigen::AlignedBox3d& run_bounds,
                                      const DrawList& typical, int width, int height);

}  // namespace sheave::render
