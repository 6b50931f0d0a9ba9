#pragma once
// The course of a run: the values of all channels at selected times.

#include <cstdint>
#include <string>
#include <vector>

#include "view/frame_channels.h"

namespace sheave::view {

/// An event of the run.
struct RecordedEvent {
  double time = 0.0;  ///< [s]
  std::string kind;   ///< "leave", "cut", "broken", "diverged", ...
  std::string text;   ///< for people
};

class Recording {
 public:
  explicit Recording(const Simulation& simulation);

  /// Records the state of the simulation, which must be later than all recorded ones.
  void add(const Simulation& simulation);
  void add(RecordedEvent event) { events_.push_back(std::move(event)); }
  /// Removes every second frame, but keeps the first and the last.
  void halve();
  /// The largest error of a length [m] that halve() would cause: at a removed time the page shows
  /// the linear interpolation between the neighbouring frames.
  [[nodiscard]] double halving_error() const;

  [[nodiscard]] const FrameChannels& channels() const { return channels_; }
  [[nodiscard]] const std::vector<double>& times() const { return times_; }  ///< [s]
  /// One list per channel, with one value per time.
  [[nodiscard]] const std::vector<std::vector<double>>& columns() const { return columns_; }
  /// In the order of time.
  [[nodiscard]] std::vector<RecordedEvent> events() const;

 private:
  FrameChannels channels_;
  std::vector<double> times_;
  std::vector<std::vector<double>> columns_;
  std::vector<RecordedEvent> events_;
  std::vector<double> values_;  // of one frame
  render::CutRopes ropes_;
};

}  // namespace sheave::view
