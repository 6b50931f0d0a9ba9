#pragma once
// A cable of a running world, link by link, as edits take it apart and put it together; internal to
// the cable library.

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
  double tension = 0.0;      ///< in the last substep [N]
  std::array<double, 2> remainder{};
  /// of a rope with memory: the strain that it remembers, and the loss by its law [J]
  std::array<double, 2> memory{};
  /// at an anchor on a floor with friction: FloorFriction::kept()
  std::vector<double> laid{};
};

/// The state of one link (cable/cable_state_layout.h).
struct RunningLink {
  std::shared_ptr<const LinkDef> link;  ///< null: a wrap
  /// The spans before and behind the link in the world that an edit takes apart. Two links with the
  /// same span were neighbours. EditDraft owns the spans, so they are gone after the edit; a link
  /// of a loose cable that is kept longer has none, and the cable may touch it anywhere.
  std::weak_ptr<const SpanGeometry> came_by;
  std::weak_ptr<const SpanGeometry> went_by;
  std::optional<double> size;  ///< size of its surface there [m]; none: the link is new
  double stored_length = 0.0;  ///< [m]
  /// length that has slid over it [m]; for an attachment the length that was fed
  double slipped = 0.0;
  double angle = 0.0;           ///< angle of a hybrid end's attachment [rad]
  double bearing_torque = 0.0;  ///< of a wheel with inertia and losses [N m]
  std::int64_t slip = 0;
  std::int64_t mode = 0;
  std::int64_t stall = 0;
  double stored_strain = 0.0;  ///< only of a new link
  /// the link was just inserted and takes its cable from the span before it
  bool is_fresh = false;
  std::vector<double>
      strain;  ///< with a material: the numbers that StoredStrain saves, and the loss by creep [J]
  LinkControl control;
  int body = -1;                  ///< of a wrap; -1: a listed link
  int winding = 0;                ///< of a wrap, or of a listed wheel in the world before
  std::array<double, 6> plane{};  ///< also for a surface link

  /// the span that begins here; none at the cable's end and where there is no cable
  std::optional<RunningSpan> span;

  [[nodiscard]] bool is_listed() const { return link != nullptr; }
  [[nodiscard]] bool is_wrap() const { return body >= 0; }
  /// Whether the cable touches it.
  [[nodiscard]] bool is_on_course() const { return is_wrap() || mode < lifted_mode; }
  // Values of `mode` in the state: the cable has left the link; left it and passed to the other
  // side.
  static constexpr std::int64_t lifted_mode = 3;
  static constexpr std::int64_t passed_mode = 4;
};

struct RunningCable {
  /// The breaking tension that a cut sets: the cable parts as soon as it pulls [N].
  static constexpr double no_tension = 1e-300;

  /// The listed links in their order, each followed by the wraps between it and the next one.
  std::vector<RunningLink> links;
  double quantum = 0.0;  ///< CompiledCable::quantum [m]
  CableControl control;
  bool is_cut = false;
  /// index in the list: the cut span, or the span of the listed link before the wrap behind which
  /// the cable is cut
  int cut_span = 0;
  /// length from the begin of that span to a cut at a chosen place [m]
  std::optional<double> cut_at{};

  /// Makes the ends of the cut loose ends, which hold as the cable did before the cut.
  void forget_cut() {
    is_cut = false;
    cut_at.reset();
    if (control.breaking_tension == no_tension) control.breaking_tension = not_set;
  }
  /// Index in `links` of a listed link.
  [[nodiscard]] std::size_t place_of(int listed) const;
  [[nodiscard]] int listed_count() const;
  /// Total length [m]. Exact if all lengths are multiples of one quantum.
  [[nodiscard]] double length() const;
};

/// A cable that an edit takes apart.
struct TakenCable {
  RunningCable running;
  std::vector<std::shared_ptr<const SpanGeometry>> spans;  ///< the spans that its links refer to
  double excess = 0.0;  ///< largest length that the cable lacks in any part [m]
};

/// Origin of a cable of an edited world. If both pointers below are unset, the cable is new.
struct CableStart {
  BodyFrames defined_in;
  int same_as = -1;                       ///< index of the same cable in the world before; -1: none
  const RunningCable* running = nullptr;  ///< the running cable from which it was made; null: none
};

}  // namespace sheave
