#pragma once
// Bodies and cables together: what most programs embed.
//
//   sheave::Model model;  std::vector<sheave::CableDef> cables;
//   auto simulation = sheave::Simulation::create(model, cables);
//   simulation->world.step();
//   double tension = simulation->cable_reports()[0].spans[2].tension;

#include <memory>
#include <optional>
#include <vector>

#include "cable/cable_system.h"
#include "cable/certificate.h"
#include "engine/world.h"

namespace sheave {

/// A world and, if it has any, its cables.
struct Simulation {
  World world;
  /// Owned by the world; null if there are no cables.
  const CableSystem* cables = nullptr;
  /// What the cables were made of.
  std::shared_ptr<const std::vector<CableDef>> cable_definitions;

  /// All faults of bodies, joints and cables are reported together.
  static Result<Simulation> create(const Model& model, const std::vector<CableDef>& cables);
  /// The faults that create() would report, with less work and memory where there are no cables.
  static Errors check(const Model& model, const std::vector<CableDef>& cables);
  /// One report per cable, for the world's current state.
  [[nodiscard]] std::vector<CableReport> cable_reports() const;
  /// Measures of each cable, for the world's current state; in the course of a run much cheaper than reports.
  void gauge_cables(std::vector<CableGauge>& gauges) const;
  /// What a check of the last substep finds (cable/certificate.h). Nothing at time 0 and after World::restore(), until the
  /// next step.
  [[nodiscard]] std::optional<Certificate> certificate() const;
};

}  // namespace sheave
