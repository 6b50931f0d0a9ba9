#pragma once
// Lines of a machine that change from frame to frame, divided into straight pieces. The number of
// pieces of a line is the same in all frames, as an animation of solids requires.

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
  std::optional<render::Color> color;       ///< nullopt: coloured by its tension
  std::vector<std::vector<Vector3>> lines;  ///< [m]; empty: absent in that frame
  std::vector<double> tensions;             ///< [N]

  /// Number of straight pieces that approximates the line well in all frames; 0 if it is never
  /// present.
  [[nodiscard]] std::size_t piece_count() const;
  /// The ends of the pieces in a frame (one more than pieces), evenly spaced along the line.
  [[nodiscard]] std::vector<Vector3> piece_ends(std::size_t frame, std::size_t pieces) const;
};

class LineTracks {
 public:
  void begin_frame() { ++frames_; }
  /// Sets a line in the present frame. Lines with one name form a track; each name may occur once
  /// per frame.
  void put(const std::string& name, double radius, const std::optional<render::Color>& color,
           std::vector<Vector3> line, double tension);
  /// The tracks in the order of their first appearance; each has all frames.
  [[nodiscard]] std::vector<LineTrack> finish();

 private:
  std::size_t frames_ = 0;
  std::map<std::string, std::size_t> index_;
  std::vector<LineTrack> tracks_;
};

}  // namespace sheave::view
