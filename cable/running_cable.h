#pragma once
// A cable of a running world, link by link; internal to the cable library. What an edit takes apart
// and puts together.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "cable/link.h"
#include "cable/span_geometry.h"
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
  /// The spans by which the cable came to it and went on in the world that an edit takes apart: two
  /// links have the same one if it lay between them. EditDraft owns them, so a link that is kept for
  /// longer than the edit knows of none: a cable that hangs loose touches its last link anywhere.
  std::weak_ptr<const SpanGeometry> came_by;
  std::weak_ptr<const SpanGeometry> went_by;
  std::optional<double> size;  ///< of what it lies on there [m]; none: it has just come
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

/// A cable that an edit takes apart.
struct TakenCable {
  RunningCable running;
  std::vector<std::shared_ptr<const SpanGeometry>> spans;  ///< that its links refer to
  double excess = 0.0;  ///< by how much it is too short where that is worst [m]
};

/// Where a cable of an edited world comes from.
struct CableStart {
  BodyFrames defined_in;
  int same_as = -1;                       ///< the cable of the world before that it is
  const RunningCable* running = nullptr;  ///< or what it has been made of; neither: it is new
};

}  // namespace sheave
