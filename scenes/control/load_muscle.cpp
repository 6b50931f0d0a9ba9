#include "scenes/control/load_muscle.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "cable/links/attachment.h"
#include "cable/links/opening.h"
#include "cable/links/pinhole.h"
#include "cable/links/surface.h"
#include "engine/body_set.h"
#include "engine/index.h"
#include "engine/model.h"
#include "engine/world.h"
#include "scenes/suggestion.h"

namespace sheave {
namespace {

constexpr std::size_t wrench_size = 6;  // force, then torque about the centre of mass

/// The path of a muscle now, and the effect of a unit tension along it.
struct MusclePath {
  double length = 0.0;  ///< [m]
  double rate = 0.0;    ///< of the length [m/s]
  /// Acceleration of the shortening per unit of tension [1/kg], if no joint held the bodies; summed
  /// over bodies, each times the peak forces of all muscles that may pull it over that of this muscle.
  double yield = 0.0;
  std::vector<double> wrenches;  ///< per body: force [1], torque [m]
};

/// Acceleration along a wrench per unit of it [1/kg], if no joint holds the body.
double yield_of(const BodyProperties& body, const BodyState& state, const Vector3& force,
                const Vector3& torque) {
  if (!(body.mass > 0.0)) return 0.0;
  const double along = force.dot(body.axis);
  if (body.mobility == Mobility::slider) return along * along / body.mass;
  if (body.mobility == Mobility::planar) {
    const double turn = torque.dot(body.axis);
    return (force.squaredNorm() - along * along) / body.mass +
           (body.axis_inertia > 0.0 ? turn * turn / body.axis_inertia : 0.0);
  }
  const Vector3 own = state.orientation.conjugate() * torque;
  return force.squaredNorm() / body.mass + own.dot(body.inverse_inertia * own);
}

/// Adds the ends of spans to a path: the derivative of the length by the pose of each body.
class MusclePathSum {
 public:
  MusclePathSum(const World& world, const std::vector<int>& bodies)
      : world_(world), bodies_(bodies) {
    path.wrenches.assign(wrench_size * bodies.size(), 0.0);
  }

  void add(const CableReport& report) {
    const CableReport whole = report.with_wraps_in_place();
    int from = -1;
    for (std::size_t i = 0; i < whole.links.size(); ++i) {
      const LinkReport& link = whole.links[i];
      path.length += link.stored_length + link.stored_stretch;
      if (!link.touched) continue;
      if (from >= 0) add_span(whole, at(from), i);
      from = static_cast<int>(i);
    }
  }

  /// Finds the yield of the path, after all reports have been added.
  void find_yield(const std::vector<double>& together) {
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      const double* const own = &path.wrenches[wrench_size * b];
      path.yield +=
          together[b] * yield_of(world_.bodies()[bodies_[b]], world_.state().bodies[at(bodies_[b])],
                                 Vector3(own[0], own[1], own[2]), Vector3(own[3], own[4], own[5]));
    }
  }

  MusclePath path;

 private:
  void add_span(const CableReport& report, std::size_t from, std::size_t to) {
    const SpanReport& span = report.spans[from];
    path.length += span.length;
    if (!(span.length > 0.0)) return;
    const Vector3 along = (span.end - span.start) / span.length;
    add_end(report.links[from].body, span.start, along);
    add_end(report.links[to].body, span.end, -along);
  }

  /// A unit force `pull` on a body at a point of the world frame.
  void add_end(BodyId body, const Vector3& point, const Vector3& pull) {
    if (body.is_world()) return;
    const BodyState& state = world_.state().bodies[at(body.index)];
    const Vector3 arm = point - state.position;
    path.rate -= pull.dot(state.velocity + state.angular_velocity.cross(arm));
    const auto found = std::find(bodies_.begin(), bodies_.end(), body.index);
    if (found == bodies_.end()) return;
    const Vector3 torque = arm.cross(pull);
    double* const own =
        &path.wrenches[wrench_size * static_cast<std::size_t>(found - bodies_.begin())];
    for (int k = 0; k < 3; ++k) {
      own[k] += pull[k];
      own[k + 3] += torque[k];
    }
  }

  const World& world_;
  const std::vector<int>& bodies_;
};

/// The report of the cable with this name; null if there is none or the cable is cut.
const CableReport* uncut_report(std::span<const CableReport> cables, std::string_view name) {
  for (const CableReport& report : cables) {
    if (report.name == name) return report.cut ? nullptr : &report;
  }
  return nullptr;
}

// The force acts over a whole substep h and depends on the rate r of the length in its middle. A force
// by the rate that the last two substeps foretell is explicit, and a light body would swing with
// growing speed. So the tension T is the solution of
//
//   T = law(r),   r = foretold rate - w h / 2 (T - T of the last substep),
//
// with w the acceleration along the path per unit of tension. The difference of tensions is of first
// order in h, so the error of w is one of second order. For a law with the slope c, bodies of the yield
// w' have the characteristic polynomial
//   (1 + w c h / 2) z^2 - (1 + w c h - 3/2 w' c h) z + (w - w') c h / 2,
// whose roots lie within the unit circle if w > w' - 1 / (c h) (criterion of Jury). Free bodies have the
// largest w', but on joints it may be a hundredth of that, and the tension would lag. So w is observed:
// the least-squares slope of past changes of the acceleration over changes of the tension, with
// weights that fade. If w were too small, the tension would swing, and its swing would tell w.
class ActingMuscle final : public ActingLoad {
 public:
  /// `together`: for each body, the peak forces of all muscles that may pull it over the own one.
  ActingMuscle(const MuscleLoad& load, std::vector<int> bodies, std::vector<double> together)
      : load_(load),
        bodies_(std::move(bodies)),
        together_(std::move(together)),
        table_(TimeTable::of(load.times,
                             load.excitations.empty() ? std::vector<double>{0.0} : load.excitations,
                             load.interpolation)) {}

  [[nodiscard]] std::size_t memory_size() const override {
    return first_moment + 2 * moment_size();
  }

  void pull(const World& world, std::span<const CableReport> cables, const LoadSubstep& substep,
            std::span<double> memory, std::map<int, PointForce>& forces) const override {
    const double h = substep.length;
    const CableReport* const cable = uncut_report(cables, load_.cable);
    const double last_tension = std::max(std::exchange(memory[tension], 0.0), 0.0);
    if (cable == nullptr) return;
    MusclePathSum sum(world, bodies_);
    sum.add(*cable);
    sum.find_yield(together_);
    const double now = world.state().time;
    if (!substep.jumped) observe(sum.path, now, last_tension, memory);
    const double yield = yield_by(memory, sum.path.yield, h);
    const double before = activation_at(memory, now);
    remember(sum.path, now, memory);
    if (substep.jumped) {
      memory[first_moment] = no_memory;
      memory[earlier_tension] = last_tension;
    }
    const double set = memory[set_excitation];
    const double wanted = set >= 0.0 ? set : table_.integral(now, now + h) / h;
    memory[activation] = before;
    memory[excitation] = std::clamp(wanted, 0.0, 1.0);
    const double half = 0.5 * h;
    const double active = load_.after(before, memory[excitation], half);
    const double foretold = ahead(memory, 1, half);
    memory[tension] = solve_tension([&](double pull) {
      const double rate = foretold - yield * half * (pull - last_tension);
      const double length =
          (sum.path.length + half * rate - load_.tendon_length) / load_.optimal_length;
      const double speed = rate / (load_.optimal_length * load_.max_speed);
      return load_.force *
             (active * load_.by_length(length) * load_.by_velocity(speed) + load_.passive(length));
    });
    add_forces(memory, half, forces);
  }

  [[nodiscard]] MuscleState muscle(std::span<const double> memory, double time) const override {
    MuscleState state;
    state.activation = activation_at(memory, time);
    state.tension = std::max(memory[tension], 0.0);
    if (memory[set_excitation] >= 0.0) state.excitation = memory[set_excitation];
    return state;
  }

 private:
  // Places in the memory, behind set_excitation. Then come two moments, of the last substep but one
  // and of the last: time, rate, wrenches.
  static constexpr std::size_t activation = 1;  // at the start of the last substep
  static constexpr std::size_t excitation = 2;  // in the last substep
  static constexpr std::size_t tension = 3;
  static constexpr std::size_t earlier_tension = 4;  // of the last substep but one
  static constexpr std::size_t observed_slope = 5;   // sums of products of changes
  static constexpr std::size_t observed_square = 6;
  static constexpr std::size_t first_moment = 7;

  /// The tension that is equal to `law` of it, by bisection: `law` is not negative, falls with the
  /// tension but for the slope of FL, and has corners.
  template <class Law>
  [[nodiscard]] static double solve_tension(const Law& law) {
    double low = 0.0;
    double high = law(0.0);
    while (law(high) > high) high *= 2.0;  // ends: FL, FV and, for a shorter path, FP are bounded
    for (int i = 0; i < 60 && low < high; ++i) {
      const double middle = 0.5 * (low + high);
      (law(middle) > middle ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }

  [[nodiscard]] std::size_t moment_size() const { return 2 + wrench_size * bodies_.size(); }

  [[nodiscard]] double activation_at(std::span<const double> memory, double time) const {
    const double last = memory[first_moment + moment_size()];
    if (last < 0.0) return load_.activation;
    const double then = std::clamp(memory[activation], 0.0, 1.0);
    return time > last ? load_.after(then, std::clamp(memory[excitation], 0.0, 1.0), time - last)
                       : then;
  }

  /// Adds the last change of the acceleration to the sums. Before remember().
  void observe(const MusclePath& path, double now, double last_tension,
               std::span<double> memory) const {
    const std::span<const double> before = memory.subspan(first_moment, moment_size());
    const std::span<const double> last = memory.last(moment_size());
    if (!(last[0] < now)) return;
    if (before[0] >= 0.0) {
      constexpr double fading = 0.8;
      const double change = last_tension - memory[earlier_tension];
      const double bend =
          (path.rate - last[1]) / (now - last[0]) - (last[1] - before[1]) / (last[0] - before[0]);
      memory[observed_slope] = fading * std::max(memory[observed_slope], 0.0) - bend * change;
      memory[observed_square] = fading * std::max(memory[observed_square], 0.0) + change * change;
    }
    memory[earlier_tension] = last_tension;
  }

  /// The observed yield, at most that of free bodies. Before any observation, the least one with which
  /// free bodies are stable: w' - 1 / (c h), where the slope c of FV is 2 at most.
  [[nodiscard]] double yield_by(std::span<const double> memory, double free, double h) const {
    const double square = memory[observed_square];
    if (square > 0.0) return std::clamp(memory[observed_slope] / square, 0.0, free);
    return std::max(free - load_.optimal_length * load_.max_speed / (2.0 * load_.force * h), 0.0);
  }

  void remember(const MusclePath& path, double now, std::span<double> memory) const {
    const std::span<double> last = memory.last(moment_size());
    if (last[0] < now && last[0] >= 0.0) {
      std::copy(last.begin(), last.end(), memory.subspan(first_moment).begin());
    }
    last[0] = now;
    last[1] = path.rate;
    std::copy(path.wrenches.begin(), path.wrenches.end(), last.begin() + 2);
  }

  /// Number `place` of a moment, `time` after the last moment.
  [[nodiscard]] double ahead(std::span<const double> memory, std::size_t place, double time) const {
    const std::span<const double> before = memory.subspan(first_moment, moment_size());
    const std::span<const double> last = memory.last(moment_size());
    if (before[0] < 0.0) return last[place];
    return last[place] + time / (last[0] - before[0]) * (last[place] - before[place]);
  }

  void add_forces(std::span<const double> memory, double time,
                  std::map<int, PointForce>& forces) const {
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      PointForce& own = forces[bodies_[b]];
      const std::size_t first = 2 + wrench_size * b;
      for (std::size_t k = 0; k < 3; ++k) {
        own.force[static_cast<int>(k)] += memory[tension] * ahead(memory, first + k, time);
        own.torque[static_cast<int>(k)] += memory[tension] * ahead(memory, first + k + 3, time);
      }
    }
  }

  MuscleLoad load_;
  std::vector<int> bodies_;
  std::vector<double> together_;
  TimeTable table_;
};

const CableDef* muscle_cable(const std::vector<CableDef>& cables, const std::string& name) {
  for (const CableDef& cable : cables) {
    if (cable.name == name) return &cable;
  }
  return nullptr;
}

/// Whether friction holds the cable at a link, or the link is of a type that no muscle passes.
std::string muscle_link_fault(const LinkDef& link) {
  double friction = 0.0;
  Passage passes = Passage::both;
  if (const auto* hole = dynamic_cast<const PinholeLink*>(&link)) {
    friction = hole->friction;
    passes = hole->passes;
  } else if (const auto* surface = dynamic_cast<const SurfaceLink*>(&link)) {
    friction = surface->friction;
  } else if (link.type() != AttachmentLink::type_name && link.type() != OpeningLink::type_name) {
    return fmt::format(
        "is of the type {}; a muscle lies along attachments, pinholes, openings and "
        "surfaces",
        link.type());
  }
  if (friction > 0.0 || passes != Passage::both) {
    return "has friction or one direction, and a muscle pulls equally on both sides; leave "
           "friction and passes out";
  }
  return {};
}

}  // namespace

std::span<const Field> MuscleLoad::field_table() {
  static const std::array table{
      field<&MuscleLoad::cable>("cable", "", {}, required,
                                "name of the cable along which the muscle lies; its own tension "
                                "acts beside that of the muscle"),
      field<&MuscleLoad::force>("force", "N", above(0.0), required, "peak active force"),
      field<&MuscleLoad::optimal_length>("optimal_length", "m", above(0.0), required,
                                         "length of the fibres at that force"),
      field<&MuscleLoad::tendon_length>("tendon_length", "m", any_number(), optional,
                                        "part of the path that is rigid tendon"),
      field<&MuscleLoad::max_speed>("max_speed", "1/s", above(0.0), optional,
                                    "fastest shortening, in optimal lengths per second"),
      field<&MuscleCurves::shortest, MuscleLoad>(
          "shortest", "", between(0.0, 1.0), optional,
          "least length with active force, in optimal lengths, below 1"),
      field<&MuscleCurves::longest, MuscleLoad>(
          "longest", "", above(1.0), optional,
          "greatest length with active force, in optimal lengths"),
      field<&MuscleCurves::passive_force, MuscleLoad>(
          "passive_force", "", at_least(0.0), optional,
          "twice the passive force at (1 + longest) / 2 optimal lengths, in peak forces"),
      field<&MuscleCurves::lengthening_force, MuscleLoad>(
          "lengthening_force", "", at_least(1.0), optional,
          "active force of fast lengthening, in peak forces"),
      field<&MuscleActivation::activation_time, MuscleLoad>(
          "activation_time", "s", above(0.0), optional, "time constant of activation"),
      field<&MuscleActivation::deactivation_time, MuscleLoad>(
          "deactivation_time", "s", above(0.0), optional, "time constant of deactivation"),
      field<&MuscleLoad::activation>("activation", "", between(0.0, 1.0), optional, "at time 0"),
      field<&MuscleLoad::times>("times", "s", any_number(), optional,
                                "increasing times of the excitations; none for a constant"),
      field<&MuscleLoad::excitations>(
          "excitations", "", between(0.0, 1.0), optional,
          "one per time; none: 0. The control excitation replaces them"),
      choice_field<&MuscleLoad::interpolation>("interpolation", interpolation_names, optional,
                                               interpolation_meaning),
  };
  return table;
}

void MuscleLoad::check_cable(const LoadScope& scope, const std::string& path,
                             Errors& errors) const {
  const auto fail = [&](const std::string& message) {
    errors.push_back(fault(path + "/cable", message));
  };
  const CableDef* const own = muscle_cable(scope.cables, cable);
  if (own == nullptr) {
    std::vector<std::string_view> names;
    for (const CableDef& other : scope.cables) names.push_back(other.name);
    const auto near = nearest(cable, names, 5);
    fail(fmt::format("there is no cable \"{}\"{}", cable,
                     near.empty()
                         ? std::string()
                         : fmt::format("; near it are \"{}\"", fmt::join(near, "\", \""))));
    return;
  }
  if (own->closed) return fail(fmt::format("cable \"{}\" is closed, and a muscle has ends", cable));
  if (own->wrap_friction > 0.0 || own->linear_density > 0.0) {
    return fail(
        fmt::format("cable \"{}\" has wrap_friction or weight, and a muscle pulls equally "
                    "everywhere; leave both out",
                    cable));
  }
  for (std::size_t i = 0; i < own->links.size(); ++i) {
    if (own->links[i] == nullptr) return;  // the cable's own fault
    const std::string link_fault = muscle_link_fault(*own->links[i]);
    if (!link_fault.empty()) {
      return fail(fmt::format("link {} of cable \"{}\" {}", i, cable, link_fault));
    }
    const BodyId on = own->links[i]->body;
    if (on.is_world()) continue;
    const BodyDef& def = scope.model.bodies[at(on.index)];
    if (def.mobility != Mobility::rotor) continue;
    return fail(
        fmt::format("link {} of cable \"{}\" is on the rotor \"{}\"; a muscle pulls bodies "
                    "on joints, so give the body a hinge",
                    i, cable, def.name));
  }
  if (bodies(scope).empty()) {
    fail(fmt::format("cable \"{}\" has no link on a body that a force can move", cable));
  }
}

std::vector<int> MuscleLoad::bodies(const LoadScope& scope) const {
  std::vector<int> list;
  const CableDef* const own = muscle_cable(scope.cables, cable);
  if (own == nullptr) return list;
  const auto add = [&](int index) {
    const Mobility mobility = scope.model.bodies[at(index)].mobility;
    const bool moves = yields(mobility) && mobility != Mobility::rotor;
    if (moves && std::find(list.begin(), list.end(), index) == list.end()) list.push_back(index);
  };
  for (const auto& link : own->links) {
    if (!link->body.is_world()) add(link->body.index);
  }
  // The cable may come to lie on these.
  for (int i = 0; own->most_wraps > 0 && i < static_cast<int>(scope.model.bodies.size()); ++i) {
    if (scope.model.bodies[at(i)].wrappable) add(i);
  }
  return list;
}

Errors MuscleLoad::validate(const LoadScope& scope, const std::string& path) const {
  Errors errors;
  if (!body.is_world()) {
    errors.push_back(
        fault(path + "/body", "a muscle acts on the bodies of its cable; leave body out"));
  }
  check_cable(scope, path, errors);
  if (!(shortest < 1.0)) {
    errors.push_back(fault(path + "/shortest", "it must be below 1, the optimal length"));
  }
  check_table(times, excitations.size(), "excitations", path, errors);
  check_times(times, path, errors);
  return errors;
}

std::optional<MuscleFibre> MuscleLoad::fibre(const World& world,
                                             std::span<const CableReport> cables) const {
  const CableReport* const report = uncut_report(cables, cable);
  if (report == nullptr) return {};
  const std::vector<int> none;
  MusclePathSum sum(world, none);
  sum.add(*report);
  return MuscleFibre{(sum.path.length - tendon_length) / optimal_length,
                     sum.path.rate / (optimal_length * max_speed)};
}

std::shared_ptr<const ActingLoad> MuscleLoad::prepare(const LoadScope& scope) const {
  const std::vector<int> own = bodies(scope);
  std::vector<double> together(own.size(), 0.0);
  for (const auto& load : scope.loads) {
    const auto* const muscle = dynamic_cast<const MuscleLoad*>(load.get());
    if (muscle == nullptr) continue;
    const std::vector<int> others = muscle->bodies(scope);
    for (std::size_t b = 0; b < own.size(); ++b) {
      if (std::find(others.begin(), others.end(), own[b]) == others.end()) continue;
      together[b] += muscle->force / force;
    }
  }
  return std::make_shared<const ActingMuscle>(*this, own, std::move(together));
}

}  // namespace sheave
