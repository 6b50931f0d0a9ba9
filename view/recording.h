#pragma once
// The course of a run: the values of all channels at chosen moments.

#include <cstdint>
#include <string>
#include <vector>

#include "view/frame_channels.h"

namespace sheave::view {

/// Something that happened at a moment.
struct RecordedEvent {
  double time = 0.0;  ///< [s]
  std::string kind;   ///< "leave", "cut", "broken", "diverged", ...
  std::string text;   ///< for people
};

class Recording {
 public:
  explicit Recording(const Simulation& simulation);

  /// Takes down the state of the simulation, which is later than all before.
  void add(const Simulation& simulation);
  void add(RecordedEvent event) { events_.push_back(std::move(event)); }
  /// Leaves out every second frame but the first and the last.
  void halve();
  /// The largest amount by which halve() would change a length [m] at a moment that it leaves out,
  /// where then a straight line between its neighbours is shown.
  [[nodiscard]] double halving_error() const;

  [[nodiscard]] const FrameChannels& channels() const { return channels_; }
  [[nodiscard]] const std::vector<double>& times() const { return times_; }  ///< [s]
  /// By channel, one value per time.
  [[nodiscard]] const std::vector<std::vector<double>>& columns() const { return columns_; }
  /// In the order of time.
  [[nodiscard]] std::vector<RecordedEvent> events() const;

 private:
  FrameChannels channels_;
  std::vector<double> times_;
  std::vector<std::vector<double>> columns_;
  std::vector<RecordedEvent> events_;
  std::vector<double> values_;  // of a frame
};

}  // namespace sheave::view
