#pragma once
// A machine that a page holds: the scene's world, the pointer that drags it, and a finer world beside
// it that tells its error.

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

/// What can be changed while a machine runs.
struct Settings {
  StepSettings step;               ///< its dt does not change
  std::optional<Vector3> gravity;  ///< default: the scene's [m/s2]
};

/// Faults for an editor: {"errors": [{"line", "column", "pointer", "message", "value", "allowed"}]}.
[[nodiscard]] Json faults_json(const std::vector<SceneError>& errors);
[[nodiscard]] Json faults_json(const Errors& errors);

class Playground {
 public:
  enum class Ending { none, diverged, stopped };

  /// Null with faults in `answer` if the text is no valid scene.
  static std::unique_ptr<Playground> open(const std::string& text,
                                          const std::vector<Override>& overrides, Json& answer);

  /// {"machine", "channels", "controls", "settings"}: all that a page needs to show it.
  [[nodiscard]] Json describe() const;

  /// A step; `text` then says what happened, one event a line, or why it goes no further. A step
  /// that diverged has not been.
  Ending step(std::string& text);
  /// One value per channel, of the state as it is.
  [[nodiscard]] const std::vector<double>& sample();
  /// Whether channels have been added since describe(): a cable lies on more bodies than before.
  [[nodiscard]] bool has_new_channels() const { return described_ < channels_.channels().size(); }

  /// Takes down where the machine is, to go back to; the oldest of more than 32 are forgotten.
  void keep();
  /// Back to the last kept state that is at least `seconds` old; the oldest if none is. False if
  /// there is none. Returns to the start for an infinite time.
  bool go_back(double seconds);

  Errors set_control(const std::string& name, double value);
  Errors change(const Settings& settings);

  Errors grab(int body, const Vector3& point);
  void drag(const Vector3& target);
  void release();
  [[nodiscard]] const PointerSpring& pointer() const { return pointer_; }

  /// Begins to run a finer world from the present state beside this one: `direct` and `rattle`
  /// with `refinement` times the substeps. 0: none.
  Errors set_reference(int refinement);
  /// A step of it; false if it has gone astray, and is no more.
  bool step_reference();
  /// How far this world is from it now, as measure/run_error.h defines it for a frame; NaN without.
  [[nodiscard]] double error() const;

  /// Worst of all checked substeps since the last call with `reset`.
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
  std::vector<SliderControl> controls_;
  PointerSpring pointer_;
  std::optional<LiveSnapshot> start_;
  std::deque<Kept> kept_;
  std::optional<Reference> reference_;
};

}  // namespace sheave::web
