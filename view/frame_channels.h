#pragma once
// What a frame of a run consists of: for each channel a number. The first channels are the columns
// of `sheave run --out`; hidden ones follow, which only a picture needs. A page finds them by their
// names (web/src/machine_state.ts).
//
//   FrameChannels channels(simulation, reports);
//   for each moment: if (!channels.fits(reports)) channels.extend(reports);
//                    channels.sample(simulation, reports, values);

#include <cstddef>
#include <string>
#include <vector>

#include "cable/cable_report.h"
#include "cable/simulation.h"
#include "scenes/observables.h"

namespace sheave::view {

/// What values of a channel are, for the accuracy that they are kept with.
enum class ChannelKind { length, angle, force, other };

struct FrameChannel {
  std::string name;  ///< e.g. "rope.1.tension"
  std::string unit;  ///< "N"; empty: a pure number
  ChannelKind kind = ChannelKind::other;
  bool hidden = false;  ///< no column of a table
};

class FrameChannels {
 public:
  /// The channels of a simulation; `reports` are of one of its states.
  FrameChannels(const Simulation& simulation, const std::vector<CableReport>& reports);

  [[nodiscard]] const std::vector<FrameChannel>& channels() const { return channels_; }
  /// How many wraps on bodies that are no link of the list a cable may have.
  [[nodiscard]] int wrap_slots(std::size_t cable) const {
    return static_cast<int>(cables_[cable].wraps.size());
  }

  /// Whether there is a channel for all that the cables now have: wraps, corners of outlines.
  [[nodiscard]] bool fits(const std::vector<CableReport>& reports) const;
  /// Makes room for it. Channels that are there keep their places; new ones follow them. Their
  /// value in frames before means nothing, for nothing counts them.
  void extend(const std::vector<CableReport>& reports);

  /// One value per channel; NaN is not known, as forces before the first step are. `reports` are of
  /// the simulation's state, and fit.
  void sample(const Simulation& simulation, const std::vector<CableReport>& reports,
              std::vector<double>& values) const;

 private:
  /// Where the values of a link or wrap are.
  struct LinkSlot {
    std::string prefix;  ///< "rope.link2."
    int first = 0;       ///< of those that all have
    int path_count = -1;
    std::vector<int> corners;  ///< x of each corner of its path
  };
  struct CableSlots {
    std::string name;
    std::vector<LinkSlot> links;
    std::vector<LinkSlot> wraps;
    std::vector<int> spans;  ///< start x of each
    int wrap_count = 0;      ///< two pieces follow it
  };

  int add(const std::string& name, const char* unit, ChannelKind kind);
  int add_point(const std::string& name, ChannelKind kind);
  void add_columns(const Model& model);
  LinkSlot add_link(const std::string& prefix);
  void add_wrap(CableSlots& cable);
  void extend_path(LinkSlot& slot, std::size_t corners);

  ObservableSet observables_;
  std::vector<FrameChannel> channels_;
  std::vector<CableSlots> cables_;
};

}  // namespace sheave::view
