// A cable along a Hilbert curve in space (hilbert_curve.cpp): a motor's drum before its first
// point, a wheel at each turn, a weight below its last point. A straight point of the curve has no
// wheel.
//
// A wheel of radius r at a turn P from direction e1 to e2 has its centre at P + r (e2 - e1), inside
// the turn, so both edges of the curve are tangents. Every free span therefore runs along the curve
// and lies in the planes of both its wheels, although these planes are mostly perpendicular to each
// other. The cable has no kinks, and no wheel has to be indented as in the paper's figure 18. A
// wheel extends 2 r along both edges, so r < spacing / 4 keeps neighbours apart.
//
// The cable does not slip. Once it is taut, all rims move at the speed v at which the motor winds
// it up. With the wheels' J = m r^2 / 2 and the drag c of their bearings a wheel needs the
// difference of tensions
//   d(v, a) = m a / 2 + c v / r^2,    a = dv/dt.
// Behind the first k of n wheels the tension is T_k = M (g + a) + (n - k) d(v, a). All wheels start
// with the motor.
//
// With a slack s in each span, wheel k (1 ... n) stands still until k s have been wound up. Then
// wheel k starts with one jerk (the cable is rigid and an impact inelastic, so no rim ever
// overtakes the cable) and follows: its rim has moved w - k s when w has been wound up. The weight
// stands on the floor until w = (n + 1) s. With k wheels running the first span carries k d(v, 0),
// so the motor's load rises in n steps.

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "cable/links/rolling.h"
#include "cable/links/spool.h"
#include "engine/field_check.h"
#include "engine/shapes/cylinder.h"
#include "scenes/generators.h"
#include "scenes/generators/parts.h"

namespace sheave {
namespace {

/// A rotation that takes z to one of the axes' directions.
Quaternion from_z_to(const Vector3& axis) {
  const double half = std::sqrt(0.5);
  if (axis.z() > 0.5) return Quaternion::Identity();
  if (axis.z() < -0.5) return {0.0, 1.0, 0.0, 0.0};
  return {half, half * (0.0 - axis.y()), half * (0.0 + axis.x()), 0.0};
}

/// Builds the scene from the drum to the weight.
class Hilbert {
 public:
  explicit Hilbert(const HilbertOptions& options)
      : options_(options), points_(hilbert_curve(options.order)) {
    for (Vector3& point : points_) point *= options_.spacing;
  }

  Scene build() {
    scene_.name =
        fmt::format("Hilbert curve of order {}{}", options_.order, loose() ? ", loose" : "");
    scene_.model.gravity = {0.0, -options_.gravity, 0.0};
    generators::step_as_the_paper(scene_, options_.dt, options_.substeps, options_.iterations);
    scene_.model.step.solver = SolverKind::direct;
    cable_.name = "cable";
    add_drum();
    for (std::size_t i = 1; i + 1 < points_.size(); ++i) add_wheel_at(i);
    set_duration();
    add_weight();
    if (loose()) add_slack();
    scene_.cables.push_back(std::move(cable_));
    add_checks();
    scene_.description =
        loose() ? "A loose cable along a Hilbert curve: the wheels start one after the other."
                : "A taut cable along a Hilbert curve: all wheels start with the motor.";
    scene_.camera = view();
    return std::move(scene_);
  }

 private:
  [[nodiscard]] bool loose() const { return options_.slack > 0.0; }
  [[nodiscard]] double drum_radius() const { return 2.0 * options_.radius; }

  /// Adds the drum, one spacing before the first point, outside of the cube.
  void add_drum() {
    const Vector3 along = (points_[1] - points_[0]) / options_.spacing;
    const int across = along.x() == 0.0 ? 0 : 2;
    Vector3 outward = Vector3::Zero();
    outward[across] = points_[0][across] < 0.0 ? -1.0 : 1.0;
    begins_.push_back(points_[0] - options_.spacing * along);
    BodyDef drum =
        generators::wheel("drum", begins_.back() + drum_radius() * outward, drum_radius(),
                          2.0 * options_.radius, 10.0 * options_.wheel_mass);
    // The cable runs clockwise about the axle, so positive angles wind it up.
    drum.orientation = from_z_to(outward.cross(along));
    drum.drive = DriveKind::speed;
    drum.drive_times = {0.0, HilbertOptions::start,
                        generators::tidy(HilbertOptions::start + options_.ramp)};
    drum.drive_values = {0.0, 0.0, generators::tidy(options_.motor / drum_radius())};
    auto link = std::make_shared<SpoolLink>();
    link->body = scene_.model.add(std::move(drum));
    link->winding = Winding::clockwise;
    link->stored_length = generators::tidy(drum_radius());
    cable_.links.push_back(std::move(link));
  }

  void add_wheel_at(std::size_t point) {
    const Vector3 in = (points_[point] - points_[point - 1]) / options_.spacing;
    const Vector3 out = (points_[point + 1] - points_[point]) / options_.spacing;
    if (in.dot(out) > 0.5) return;
    const double r = options_.radius;
    ends_.push_back(points_[point] - r * in);
    begins_.push_back(points_[point] + r * out);
    BodyDef wheel = generators::wheel(wheel_name(++wheels_), points_[point] + r * (out - in), r,
                                      0.5 * r, options_.wheel_mass);
    // Clockwise again, so that the wheels turn with positive angles when the motor pulls.
    wheel.orientation = from_z_to(out.cross(in));
    wheel.angular_damping = options_.drag;
    cable_.links.push_back(
        generators::roll(scene_.model.add(std::move(wheel)), Winding::clockwise));
  }

  void set_duration() {
    const double least = options_.time_of(all_slack()) + 1.5;
    scene_.duration =
        options_.duration > 0.0 ? options_.duration : 0.5 * std::ceil(2.0 * least - 1e-9);
  }

  /// Adds the weight below the last point, with room for its way up.
  void add_weight() {
    const double edge = 0.6 * options_.spacing;
    const Vector3 top = points_.back() - Vector3::UnitY() * 1.05 * lifted();
    ends_.push_back(top);
    BodyDef weight = generators::weight("weight", top - Vector3(0.0, 0.5 * edge, 0.0),
                                        Vector3::Constant(edge), options_.load);
    if (loose()) {
      GroundDef floor;
      floor.point = generators::tidy(Vector3(0.0, top.y() - edge, 0.0));
      scene_.model.ground = floor;
    }
    cable_.links.push_back(
        generators::attach(scene_.model.add(std::move(weight)), {0.0, 0.5 * edge, 0.0}));
  }

  void add_slack() {
    for (std::size_t k = 0; k < ends_.size(); ++k) {
      cable_.rest_lengths.push_back(
          generators::tidy((ends_[k] - begins_[k]).norm() + options_.slack));
    }
  }

  /// View from the side of drum and weight, a little from the left and from above.
  [[nodiscard]] CameraDef view() const {
    Vector3 eye = points_.front() + points_.back();
    eye.y() = 0.0;
    eye.normalize();
    const Vector3 left = eye.cross(Vector3::UnitY());
    CameraDef camera;
    camera.direction = generators::tidy(-(eye + 0.5 * left + 0.4 * Vector3::UnitY()));
    return camera;
  }

  [[nodiscard]] static std::string wheel_name(int k) { return fmt::format("wheel {}", k); }
  /// Length of cable to be wound up before the weight moves [m].
  [[nodiscard]] double all_slack() const { return options_.slack * (wheels_ + 1); }
  /// Total rise of the weight [m].
  [[nodiscard]] double lifted() const {
    return std::max(0.0, options_.wound(scene_.duration) - all_slack());
  }
  /// Difference of the tensions at a running wheel: d(v, a).
  [[nodiscard]] double difference(double speed, double acceleration) const {
    return 0.5 * options_.wheel_mass * acceleration +
           options_.drag * speed / (options_.radius * options_.radius);
  }

  /// Time of the step nearest to a time, at which a check is evaluated.
  [[nodiscard]] double step_near(double time) const {
    return options_.dt * std::round(time / options_.dt);
  }
  void check_at(std::string quantity, double time, double equals, double tolerance,
                std::string because) {
    CheckDef check;
    check.quantity = std::move(quantity);
    check.at = generators::tidy(time);
    check.equals = generators::tidy(equals);
    check.tolerance = generators::tidy(tolerance);
    check.because = std::move(because);
    scene_.checks.push_back(std::move(check));
  }
  /// Rows are solved to 1e-10 of the scene's size, and each wheel may add an error of that size.
  void check_angle(int wheel, double near, double slack, std::string because) {
    const double time = step_near(near);
    if (time > scene_.duration) return;
    const double size = 10.0 * options_.spacing * std::exp2(options_.order);
    check_at(wheel_name(wheel) + ".angle", time,
             std::max(0.0, options_.wound(time) - slack) / options_.radius,
             1e-10 * size * (wheels_ + 1) / options_.radius, std::move(because));
  }
  /// Mean tensions over the substep that ends at the time, with k wheels running. Within the
  /// substep drag changes a wheel's speed by up to the fraction c h / J before the cable
  /// compensates it, so the part of the wheels has that relative error.
  void check_tensions(double near, int running, bool lifting, const std::string& because) {
    const double time = step_near(near);
    if (time > scene_.duration) return;
    const double h = options_.dt / options_.substeps;
    const double inertia = 0.5 * options_.wheel_mass * options_.radius * options_.radius;
    const double speed = (options_.wound(time) - options_.wound(time - h)) / h;
    const bool rising =
        time > HilbertOptions::start && time < HilbertOptions::start + options_.ramp;
    const double acceleration = rising ? options_.rise() : 0.0;
    const double weight = lifting ? options_.load * (options_.gravity + acceleration) : 0.0;
    const double wheels = running * difference(speed, acceleration);
    const double rounding = 1e-6 * options_.load * options_.gravity;
    check_at("cable.0.tension", time, weight + wheels,
             wheels * std::min(1.0, options_.drag * h / inertia) + rounding, because);
    check_at(fmt::format("cable.{}.tension", wheels_), time, weight, rounding, because);
  }

  void add_checks() {
    if (loose()) {
      add_loose_checks();
    } else {
      add_taut_checks();
    }
    scene_.checks.push_back(generators::check("weight.y", Statistic::drift, lifted(), 0.0,
                                              "what has been wound up less the slack"));
    CheckDef length = generators::check("cable.length_error", Statistic::range, 0.0, 0.0,
                                        "cable is neither lost nor made");
    length.tolerance = 1e-12;
    scene_.checks.push_back(std::move(length));
  }

  void add_taut_checks() {
    const double start = HilbertOptions::start;
    const double ramp = options_.ramp;
    check_tensions(0.5 * start, wheels_, true, "M g before the motor starts");
    const std::string speeding = "M (g + a), at the motor with n (m a / 2 + c v / r^2) more";
    check_tensions(start + 0.5 * ramp, wheels_, true, speeding);
    check_tensions(scene_.duration, wheels_, true, "M g, at the motor with n c v / r^2 more");
    for (const int k : sample_of_wheels()) {
      check_angle(k, start + 0.2 * ramp, 0.0, "all wheels start with the motor");
      check_angle(k, scene_.duration, 0.0, "and stay with it");
    }
  }

  void add_loose_checks() {
    const double slack = options_.slack;
    for (const int k : sample_of_wheels()) {
      const std::string because =
          fmt::format("it starts at {:.4g} s, when {} slack{} been wound up",
                      options_.time_of(k * slack), k, k == 1 ? " has" : "s have");
      check_angle(k, options_.time_of((k - 0.5) * slack), k * slack, because);
      check_angle(k, options_.time_of((k + 0.5) * slack), k * slack, because);
      check_angle(k, scene_.duration, k * slack, "and stays with the cable");
      // Not while the motor accelerates, because the running wheels then take a part of the tension
      // for their acceleration.
      const double between = options_.time_of((k + 0.5) * slack);
      if (between > HilbertOptions::start + options_.ramp && jerks_are_apart()) {
        check_tensions(between, k, false,
                       fmt::format("the drag of {} wheel{}, c v / r^2 each", k, k == 1 ? "" : "s"));
      }
    }
    check_tensions(scene_.duration, wheels_, true, "M g, at the motor with n c v / r^2 more");
  }

  /// A jerk lasts one or two substeps; there must be a step without a jerk between two of them.
  [[nodiscard]] bool jerks_are_apart() const {
    return options_.slack / options_.motor > 4.0 * options_.dt;
  }
  /// The first, the last, and some between.
  [[nodiscard]] std::vector<int> sample_of_wheels() const {
    std::vector<int> sample;
    for (int quarter = 0; quarter <= 4; ++quarter) {
      const int k = 1 + (wheels_ - 1) * quarter / 4;
      if (sample.empty() || sample.back() != k) sample.push_back(k);
    }
    return sample;
  }

  const HilbertOptions& options_;
  std::vector<Vector3> points_;
  std::vector<Vector3> begins_;  // of the spans
  std::vector<Vector3> ends_;
  int wheels_ = 0;
  CableDef cable_;
  Scene scene_;
};

}  // namespace

std::span<const Field> HilbertOptions::field_table() {
  using Options = HilbertOptions;
  static const std::array table{
      field<&Options::order>("order", "", between(1, 5), optional,
                             "of the curve, which passes 8^order points"),
      field<&Options::spacing>("spacing", "m", above(0.0), optional, "of the curve's points"),
      field<&Options::radius>("radius", "m", above(0.0), optional,
                              "of each wheel, less than a quarter of the spacing"),
      field<&Options::wheel_mass>("wheel_mass", "kg", above(0.0), optional,
                                  "of each wheel, a solid disc"),
      field<&Options::drag>("drag", "N m s/rad", at_least(0.0), optional,
                            "of each wheel's bearing"),
      field<&Options::load>("load", "kg", above(0.0), optional, "the weight at the cable's end"),
      field<&Options::slack>("slack", "m", at_least(0.0), optional,
                             "of each span beyond the distance it bridges; 0: the cable is taut"),
      field<&Options::motor>("motor", "m/s", above(0.0), optional,
                             "speed at which the drum winds the cable up"),
      field<&Options::ramp>("ramp", "s", above(0.0), optional,
                            "time in which the motor gets there, from 0.5 s on"),
      field<&Options::gravity>("gravity", "m/s2", above(0.0), optional, "downwards"),
      field<&Options::duration>("duration", "s", at_least(0.0), optional,
                                "time to simulate; 0: until the weight has risen for 1.5 s"),
      field<&Options::dt>("dt", "s", above(0.0), optional, "time per step"),
      field<&Options::substeps>("substeps", "", between(1, 100000), optional, "per step"),
      field<&Options::iterations>("iterations", "", between(1, 1000000), optional,
                                  "rounds of the direct solver at most"),
  };
  return table;
}

double HilbertOptions::wound(double time) const {
  const double running = std::max(0.0, time - start);
  if (running < ramp) return 0.5 * rise() * running * running;
  return motor * (running - 0.5 * ramp);
}

double HilbertOptions::time_of(double length) const {
  if (length < 0.5 * motor * ramp) return start + std::sqrt(2.0 * length / rise());
  return start + 0.5 * ramp + length / motor;
}

Result<Scene> generate_hilbert(const HilbertOptions& options) {
  Errors errors;
  check_fields(HilbertOptions::field_table(), &options, "", errors);
  if (!errors.empty()) return errors;
  if (!(options.radius < 0.25 * options.spacing)) {
    return Error{"/radius",
                 fmt::format("radius must be less than a quarter of the spacing, {} m, "
                             "or wheels touch; it is {} m",
                             number_text(0.25 * options.spacing), number_text(options.radius))};
  }
  return Hilbert(options).build();
}

}  // namespace sheave
