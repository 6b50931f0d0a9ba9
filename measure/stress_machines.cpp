// The standard stability maps. Each cell is a generated scene whose checks are closed forms. If a
// map changes the machine in a way that the generator does not know, it also sets the values of the
// checks.
//
// Atwood, wheel train, tackle: the closed forms of the generators hold for all masses, sizes and
// gravities.
//
// Elastic. Two weights on a cable with compliance c per span over a massless wheel: both spans have
// the same tension T, and the cable is a spring of compliance 2c between the weights, w^2 = (1/m1 +
// 1/m2) / (2c). From rest, just taut,
//   T = T0 (1 - cos wt) with T0 = 2 m1 m2 g / (m1 + m2);
//   its mean over a duration D is T0 (1 - sin(wD) / (wD)),
//   v2 = -g D + (1/m2) x the integral of T, and v1 = -g D + (1/m1) x the same.
// xpbd damps a vibration that a step cannot resolve to T = T0, and the mean also tends to T0 as wD
// grows. The closed form therefore holds at both ends. Errors of the tension are relative to T0:
// for a cable so soft that its tension is still small, the first order of xpbd leaves a larger
// relative error, which has no effect on the motion.
//
// Capstan. The cable slips over a fixed wheel, half a turn of it, with friction f, q = e^(pi f):
// nothing moves if m2 <= q m1; else a = (m2 - q m1) g / (m2 + q m1) and T1 = m1 (g + a), T2 = q T1
// = m2 (g - a).
//
// Gravity 0 and upwards. Without gravity nothing moves and all tensions are 0. With upward gravity
// both weights rise freely and the cable is slack.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "measure/stress_map.h"

namespace sheave::measure {
namespace {

constexpr double g = 9.81;
constexpr double first_mass = 1.0;
constexpr double last_mass = 2.0;

std::vector<double> decades(int first, int last, int by) {
  std::vector<double> values;
  for (int e = first; e <= last; e += by) values.push_back(std::pow(10.0, e));
  return values;
}

/// The common part of all maps: cells over two axes.
class MapMaker {
 public:
  explicit MapMaker(const StressRange& range) : range_(range) {}

  /// 1e-5 ... 0.1 s, 1/30 s among them.
  [[nodiscard]] StressAxis steps() const {
    if (range_.quick) return {"step [s]", {1e-4, 1.0 / 60.0, 0.1}};
    return {"step [s]", {1e-5, 1e-4, 1e-3, 1e-2, 1.0 / 60.0, 1.0 / 30.0, 0.1}};
  }
  [[nodiscard]] int by() const { return range_.quick ? 6 : 1; }
  [[nodiscard]] bool quick() const { return range_.quick; }

  /// 0.5 s, but at least 10 steps and at most 2000 (quick: 200): failures occur early or grow.
  [[nodiscard]] double duration(double dt) const {
    const double most = range_.quick ? 200.0 : 2000.0;
    return dt * std::clamp(std::round(0.5 / dt), 10.0, most);
  }

  /// A cell with the step, a suitable duration and the paper's number of iterations.
  [[nodiscard]] StressCell cell(const char* kind, double dt) const {
    StressCell made;
    made.kind = kind;
    made.settings = {{"dt", stress_number(dt)},
                     {"duration", stress_number(duration(dt))},
                     {"iterations", std::to_string(StepSettings::paper().iterations)}};
    return made;
  }

 private:
  StressRange range_;
};

void set(StressCell& cell, const char* option, double value) {
  cell.settings.push_back({option, stress_number(value)});
}
/// Changes the value of a check of the scene; the tolerance is 1/1000 of the value or of `size`.
void expect(StressCell& cell, int check, double value, double size) {
  const std::string pointer = "/checks/" + std::to_string(check);
  cell.replace(pointer + "/equals", stress_number(value));
  cell.replace(pointer + "/tolerance", stress_number(1e-3 * std::max(std::abs(value), size)));
}

// Checks of a train of one wheel, in its generator's order.
enum TrainCheck { first_rate, last_rate, first_tension, last_tension };

StressMap atwood_map(const MapMaker& maker) {
  return StressMap::over(
      "atwood", "Two weights over one wheel of 1 kg; the mass of the heavier one.",
      {"mass ratio", decades(0, 12, maker.by())}, maker.steps(), [&](double ratio, double dt) {
        StressCell cell = maker.cell("wheel-train", dt);
        set(cell, "wheels", 1);
        set(cell, "last_mass", ratio);
        // In balance all accelerations are 0; errors are then relative to gravity.
        if (ratio == 1.0) {
          expect(cell, first_rate, 0.0, g);
          expect(cell, last_rate, 0.0, g);
        }
        return cell;
      });
}

StressMap train_map(const MapMaker& maker) {
  return StressMap::over("wheel-train",
                         "One cable over 16 wheels, 1 kg and 2 kg at its ends; the wheels' mass.",
                         {"mass of 1 kg / wheel", decades(0, 12, maker.by())}, maker.steps(),
                         [&](double ratio, double dt) {
                           StressCell cell = maker.cell("wheel-train", dt);
                           set(cell, "wheels", 16);
                           set(cell, "wheel_mass", 1.0 / ratio);
                           return cell;
                         });
}

StressMap tackle_map(const MapMaker& maker) {
  return StressMap::over("tackle", "A load of 12 kg on four parts of rope; the effort at its end.",
                         {"load / effort", decades(0, 12, maker.by())}, maker.steps(),
                         [&](double ratio, double dt) {
                           StressCell cell = maker.cell("block-and-tackle", dt);
                           set(cell, "unbalance", 4.0 / ratio);
                           return cell;
                         });
}

StressMap elastic_map(const MapMaker& maker) {
  std::vector<double> compliances = decades(-12, 3, maker.quick() ? 5 : 1);
  compliances.insert(compliances.begin(), 0.0);
  return StressMap::over(
      "elastic", "Two weights over a massless wheel on an elastic cable.",
      {"compliance [m/N]", std::move(compliances)}, maker.steps(), [&](double c, double dt) {
        StressCell cell = maker.cell("wheel-train", dt);
        set(cell, "wheels", 1);
        cell.replace("/bodies/1/spin_inertia", "0");
        cell.replace("/cables/0/compliance", stress_number(c));
        const double duration = maker.duration(dt);
        const double pull = 2.0 * first_mass * last_mass * g / (first_mass + last_mass);
        double mean = pull;
        if (c > 0.0) {
          const double angle =
              std::sqrt((1.0 / first_mass + 1.0 / last_mass) / (2.0 * c)) * duration;
          // 1 - sin x / x loses its digits for small x; there it is x^2 / 6.
          mean *= angle < 1e-3 ? angle * angle / 6.0 : 1.0 - std::sin(angle) / angle;
        }
        expect(cell, first_rate, -g + mean / first_mass, g);
        expect(cell, last_rate, -g + mean / last_mass, g);
        expect(cell, first_tension, mean, pull);
        expect(cell, last_tension, mean, pull);
        return cell;
      });
}

StressMap capstan_map(const MapMaker& maker) {
  std::vector<double> frictions{0.0, 0.01, 0.1, 0.3, 0.6, 0.9, 1.0, 2.0, 5.0};
  if (maker.quick()) frictions = {0.0, 0.3, 2.0};
  return StressMap::over(
      "capstan", "1 kg and 20 kg on a cable over a fixed post, half a turn; friction.",
      {"friction", std::move(frictions)}, maker.steps(), [&](double friction, double dt) {
        constexpr double heavy = 20.0;
        StressCell cell = maker.cell("wheel-train", dt);
        set(cell, "wheels", 1);
        set(cell, "last_mass", heavy);
        cell.replace("/bodies/1", R"({"name": "wheel 0", "mobility": "static", "shape": )"
                                  R"({"type": "cylinder", "radius": 0.5, "length": 0.15}})");
        cell.replace("/cables/0/links/1/friction", stress_number(friction));
        const double q = std::exp(std::numbers::pi * friction);
        const double a = std::max(0.0, (heavy - q * first_mass) * g / (heavy + q * first_mass));
        expect(cell, first_rate, a, g);
        expect(cell, last_rate, -a, g);
        expect(cell, first_tension, first_mass * (g + a), 0.0);
        expect(cell, last_tension, heavy * (g - a), 0.0);
        return cell;
      });
}

StressMap spin_map(const MapMaker& maker) {
  std::vector<double> turns{0.01, 0.1, 0.3, 0.5, 0.7, 1.0, 3.0, 10.0, 30.0, 100.0};
  if (maker.quick()) turns = {0.1, 1.0, 100.0};
  return StressMap::over(
      "spin", "Two weights over one wheel that turns so often in the last step.",
      {"turns per step", std::move(turns)}, maker.steps(), [&](double turns_per_step, double dt) {
        StressCell cell = maker.cell("wheel-train", dt);
        // v dt = 2 pi r x turns at the end, with v = a x duration, where a is that of the machine
        // with these masses.
        constexpr double radius = 0.5;
        WheelTrainOptions options;
        options.wheels = 1;
        options.gravity = 1.0;
        const double gravity = 2.0 * std::numbers::pi * radius * turns_per_step /
                               (options.acceleration() * maker.duration(dt) * dt);
        set(cell, "wheels", 1);
        set(cell, "gravity", gravity);
        return cell;
      });
}

StressMap spans_map(const MapMaker& maker) {
  std::vector<double> wheels{1, 10, 100, 1e3, 1e4, 1e5};
  if (maker.quick()) wheels = {1, 10, 1000};
  return StressMap::over(
      "spans", "One cable over so many wheels of 1 kg, 1 kg and 2 kg at its ends; 10 steps.",
      {"wheels", std::move(wheels)}, {"step [s]", {1.0 / 60.0}}, [&](double count, double dt) {
        StressCell cell = maker.cell("wheel-train", dt);
        cell.settings[1].value = stress_number(10.0 * dt);
        set(cell, "wheels", count);
        return cell;
      });
}

StressMap tension_map(const MapMaker& maker) {
  return StressMap::over("tension", "Two weights over one wheel, all of them so much heavier.",
                         {"tension [N]", decades(-9, 9, maker.quick() ? 6 : 2)}, maker.steps(),
                         [&](double tension, double dt) {
                           StressCell cell = maker.cell("wheel-train", dt);
                           set(cell, "wheels", 1);
                           set(cell, "wheel_mass", tension / g);
                           set(cell, "first_mass", tension / g);
                           set(cell, "last_mass", 2.0 * tension / g);
                           return cell;
                         });
}

StressMap scale_map(const MapMaker& maker) {
  return StressMap::over("scale",
                         "Two weights over one wheel; all lengths and gravity times a factor.",
                         {"scale", decades(-6, 6, maker.quick() ? 6 : 1)}, maker.steps(),
                         [&](double scale, double dt) {
                           StressCell cell = maker.cell("wheel-train", dt);
                           set(cell, "wheels", 1);
                           set(cell, "radius", 0.5 * scale);
                           set(cell, "gravity", g * scale);
                           return cell;
                         });
}

StressMap gravity_map(const MapMaker& maker) {
  return StressMap::over("gravity",
                         "Two weights over one wheel without gravity, and with gravity upwards.",
                         {"rise of the weights [m]", {0.0, 1e-9, 1e-6, 1e-3, 0.1, 1.0}},
                         maker.steps(), [&](double rise, double dt) {
                           StressCell cell = maker.cell("wheel-train", dt);
                           // The weights start more than 1.5 m below the wheel, so the cable stays
                           // slack.
                           const double upwards = 2.0 * rise / std::pow(maker.duration(dt), 2);
                           set(cell, "wheels", 1);
                           cell.replace("/gravity", "[0, " + stress_number(upwards) + ", 0]");
                           const double size = rise > 0.0 ? 0.0 : g;
                           expect(cell, first_rate, upwards, size);
                           expect(cell, last_rate, upwards, size);
                           // A tension would be of the size of the weights; 1 kg and 2 kg.
                           expect(cell, first_tension, 0.0, rise > 0.0 ? upwards : g);
                           expect(cell, last_tension, 0.0, rise > 0.0 ? upwards : g);
                           return cell;
                         });
}

}  // namespace

std::vector<StressMap> standard_stress_maps(const StressRange& range) {
  const MapMaker maker(range);
  return {atwood_map(maker),  train_map(maker),  tackle_map(maker), elastic_map(maker),
          capstan_map(maker), spin_map(maker),   spans_map(maker),  tension_map(maker),
          scale_map(maker),   gravity_map(maker)};
}

}  // namespace sheave::measure
