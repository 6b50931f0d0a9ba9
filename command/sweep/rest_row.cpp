// A row of a sweep of equilibria or of vibrations.

#include <algorithm>
#include <limits>
#include <span>

#include <fmt/format.h>

#include "command/failure.h"
#include "command/run/player.h"
#include "command/sweep/row_run.h"
#include "scenes/quantity_list.h"
#include "statics/equilibrium.h"
#include "statics/modes.h"

namespace sheave::command {
namespace {

constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();

double largest_tension(const Simulation& simulation, const std::string& cable) {
  for (const CableReport& report : simulation.cable_reports()) {
    if (report.name == cable) return report.largest_tension();
  }
  return not_measured;
}

/// A machine at rest, and its vibrations if they are asked for.
struct RestedMachine {
  const Simulation& simulation;
  const Equilibrium& rest;
  const Modes& modes;

  /// The value of a measure; NaN with a message in the row if the machine has none.
  double value(const SweepMeasure& measure, SweepRow& row) const {
    switch (measure.figure) {
      case RestFigure::quantity:
        return quantity(measure, row);
      case RestFigure::largest_tension: {
        const double largest = largest_tension(simulation, measure.course.quantity);
        if (!(largest >= 0.0)) add_message(row, measure.name + ": there is no such cable");
        return largest;
      }
      case RestFigure::unstable_motions:
        return rest.unstable_motions;
      case RestFigure::neutral_motions:
        return rest.neutral_motions;
      case RestFigure::eigenvalue:
        return has(measure, rest.eigenvalues.size(), row) ? rest.eigenvalues[measure.number - 1]
                                                          : not_measured;
      case RestFigure::frequency:
        return has(measure, modes.modes.size(), row) ? modes.modes[measure.number - 1].frequency
                                                     : not_measured;
      case RestFigure::damping:
        return has(measure, modes.modes.size(), row) ? modes.modes[measure.number - 1].damping_ratio
                                                     : not_measured;
    }
    return not_measured;
  }

 private:
  static bool has(const SweepMeasure& measure, std::size_t count, SweepRow& row) {
    if (measure.number <= count) return true;
    add_message(row, fmt::format("{}: there are {} independent motions", measure.name, count));
    return false;
  }

  double quantity(const SweepMeasure& measure, SweepRow& row) const {
    const std::string& text = measure.course.quantity;
    QuantityList list(QuantityIndex::of(simulation, std::span(&text, 1)));
    if (const Errors errors = list.add(text); !errors.empty()) {
      add_message(row, measure.name + ": " + to_text(errors));
      return not_measured;
    }
    double value = not_measured;
    list.sample(simulation, {&value, 1});
    return value;
  }
};

}  // namespace

void measure_at_rest(const SweepOptions& options, Scene scene, SweepRow& row) {
  scene.start.reset();  // the search starts in the pose, or in the loaded state
  Simulation simulation = make_simulation(scene);
  const Equilibrium rest = find_equilibrium(simulation);
  row.end = simulation.world.state().time;
  if (!rest.converged) {
    row.status = SweepStatus::no_rest;
    add_message(row, rest.message);
    return;
  }
  if (rest.stability == Stability::unstable) {
    row.status = SweepStatus::unstable;
    add_message(row, fmt::format("unstable: {} of {} independent motions run away",
                                 rest.unstable_motions, rest.eigenvalues.size()));
  }
  const Modes modes = options.kind == SweepKind::modes ? find_modes(simulation) : Modes{};
  const RestedMachine machine{simulation, rest, modes};
  for (std::size_t i = 0; i < options.measures.size(); ++i) {
    row.measured[i] = machine.value(options.measures[i], row);
  }
}

}  // namespace sheave::command
