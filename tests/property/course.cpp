#include "tests/property/course.h"

#include <algorithm>
#include <cmath>

#include "cable/cable_system.h"
#include "engine/body_set.h"
#include "tests/property/machine_values.h"

namespace sheave::test {
namespace {

constexpr double safety = 72.0;
constexpr std::uint64_t most_twins = 8;
constexpr double hopeless = 1e-4;

double turn_between(const Quaternion& a, const Quaternion& b) {
  return std::min((a.coeffs() - b.coeffs()).norm(), (a.coeffs() + b.coeffs()).norm());
}

double motion_apart(const Moment& a, const Moment& b, double dt, double size) {
  double worst = 0.0;
  for (std::size_t i = 0; i < a.bodies.size(); ++i) {
    const BodyState& p = a.bodies[i];
    const BodyState& q = b.bodies[i];
    worst = std::max({worst, (p.position - q.position).norm() / size,
                      turn_between(p.orientation, q.orientation),
                      dt * (p.velocity - q.velocity).norm() / size,
                      dt * (p.angular_velocity - q.angular_velocity).norm()});
  }
  return worst;
}

/// Of the spans in their order; of a belt in the order of their size, because it depends on the
/// direction which span is the first when the first link has been left.
void append_tensions(const CableReport& report, Moment& moment) {
  const CableReport whole = report.with_wraps_in_place();
  std::vector<double>& tensions = moment.tensions.emplace_back();
  for (const SpanReport& span : whole.spans) {
    // Where a link is lifted one of the spans beside it is there no more.
    if (span.length > 0.0 || span.rest_length > 0.0) tensions.push_back(span.tension);
  }
  if (report.closed) std::sort(tensions.begin(), tensions.end());
}

/// Of one cable, as a share of the largest of all [1].
double tensions_apart(const std::vector<double>& a, const std::vector<double>& b, double largest) {
  if (a.size() != b.size()) return 1.0;  // other wraps
  double worst = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    worst = std::max(worst, std::abs(a[k] - b[k]) / largest);
  }
  return worst;
}

double largest_tension(const Moment& moment) {
  double largest = 0.0;
  for (const auto& cable : moment.tensions) {
    for (const double tension : cable) largest = std::max(largest, tension);
  }
  return largest;
}

/// Of two courses, step by step; as long as both last and take the same steps.
std::vector<Apart> apart(const Course& a, const Course& b, double dt, double size, double weight) {
  std::vector<Apart> result;
  double largest = weight;
  for (std::size_t i = 0; i < std::min(a.moments.size(), b.moments.size()); ++i) {
    const Moment& p = a.moments[i];
    const Moment& q = b.moments[i];
    if (p.parts != q.parts) break;
    largest = std::max(largest, largest_tension(p));
    Apart now{motion_apart(p, q, dt, size), 0.0};
    for (std::size_t k = 0; k < p.tensions.size(); ++k) {
      now.tension = std::max(now.tension, tensions_apart(p.tensions[k], q.tensions[k], largest));
    }
    result.push_back(now);
  }
  return result;
}

/// The same machine in a scene that is four times as large, because something stands far away. So
/// rounds end elsewhere, which changes of the machine's own numbers do not tell: its rows fit then,
/// too.
Machine beside_a_landmark(const Machine& machine, double size) {
  Machine twin = machine;
  BodyDef landmark;
  landmark.name = "landmark";
  landmark.mobility = Mobility::fixed;
  landmark.position = Vector3(4.0 * size, 0.0, 0.0);
  twin.model.add(landmark);
  return twin;
}

/// How far twins are from the machine, the worst so far. Shorter than the course if a twin ends
/// before it.
class Twins {
 public:
  Twins(const Machine& machine, const Course& course, double size, double weight)
      : machine_(machine),
        course_(course),
        size_(size),
        weight_(weight),
        apart_(course.moments.size()) {}

  void add(double change, std::uint64_t seed) { add(perturbed(machine_, change, seed)); }
  void add(const Machine& twin) {
    if (!Simulation::create(twin.model, twin.cables)) return;
    // The step that tells has no moment.
    const int steps = static_cast<int>(course_.moments.size()) + (course_.told ? 1 : 0);
    const Course course = follow(twin, steps);
    same_told_ = same_told_ && course.told == course_.told;
    const auto now = apart(course_, course, machine_.model.step.dt, size_, weight_);
    apart_.resize(std::min(apart_.size(), now.size()));
    Apart worst;
    for (std::size_t i = 0; i < std::min(apart_.size(), now.size()); ++i) {
      worst.motion = std::max(worst.motion, now[i].motion);
      worst.tension = std::max(worst.tension, now[i].tension);
      apart_[i].motion = std::max(apart_[i].motion, worst.motion);
      apart_[i].tension = std::max(apart_[i].tension, worst.tension);
    }
    ++count_;
  }
  [[nodiscard]] int count() const { return count_; }
  /// Whether all of them told as much as the machine.
  [[nodiscard]] bool same_told() const { return same_told_; }
  [[nodiscard]] const std::vector<Apart>& apart_so_far() const { return apart_; }

 private:
  const Machine& machine_;
  const Course& course_;
  double size_;
  double weight_;
  std::vector<Apart> apart_;
  int count_ = 0;
  bool same_told_ = true;
};

/// `steps`: those that were to be compared.
Finding judged(const std::vector<Apart>& difference, const Twins& twins, double noise, int steps) {
  Finding worst;
  worst.limit = safety * noise;
  worst.steps = steps;
  worst.dropped = steps;
  for (std::size_t i = 0; i < std::min(difference.size(), twins.apart_so_far().size()); ++i) {
    const Apart& allowed = twins.apart_so_far()[i];
    if (!(allowed.motion < hopeless)) break;
    --worst.dropped;
    const std::string step = ", step " + std::to_string(i + 1);
    worst.worsen(difference[i].motion, safety * (allowed.motion + noise), "motion" + step);
    if (!(allowed.tension < 100.0 * hopeless)) continue;
    worst.worsen(difference[i].tension, safety * (allowed.tension + noise), "tension" + step);
  }
  return worst;
}

double weight_of(const Machine& machine) {
  double mass = 0.0;
  for (const BodyDef& body : machine.model.bodies) mass += body.mass.value_or(0.0);
  return mass * machine.model.gravity.norm();
}

void retell(const Retold& retold, Course& course, const Machine& machine) {
  for (Moment& moment : course.moments) {
    for (BodyState& body : moment.bodies) body = retold.body(body);
    for (std::size_t k = 0; k < machine.cables.size(); ++k) {
      std::vector<double>& tensions = moment.tensions[k];
      for (double& tension : tensions) tension *= retold.tension;
      const bool turned = retold.tensions_reversed && !machine.cables[k].closed;
      if (turned) std::reverse(tensions.begin(), tensions.end());
    }
  }
}

/// Where in either of them rows depend on each other.
void forget_shared_loads(Course& a, Course& b) {
  for (std::size_t i = 0; i < std::min(a.moments.size(), b.moments.size()); ++i) {
    if (!a.moments[i].redundant && !b.moments[i].redundant) continue;
    a.moments[i].tensions.clear();
    b.moments[i].tensions.clear();
  }
}

}  // namespace

Course follow(const Machine& machine, int steps) {
  Simulation s = start(machine);
  const bool breaks = std::any_of(
      machine.model.joints.begin(), machine.model.joints.end(),
      [](const auto& joint) { return joint->breaking_force || joint->breaking_torque; });
  Course course;
  for (int i = 0; i < steps; ++i) {
    const StepReport report = s.world.step();
    if (!report.ok()) {
      course.failed = true;
      return course;
    }
    const StepStatistics& done = report.statistics;
    course.impossible = done.impossible > 0 || done.dead_ends > 0;
    course.told = course.impossible || done.compromises > 0 || done.unconverged > 0 ||
                  (breaks && done.redundant_rows > 0);
    if (course.told) return course;
    if (s.cables != nullptr && !s.cables->tangent_warnings().empty()) {
      course.lost = true;
      return course;
    }
    Moment& moment = course.moments.emplace_back();
    moment.bodies = s.world.state().bodies;
    moment.redundant = done.redundant_rows > 0;
    moment.parts = done.substep_parts;
    for (const CableReport& cable : s.cable_reports()) append_tensions(cable, moment);
  }
  return course;
}

Finding alike(const Machine& machine, const Machine& other, const Retold& retold, int steps,
              double noise, std::uint64_t seed) {
  const Course course = follow(machine, steps);
  Course told = follow(other, steps);
  retell(retold, told, machine);
  const double size = start(machine).world.bodies().scale() + 1.0;
  const double weight = weight_of(machine);
  const double dt = machine.model.step.dt;
  Course own = course;
  if (!retold.compares_shared_loads) forget_shared_loads(own, told);
  const auto difference = apart(own, told, dt, size, weight);
  Twins twins(machine, course, size, weight);
  for (std::uint64_t k = 0; k < 2; ++k) twins.add(noise, 1000 * seed + k);
  if (noise > 1e-14) twins.add(beside_a_landmark(machine, size));
  Finding finding = judged(difference, twins, noise, steps);
  if (twins.count() == 0 || difference.empty() || twins.apart_so_far().empty()) {
    finding.checked = false;
  }
  // Further twins only widen the bound, so those that are not needed are not run.
  for (std::uint64_t k = 2; k < most_twins && !finding.holds(); ++k) {
    twins.add(noise, 1000 * seed + k);
    finding = judged(difference, twins, noise, steps);
  }
  const bool ends_apart =
      !course.told && !told.told && (course.failed != told.failed || course.lost != told.lost);
  if (finding.holds() && ends_apart && twins.apart_so_far().size() == course.moments.size() &&
      (twins.apart_so_far().empty() || twins.apart_so_far().back().motion < hopeless)) {
    finding = {true, 1.0, 0.0, "one fails, the other does not", finding.steps, finding.dropped};
  }
  const bool one_tells = (course.impossible && !told.told) || (told.impossible && !course.told);
  if (finding.holds() && one_tells && twins.same_told()) {
    finding = {true,          1.0,
               0.0,           "one tells of what cannot be, the other does not",
               finding.steps, finding.dropped};
  }
  return finding;
}

}  // namespace sheave::test
