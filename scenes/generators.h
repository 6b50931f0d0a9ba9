#pragma once
// Generators of scenes of any size, for measurements, tests and examples. The same options always
// give the same scene.

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/scene.h"

namespace sheave {

/// One cable over a row of wheels on fixed axles, with a weight at each end.
struct WheelTrainOptions {
  int wheels = 16;          ///< 1 ... 100 000
  double radius = 0.5;      ///< of each wheel [m], > 0
  double wheel_mass = 1.0;  ///< of each, a solid disc [kg], > 0
  double first_mass = 1.0;  ///< weight before the first wheel [kg], > 0
  double last_mass = 2.0;   ///< weight behind the last wheel [kg], > 0
  double gravity = 9.81;    ///< downwards [m/s2], > 0
  double duration = 1.0;    ///< [s], > 0
  double dt = 1.0 / 60.0;   ///< [s], > 0
  int substeps = 1;         ///< 1 ... 100 000
  int iterations = 0;       ///< 0: the number that brings the acceleration within 0.1 %

  static std::span<const Field> field_table();
  /// Closed form of the acceleration of the last weight, downwards [m/s2].
  [[nodiscard]] double acceleration() const;
};
/// An error, with the option's name as its path, if an option is out of range.
[[nodiscard]] Result<Scene> generate_wheel_train(const WheelTrainOptions& options);

/// A block and tackle: a load on several parts of one rope, and the effort weight at its free end.
struct BlockAndTackleOptions {
  int parts = 4;             ///< number of rope parts that carry the lower block, 2 ... 64
  double diameter = 0.4;     ///< of each sheave [m], > 0
  double sheave_mass = 0.1;  ///< of each, a solid disc [kg], > 0
  double load = 12.0;        ///< mass of the lower block with its sheaves [kg]
  double unbalance = 1.0;    ///< effort mass as a multiple of load / parts, > 0
  double drop = 3.0;         ///< height of the upper sheaves above the lower ones [m]
  double gravity = 9.81;     ///< downwards [m/s2], > 0
  double duration = 10.0;    ///< [s], > 0
  double dt = 1.0 / 60.0;    ///< [s], > 0
  int substeps = 1;          ///< 1 ... 100 000
  int iterations = 0;        ///< 0: the number that brings the tensions within 0.1 %

  static std::span<const Field> field_table();
  [[nodiscard]] double effort_mass() const { return unbalance * load / parts; }
  /// Closed form of the acceleration of the load, downwards [m/s2].
  [[nodiscard]] double acceleration() const;
};
/// An error, with the option's name as its path, if an option is out of range.
[[nodiscard]] Result<Scene> generate_block_and_tackle(const BlockAndTackleOptions& options);

/// One cable along a three-dimensional Hilbert curve, with a wheel at each turn of the curve. A
/// motor's drum winds the cable up at one end; a weight hangs at the other (figures 1 and 18 of the
/// paper).
struct HilbertOptions {
  int order = 2;            ///< of the curve, through 8^order points; 1 ... 5
  double spacing = 1.0;     ///< of the curve's points [m], > 0
  double radius = 0.2;      ///< of each wheel [m], > 0, less than spacing / 4
  double wheel_mass = 0.2;  ///< of each, a solid disc [kg], > 0
  double drag = 0.001;      ///< of each wheel's bearing [N m s/rad], >= 0
  double load = 2.0;        ///< mass of the weight [kg], > 0
  double slack = 0.0;       ///< length of each span in excess of the distance of its ends [m], >= 0
  double motor = 0.5;       ///< speed at which the drum winds cable up [m/s], > 0
  double ramp = 0.5;  ///< time in which the motor reaches its speed [s], > 0; it begins after 0.5 s
  double gravity = 10.0;   ///< downwards [m/s2], > 0
  double duration = 0.0;   ///< [s]; 0: until the weight has been rising for 1.5 s
  double dt = 1.0 / 60.0;  ///< [s], > 0
  int substeps = 1;        ///< 1 ... 100 000
  int iterations = 10;     ///< largest number of rounds of the direct solver

  static constexpr double start = 0.5;  ///< start of the motor [s]

  static std::span<const Field> field_table();
  /// acceleration of the winding speed [m/s2]
  [[nodiscard]] double rise() const { return motor / ramp; }
  /// Length of cable that the drum has wound up at a time [m].
  [[nodiscard]] double wound(double time) const;
  /// Time at which the drum has wound up that length [s].
  [[nodiscard]] double time_of(double length) const;
};
/// An error, with the option's name as its path, if an option is out of range.
[[nodiscard]] Result<Scene> generate_hilbert(const HilbertOptions& options);
/// The points of the curve, in units of their spacing: 8^order of them, neighbours one apart; the
/// last step is -y.
[[nodiscard]] std::vector<Vector3> hilbert_curve(int order);

/// A chain of rigid links with ball joints, fixed at one end, with a heavy ball at the other,
/// released from a straight line: the hardest case for solvers that propagate errors from joint to
/// joint.
struct ChainOptions {
  int links = 40;              ///< 1 ... 10 000
  double link_length = 1.0;    ///< distance between the joints of a link [m], > 0
  double link_radius = 0.125;  ///< of each, a capsule [m], > 0
  double link_mass = 1.0;      ///< of each [kg], > 0
  double mass_ratio = 672.0;   ///< mass of the ball / mass of a link, > 0
  double ball_radius = 8.0;    ///< of the ball [m], > 0; the last joint is on its surface
  double angle = 0.0;          ///< of the chain below the horizontal at the start [rad], 0 ... 1.5
  double gravity = 10.0;       ///< downwards [m/s2], > 0
  double duration = 20.0;      ///< [s], > 0
  double dt = 1.0 / 60.0;      ///< [s], > 0
  int substeps = 16;           ///< 1 ... 100 000
  int iterations = 10;         ///< sweeps, or largest number of rounds of the direct solver

  static std::span<const Field> field_table();
};
/// An error, with the option's name as its path, if an option is out of range.
[[nodiscard]] Result<Scene> generate_chain(const ChainOptions& options);

/// A rope over two wheels with a weight at each end, as rigid segments with ball joints that touch
/// the wheels; or the same machine with one cable (figure 14 of the paper).
struct NaiveRopeOptions {
  int segments = 100;           ///< of the rope, 20 ... 10 000
  bool cable = false;           ///< one cable in place of the segments
  double radius = 0.3;          ///< of the wheels [m], > 0
  double wheel_mass = 2.0;      ///< of each, a solid disc [kg], > 0
  double rope_radius = 0.02;    ///< of the segments, capsules [m], > 0
  double linear_density = 1.0;  ///< of the rope [kg/m], > 0; the cable has no mass
  double load = 20.0;           ///< mass of the weight at each end [kg], > 0
  double friction = 0.5;        ///< between segments and wheels, >= 0
  double gravity = 10.0;        ///< downwards [m/s2], > 0
  double duration = 1.5;        ///< [s], > 0
  double dt = 1.0 / 60.0;       ///< [s], > 0
  int substeps = 1;             ///< 1 ... 100 000
  int iterations = 100;         ///< sweeps, or largest number of rounds of the direct solver

  static std::span<const Field> field_table();
};
/// An error, with the option's name as its path, if an option is out of range.
[[nodiscard]] Result<Scene> generate_naive_rope(const NaiveRopeOptions& options);

/// One kind of generated scene, for programs that choose it by name.
struct GeneratorKind {
  std::string_view name;                    ///< "wheel-train", ...
  std::string_view meaning;                 ///< one line
  std::span<const Field> (*fields)();       ///< the options
  std::shared_ptr<void> (*make_options)();  ///< with their defaults
  Result<Scene> (*generate)(const void* options);
};
[[nodiscard]] std::span<const GeneratorKind> generator_kinds();

/// The value of an option as JSON text.
struct GeneratorSetting {
  std::string option;
  std::string value;
};
/// Generates a scene by the name of its kind. Errors have the option's name as their pointer.
[[nodiscard]] SceneResult generate_scene(std::string_view kind,
                                         const std::vector<GeneratorSetting>& settings);
/// The command that generates the scene, as a comment for the head of a scene file.
[[nodiscard]] std::string generator_comment(std::string_view kind,
                                            const std::vector<GeneratorSetting>& settings);
/// The command line's option for a field of the options: "--wheel-mass" for wheel_mass.
[[nodiscard]] std::string generator_option(std::string_view field);

}  // namespace sheave
