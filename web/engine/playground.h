#pragma once
// The machine of a page: the scene's world, the pointer that drags bodies, and a finer reference
// world that gives the error.

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "measure/trajectory.h"
#include "scenes/scene.h"
#include "view/frame_channels.h"
#include "view/machine_json.h"
#include "web/engine/control_list.h"
#include "web/engine/pointer_spring.h"

namespace sheave::web {

using Json = nlohmann::ordered_json;

/// The settings that can change while a machine runs.
struct Settings {
  StepSettings step;               ///< dt cannot change
  std::optional<Vector3> gravity;  ///< [m/s2]; default: the scene's
};

/// Faults for an editor: {"errors": [{"line", "column", "pointer", "message", "value", "allowed"}]}.
[[nodiscard]] Json faults_json(const std::vector<SceneError>& errors);
[[nodiscard]] Json faults_json(const Errors& errors);

class Playground {
 public:
  enum class Ending { none, diverged, stopped };

  /// Null, with faults in `answer`, if the text is no valid scene.
  static std::unique_ptr<Playground> open(const std::string& text,
                                          const std::vector<Override>& overrides, Json& answer);

  /// {"machine", "channels", "controls", "settings"}: everything that a page needs to show the
  /// machine.
  [[nodiscard]] Json describe() const;

  /// Makes a step. `text` then has the events, one per line, or the reason why the run cannot
  /// continue. A step that diverged leaves the state unchanged.
  Ending step(std::string& text);
  /// One value per channel, for the present state.
  [[nodiscard]] const std::vector<double>& sample();
  /// Whether channels have been added since describe(), because a cable lies on more bodies.
  [[nodiscard]] bool has_new_channels() const { return described_ < channels_.channels().size(); }

  /// Stores the present state for go_back(). Only the last 32 stored states are kept.
  void keep();
  /// Restores the latest stored state that is at least `seconds` old, or else the oldest one. False
  /// if no state is stored. An infinite time restores the start.
  bool go_back(double seconds);

  Errors set_control(const std::string& name, double value);
  Errors change(const Settings& settings);

  Errors grab(int body, const Vector3& point);
  void drag(const Vector3& target);
  void release();
  [[nodiscard]] const PointerSpring& pointer() const { return pointer_; }

  /// Begins a finer reference world from the present state, with `direct`, `rattle` and
  /// `refinement` times the substeps. 0: no reference.
  Errors set_reference(int refinement);
  /// A step of the reference; false if it diverged, which ends the reference.
  bool step_reference();
  /// Difference to the reference as measure/run_error.h defines it for a frame; NaN without
  /// reference.
  [[nodiscard]] double error() const;

  /// The worst figures of all checked substeps since the last call with `reset`.
  [[nodiscard]] Json certificate(bool reset);
  [[nodiscard]] std::string hash_text() const;
  [[nodiscard]] const LiveWorld& world() const { return world_; }

 private:
  struct Kept {
    double time = 0.0;
    LiveSnapshot snapshot;
  };
  struct Reference {
    LiveWorld world;
    PointerSpring pointer;
    std::vector<measure::TrackedBody> bodies;
  };

  Playground(Scene scene, Simulation simulation);
  [[nodiscard]] std::string events_text(const LiveReport& report) const;

  Scene scene_;
  LiveWorld world_;
  view::FrameChannels channels_;
  mutable std::size_t described_ = 0;
  std::vector<double> values_;
  render::CutRopes ropes_;
  std::vector<SliderControl> controls_;
  PointerSpring pointer_;
  std::optional<LiveSnapshot> start_;
  std::deque<Kept> kept_;
  std::optional<Reference> reference_;
};

}  // namespace sheave::web
