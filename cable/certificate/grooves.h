#pragma once
// The groove of a drum, from its settings alone, by code of its own (cable/drum_groove.h has the law).

#include <memory>

#include "cable/link.h"
#include "engine/body_set.h"

namespace sheave::certify {

enum End : int;
struct CableEvidence;
struct SpanSide;

/// Length and place of the rope on a drum over the angle that is wound on.
class GrooveLaw {
 public:
  /// The law of a link on a body; null without a groove.
  static std::shared_ptr<const GrooveLaw> of(const LinkDef& link, const BodySet& bodies, int body);

  struct Place {
    double length = 0.0;  ///< stored length [m]
    double gain = 0.0;    ///< its derivative with respect to the angle [m/rad]
    double axial = 0.0;   ///< way along the normal since the groove's start [m]
    double slope = 0.0;   ///< its derivative [m/rad]
  };
  [[nodiscard]] Place place(double angle) const;
  /// The angle with this stored length [rad].
  [[nodiscard]] double angle(double length) const;

 private:
  double radius_ = 0.0;
  double along_ = 0.0;  ///< way along the normal per radian of the innermost layer [m/rad]
  double whole_ = 0.0;  ///< angle of a layer [rad]; infinite: one layer
  double height_ = 0.0;
};

/// Gives the end of a span at a drum with a groove the angle of its rope.
void follow_groove(const BodySet& bodies, const CableEvidence& cable, End when, SpanSide& side);

}  // namespace sheave::certify
