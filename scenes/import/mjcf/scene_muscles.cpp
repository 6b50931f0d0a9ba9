// Muscles as loads along cables. MuJoCo's length of an actuator is the gear times that of the
// tendon; with the divisor of a pulley it is g P, where P is the length of the cable's path. With
// the lengths lr of lengthrange and the normalised lengths r of range, L0 = (lr1 - lr0) / (r1 - r0)
// and L = r0 + (g P - lr0) / L0. So in the lengths of the path the optimal length is L0 / g, the
// tendon's length is (lr0 - r0 L0) / g, and the force is g times as large.

#include <algorithm>

#include <fmt/format.h>

#include "engine/number_text.h"
#include "scenes/import/mjcf/scene.h"

namespace sheave::import::mjcf {

void write_muscle(Writer& writer, const Actuator& actuator, std::size_t number,
                  const std::string& cable, double divisor) {
  const double gear = actuator.gear / divisor;
  if (!(gear > 0.0)) {
    writer.log.skipped(*actuator.element, "with a gear of 0 or below it would push");
    return;
  }
  const MuscleLaw& law = *actuator.muscle;
  const auto [shortest, longest] = *law.length_range;
  const double optimal = (longest - shortest) / (law.range[1] - law.range[0]);
  const std::string name = writer.load_names.take(actuator.name, "muscle");
  Json load = {{"type", "muscle"},
               {"name", name},
               {"cable", cable},
               {"force", gear * law.force},
               {"optimal_length", optimal / gear},
               {"tendon_length", (shortest - law.range[0] * optimal) / gear},
               {"max_speed", law.max_speed},
               {"shortest", law.shortest},
               {"longest", law.longest},
               {"passive_force", law.passive_force},
               {"lengthening_force", law.lengthening_force},
               {"activation_time", law.time_constants[0]},
               {"deactivation_time", law.time_constants[1]}};
  const auto bounded = [](double value) { return std::clamp(value, 0.0, 1.0); };
  if (const double start = bounded(writer.activations[number]); start > 0.0) {
    load["activation"] = start;
  }
  if (const double control = bounded(writer.controls[number]); control > 0.0) {
    load["excitations"] = {control};
  }
  if (actuator.force_range) writer.log.changed(*actuator.element, "not taken: forcerange");
  Json& list = writer.scene["loads"];
  writer.log.origin(*actuator.element, fmt::format("/loads/{}", list.size()));
  writer.log.same(
      *actuator.element,
      fmt::format("\"{}\": a muscle of {} N and {} m along the cable \"{}\"; the control "
                  "\"{}.excitation\" excites it",
                  name, number_text(gear * law.force, 6), number_text(optimal / gear, 6), cable,
                  name));
  list.push_back(std::move(load));
}

}  // namespace sheave::import::mjcf
