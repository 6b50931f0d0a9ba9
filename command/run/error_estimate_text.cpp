#include "command/run/error_estimate_text.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "command/run/decision_text.h"
#include "command/text/table.h"

namespace sheave::command {
namespace {

using measure::ErrorEstimate;
using measure::StepDifference;
using measure::StepErrorKind;

constexpr std::size_t max_quantities = 12;
/// If bodies move by less than this part of the scene's size, errors are also given relative to the
/// motion.
constexpr double small_motion = 0.1;

std::string share_text(double share) { return fmt::format("{:.2g} %", 100.0 * share); }

double relative_error(const StepDifference& difference) {
  const double error = difference.error();
  return error == 0.0 ? 0.0 : error / difference.scale;
}

struct Quantity {
  std::string name;
  const char* unit;
  const StepDifference* difference;
};

std::vector<Quantity> worst_first(const ErrorEstimate& estimate) {
  std::vector<Quantity> all;
  for (const measure::BodyDifference& body : estimate.bodies) {
    all.push_back({body.name + " position", "m", &body.position});
    all.push_back({body.name + " turn", "rad", &body.turn});
  }
  for (const measure::SpanDifference& span : estimate.spans) {
    all.push_back({span.name + " tension", "N", &span.tension});
  }
  std::erase_if(all, [](const Quantity& own) {
    const StepDifference& difference = *own.difference;
    return difference.negligible() &&
           difference.unseen <= measure::negligible_difference * difference.scale;
  });
  std::stable_sort(all.begin(), all.end(), [](const Quantity& a, const Quantity& b) {
    return relative_error(*a.difference) > relative_error(*b.difference);
  });
  return all;
}

std::string estimate_table(const ErrorEstimate& estimate) {
  const std::vector<Quantity> all = worst_first(estimate);
  if (all.empty()) return "";
  TextTable lines({"quantity", "differs by", "at [s]", "relative", "order", "error", "relative"},
                  1);
  for (std::size_t i = 0; i < std::min(all.size(), max_quantities); ++i) {
    const StepDifference& difference = *all[i].difference;
    lines.add({all[i].name, fmt::format("{:.3g} {}", difference.largest, all[i].unit),
               short_number(difference.time), share_text(difference.relative()),
               difference.order ? fmt::format("{:.2f}", *difference.order) : "-",
               fmt::format("{:.3g} {}", difference.error(), all[i].unit),
               share_text(relative_error(difference))});
  }
  if (all.size() <= max_quantities) return lines.text();
  return lines.text() + fmt::format("  ... and {} more quantities; --json lists all\n",
                                    all.size() - max_quantities);
}

/// The reason why no order of convergence is known.
std::string missing_order_reason(const ErrorEstimate& estimate, StepErrorKind kind) {
  switch (kind) {
    case StepErrorKind::rounding:
    case StepErrorKind::regular:
      break;
    case StepErrorKind::events:
      return fmt::format(
          "{} events (links left or touched, spans that go slack or taut, contacts, stops by "
          "friction, breaks, impacts) come at moments that depend on the step",
          std::max(estimate.changes.count(), estimate.changes.sudden));
    case StepErrorKind::chaos:
      return fmt::format("the motion is chaotic, differences grow as e^({:.2g} t)",
                         estimate.growth.value_or(0.0));
    case StepErrorKind::sweeps:
      return "Gauss-Seidel sweeps have not converged, and half the step has twice as many of them; "
             "--solver direct has no sweeps";
    case StepErrorKind::coarse:
      return "the step is too long to show an order; more substeps may show one";
  }
  return "";
}

/// "positions are off by ...", without a reason if the order is unknown.
std::string estimate_clause(const char* what, const StepDifference& difference, StepErrorKind kind,
                            const std::string& of) {
  if (kind == StepErrorKind::rounding) {
    return fmt::format("{} depend on the step by only {} of {}", what,
                       share_text(difference.relative()), of);
  }
  if (kind != StepErrorKind::regular) {
    return fmt::format(
        "{} are off by up to about {} of {} (they change by {} at t = {} s), without an order",
        what, share_text(relative_error(difference)), of, share_text(difference.relative()),
        short_number(difference.time));
  }
  const double error = relative_error(difference);
  return fmt::format(
      "{} are off by about {} of {} at t = {} s, of order {:.2f}: half the step leaves {}", what,
      share_text(error), of, short_number(difference.time), *difference.order,
      share_text(error / std::exp2(*difference.order)));
}

/// The events that a run places at the end of the substep in which they happen.
std::string sudden_text(const ErrorEstimate& estimate) {
  const std::size_t count = estimate.changes.sudden;
  return fmt::format(
      "{} (impacts, ropes that go taut, friction that lets go, breaks) within a substep, and {} at "
      "its end: later motion is delayed by up to one substep",
      count == 1 ? "1 sudden event lies" : fmt::format("{} sudden events lie", count),
      count == 1 ? "it acts" : "they act");
}

/// The length to which errors of positions are relative.
std::string size_text(const ErrorEstimate& estimate) {
  const double size = estimate.position.scale;
  const double error = estimate.position.error();
  if (estimate.motion >= small_motion * size || estimate.position.largest == 0.0) {
    return "the scene's size";
  }
  if (estimate.motion < 2.0 * error) return "the scene's size (as far as anything moves)";
  return fmt::format("the scene's size ({} of the motion)", share_text(error / estimate.motion));
}

bool has_known_order(StepErrorKind kind) {
  return kind == StepErrorKind::regular || kind == StepErrorKind::rounding;
}

/// The settings of the three runs.
std::string compared_settings(const ErrorEstimate& estimate) {
  if (estimate.tolerance > 0.0) {
    return fmt::format("tolerance {} m against {} m and {} m", short_number(estimate.tolerance),
                       short_number(estimate.tolerance / 4.0),
                       short_number(estimate.tolerance / 16.0));
  }
  return fmt::format("{} {} against {} and {}", estimate.substeps[0],
                     estimate.substeps[0] == 1 ? "substep" : "substeps", estimate.substeps[1],
                     estimate.substeps[2]);
}

}  // namespace

std::string error_estimate_conclusion(const ErrorEstimate& estimate) {
  std::vector<std::string> clauses;
  std::vector<StepErrorKind> unknown;
  const auto add = [&](const char* what, const StepDifference& difference, StepErrorKind kind,
                       const std::string& of) {
    clauses.push_back(estimate_clause(what, difference, kind, of));
    if (!has_known_order(kind)) unknown.push_back(kind);
  };
  if (!estimate.bodies.empty()) {
    add("positions", estimate.position, estimate.position_kind, size_text(estimate));
  }
  if (!estimate.spans.empty()) {
    add("tensions", estimate.tension, estimate.tension_kind, "their mean size");
  }
  if (clauses.empty()) return "nothing in the scene depends on the step";
  if (!unknown.empty()) {
    std::string why = missing_order_reason(estimate, unknown.front());
    if (unknown.back() != unknown.front()) {
      why += ", and " + missing_order_reason(estimate, unknown.back());
    }
    clauses.push_back("where there is no order the error may be larger: " + why);
  }
  if (!estimate.bodies.empty() && !has_known_order(estimate.position_kind)) {
    clauses.push_back(fmt::format("positions change by less than 0.1 % until t = {} s",
                                  short_number(estimate.trusted_time)));
  }
  if (estimate.changes.sudden > 0) clauses.push_back(sudden_text(estimate));
  std::string text = "by the step alone ";
  for (std::size_t i = 0; i < clauses.size(); ++i) text += (i == 0 ? "" : "; ") + clauses[i];
  return text;
}

std::string error_estimate_text(const ErrorEstimate& estimate) {
  std::string text =
      fmt::format("{}, to t = {} s:\n", compared_settings(estimate), short_number(estimate.end));
  text += estimate_table(estimate);
  if (estimate.divergence) {
    text += "  a run with a shorter substep diverged, which ended the comparison: " +
            estimate.divergence->message + "\n";
  }
  text += decision_text(estimate);
  return text + error_estimate_conclusion(estimate) + "\n";
}

}  // namespace sheave::command
