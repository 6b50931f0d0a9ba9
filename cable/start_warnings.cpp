#include "cable/start_warnings.h"

#include <algorithm>
#include <cmath>

#include "cable/cable_system.h"
#include "cable/tension_law.h"
#include "engine/number_text.h"

namespace sheave {
namespace {

/// Steel ropes part at a strain of 2 %, ropes of polyester or nylon at 10 % to 30 %.
constexpr double strained = 0.1;
constexpr int strain_digits = 3;
constexpr int length_digits = 6;

/// A span of an elastic cable by the law of its cable, without dampers.
struct StartStrain {
  std::size_t span = 0;
  double strain = 0.0;
  double tension = 0.0;  ///< [N]
};

StartStrain largest_strain(const CableDef& cable, const CableReport& report) {
  StartStrain most;
  for (std::size_t k = 0; k < report.spans.size(); ++k) {
    const SpanReport& span = report.spans[k];
    if (span.hangs && cable.axial_stiffness) {
      // The rope is stretched most where its tension is largest.
      const double tension = span.largest_tension();
      const double strain = tension / *cable.axial_stiffness;
      if (strain > most.strain) most = {k, strain, tension};
      continue;
    }
    const double stretch = span.length - span.rest_length;
    if (!(stretch > 0.0) || !(span.rest_length > 0.0)) continue;
    const double strain = stretch / span.rest_length;
    if (!(strain > most.strain)) continue;
    most = {k, strain, spring_tension(cable, span.length, span.rest_length).value_or(0.0)};
  }
  return most;
}

std::string strain_message(const CableDef& cable, const SpanReport& span, const StartStrain& most) {
  const auto text = [](double value) { return number_text(value, strain_digits); };
  const std::string start = "cable \"" + cable.name + "\" starts stretched by " +
                            text(100.0 * most.strain) + " % in span " + std::to_string(most.span) +
                            ": " + text(span.length) + " m long with a rest length of " +
                            text(span.rest_length) + " m, so with " + text(most.tension) + " N";
  if (most.tension > cable.breaking_tension.value_or(most.tension)) {
    return start + ", and parts at once: its breaking tension is " + text(*cable.breaking_tension) +
           " N; give longer rest_lengths, or none for a cable that is just taut";
  }
  return start +
         "; ropes part at 2 % (steel) to 30 % (nylon), so give longer rest_lengths, or none for a "
         "cable that is just taut";
}

/// Tells of rest lengths that the cable does not keep, because it passes a link freely.
void append_uneven_warning(const CableDef& cable, const CableReport& report,
                           std::vector<Warning>& warnings) {
  constexpr double rounding = 1e-6;
  std::size_t most = 0;
  double change = 0.0;
  for (std::size_t k = 0; k < report.spans.size() && k < cable.rest_lengths.size(); ++k) {
    const double own = std::abs(report.spans[k].rest_length - cable.rest_lengths[k]);
    if (!(own > std::max(change, rounding * cable.rest_lengths[k]))) continue;
    most = k;
    change = own;
  }
  if (!(change > 0.0)) return;
  const auto text = [](double value) { return number_text(value, length_digits); };
  warnings.push_back(
      {"uneven_start", cable.name + "." + std::to_string(most),
       "the rest_lengths of cable \"" + cable.name +
           "\" give its spans different tensions, and the cable passes freely between them: the "
           "start has one tension and the same length of rope, so span " +
           std::to_string(most) + " has a rest length of " + text(report.spans[most].rest_length) +
           " m in place of " + text(cable.rest_lengths[most]) +
           " m; give rest lengths in proportion to the lengths, or a pretension"});
}

}  // namespace

void append_winding_warnings(const CableSystem& cables, std::vector<Warning>& warnings) {
  for (const cable_parts::WindingWarning& warning : cables.winding_warnings()) {
    const auto better = winding_names[static_cast<std::size_t>(warning.better)];
    warnings.push_back({"crossed_winding", warning.cable,
                        "cable \"" + warning.cable + "\" crosses itself beside link " +
                            std::to_string(warning.link) + " on \"" + warning.body +
                            "\", which looks like the wrong winding; try \"winding\": \"" +
                            std::string(better) +
                            "\" there, or \"turns\": 1 if a whole turn is meant"});
  }
}

void append_uneven_warnings(const Simulation& start, std::vector<Warning>& warnings) {
  const std::vector<CableDef>& cables = *start.cable_definitions;
  std::vector<CableReport> reports;
  for (std::size_t i = 0; i < cables.size(); ++i) {
    if (!cables[i].is_elastic() || cables[i].rest_lengths.empty()) continue;
    if (reports.empty()) reports = start.cable_reports();
    append_uneven_warning(cables[i], reports[i], warnings);
  }
}

void append_strain_warnings(const Simulation& start, std::vector<Warning>& warnings) {
  const std::vector<CableDef>& cables = *start.cable_definitions;
  std::vector<CableReport> reports;
  for (std::size_t i = 0; i < cables.size(); ++i) {
    const CableDef& cable = cables[i];
    if (!cable.is_elastic() || cable.rest_lengths.empty()) continue;
    if (reports.empty()) reports = start.cable_reports();
    const StartStrain most = largest_strain(cable, reports[i]);
    if (most.strain <= strained && most.tension <= cable.breaking_tension.value_or(most.tension)) {
      continue;
    }
    warnings.push_back({"strained_start", cable.name + "." + std::to_string(most.span),
                        strain_message(cable, reports[i].spans[most.span], most)});
  }
}

}  // namespace sheave
