// sheave trade: the settings, and the selection of one that meets a requirement.

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <string_view>

#include <fmt/format.h>

#include "command/failure.h"
#include "command/trade/table.h"
#include "measure/paper_table.h"

namespace sheave::command {
namespace {

/// Parses a positive number at the beginning of `text` and removes it from `text`.
std::optional<double> leading_number(std::string_view& text) {
  double value = 0.0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || !std::isfinite(value) || value <= 0.0) return {};
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return value;
}

}  // namespace

std::string TradeSetting::name() const {
  std::string text = measure::settings_text(step);
  if (tangents == TangentUpdate::substep) text += ", tangents per substep";
  return text;
}

Scene TradeSetting::applied(const Scene& scene) const {
  Scene own = scene;
  own.model.step = step;
  if (tangents) {
    for (CableDef& cable : own.cables) cable.tangent_update = *tangents;
  }
  return own;
}

namespace {

/// Appends a setting per tolerance and tangent update.
void add_tolerances(const TradeGrid& grid, const Scene& scene,
                    const std::vector<std::optional<TangentUpdate>>& tangents,
                    std::vector<TradeSetting>& settings) {
  const auto has = [](const auto& list, auto wanted) {
    return std::find(list.begin(), list.end(), wanted) != list.end();
  };
  if (grid.tolerances.empty() || !has(grid.solvers, SolverKind::direct) ||
      !has(grid.integrators, IntegratorKind::rattle)) {
    return;
  }
  std::vector<double> tolerances;
  for (const GivenTolerance& given : grid.tolerances) {
    tolerances.push_back(tolerance_of(given, scene));
  }
  std::sort(tolerances.rbegin(), tolerances.rend());
  tolerances.erase(std::unique(tolerances.begin(), tolerances.end()), tolerances.end());
  for (const auto& update : tangents) {
    for (const double tolerance : tolerances) {
      // The number of substeps decides when controllers without a sample time act.
      const TradeSetting setting{
          {scene.model.step.dt, scene.model.step.substeps, scene.model.step.iterations,
           SolverKind::direct, IntegratorKind::rattle, tolerance},
          update};
      const Scene own = setting.applied(scene);
      if (Simulation::check(own.model, own.cables).empty()) settings.push_back(setting);
    }
  }
}

}  // namespace

std::vector<TradeSetting> trade_settings(const TradeGrid& grid, const Scene& scene) {
  std::vector<std::optional<TangentUpdate>> tangents(grid.tangents.begin(), grid.tangents.end());
  if (scene.cables.empty()) tangents = {std::nullopt};
  std::vector<TradeSetting> settings;
  for (const SolverKind solver : grid.solvers) {
    // The direct solver stops when the constraints are met. Its iterations are only a limit, so
    // they are not varied.
    const std::vector<int> own{scene.model.step.iterations};
    const bool direct = solver == SolverKind::direct;
    for (const IntegratorKind integrator : grid.integrators) {
      for (const auto& update : tangents) {
        for (const int iterations : direct ? own : grid.iterations) {
          for (const int substeps : grid.substeps) {
            settings.push_back(
                {{scene.model.step.dt, substeps, iterations, solver, integrator}, update});
          }
        }
      }
    }
  }
  add_tolerances(grid, scene, tangents, settings);
  return settings;
}

bool TradeTable::tensions_known() const {
  constexpr double useful = 0.1;
  const bool compared = std::any_of(rows.begin(), rows.end(), [](const TradeRow& row) {
    return row.measured() && !std::isnan(row.error.tension);
  });
  return !compared || doubt.tension <= useful;
}

double TradeTable::position_bound(const TradeRow& row) const {
  // Errors below rounding count as equal.
  return std::max(row.error.position + doubt.position, rounding_error);
}

double TradeTable::tension_bound(const TradeRow& row) const {
  if (std::isnan(row.error.tension)) return 0.0;
  return std::max(row.error.tension + doubt.tension, rounding_error);
}

double TradeTable::bound(const TradeRow& row) const {
  const double position = position_bound(row);
  return tensions_known() ? std::max(position, tension_bound(row)) : position;
}

std::vector<measure::WorkPoint> TradeTable::points() const {
  std::vector<measure::WorkPoint> points;
  for (const TradeRow& row : rows) {
    if (row.measured()) {
      points.push_back({row.seconds.median, bound(row)});
    } else {
      points.emplace_back();
    }
  }
  return points;
}

void judge(TradeTable& table) {
  for (TradeRow& row : table.rows) row.on_front = false;
  for (const std::size_t i : measure::pareto_front(table.points())) table.rows[i].on_front = true;
  int most_iterations = 0;
  for (const TradeRow& row : table.rows) {
    if (row.setting.step.solver != SolverKind::gauss_seidel) continue;
    most_iterations = std::max(most_iterations, row.setting.step.iterations);
  }
  // The order of convergence is fitted to rows whose error is due to the step alone: the most
  // iterations, and the most accurate measured tangents.
  std::map<std::string, std::vector<measure::StepError>> families;
  std::vector<std::string> order;
  for (const TradeRow& row : table.rows) {
    const StepSettings& step = row.setting.step;
    const bool direct = step.solver == SolverKind::direct;
    if (step.tolerance > 0.0) continue;
    if (!direct && step.iterations != most_iterations) continue;
    if (row.setting.tangents != table.rows.front().setting.tangents) continue;
    std::string name(solver_names[static_cast<std::size_t>(step.solver)]);
    if (!direct) name += fmt::format(" ({} iterations)", most_iterations);
    name += fmt::format(", {}", integrator_names[static_cast<std::size_t>(step.integrator)]);
    if (!families.contains(name)) order.push_back(name);
    auto& errors = families[name];
    if (row.measured()) {
      errors.push_back({step.dt / step.substeps, row.error.position, table.doubt.position});
    }
  }
  table.families.clear();
  for (const std::string& name : order) {
    table.families.push_back({name, measure::fitted_order(families[name])});
  }
}

double budget_seconds(const std::string& text) {
  constexpr std::array<std::pair<std::string_view, double>, 3> units{
      {{"us/frame", 1e-6}, {"ms/frame", 1e-3}, {"s/frame", 1.0}}};
  std::string_view rest = text;
  if (const auto value = leading_number(rest)) {
    for (const auto& [unit, seconds] : units) {
      if (rest == unit) return *value * seconds;
    }
  }
  throw Failure(ExitCode::usage, "--budget " + text +
                                     ": must be a positive number with us/frame, ms/frame or "
                                     "s/frame, for example 2ms/frame");
}

double error_share(const std::string& text, const std::string& option) {
  std::string_view rest = text;
  if (const auto value = leading_number(rest)) {
    if (rest.empty()) return *value;
    if (rest == "%") return 0.01 * *value;
  }
  throw Failure(ExitCode::usage, option + " " + text +
                                     ": must be a positive share of the scene's size, or of the "
                                     "tensions, for example 0.1% or 1e-3");
}

std::string errors_text(const TradeTable& table, const TradeRow& row) {
  const std::string position =
      "position error " + error_text(row.error.position, table.doubt.position);
  if (std::isnan(row.error.tension)) return position;
  return position + ", tension error " + error_text(row.error.tension, table.doubt.tension);
}

std::optional<std::size_t> answer(const TradeTable& table, const TradeQuestion& question) {
  if (!question.asks_for_errors()) {
    return measure::best_within(table.points(), *question.seconds_per_frame / table.dt);
  }
  // The errors as shares of their allowed values.
  std::vector<measure::WorkPoint> points;
  for (const TradeRow& row : table.rows) {
    measure::WorkPoint& point = points.emplace_back();
    if (!row.measured()) continue;
    const double position = question.error ? table.position_bound(row) / *question.error : 0.0;
    const bool both = question.error && table.tensions_known();
    const double tension = question.tension_error
                               ? table.tension_bound(row) / *question.tension_error
                           : both ? table.tension_bound(row) / *question.error
                                  : 0.0;
    point = {row.seconds.median, std::max(position, tension)};
  }
  return measure::cheapest_within(points, 1.0);
}

}  // namespace sheave::command
