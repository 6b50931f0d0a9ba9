// Measures are looked up in the scene, and the journal gets its key.

#include <algorithm>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "command/failure.h"
#include "command/input/content_hash.h"
#include "command/input/state_file.h"
#include "command/sweep/journal.h"
#include "command/sweep/row_run.h"
#include "scenes/quantity_list.h"

namespace sheave::command {
namespace {

std::string unit_of(const CheckDef& course, std::string unit) {
  if (course.statistic == Statistic::rate) unit = unit.empty() ? "1/s" : unit + "/s";
  if (course.statistic == Statistic::integral) unit += unit.empty() ? "s" : " s";
  return unit;
}

/// Looks up a measure in a scene and fills in its unit. Returns the fault; empty if there is none.
std::string fault_of(const Scene& scene, const std::shared_ptr<const QuantityIndex>& index,
                     SweepKind kind, SweepMeasure& measure) {
  const std::string& name = measure.course.quantity;
  if (measure.figure == RestFigure::largest_tension) {
    const auto& cables = scene.cables;
    const bool known = std::any_of(cables.begin(), cables.end(),
                                   [&](const CableDef& cable) { return cable.name == name; });
    if (known) return "";
    if (index->find(name + ".tension")) {
      return fmt::format("at rest a span has one tension; write {}.tension", name);
    }
    return fmt::format("there is no cable \"{}\"", name);
  }
  if (measure.figure != RestFigure::quantity) return "";
  QuantityList quantity(index, kind == SweepKind::run ? Taken::along_run : Taken::at_moments);
  if (const Errors errors = quantity.add(name); !errors.empty()) return to_text(errors);
  if (kind != SweepKind::run && !quantity.follows_from_state(0)) {
    return "this quantity needs motion; a machine at rest has poses, lengths, tensions and the "
           "forces of joints";
  }
  measure.unit = unit_of(measure.course, quantity.unit(0));
  return "";
}

}  // namespace

std::vector<std::string> find_measures(SweepOptions& options,
                                       const std::vector<std::vector<std::string>>& points) {
  std::vector<std::string> faults(options.measures.size());
  std::vector<bool> found(options.measures.size(), false);
  std::optional<Failure> no_scene;
  std::vector<std::string> scenes;
  for (const std::vector<std::string>* point : {&points.front(), &points.back()}) {
    try {
      SceneOptions first = with_values(options, *point);
      first.tells_strains = point == &points.front();  // once for all rows
      const Scene scene = load(first);
      if (first.tells_strains && options.kind != SweepKind::run) warn_of_loads_left_out(scene);
      scenes.push_back(write_scene(scene));
      const auto index = std::make_shared<const QuantityIndex>(scene);
      for (SweepAxis& axis : options.plan.axes) {
        if (const auto setting = index->setting(axis.name)) axis.unit = setting->unit.text();
      }
      for (std::size_t i = 0; i < options.measures.size(); ++i) {
        const std::string fault = fault_of(scene, index, options.kind, options.measures[i]);
        found[i] = found[i] || fault.empty();
        if (!fault.empty()) faults[i] = fault;
      }
    } catch (const Failure& failure) {
      no_scene = failure;
    }
  }
  if (scenes.empty()) throw Failure(*no_scene);
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i]) continue;
    const SweepMeasure& measure = options.measures[i];
    throw Failure(ExitCode::usage,
                  fmt::format("{} {}: {}", measure.option, measure.name, faults[i]));
  }
  return scenes;
}

std::string key_of(const SweepOptions& options, const std::vector<std::vector<std::string>>& points,
                   const std::vector<std::string>& scenes) {
  ContentHash hash;
  hash.add(sweep_journal_formats.marked);
  hash.add_program();
  hash.add(*options.scene.text);
  // Includes the settings of the command line, which the scene file does not contain.
  for (const std::string& text :
       {options.scene.dt, options.scene.substeps, options.scene.iterations, options.scene.solver,
        options.scene.integrator, options.scene.tolerance, options.scene.duration}) {
    hash.add(text);
  }
  if (!options.scene.load_state.empty()) hash.add(read_state_bytes(options.scene.load_state));
  for (const std::string& setting : options.scene.settings) hash.add(setting);
  for (const std::string& parameter : options.scene.parameters) hash.add(parameter);
  // The hash is of the resulting scenes, so that it covers imports.
  for (const std::string& scene : scenes) hash.add(scene);
  hash.add(name_of(options.kind));
  for (const SweepAxis& axis : options.plan.axes) {
    hash.add(axis.name);
    for (const auto& settings : axis.cases) {
      for (const SweepSetting& setting : settings) hash.add(setting.name + "=" + setting.value);
      hash.add("");
    }
  }
  for (const SweepMeasure& measure : options.measures) hash.add(measure.name);
  for (const std::vector<std::string>& point : points) {
    for (const std::string& value : point) hash.add(value);
  }
  hash.add(fmt::format("{} {}", options.trust, options.time_limit.value_or(0.0)));
  return hash.text();
}

SweepHead head_of(const SweepOptions& options) {
  SweepHead head;
  head.scene = options.scene.path;
  for (const SweepAxis& axis : options.plan.axes) {
    head.axes.push_back(axis.name);
    head.axis_units.push_back(axis.unit);
  }
  head.measures = options.measures;
  head.shard = options.shard;
  head.kind = options.kind;
  return head;
}

}  // namespace sheave::command
