#pragma once
// A cable of a running world, link by link; internal to the cable library. What an edit takes apart
// and puts together.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "cable/link.h"
#include "engine/body_frames.h"
#include "engine/controls.h"

namespace sheave {

class CableSystem;

struct RunningSpan {
  double rest_length = 0.0;  ///< [m]
  double tension = 0.0;      ///< of the last substep [N]
  std::array<double, 2> remainder{};
};

/// What the state of the cables says of one link (cable/cable_state_layout.h).
struct RunningLink {
  std::shared_ptr<const LinkDef> link;  ///< null: a wrap
  // Numbers among all links of the world before: its own, and those before and behind it on its
  // course; -1: none.
  int was = -1;
  int came_from = -1;
  int went_to = -1;
  double size = 0.0;           ///< of what it lies on there [m]
  double stored_length = 0.0;  ///< [m]
  double slipped = 0.0;        ///< [m]; of an attachment what was fed
  double angle = 0.0;          ///< of a hybrid end's attachment [rad]
  std::int64_t slip = 0;
  std::int64_t mode = 0;
  std::int64_t stall = 0;
  double stored_strain = 0.0;  ///< of a fresh one
  bool is_fresh = false;  ///< it has just been inserted, and shares the length of the span before
  std::vector<double>
      strain;  ///< of a material: what StoredStrain saves, and what creep has lost [J]
  LinkControl control;
  // Of a wrap.
  int body = -1;
  int winding = 0;
  std::array<double, 6> plane{};

  std::optional<RunningSpan> span;  ///< that begins here; none at the end, and where no cable is

  [[nodiscard]] bool is_listed() const { return link != nullptr; }
  [[nodiscard]] bool is_wrap() const { return body >= 0; }
  /// Whether the cable touches it.
  [[nodiscard]] bool is_on_course() const { return is_wrap() || mode < lifted_mode; }
  // Of `mode`, as the state has it: the cable has left the link, and passed it to the other side.
  static constexpr std::int64_t lifted_mode = 3;
  static constexpr std::int64_t passed_mode = 4;
};

struct RunningCable {
  /// The listed links in their order, each followed by the wraps between it and the next one.
  std::vector<RunningLink> links;
  double quantum = 0.0;  ///< CompiledCable::quantum [m]
  CableControl control;
  bool is_cut = false;
  int cut_span = 0;  ///< as listed: the span in which, or behind which on a wrap, it is cut

  /// Place of a listed link among `links`.
  [[nodiscard]] std::size_t place_of(int listed) const;
  [[nodiscard]] int listed_count() const;
  /// Of everything [m]; exact as long as there is one quantum.
  [[nodiscard]] double length() const;
};

/// Where a cable of an edited world comes from.
struct CableStart {
  BodyFrames defined_in;
  int same_as = -1;                       ///< the cable of the world before that it is
  const RunningCable* running = nullptr;  ///< or what it has been made of; neither: it is new
};

}  // namespace sheave
