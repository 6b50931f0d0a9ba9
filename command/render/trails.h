#pragma once
// The paths of bodies, as lines that fade.

#include <deque>
#include <string>
#include <vector>

#include "engine/world.h"
#include "render/draw_list.h"
#include "scenes/scene.h"

namespace sheave::command {

class Trails {
 public:
  /// Each trail is NAME:SECONDS for the body's origin, or NAME:SECONDS:X,Y,Z for a point in its
  /// frame [m]. A Failure (2) for another form.
  Trails(const Scene& scene, const std::vector<std::string>& trails);

  /// Largest interval between moments that gives smooth lines [s]; 0 if there are no trails.
  [[nodiscard]] double longest_interval() const;
  /// Records the positions of the bodies. Calls must be in the order of time.
  void observe(const World& world);
  /// Adds the lines up to the last recorded moment; cable_radius: the drawn radius of cables [m].
  void add_to(render::DrawList& list, double cable_radius) const;

 private:
  struct Place {
    double time = 0.0;  // [s]
    Vector3 position;
  };
  struct Trail {
    BodyId body;
    Vector3 point = Vector3::Zero();  // [m], body frame
    double seconds = 0.0;
    std::deque<Place> places;
  };
  std::vector<Trail> trails_;
};

}  // namespace sheave::command
