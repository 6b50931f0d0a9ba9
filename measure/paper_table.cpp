#include "measure/paper_table.h"

#include <array>

#include <fmt/format.h>

namespace sheave::measure {
namespace {

constexpr std::array<PaperRow, 11> rows{{
    {"Simple", "simple.json", 4, 1, 1, 0.012, "Table 1"},
    {"Simple", "simple.json", 4, 1, 10, 0.036, "text"},
    {"Servin", "servin.json", 16, 1, 10, 0.25, "Table 1"},
    {"Pulley", "pulley.json", 6, 1, 15, 0.3, "Table 1"},
    {"Hand", "hand.json", 28, 1, 20, 1.7, "Table 1"},
    {"Gym", "gym.json", 16, 1, 20, 2.5, "Table 1"},
    {"Hilbert2", "hilbert2-stretched.json", 62, 1, 10, 1.8, "Table 1"},
    {"Hilbert3", "hilbert3.json", 498, 1, 10, 60.0, "Table 1"},
    {"Hilbert3", "hilbert3.json", 498, 1, 100, 60.0, "text"},
    {"Bow", "bow.json", 0, 10, 10, 25.0, "text"},
    {"Naive rope", "naive-rope.json", 100, 1, 100, std::nullopt, "text", "naive-rope-cable.json"},
}};

}  // namespace

std::span<const PaperRow> paper_table() { return rows; }

StepSettings paper_settings(const PaperRow& row) {
  return {paper_frame, row.substeps, row.iterations, SolverKind::gauss_seidel,
          IntegratorKind::xpbd};
}

StepSettings direct_settings(const PaperRow& row, IntegratorKind integrator) {
  StepSettings step = StepSettings::paper();
  step.dt = paper_frame;
  step.substeps = row.substeps;
  step.solver = SolverKind::direct;
  step.integrator = integrator;
  return step;
}

int joint_count(const Scene& scene, const Trajectory& run) {
  return run.most_spans > 0 ? run.most_spans : static_cast<int>(scene.model.joints.size());
}

std::string settings_text(const StepSettings& step) {
  const bool direct = step.solver == SolverKind::direct;
  std::string text(solver_names[static_cast<std::size_t>(step.solver)]);
  if (step.tolerance > 0.0) {
    text += fmt::format(" within {:g} m", step.tolerance);
  } else {
    text += direct ? fmt::format(" {}", step.substeps)
                   : fmt::format(" {} x {}", step.substeps, step.iterations);
  }
  if (step.integrator != IntegratorKind::xpbd) {
    text += fmt::format(", {}", integrator_names[static_cast<std::size_t>(step.integrator)]);
  }
  return text;
}

}  // namespace sheave::measure
