#pragma once
// The channels of a recorded frame; each channel has one number per frame. The first channels are
// the columns of `sheave run --out`. Hidden channels follow, which only a picture needs. A page
// finds channels by their names (web/src/machine_state.ts).
//
//   FrameChannels channels(simulation, reports);
//   for each moment: if (!channels.fits(reports)) channels.extend(reports);
//                    channels.sample(simulation, reports, values);

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "cable/cable_report.h"
#include "cable/simulation.h"
#include "render/cut_ropes.h"
#include "scenes/observables.h"

namespace sheave::view {

/// The kind of a channel's values, which determines the accuracy of their storage.
enum class ChannelKind { length, angle, force, other };

struct FrameChannel {
  std::string name;  ///< e.g. "rope.1.tension"
  std::string unit;  ///< "N"; empty: dimensionless
  ChannelKind kind = ChannelKind::other;
  bool hidden = false;  ///< not a column of a table
};

class FrameChannels {
 public:
  /// The channels of a simulation; `reports` belong to any of its states.
  FrameChannels(const Simulation& simulation, const std::vector<CableReport>& reports);

  [[nodiscard]] const std::vector<FrameChannel>& channels() const { return channels_; }
  /// Number of wraps, on bodies outside its list of links, that a cable may have.
  [[nodiscard]] int wrap_slots(std::size_t cable) const {
    return static_cast<int>(cables_[cable].wraps.size());
  }

  /// Whether every wrap, outline corner and piece of the present cables has a channel.
  [[nodiscard]] bool fits(const std::vector<CableReport>& reports,
                          const render::CutRopes& ropes) const;
  /// Adds the missing channels. Existing channels keep their indices; the new ones follow. The
  /// values of new channels in earlier frames are meaningless and unused, because the counts in
  /// those frames exclude them.
  void extend(const std::vector<CableReport>& reports, const render::CutRopes& ropes);

  /// One value per channel; NaN if unknown, such as a force before the first step. `reports` belong
  /// to the simulation's state and must fit; `ropes` has followed the run to this state.
  void sample(const Simulation& simulation, const std::vector<CableReport>& reports,
              const render::CutRopes& ropes, std::vector<double>& values) const;

 private:
  /// The channel indices of a link or wrap.
  struct LinkSlot {
    std::string prefix;  ///< "rope.link2."
    int first = 0;       ///< first of the channels that all links have
    int path_count = -1;
    std::vector<int> corners;  ///< channel of x of each corner of its path
  };
  /// The channels of a line in the world with up to so many points.
  struct LineSlot {
    std::string prefix;  ///< "rope.piece0."
    int count = 0;       ///< channel of the number of points
    std::vector<int> points;
  };
  struct CableSlots {
    std::string name;
    std::vector<LinkSlot> links;
    std::vector<LinkSlot> wraps;
    std::vector<int> spans;  ///< channel of the start's x of each span
    /// Rope with weight: channel of x of the force at the start of each span; empty for others.
    std::vector<int> forces;
    /// Rope with a floor: channel of the length on the floor of each span, and behind it its places.
    std::vector<int> floors;
    int wrap_count = 0;              ///< channel of the number of wraps
    std::array<LineSlot, 2> pieces;  ///< of a cut cable
  };

  int add(const std::string& name, const char* unit, ChannelKind kind);
  int add_point(const std::string& name, ChannelKind kind);
  void add_columns(const Model& model);
  LinkSlot add_link(const std::string& prefix);
  void add_wrap(CableSlots& cable);
  void extend_piece(LineSlot& slot, std::size_t points);
  void write_pieces(const CableSlots& cable, std::span<const std::vector<Vector3>> pieces,
                    std::vector<double>& values) const;
  void extend_path(LinkSlot& slot, std::size_t corners);

  ObservableSet observables_;
  std::vector<FrameChannel> channels_;
  std::vector<CableSlots> cables_;
};

}  // namespace sheave::view
