#pragma once
// The ways that bodies have come, as lines that fade.

#include <deque>
#include <string>
#include <vector>

#include "engine/world.h"
#include "render/draw_list.h"
#include "scenes/scene.h"

namespace sheave::command {

class Trails {
 public:
  /// Each as NAME:SECONDS, of the body's origin, or NAME:SECONDS:X,Y,Z, of a point in its frame [m].
  /// A Failure (2) if one is not.
  Trails(const Scene& scene, const std::vector<std::string>& trails);

  /// How far moments may be apart for the lines to be smooth [s]; 0 if there are no trails.
  [[nodiscard]] double longest_interval() const;
  /// Takes note of where the bodies are now; moments must come in order.
  void observe(const World& world);
  /// Adds the lines up to the last moment; cable_radius: what cables are drawn with [m].
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
