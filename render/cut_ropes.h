#pragma once
// Cut cables in pictures of a run.
//
// A cut cable has no mass and no rows, so the world says nothing about its shape. A chain of light
// links, which swings and falls, stands for it. The chain is a drawing, not physics: a chain acts on
// no body, passes through all bodies but the wheels of its own cable and the ground, and its shape
// is part of no state.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "cable/cable_polyline.h"
#include "cable/cable_report.h"
#include "engine/world.h"

namespace sheave::render {

/// A chain of equal inextensible links without stiffness in bending, with some friction.
class LooseChain {
 public:
  /// A wheel of the cable. The chain cannot enter its cylinder.
  struct Wheel {
    Vector3 center;
    Vector3 normal;  ///< unit vector along the axle
    double radius;   ///< [m]
  };
  struct Surroundings {
    Vector3 gravity = Vector3::Zero();  ///< [m/s2]
    std::vector<Wheel> wheels{};
    std::optional<PolylineFloor> ground{};
  };

  /// Along a line of two points at least, with the length [m], > 0. `held`: its first point is held.
  LooseChain(std::span<const Vector3> line, double length, bool held);

  /// Moves the chain by `time` [s]. The held point goes to `hold` [m] at constant velocity.
  void move(double time, const Vector3& hold, const Surroundings& around);
  [[nodiscard]] const std::vector<Vector3>& points() const { return points_; }

 private:
  [[nodiscard]] Vector3 mean_velocity() const;
  void substep(double h, const Surroundings& around);
  void restore_lengths();
  static void keep_out(const Surroundings& around, Vector3& point, Vector3& velocity);

  std::vector<Vector3> points_;
  std::vector<Vector3> before_;
  std::vector<Vector3> velocities_;
  std::vector<double> diagonal_;  // scratch of restore_lengths()
  std::vector<double> multipliers_;
  double segment_ = 0.0;  ///< length of a link [m]
  bool held_ = false;
};

/// The pieces of all cut cables in a run, from picture to picture.
class CutRopes {
 public:
  /// Looks at a state of the run. Call it for every picture in their order, and between them at
  /// least 30 times per second of simulated time. A cable that was cut before the first look, or a
  /// state that is earlier than the last one, makes its pieces hang at rest.
  void follow(const World& world, std::span<const CableReport> cables);

  /// The lines of the pieces of a cut cable; none if the cable is whole. The cable on the wheel of
  /// its end is in the line of a piece.
  [[nodiscard]] std::span<const std::vector<Vector3>> pieces(std::size_t cable) const;

 private:
  struct Piece {
    LooseChain chain;
    int link = -1;                   ///< the link that holds it; -1: none
    Vector3 hold = Vector3::Zero();  ///< in the frame of the link's body [m]
  };
  struct Cable {
    std::vector<Vector3> free_line;  ///< of the whole cable at the last look, without its ends
    std::vector<Piece> pieces;
    std::vector<std::vector<Vector3>> lines;
  };

  void part(const World& world, const CableReport& report, Cable& cable) const;
  void hang(const World& world, const CableReport& report, Cable& cable) const;

  std::vector<Cable> cables_;
  std::optional<double> time_;  ///< of the last look [s]
};

}  // namespace sheave::render
