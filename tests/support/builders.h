#pragma once
// Small machines for tests, built as a C++ user would build them.

#include <initializer_list>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cable/links/attachment.h"
#include "cable/links/rolling.h"
#include "cable/simulation.h"

namespace sheave::test {

/// Standard gravity in the tests [m/s2], along -y.
inline constexpr double g = 9.81;
inline const Vector3 down{0.0, -g, 0.0};

/// A model and its cables.
struct Machine {
  Model model;
  std::vector<CableDef> cables;
};

/// The simulation of a machine that must be valid; throws with all messages if it is not.
[[nodiscard]] Simulation start(const Machine& machine);
/// The world of a model that must be valid.
[[nodiscard]] World start(const Model& model);
/// One "path: message" per line.
[[nodiscard]] std::string text(const Errors& errors);
/// Steps until `time` [s]; throws if the run diverges.
void run(World& world, double time);

/// The paper's settings with these dt, substeps and iterations.
[[nodiscard]] StepSettings settings(double dt, int substeps, int iterations);
/// The direct solver with its own number of rounds.
[[nodiscard]] StepSettings direct_settings(IntegratorKind integrator, double dt, int substeps = 1);

/// A wheel on a fixed axle along z with the moment of inertia `inertia` about it; mass 1 kg.
[[nodiscard]] BodyDef wheel(std::string name, const Vector3& center, double radius, double inertia);
/// The same on an axle carried by `mount`, with a mass.
[[nodiscard]] BodyDef sheave(std::string name, BodyId mount, const Vector3& center, double radius,
                             double mass, double inertia);
/// A body that slides along y.
[[nodiscard]] BodyDef weight(std::string name, const Vector3& position, double mass);
/// A free box of 0.3 m with three different moments of inertia, all about mass (0.3 m)^2.
[[nodiscard]] BodyDef lump(std::string name, const Vector3& position, double mass);

[[nodiscard]] std::shared_ptr<AttachmentLink> attach(BodyId body,
                                                     const Vector3& point = Vector3::Zero());
[[nodiscard]] std::shared_ptr<RollingLink> roll(BodyId body, Winding winding);
inline constexpr Winding left = Winding::counter_clockwise;
inline constexpr Winding right = Winding::clockwise;

[[nodiscard]] CableDef cable(std::string name,
                             std::initializer_list<std::shared_ptr<const LinkDef>> links);

/// Two weights over one wheel; bodies: 0 wheel, 1 left weight (m1), 2 right weight (m2).
struct Atwood {
  double m1 = 1.0;
  double m2 = 2.0;
  double radius = 0.25;
  double inertia = 0.05;
  double hang = 2.0;  ///< free length of each side [m]
  /// Acceleration of the right weight downwards [m/s2].
  [[nodiscard]] double acceleration() const {
    return (m2 - m1) * g / (m1 + m2 + inertia / (radius * radius));
  }
  [[nodiscard]] Machine machine() const;
};

/// Weights m1 and m2 at the ends of a cable over `count` (odd) wheels in a row, alternately over
/// and under, so that the cable zigzags; bodies: wheels 0 ... count - 1, left weight, right weight.
[[nodiscard]] Machine wheel_train(int count, double m1, double m2, double radius, double inertia);

/// A load that hangs on `strands` (even) vertical strands of one cable, over fixed wheels and
/// sheaves mounted in the moving block; the free end carries the effort.
struct Tackle {
  int strands = 2;
  double load = 8.0;    ///< mass of the block with its sheaves [kg]
  double effort = 4.0;  ///< mass at the free end [kg]
  double radius = 0.1;
  double sheave_mass = 0.2;
  double inertia = 1e-3;  ///< of each wheel and sheave
  Mobility block_mobility = Mobility::slider;
  static constexpr BodyId block{0};
  static constexpr BodyId weight{1};
  /// Upward acceleration of the load. When it rises at v the k-th wheel's rim runs at k v and the
  /// effort falls at n v, so (n m - M) g = (M + n^2 m + J/r^2 (1 + 4 + ... + n^2)) a.
  [[nodiscard]] double acceleration() const {
    const double n = strands;
    const double squares = n * (n + 1) * (2 * n + 1) / 6.0;
    return (n * effort - load) * g /
           (load + n * n * effort + inertia / (radius * radius) * squares);
  }
  [[nodiscard]] Machine machine() const;
};

/// A weight on a cable of `length` from the world's origin, at `angle` from the vertical; body 0.
[[nodiscard]] Machine cable_pendulum(double mass, double length, double angle);

/// A weight of 1 kg, body 1, that flies at 1 m/s without gravity on a cable which unwinds from a
/// fixed round post of 0.2 m: its path is the involute. It starts with 1 m of free cable, across
/// it, so the free length is l(t)^2 = 1 + 2 r v t and the tension v^2 / l.
[[nodiscard]] Machine involute();

/// Three bodies of 1 kg in a row, each hinged to the last about an axis of its own, the first one
/// to the world.
[[nodiscard]] Machine hinged_chain();

/// Two wheels on fixed axles joined by a closed, uncrossed cable; bodies 0 (radius r1) and 1 (r2).
[[nodiscard]] Machine belt(double r1, double r2, double distance, double inertia1, double inertia2);

}  // namespace sheave::test
