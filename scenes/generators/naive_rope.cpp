// A rope over two wheels as jointed rigid segments, with a weight at each end (figure 14 of the
// paper), or, to compare with, the same machine with one cable.
//
//        __________          The segments are tangents of the rope's centre line, which has the
//      /            \        radius S = R + r on a wheel: k segments to a quarter turn have the
//     |  o        o  |       length
//     |              |         l = 2 S tan(pi / 4 k).
//    [ ]            [ ]
//
// The wheels are m segments apart. Both sides hang down equally far, so the rope has
//   N = 2 n + 2 (k - 1) + m + 1
// segments; the first of the n segments of each side hangs beside the centre of its wheel. A
// quarter turn takes about 8 N / 100 segments and the way between the wheels N / 3; m is odd if N
// is even and even if N is odd.
//
// Each weight has the mass M, so the machine is in balance and at rest, and every span of the cable
// carries M g. A joint of the rope carries M g and the weight of the rope below the joint.
//
// Why the naive rope is hard. A joint is as accurate as the corrections that have reached it, and a
// correction passes one joint per sweep. In a substep the weights fall by g h^2 however much the
// rope holds back, so the rope stretches like rubber. And a segment of mass m between joints that
// pull with T swings across the rope with up to 2 sqrt(T / m l). The solver works with the
// gradients of the last round, so it converges only while h times that rate is about 1; for 100
// segments that takes some 16 substeps of 1/960 s.

#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "cable/links/rolling.h"
#include "engine/field_check.h"
#include "engine/joints/ball.h"
#include "engine/shapes/box.h"
#include "engine/shapes/capsule.h"
#include "scenes/generators.h"
#include "scenes/generators/parts.h"

namespace sheave {
namespace {

constexpr double load_edge = 0.25;   // of the weights, cubes [m]
constexpr double floor_below = 1.5;  // the weights [m]
constexpr double wheel_width = 0.2;  // [m]
constexpr double first_steps = 0.1;  // time until sweeps have found the tension [s]

class NaiveRope {
 public:
  explicit NaiveRope(const NaiveRopeOptions& options)
      : options_(options),
        center_line_(options.radius + options.rope_radius),
        per_quarter_(std::max(2, static_cast<int>(std::lround(0.08 * options.segments)))),
        between_(static_cast<int>(std::lround(0.33 * options.segments))) {
    if ((options.segments - between_) % 2 == 0) ++between_;
    hanging_ = (options.segments - 2 * (per_quarter_ - 1) - between_ - 1) / 2;
    length_ =
        generators::tidy(2.0 * center_line_ * std::tan(std::numbers::pi / (4.0 * per_quarter_)));
    half_span_ = 0.5 * between_ * length_;
  }

  Scene make() {
    Model& model = scene_.model;
    model.gravity = {0.0, -options_.gravity, 0.0};
    generators::step_as_the_paper(scene_, options_.dt, options_.substeps, options_.iterations);
    scene_.duration = options_.duration;
    add_machine();
    if (options_.cable) {
      add_cable();
    } else {
      add_rope();
    }
    GroundDef floor;
    floor.point = generators::tidy(Vector3(0.0, floor_height(), 0.0));
    model.ground = floor;
    scene_.camera = CameraDef{};
    scene_.camera->direction = Vector3(-0.3, -0.2, -1.0);
    return std::move(scene_);
  }

 private:
  /// Height of the rope's ends [m].
  [[nodiscard]] double bottom() const { return -(hanging_ - 0.5) * length_; }
  [[nodiscard]] double floor_height() const { return bottom() - load_edge - floor_below; }

  void add_machine() {
    for (const double side : {-1.0, 1.0}) {
      const std::string name = side < 0.0 ? "left" : "right";
      wheels_.push_back(
          scene_.model.add(generators::wheel(name + " wheel", {side * half_span_, 0.0, 0.0},
                                             options_.radius, wheel_width, options_.wheel_mass)));
    }
    for (const double side : {-1.0, 1.0}) {
      BodyDef load;
      load.name = side < 0.0 ? "left load" : "right load";
      load.position = generators::tidy(
          Vector3(side * (half_span_ + center_line_), bottom() - 0.5 * load_edge, 0.0));
      load.mass = generators::tidy(options_.load);
      auto box = std::make_shared<Box>();
      box->size = Vector3::Constant(load_edge);
      load.shapes.push_back({std::move(box)});
      loads_.push_back(scene_.model.add(std::move(load)));
    }
  }

  void add_cable() {
    CableDef cable;
    cable.name = "cable";
    const Vector3 top(0.0, 0.5 * load_edge, 0.0);
    cable.links.push_back(generators::attach(loads_[0], top));
    for (const BodyId wheel : wheels_) {
      auto link = std::make_shared<RollingLink>();
      link->body = wheel;
      link->winding = Winding::clockwise;
      link->radius = generators::tidy(center_line_);
      cable.links.push_back(std::move(link));
    }
    cable.links.push_back(generators::attach(loads_[1], top));
    scene_.cables.push_back(std::move(cable));
    scene_.name = "One cable over two wheels";
    scene_.description = "The machine of the naive rope with three cable joints (Figure 14).";
    const double weight = options_.load * options_.gravity;
    for (int span = 0; span < 3; ++span) {
      add_check(fmt::format("cable.{}.tension", span), Statistic::minimum, weight, 1e-3 * weight,
                "M g: it carries the weights");
      scene_.checks.back().from = first_steps;
    }
    for (const char* name : {"left load.y", "right load.y"}) {
      add_check(name, Statistic::range, 0.0, 1e-3 * options_.segments * length_,
                "the cable does not stretch: within 0.1 % of its length");
    }
    add_check("cable.length_error", Statistic::range, 0.0, 1e-12, "cable is neither lost nor made");
  }

  /// Centre of a segment and direction of the rope there; segments are counted from the left
  /// weight.
  struct Place {
    Vector3 center;
    double angle;
  };
  [[nodiscard]] Place place(int k) const {
    const double quarter = 0.5 * std::numbers::pi;
    const double beside = half_span_ + center_line_;
    if (k < hanging_) return {{-beside, (k - hanging_ + 1) * length_, 0.0}, quarter};
    k -= hanging_;
    if (k < per_quarter_ - 1)
      return on_wheel(-half_span_, quarter * (1.0 - (k + 1.0) / per_quarter_));
    k -= per_quarter_ - 1;
    if (k <= between_) return {{k * length_ - half_span_, center_line_, 0.0}, 0.0};
    k -= between_ + 1;
    if (k < per_quarter_ - 1) return on_wheel(half_span_, -quarter * (k + 1.0) / per_quarter_);
    k -= per_quarter_ - 1;
    return {{beside, -k * length_, 0.0}, -quarter};
  }
  [[nodiscard]] Place on_wheel(double x, double angle) const {
    const Vector3 out(-std::sin(angle), std::cos(angle), 0.0);
    return {Vector3(x, 0.0, 0.0) + center_line_ * out, angle};
  }

  BodyId add_segment(int k) {
    const Place at = place(k);
    BodyDef segment;
    segment.name = fmt::format("segment {}", k + 1);
    segment.position = generators::tidy(at.center);
    segment.orientation = Quaternion(std::cos(0.5 * at.angle), 0.0, 0.0, std::sin(0.5 * at.angle));
    segment.mass = generators::tidy(options_.linear_density * length_);
    auto capsule = std::make_shared<Capsule>();
    capsule->radius = generators::tidy(options_.rope_radius);
    capsule->length = length_;
    // The capsule lies along z of its shape, the rope along x of the segment.
    const Quaternion along_x(std::sqrt(0.5), 0.0, std::sqrt(0.5), 0.0);
    segment.shapes.push_back({std::move(capsule), Vector3::Zero(), along_x});
    const BodyId body = scene_.model.add(std::move(segment));
    ColliderDef collider;
    collider.body = body;
    collider.friction = options_.friction;
    collider.groups = collider.ignores = {"rope"};
    scene_.model.colliders.push_back(std::move(collider));
    return body;
  }

  void add_rope() {
    for (const BodyId wheel : wheels_) {
      ColliderDef collider;
      collider.body = wheel;
      collider.friction = options_.friction;
      scene_.model.colliders.push_back(std::move(collider));
    }
    BodyId last = loads_[0];
    for (int k = 0; k <= options_.segments; ++k) {
      const bool end = k == options_.segments;
      const Place at = place(end ? k - 1 : k);
      const Vector3 along(std::cos(at.angle), std::sin(at.angle), 0.0);
      auto joint = std::make_shared<BallJoint>();
      joint->name = fmt::format("joint {}", k + 1);
      joint->body_a = last;
      joint->body_b = end ? loads_[1] : add_segment(k);
      joint->anchor = generators::tidy(at.center + (end ? 0.5 : -0.5) * length_ * along);
      last = joint->body_b;
      scene_.model.joints.push_back(std::move(joint));
    }
    scene_.name = fmt::format("Naive rope of {} segments", options_.segments);
    scene_.description =
        "A cable as jointed rigid segments stretches and falls off its wheels (Figure 14).";
    add_rope_checks();
  }

  /// A rope that holds keeps the weights in place; at rest on the floor they are floor_below lower.
  void add_rope_checks() {
    const bool coarse = options_.substeps == 1 && options_.segments >= 100;
    const double rest = floor_height() + 0.5 * load_edge;
    for (const char* name : {"left load.y", "right load.y"}) {
      if (coarse) {
        add_check(name, Statistic::minimum, rest, 0.01,
                  "the rope does not hold the weights: they drop on the floor");
      } else {
        add_check(name, Statistic::drift, 0.0, floor_below,
                  "the rope may stretch, but the weights hang above the floor");
      }
    }
  }

  void add_check(std::string quantity, Statistic statistic, double equals, double tolerance,
                 std::string because) {
    CheckDef check;
    check.quantity = std::move(quantity);
    check.statistic = statistic;
    check.equals = generators::tidy(equals);
    check.tolerance = generators::tidy(tolerance);
    check.because = std::move(because);
    scene_.checks.push_back(std::move(check));
  }

  const NaiveRopeOptions& options_;
  double center_line_;
  int per_quarter_;
  int between_;
  int hanging_ = 0;
  double length_ = 0.0;
  double half_span_ = 0.0;
  std::vector<BodyId> wheels_;
  std::vector<BodyId> loads_;
  Scene scene_;
};

}  // namespace

std::span<const Field> NaiveRopeOptions::field_table() {
  using Options = NaiveRopeOptions;
  static const std::array table{
      field<&Options::segments>("segments", "", between(20, 10000), optional,
                                "of the rope, capsules with ball joints"),
      field<&Options::cable>("cable", "", {}, optional,
                             "true: one cable in place of the segments, to compare with"),
      field<&Options::radius>("radius", "m", above(0.0), optional, "of the wheels"),
      field<&Options::wheel_mass>("wheel_mass", "kg", above(0.0), optional,
                                  "of each, a solid disc"),
      field<&Options::rope_radius>("rope_radius", "m", above(0.0), optional, "of the rope"),
      field<&Options::linear_density>("linear_density", "kg/m", above(0.0), optional,
                                      "of the rope; the cable has no mass"),
      field<&Options::load>("load", "kg", above(0.0), optional, "the weight at each end"),
      field<&Options::friction>("friction", "", at_least(0.0), optional,
                                "between segments and wheels"),
      field<&Options::gravity>("gravity", "m/s2", above(0.0), optional, "downwards"),
      field<&Options::duration>("duration", "s", above(0.0), optional, "time to simulate"),
      field<&Options::dt>("dt", "s", above(0.0), optional, "time per step"),
      field<&Options::substeps>("substeps", "", between(1, 100000), optional, "per step"),
      field<&Options::iterations>("iterations", "", between(1, 1000000), optional,
                                  "sweeps, or rounds of the direct solver at most"),
  };
  return table;
}

Result<Scene> generate_naive_rope(const NaiveRopeOptions& options) {
  Errors errors;
  check_fields(NaiveRopeOptions::field_table(), &options, "", errors);
  if (!errors.empty()) return errors;
  return NaiveRope(options).make();
}

}  // namespace sheave
