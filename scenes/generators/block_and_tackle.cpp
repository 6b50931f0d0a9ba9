// A block and tackle with n parts of rope between a beam and a block that slides up and down.
//
//   ==+=============      All parts are vertical, one sheave diameter D apart; part k, counted from
//     | (o)   (o)         the fixed end, is at x = (k - 1) D. The fixed end is on the beam if n is
//     | | |   | |         even (drawn: n = 4) and on the block if n is odd, so that part n always
//     | | |   | |         goes up, over the last upper sheave, and down to the effort weight.
//     (o) (o) | |         (In the drawing neighbouring sheaves share a column.)
//   [ block ] effort
//
// Speeds. Let the block go down with speed v. Even n: part 1 hangs on the beam, and no point of it
// moves. Seen from the block it goes up with v, so the first lower sheave's rim turns with v and
// part 2 goes down with v relative to the block, with 2 v in all. The first upper sheave is fixed,
// so its rim turns with 2 v and part 3 goes up with 2 v: with 3 v relative to the block; and so on.
// Odd n: part 1 goes down with the block, so the first (upper) sheave's rim turns with v, part 2
// goes up with v, with 2 v relative to the block, and so on. Either way the rim of wheel k, between
// part k and part k + 1, turns with k v against its axle, and since neither beam nor block rotates
// that is its absolute spin: w_k = k v / r. The effort weight rises with n v.
//
// Acceleration. M: mass of the block with all it carries, the lower sheaves included; m: effort
// mass; I: inertia of a sheave about its axle.
//   kinetic energy  1/2 (M + n^2 m + (I / r^2) sum k^2) v^2,   sum k^2 = n (n + 1) (2 n + 1) / 6,
//   power of gravity  (M - n m) g v,
//   a = (M - n m) g / (M + n^2 m + (I / r^2) sum k^2),   with I / r^2 = (sheave mass) / 2.
// The effort weight hangs on m (g + n a); in balance, m = M / n, every part carries m g.

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "engine/field_check.h"
#include "engine/shapes/box.h"
#include "scenes/generators.h"
#include "scenes/generators/parts.h"

namespace sheave {
namespace {

/// Number of Gauss-Seidel sweeps that brings every check within its tolerance, with a margin. The
/// ratio of the effort's mass to that of a sheave matters, because a light sheave absorbs
/// corrections. Measured needs with the default masses (10 s at 60 Hz in balance): 93 for 2 parts,
/// 59 for 4, 47 for 6, 37 for 8, 18 for 16.
int sufficient_iterations(const BlockAndTackleOptions& options) {
  const double n = options.parts;
  const double ratio = options.effort_mass() / options.sheave_mass;
  return static_cast<int>(std::min(1e6, std::ceil(20.0 + n * n / 20.0 + 4.0 * ratio)));
}

/// Builds the scene from the fixed end to the effort.
class BlockAndTackle {
 public:
  explicit BlockAndTackle(const BlockAndTackleOptions& options)
      : options_(options),
        diameter_(options.diameter),
        radius_(0.5 * options.diameter),
        acceleration_(options.acceleration()),
        travel_(1.1 * 0.5 * std::abs(acceleration_) * options.duration * options.duration),
        lower_(-options.drop - (acceleration_ < 0.0 ? travel_ : 0.0)) {}

  Scene build() {
    scene_.name = fmt::format("Block and tackle, {} parts", options_.parts);
    scene_.description = "A load on several parts of one rope, and the effort at its free end.";
    scene_.duration = options_.duration;
    scene_.model.gravity = {0.0, -options_.gravity, 0.0};
    generators::step_as_the_paper(
        scene_, options_.dt, options_.substeps,
        options_.iterations > 0 ? options_.iterations : sufficient_iterations(options_));
    add_beam_and_block();
    add_rope();
    add_checks();
    scene_.camera = generators::side_view();
    return std::move(scene_);
  }

  [[nodiscard]] static int lower_sheaves(int parts) { return parts / 2; }

 private:
  [[nodiscard]] bool even() const { return options_.parts % 2 == 0; }
  /// Wheel k (1 ... n) is between part k and part k + 1.
  [[nodiscard]] bool is_lower(int k) const { return (k % 2 == 1) == even(); }
  [[nodiscard]] double wheel_x(int k) const { return (k - 0.5) * diameter_; }

  void add_beam_and_block() {
    const double width = diameter_ * options_.parts;
    BodyDef beam;
    beam.name = "beam";
    beam.mobility = Mobility::fixed;
    beam.position = generators::tidy(Vector3(0.5 * width, 1.6 * diameter_, 0.0));
    auto box = std::make_shared<Box>();
    box->size =
        generators::tidy(Vector3(width + 0.5 * diameter_, 0.4 * diameter_, 0.6 * diameter_));
    beam.shapes.push_back({std::move(box)});
    beam_ = scene_.model.add(std::move(beam));
    // The block extends over the fixed end, if that is on it, and the lower sheaves.
    const double left = even() ? 0.0 : -0.25 * diameter_;
    const double right = diameter_ * (options_.parts - 1) + (even() ? 0.0 : 0.25 * diameter_);
    block_center_ = {0.5 * (left + right), lower_ - 1.1 * diameter_, 0.0};
    block_height_ = 0.8 * diameter_;
    const double mass = options_.load - lower_sheaves(options_.parts) * options_.sheave_mass;
    block_ = scene_.model.add(generators::weight(
        "block", block_center_, {right - left, block_height_, 0.6 * diameter_}, mass));
  }

  void add_rope() {
    CableDef rope;
    rope.name = "rope";
    rope.links.push_back(
        even() ? generators::attach(
                     beam_, Vector3(0.0, 1.4 * diameter_, 0.0) - scene_.model.bodies[0].position)
               : generators::attach(block_, {-block_center_.x(), 0.5 * block_height_, 0.0}));
    for (int k = 1; k <= options_.parts; ++k) {
      const Vector3 center(wheel_x(k), is_lower(k) ? lower_ : 0.0, 0.0);
      BodyDef sheave = generators::wheel(fmt::format("sheave {}", k), center, radius_,
                                         0.4 * diameter_, options_.sheave_mass);
      if (is_lower(k)) sheave.mount = block_;
      const BodyId id = scene_.model.add(std::move(sheave));
      rope.links.push_back(
          generators::roll(id, is_lower(k) ? Winding::counter_clockwise : Winding::clockwise));
    }
    const double edge = 0.7 * diameter_;
    const double down =
        0.6 * options_.drop + (acceleration_ > 0.0 ? options_.parts * travel_ : 0.0);
    const BodyId effort =
        scene_.model.add(generators::weight("effort", {diameter_ * options_.parts, -down, 0.0},
                                            Vector3::Constant(edge), options_.effort_mass()));
    rope.links.push_back(generators::attach(effort, {0.0, 0.5 * edge, 0.0}));
    scene_.cables.push_back(std::move(rope));
  }

  void add_checks() {
    const double a = acceleration_;
    const double g = options_.gravity;
    const double n = options_.parts;
    const bool balanced = options_.unbalance == 1.0;
    if (balanced) {
      scene_.checks.push_back(generators::check("block.y", Statistic::range, 0.0, options_.drop,
                                                "in balance: effort = load / parts"));
      scene_.checks.push_back(generators::check("effort.y", Statistic::range, 0.0, options_.drop,
                                                "in balance: effort = load / parts"));
    } else {
      scene_.checks.push_back(
          generators::check("block.vy", Statistic::rate, -a, 1e-6 * g,
                            "a = (M - n m) g / (M + n^2 m + (I / r^2) sum k^2)"));
      scene_.checks.push_back(generators::check("effort.vy", Statistic::rate, n * a, 1e-6 * g,
                                                "the effort moves n times as fast as the load"));
    }
    CheckDef tension = generators::check(fmt::format("rope.{}.tension", options_.parts),
                                         Statistic::mean, options_.effort_mass() * (g + n * a), 0.0,
                                         balanced ? "m g" : "m (g + n a)");
    scene_.checks.push_back(std::move(tension));
  }

  const BlockAndTackleOptions& options_;
  double diameter_;
  double radius_;
  double acceleration_;  // of the load, downwards
  double travel_;        // range of the load's motion, to either side
  double lower_;         // height of the lower sheaves
  Vector3 block_center_ = Vector3::Zero();
  double block_height_ = 0.0;
  BodyId beam_;
  BodyId block_;
  Scene scene_;
};

}  // namespace

std::span<const Field> BlockAndTackleOptions::field_table() {
  using Options = BlockAndTackleOptions;
  static const std::array table{
      field<&Options::parts>("parts", "", between(2, 64), optional,
                             "of the rope that carry the lower block"),
      field<&Options::diameter>("diameter", "m", above(0.0), optional, "of each sheave"),
      field<&Options::sheave_mass>("sheave_mass", "kg", above(0.0), optional,
                                   "of each sheave, a solid disc"),
      field<&Options::load>("load", "kg", above(0.0), optional,
                            "mass of the lower block with its sheaves"),
      field<&Options::unbalance>("unbalance", "", above(0.0), optional,
                                 "effort mass as a multiple of load / parts"),
      field<&Options::drop>("drop", "m", above(0.0), optional,
                            "height of the upper sheaves above the lower ones"),
      field<&Options::gravity>("gravity", "m/s2", above(0.0), optional, "downwards"),
      field<&Options::duration>("duration", "s", above(0.0), optional, "time to simulate"),
      field<&Options::dt>("dt", "s", above(0.0), optional, "time per step"),
      field<&Options::substeps>("substeps", "", between(1, 100000), optional, "per step"),
      field<&Options::iterations>("iterations", "", between(0, 1000000), optional,
                                  "0: as many as bring the tensions within 0.1 %"),
  };
  return table;
}

double BlockAndTackleOptions::acceleration() const {
  const double n = parts;
  const double m = effort_mass();
  const double inertia_over_r2 = 0.5 * sheave_mass;
  const double squares = n * (n + 1.0) * (2.0 * n + 1.0) / 6.0;
  return (load - n * m) * gravity / (load + n * n * m + inertia_over_r2 * squares);
}

Result<Scene> generate_block_and_tackle(const BlockAndTackleOptions& options) {
  Errors errors;
  check_fields(BlockAndTackleOptions::field_table(), &options, "", errors);
  if (!errors.empty()) return errors;
  const double sheaves = BlockAndTackle::lower_sheaves(options.parts) * options.sheave_mass;
  if (!(options.load > sheaves)) {
    return Error{"/load", fmt::format("load includes the lower sheaves, so it must be more than "
                                      "their {} kg; it is {} kg",
                                      number_text(sheaves), number_text(options.load))};
  }
  if (!(options.drop > options.diameter)) {
    return Error{"/drop", fmt::format("drop must be more than the diameter of the sheaves, {} m, "
                                      "or upper and lower ones overlap; it is {} m",
                                      number_text(options.diameter), number_text(options.drop))};
  }
  return BlockAndTackle(options).build();
}

}  // namespace sheave
