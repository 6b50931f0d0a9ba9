#pragma once
// From a simulated world to a draw list.
//
//   ViewBuilder builder(simulation.world, simulation.cable_reports(), options);
//   DrawList list = builder.build(simulation.world, simulation.cable_reports());
//
// Building reads the world and changes nothing in it.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "cable/cable_report.h"
#include "engine/world.h"
#include "render/body_view.h"
#include "render/cable_path.h"
#include "render/cut_ropes.h"
#include "render/draw_list.h"
#include "render/joint_view.h"
#include "scenes/annotation.h"

namespace sheave::render {

struct ViewOptions {
  /// Radius of drawn cables [m], > 0; default: suits the size of the scene.
  std::optional<double> cable_radius{};
  /// Tension at the top of the colour map [N], > 0. Default: the largest tension of each frame (the
  /// weight of all bodies if no cable has a tension). A video needs one value, e.g. from
  /// ViewSurvey; otherwise colours mean different forces in different frames.
  std::optional<double> tension_max{};
  /// Box round everything that the picture shows over the whole run [m], for the grid of the ground;
  /// default: the scene at the beginning.
  Eigen::AlignedBox3d run_bounds{};
  /// Travels of sliders (ViewSurvey); default: their stops, or an estimate from their bodies.
  std::vector<JointTravel> travels{};
  bool force_labels = false;  ///< the tension beside every span
  /// with the name of the cable at its largest tension, as far as `force_labels`
  bool label_names = false;
  /// Colours of bodies, by index. Missing ones are chosen by the kind of body.
  std::vector<std::optional<Color>> body_colors{};
  bool joints = true;  ///< pins, rods and rails
  bool legend = true;  ///< drawn only if there are cables
  bool time = true;
  std::optional<double> duration{};  ///< end of the run [s], > 0: a line of the time
  bool axes = false;                 ///< the directions of x, y and z in a corner
  std::string title{};
  std::vector<AnnotationDef> annotations{};
};

class ViewBuilder {
 public:
  /// Decides once the appearance of bodies, joints and cables. `world` and `cables` must be of the
  /// same state, usually that at time 0; later calls of build() must use the same model.
  ViewBuilder(const World& world, std::span<const CableReport> cables, ViewOptions options = {});

  /// Draw list of the present state of the world. `ropes` has the shapes of cut cables; without it
  /// their pieces hang at rest.
  [[nodiscard]] DrawList build(const World& world, std::span<const CableReport> cables,
                               const CutRopes* ropes = nullptr) const;

  [[nodiscard]] double cable_radius() const { return cable_radius_; }
  // The decisions, for other code that draws.
  /// Style of one cable of build(); `places` is that of CableReport::with_wraps_in_place().
  [[nodiscard]] CableStyle cable_style(std::size_t cable, const std::vector<int>& places,
                                       double tension_max) const;
  [[nodiscard]] const BodyView& bodies() const { return bodies_; }
  [[nodiscard]] const JointView& joints() const { return joints_; }
  [[nodiscard]] const std::optional<Plane>& floor() const { return floor_; }

 private:
  void paint_bodies();
  void add_bodies(const World& world, DrawList& list) const;
  void add_cables(std::span<const CableReport> cables, const CutRopes* ropes, DrawList& list) const;
  [[nodiscard]] double tension_scale(std::span<const CableReport> cables) const;
  void add_annotations(const World& world, DrawList& list) const;
  void add_labels(const CableReport& cable, const CableStyle& style, DrawList& list) const;

  ViewOptions options_;
  Vector3 gravity_;
  double weight_ = 0.0;  ///< of all bodies [N]
  double cable_radius_ = 0.0;
  BodyView bodies_;
  JointView joints_;
  std::optional<Plane> floor_;
};

/// Weight of all bodies [N]; 0 without gravity. Tensions below a millionth of it are rounding
/// errors of the solver and get no colour.
[[nodiscard]] double total_weight(const Model& model);

/// Against gravity; +y without any.
[[nodiscard]] Vector3 up_direction(const Model& model);

/// The normal of the plane in which the scene moves: the common axis of its wheels, or of its
/// planar bodies if it has no wheels, or of its hinges if it has neither. Nothing without a common
/// axis.
[[nodiscard]] std::optional<Vector3> motion_plane(const Model& model,
                                                  std::span<const CableReport> cables);

}  // namespace sheave::render
