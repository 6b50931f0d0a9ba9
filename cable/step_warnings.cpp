#include "cable/step_warnings.h"

#include <cstdint>

#include "cable/cable_system.h"
#include "cable/drum_grooves.h"
#include "cable/sheaths.h"
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
             " bodies with a prescribed motion required a motion that is impossible, by up to " +
             most +
             ": a rigid cable or a joint between them moves no other body; make one of them "
             "elastic, or give the cable an axial_stiffness"});
  }
  if (statistics.dead_ends > 0) {
    warnings.push_back({"dead_end", "",
                        "in " + substeps_text(statistics.dead_ends) +
                            " no motion met all cables, joints and drives: as where a winch draws "
                            "a load beyond its reach, or a drive passes its dead centre; bodies "
                            "were left at the least residual, up to " +
                            most});
  }
}

std::string link_name(const cable_parts::LinkWarning& warning, const BodySet& bodies) {
  const std::string body =
      warning.body < bodies.count() ? "\"" + bodies.name(warning.body) + "\"" : "the world";
  if (warning.link < 0) return "the wrap on " + body;
  return "link " + std::to_string(warning.link) + " on " + body;
}

/// " in 3 substeps, first at 0.5 s".
template <class Observed>
std::string when_seen(const Observed& warning) {
  return " in " + substeps_text(warning.substeps) + ", first at " +
         number_text(warning.first_time) + " s";
}

/// Warnings of wraps that are not where a rope would lie.
void append_wrap_warnings(const CableSystem& cables, const BodySet& bodies, double since,
                          std::vector<Warning>& warnings) {
  for (const cable_parts::LeanWarning& warning : cables.lean_warnings()) {
    if (!(warning.first_time > since)) continue;
    if (wrap_candidate(bodies, warning.body).surface) {
      warnings.push_back(
          {"wrap_off_plane", warning.cable,
           "cable " + warning.cable + " slid sideways over " + bodies.name(warning.body) +
               ", at up to " + number_text(warning.angle * 180.0 / pi, digits) +
               " degrees to its own direction" + when_seen(warning) +
               ": friction acts along the cable only; a real cable would be held sideways, too"});
      continue;
    }
    warnings.push_back(
        {"wrap_off_plane", warning.cable,
         "cable " + warning.cable + " lies on " + bodies.name(warning.body) +
             " in the plane of their first contact, and its spans left that plane by up to " +
             number_text(warning.angle * 180.0 / pi, digits) + " degrees" + when_seen(warning) +
             ": the model holds it as in a groove; without one it would slide sideways to a "
             "shorter "
             "path"});
  }
  for (const cable_parts::MisplacedWarning& warning : cables.misplaced_warnings()) {
    if (!(warning.first_time > since)) continue;
    if (warning.hollow) {
      warnings.push_back({"wrap_lifts_off", warning.cable,
                          "cable " + warning.cable + " lay along a hollow part of " +
                              bodies.name(warning.body) + ", in a wrap of " +
                              number_text(warning.beyond, digits) + " m" + when_seen(warning) +
                              ": the model keeps it on the surface; a taut cable lifts off there, "
                              "and the wrap holds no friction"});
      continue;
    }
    warnings.push_back({"wrap_off_end", warning.cable,
                        "cable " + warning.cable + " passed the end of " +
                            bodies.name(warning.body) + " by up to " +
                            number_text(warning.beyond, digits) + " m" + when_seen(warning) +
                            ": the model has no rim there; a wrap lies as on a longer cylinder "
                            "until its middle is past the end, a free span goes through the "
                            "flat end, and an opening has no ends"});
  }
}

/// Warnings of drums whose rope leaves at too large an angle.
void append_fleet_warnings(const CableSystem& cables, const BodySet& bodies, double since,
                           std::vector<Warning>& warnings) {
  const auto degrees = [](double angle) { return number_text(angle * 180.0 / pi, digits); };
  for (const cable_parts::FleetWarning& warning : DrumGrooves::fleet_warnings(cables)) {
    if (!(warning.drum.first_time > since)) continue;
    warnings.push_back(
        {"fleet_angle", warning.drum.cable,
         "cable " + warning.drum.cable + " left " + link_name(warning.drum, bodies) +
             " at a fleet angle of up to " + degrees(warning.angle) +
             " degrees, more than its most_fleet_angle of " + degrees(warning.limit) + " degrees" +
             when_seen(warning.drum) +
             ": put the next link farther from the drum, or use fewer turns_per_layer"});
  }
}

/// Warnings of sheaths that are too short for the motion of their bodies.
void append_sheath_warnings(const CableSystem& cables, const BodySet& bodies, double since,
                            std::vector<Warning>& warnings) {
  for (const cable_parts::SheathWarning& warning : Sheaths::warnings(cables)) {
    if (!(warning.sheath.first_time > since)) continue;
    warnings.push_back({"sheath_too_short", warning.sheath.cable,
                        "cable " + warning.sheath.cable + ": the ends of the sheath at " +
                            link_name(warning.sheath, bodies) + " were up to " +
                            number_text(warning.apart, digits) + " m apart, and it is " +
                            number_text(warning.length, digits) + " m long" +
                            when_seen(warning.sheath) +
                            ": a real sheath would hold the bodies or tear; give it more length"});
  }
}

}  // namespace

void append_solver_warnings(const StepStatistics& statistics, std::vector<Warning>& warnings) {
  // A substep at a singular configuration counts as a dead end only.
  const std::int64_t fallbacks = statistics.integrator_fallbacks - statistics.dead_ends;
  const std::int64_t unconverged = statistics.unconverged - statistics.dead_ends;
  if (statistics.solver_fallbacks > 0) {
    warnings.push_back({"solver_fallback", "",
                        "the direct solver did not find the active set in " +
                            substeps_text(statistics.solver_fallbacks) + " and left " +
                            (statistics.solver_fallbacks == 1 ? "it" : "them") +
                            " to Gauss-Seidel sweeps, which limit the precision there"});
  }
  if (fallbacks > 0) {
    warnings.push_back({"integrator_fallback", "",
                        "bodies moved too far for rattle in " + substeps_text(fallbacks) +
                            ", or in the smallest part of one, which left " +
                            (fallbacks == 1 ? "it" : "them") +
                            " to xpbd and its damping; more substeps avoid that"});
  }
  if (statistics.cut_substeps > 0) {
    warnings.push_back({"cut_substeps", "",
                        substeps_text(statistics.cut_substeps) +
                            " did not converge as a whole, or created energy, and " +
                            (statistics.cut_substeps == 1 ? "was" : "were") + " done in " +
                            std::to_string(statistics.substep_parts) +
                            " parts: bodies move far there, and each part may be off by 1 % of "
                            "their energy; more substeps avoid that"});
  }
  if (statistics.exhausted > 0) {
    warnings.push_back(
        {"exhausted", "",
         substeps_text(statistics.exhausted) +
             " took all the rounds or factorisations that a substep may and " +
             (statistics.exhausted == 1 ? "was" : "were") +
             " done as a whole: the motion there is hard to solve; more substeps may avoid that"});
  }
  if (statistics.unknown_forces > 0) {
    warnings.push_back(
        {"unknown_forces", "",
         "at the end of " + substeps_text(statistics.unknown_forces) +
             " no short motion met all constraints, so the forces of that instant are unknown: "
             "mean forces of the substep decided whether rigid ropes or joints break, up to half a "
             "substep late, or 3 substeps with xpbd; more substeps or elastic ropes avoid that"});
  }
  append_impossible(statistics, warnings);
  if (unconverged > 0) {
    warnings.push_back(
        {"unconverged", "",
         substeps_text(unconverged) +
             " did not converge, not even in small parts, perhaps because constraints contradict "
             "each other; their residual has become velocity"});
  }
}

void append_cable_warnings(const CableSystem& cables, const BodySet& bodies, double since,
                           std::vector<Warning>& warnings) {
  for (const cable_parts::TangentWarning& warning : cables.tangent_warnings()) {
    if (!(warning.first_time > since)) continue;
    std::string span =
        warning.cable + (warning.span < 0 ? " behind a wrap" : "." + std::to_string(warning.span));
    std::string message = "span " + span + " had no tangent" + when_seen(warning) +
                          ": its wheels overlap, it leans so far out of a wheel's plane that no "
                          "groove would hold it, or it slid off a smooth body; its tension and "
                          "length are not reliable there";
    warnings.push_back({"no_tangent", std::move(span), std::move(message)});
  }
  for (const cable_parts::WrapWarning& warning : cables.wrap_warnings()) {
    if (!(warning.first_time > since)) continue;
    warnings.push_back({"too_many_wraps", warning.cable,
                        "cable " + warning.cable + " found no place for another wrap" +
                            when_seen(warning) +
                            ", and went through the body; raise its most_wraps"});
  }
  append_wrap_warnings(cables, bodies, since, warnings);
  append_fleet_warnings(cables, bodies, since, warnings);
  append_sheath_warnings(cables, bodies, since, warnings);
  for (const cable_parts::LinkWarning& warning : cables.beside_warnings()) {
    if (!(warning.first_time > since)) continue;
    warnings.push_back({"beside_groove", warning.cable,
                        "cable " + warning.cable + " came to " + link_name(warning, bodies) +
                            " beside its groove" + when_seen(warning) +
                            ", which would bend it by more than 6 degrees out of the plane of the "
                            "wheel, and is too taut for that way: it passes the wheel; place the "
                            "links in the plane of the wheel, or use a \"surface\" link"});
  }
  for (const cable_parts::LinkWarning& warning : cables.stall_warnings()) {
    if (!(warning.first_time > since)) continue;
    warnings.push_back({"stalled", warning.cable,
                        "cable " + warning.cable + ": " + link_name(warning, bodies) + " stalled" +
                            when_seen(warning) +
                            ": its drive draws more cable than there is, or than another drive "
                            "feeds"});
  }
  for (const cable_parts::LinkWarning& warning : cables.slide_warnings()) {
    if (!(warning.first_time > since)) continue;
    warnings.push_back(
        {"slid", warning.cable,
         "cable " + warning.cable + " slid over " + link_name(warning, bodies) +
             when_seen(warning) +
             ", although that link allows no slip: the span next to it was used up"});
  }
}

}  // namespace sheave
