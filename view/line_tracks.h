#pragma once
// Lines of a machine that change from frame to frame, cut into straight pieces of which each frame
// has the same number: what an animation of solids needs.

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/vector.h"
#include "render/color.h"

namespace sheave::view {

/// One line in all frames.
struct LineTrack {
  std::string name;
  double radius = 0.01;                     ///< [m]
  std::optional<render::Color> color;       ///< nothing: by its tension
  std::vector<std::vector<Vector3>> lines;  ///< [m]; empty: not there in that frame
  std::vector<double> tensions;             ///< [N]

  /// How many straight pieces show it well in all frames; 0 if it is never there.
  [[nodiscard]] std::size_t piece_count() const;
  /// The ends of the pieces of a frame, one more than pieces, evenly along the line.
  [[nodiscard]] std::vector<Vector3> piece_ends(std::size_t frame, std::size_t pieces) const;
};

class LineTracks {
 public:
  void begin_frame() { ++frames_; }
  /// A line of this frame. Lines of one name belong together and are put once a frame at most.
  void put(const std::string& name, double radius, const std::optional<render::Color>& color,
           std::vector<Vector3> line, double tension);
  /// In the order in which they were first put; each has all frames.
  [[nodiscard]] std::vector<LineTrack> finish();

 private:
  std::size_t frames_ = 0;
  std::map<std::string, std::size_t> index_;
  std::vector<LineTrack> tracks_;
};

}  // namespace sheave::view
