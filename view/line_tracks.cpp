#include "view/line_tracks.h"

#include <algorithm>
#include <utility>

namespace sheave::view {
namespace {

constexpr std::size_t most_pieces = 64;

}  // namespace

std::size_t LineTrack::piece_count() const {
  std::size_t most = 0;
  for (const auto& line : lines) most = std::max(most, line.size());
  if (most < 2) return 0;
  return std::min(most_pieces, most - 1);
}

std::vector<Vector3> LineTrack::piece_ends(std::size_t frame, std::size_t pieces) const {
  const std::vector<Vector3>& line = lines[frame];
  std::vector<double> along{0.0};
  for (std::size_t k = 1; k < line.size(); ++k) {
    along.push_back(along.back() + (line[k] - line[k - 1]).norm());
  }
  std::vector<Vector3> ends;
  std::size_t k = 1;
  for (std::size_t i = 0; i <= pieces; ++i) {
    const double wanted = along.back() * static_cast<double>(i) / static_cast<double>(pieces);
    while (k + 1 < line.size() && along[k] < wanted) ++k;
    const double step = along[k] - along[k - 1];
    const double share = step > 0.0 ? std::clamp((wanted - along[k - 1]) / step, 0.0, 1.0) : 0.0;
    ends.emplace_back(line[k - 1] + share * (line[k] - line[k - 1]));
  }
  return ends;
}

void LineTracks::put(const std::string& name, double radius,
                     const std::optional<render::Color>& color, std::vector<Vector3> line,
                     double tension) {
  const auto [place, is_new] = index_.emplace(name, tracks_.size());
  if (is_new) tracks_.push_back({name, radius, color, {}, {}});
  LineTrack& track = tracks_[place->second];
  track.lines.resize(frames_ - 1);
  track.tensions.resize(frames_ - 1, 0.0);
  if (line.size() < 2) line.clear();
  track.lines.push_back(std::move(line));
  track.tensions.push_back(tension);
}

std::vector<LineTrack> LineTracks::finish() {
  for (LineTrack& track : tracks_) {
    track.lines.resize(frames_);
    track.tensions.resize(frames_, 0.0);
  }
  index_.clear();
  return std::move(tracks_);
}

}  // namespace sheave::view
