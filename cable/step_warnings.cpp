#include "cable/step_warnings.h"

#include <cstdint>

#include "cable/cable_system.h"
#include "engine/body_set.h"
#include "engine/number_text.h"

namespace sheave {
namespace {

/// "1 substep", "3 substeps".
std::string substeps_text(std::int64_t count) {
  return std::to_string(count) + (count == 1 ? " substep" : " substeps");
}

constexpr int digits = 3;

/// Warnings of requests that no solver could have met.
void append_impossible(const StepStatistics& statistics, std::vector<Warning>& warnings) {
  const std::string most = number_text(statistics.most_impossible, digits) + " m or rad";
  if (statistics.impossible > 0) {
    warnings.push_back(
        {"impossible", "",
         "in " + substeps_text(statistics.impossible) +
             " bodies that move as they are told asked for what cannot be, by up to " + most +
             ": a rigid cable or a joint between them has nothing else that it could move; let one "
             "of them yield, or give the cable an axial_stiffness"});
  }
  if (statistics.dead_ends > 0) {
    warnings.push_back(
        {"dead_end", "",
         "in " + substeps_text(statistics.dead_ends) +
             " no motion met all that cables, joints and drives ask for: as where a winch draws a "
             "load beyond what it can reach, or a drive passes its dead centre; bodies were left "
             "where the least is off, up to " +
             most});
  }
}

std::string link_name(const CableSystem::LinkWarning& warning, const BodySet& bodies) {
  const std::string body =
      warning.body < bodies.count() ? "\"" + bodies.name(warning.body) + "\"" : "the world";
  if (warning.link < 0) return "the wrap on " + body;
  return "link " + std::to_string(warning.link) + " on " + body;
}

}  // namespace

void append_solver_warnings(const StepStatistics& statistics, std::vector<Warning>& warnings) {
  // A substep at a singular configuration counts as a dead end only.
  const std::int64_t fallbacks = statistics.integrator_fallbacks - statistics.dead_ends;
  const std::int64_t unconverged = statistics.unconverged - statistics.dead_ends;
  if (statistics.solver_fallbacks > 0) {
    warnings.push_back({"solver_fallback", "",
                        "the direct solver did not find which rows act in " +
                            substeps_text(statistics.solver_fallbacks) + " and left " +
                            (statistics.solver_fallbacks == 1 ? "it" : "them") +
                            " to Gauss-Seidel sweeps, so that precision is theirs there"});
  }
  if (fallbacks > 0) {
    warnings.push_back({"integrator_fallback", "",
                        "things moved too far for rattle in " + substeps_text(fallbacks) +
                            ", or in the smallest part of one, which left " +
                            (fallbacks == 1 ? "it" : "them") +
                            " to xpbd and its damping; more substeps avoid that"});
  }
  if (statistics.cut_substeps > 0) {
    warnings.push_back({"cut_substeps", "",
                        substeps_text(statistics.cut_substeps) +
                            " did not converge as a whole, or made energy, and " +
                            (statistics.cut_substeps == 1 ? "was" : "were") + " done in " +
                            std::to_string(statistics.substep_parts) +
                            " parts: things move far there, and each part may be off by a "
                            "hundredth of their energy; more substeps avoid that"});
  }
  if (statistics.exhausted > 0) {
    warnings.push_back({"exhausted", "",
                        substeps_text(statistics.exhausted) +
                            " took all the rounds or factorisations that a substep may and " +
                            (statistics.exhausted == 1 ? "was" : "were") +
                            " done as a whole: what moves there is hard to solve; more substeps "
                            "may avoid that"});
  }
  append_impossible(statistics, warnings);
  if (unconverged > 0) {
    warnings.push_back({"unconverged", "",
                        substeps_text(unconverged) +
                            " did not converge, in however small parts: constraints that "
                            "contradict each other? What they left off has become velocity"});
  }
}

void append_cable_warnings(const CableSystem& cables, const BodySet& bodies, double since,
                           std::vector<Warning>& warnings) {
  const auto when = [](const auto& warning) {
    return " in " + substeps_text(warning.substeps) + ", first at " +
           number_text(warning.first_time) + " s";
  };
  for (const CableSystem::TangentWarning& warning : cables.tangent_warnings()) {
    if (!(warning.first_time > since)) continue;
    std::string span =
        warning.cable + (warning.span < 0 ? " behind a wrap" : "." + std::to_string(warning.span));
    std::string message = "span " + span + " had no tangent" + when(warning) +
                          ": its wheels overlap, or it leans so far out of a wheel's plane that "
                          "no groove would hold it; its numbers mean little there";
    warnings.push_back({"no_tangent", std::move(span), std::move(message)});
  }
  for (const CableSystem::WrapWarning& warning : cables.wrap_warnings()) {
    if (!(warning.first_time > since)) continue;
    warnings.push_back({"too_many_wraps", warning.cable,
                        "cable " + warning.cable + " found no place for another wrap" +
                            when(warning) + ", and went through the body; raise its most_wraps"});
  }
  for (const CableSystem::LeanWarning& warning : cables.lean_warnings()) {
    if (!(warning.first_time > since)) continue;
    warnings.push_back({"wrap_off_plane", warning.cable,
                        "cable " + warning.cable + " lies on " + bodies.name(warning.body) +
                            " in the plane in which it came onto it, and its spans left that plane "
                            "by up to " +
                            number_text(warning.angle * 180.0 / pi, digits) + " degrees" +
                            when(warning) +
                            ": it lies as in a groove there, where on a smooth body it would slide "
                            "sideways to a shorter way"});
  }
  for (const CableSystem::LinkWarning& warning : cables.stall_warnings()) {
    if (!(warning.first_time > since)) continue;
    warnings.push_back({"stalled", warning.cable,
                        "cable " + warning.cable + ": " + link_name(warning, bodies) + " stalled" +
                            when(warning) +
                            ": its drive draws more cable than there is, or than another drive "
                            "feeds"});
  }
  for (const CableSystem::LinkWarning& warning : cables.slide_warnings()) {
    if (!(warning.first_time > since)) continue;
    warnings.push_back({"slid", warning.cable,
                        "cable " + warning.cable + " slid over " + link_name(warning, bodies) +
                            when(warning) +
                            ", although it cannot slip there: the span next to it was used up"});
  }
}

}  // namespace sheave
