#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "cable/links/opening.h"
#include "cable/links/pinhole.h"
#include "cable/links/rolling.h"
#include "cable/links/sheath.h"
#include "cable/links/surface.h"
#include "cable/tension_law.h"
#include "command/explain/explain.h"
#include "command/text/table.h"
#include "engine/body_set.h"
#include "engine/index.h"
#include "statics/joint_space.h"

namespace sheave::command {
namespace {

/// Smallest part of a moment arm that is not rounding.
constexpr double least_arm = 1e-9;
/// Angles below this are those of a cable that only touches [rad].
constexpr double least_angle = 1e-9;

/// One cable with its settings and its state.
struct CableView {
  const Model& model;
  const Simulation& simulation;
  const CableDef& cable;
  const CableReport& report;

  [[nodiscard]] bool is_end(std::size_t link) const {
    return !cable.closed && (link == 0 || link + 1 == cable.links.size());
  }
  [[nodiscard]] std::string body(std::size_t link) const {
    return body_text(model, cable.links[link]->body);
  }
};

std::string degrees(double radians) { return short_number(radians * 180.0 / pi) + " degrees"; }

/// The law by which cable slides over a link, none without friction or with a massless wheel.
struct Sliding {
  bool slides = false;
  double friction = 0.0;
  Passage passes = Passage::both;
  double efficiency = 1.0;
};

Sliding sliding_of(const LinkDef& link) {
  if (const auto* hole = dynamic_cast<const PinholeLink*>(&link)) {
    return {true, hole->friction, hole->passes, 1.0};
  }
  if (link.type() == OpeningLink::type_name) return {true, 0.0, Passage::both, 1.0};
  if (const auto* sheath = dynamic_cast<const SheathLink*>(&link)) {
    return {true, sheath->friction, Passage::both, 1.0};
  }
  if (const auto* surface = dynamic_cast<const SurfaceLink*>(&link)) {
    return {true, surface->friction, Passage::both, 1.0};
  }
  if (const auto* rolling = dynamic_cast<const RollingLink*>(&link)) {
    return {rolling->friction.has_value(), rolling->friction.value_or(0.0), rolling->passes,
            rolling->efficiency.value_or(1.0)};
  }
  return {};
}

/// "over "wheel" on its left (180 degrees)".
std::string place_text(const CableView& view, std::size_t link) {
  const LinkReport& report = view.report.links[link];
  const std::string body = view.body(link);
  if (report.type == "pinhole") return "through a hole of " + body;
  if (report.type == "opening") return "through an opening of " + body;
  if (report.type == "sheath") {
    const std::string on =
        report.exit_body == report.body
            ? "of " + body
            : fmt::format("from {} to {}", body, body_text(view.model, report.exit_body));
    return fmt::format("through a sheath {}, {} m long and bent by {}", on,
                       short_number(report.stored_length + report.stored_stretch),
                       degrees(report.wrap_angle));
  }
  if (report.winding == 0) return "fixed to " + body;
  const char* side = report.winding > 0 ? "left" : "right";
  if (!report.touched) {
    return fmt::format("past {}, which lies on its {} and which it does not touch", body, side);
  }
  if (view.is_end(link)) {
    const std::string layer =
        report.groove ? fmt::format(" in layer {} of its groove", report.groove->layer) : "";
    return fmt::format("wound on {} with {} m{}", body, short_number(report.stored_length), layer);
  }
  return fmt::format("over {} on its {} by {}", body, side, degrees(report.wrap_angle));
}

std::string way_sentence(const CableView& view) {
  std::string text =
      fmt::format("Cable \"{}\" is {}:", view.cable.name, view.cable.closed ? "a ring" : "open");
  const std::size_t count = view.cable.links.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (i == most_explained && count > i + 1) {
      text += fmt::format(", then {} more links", count - i - 1);
      i = count - 1;
    }
    text += (i == 0 ? " " : ", ") + place_text(view, i);
  }
  return text + ".";
}

/// Whether spans hang as catenaries, which are longer than their chords and never slack.
bool hangs(const CableDef& cable) { return cable.linear_density > 0.0; }

std::string material_sentence(const CableView& view) {
  const CableDef& cable = view.cable;
  double free = 0.0;
  double stored = 0.0;
  double sheathed = 0.0;
  for (const SpanReport& span : view.report.spans)
    free += hangs(cable) ? span.rest_length : span.length;
  for (const LinkReport& link : view.report.links) {
    (link.type == "sheath" ? sheathed : stored) += link.stored_length;
  }
  std::string kind = "It is rigid";
  if (cable.axial_stiffness) {
    kind = fmt::format("Its axial stiffness is {} N", short_number(*cable.axial_stiffness));
  } else if (!cable.tension_table.empty()) {
    kind = fmt::format("Its tension follows a table of {} up to {} N at the strain {}",
                       counted(cable.tension_table.size(), "point", "points"),
                       short_number(cable.tension_table.back()),
                       short_number(cable.strain_table.back()));
    if (cable.unloading_stiffness) {
      kind += fmt::format("; it yields, and is let off with the stiffness {} N",
                          short_number(*cable.unloading_stiffness));
    } else if (!cable.unloading_table.empty()) {
      kind += "; it is let off on another curve";
    }
  } else if (cable.compliance.value_or(0.0) > 0.0) {
    kind = fmt::format("Each span yields by {} m/N", short_number(*cable.compliance));
  }
  std::string text =
      fmt::format("{}; {} m lie free in {}, and {} m on wheels", kind, short_number(free),
                  counted(view.report.spans.size(), "span", "spans"), short_number(stored));
  if (cable.floor) {
    double floored = 0.0;
    for (const SpanReport& span : view.report.spans) floored += span.floored;
    text += fmt::format("; {} m of it lie on the floor at the height {} m", short_number(floored),
                        short_number(*cable.floor));
  }
  if (sheathed > 0.0) text += fmt::format("; {} m lie in sheaths", short_number(sheathed));
  if (cable.breaking_tension) {
    text += fmt::format("; it breaks at {} N", short_number(*cable.breaking_tension));
  }
  return text + ".";
}

std::string tension_sentence(const CableView& view) {
  const double rounding = 1e-9 * view.simulation.world.bodies().scale();
  std::vector<std::string> slack;
  double least = std::numeric_limits<double>::infinity();
  double most = 0.0;
  for (std::size_t k = 0; k < view.report.spans.size(); ++k) {
    const SpanReport& span = view.report.spans[k];
    if (!view.report.links[k].touched) continue;
    if (!hangs(view.cable) && span.rest_length - span.length > rounding) {
      slack.push_back(fmt::format("{} (by {} m)", k, short_number(span.rest_length - span.length)));
    }
    const double tension =
        hangs(view.cable)
            ? span.tension
            : spring_tension(view.cable, span.length, span.rest_length).value_or(span.tension);
    least = std::min(least, tension);
    most = std::max(most, tension);
  }
  std::string text;
  if (!slack.empty()) {
    text = fmt::format("At the start {} {} {} slack", slack.size() == 1 ? "span" : "spans",
                       joined_names(slack), slack.size() == 1 ? "is" : "are");
  }
  if (most > 0.0) {
    text += (text.empty() ? "At the start " : "; ") +
            (most - least <= 1e-6 * most ? fmt::format("all tensions are {} N", short_number(most))
                                         : fmt::format("the tensions are {} N to {} N",
                                                       short_number(least), short_number(most)));
  }
  if (text.empty()) {
    text = fmt::format("It starts {}; the first step finds its tensions",
                       hangs(view.cable) ? "as a catenary" : "just taut");
  }
  return text + ".";
}

/// Tells where the cable slides, and at which ratio of tensions.
void append_sliding(const CableView& view, Sentences& sentences) {
  std::vector<std::string> held;
  std::vector<std::string> equal;
  const auto add = [](std::vector<std::string>& list, const std::string& body) {
    if (std::find(list.begin(), list.end(), body) == list.end()) list.push_back(body);
  };
  std::size_t told = 0;
  for (std::size_t i = 0; i < view.cable.links.size(); ++i) {
    if (view.is_end(i) || view.report.links[i].winding == 0) {
      const std::string_view type = view.report.links[i].type;
      if (type != "pinhole" && type != "opening" && type != "sheath") continue;
    }
    const Sliding law = sliding_of(*view.cable.links[i]);
    if (++told > most_explained) break;
    const int index = view.simulation.world.bodies().index(view.cable.links[i]->body);
    const bool massless = index < view.simulation.world.bodies().count() &&
                          view.simulation.world.bodies()[index].massless();
    const std::string body = view.body(i);
    if (law.passes != Passage::both) {
      sentences.push_back(fmt::format(
          "Over {} it slides only {}; the other way that link holds any tension.", body,
          law.passes == Passage::forward ? "towards its last link" : "towards its first link"));
    } else if (law.efficiency < 1.0) {
      sentences.push_back(fmt::format("At {} the bearing takes {} % of the tension.", body,
                                      short_number(100.0 * (1.0 - law.efficiency))));
    } else if (massless || (law.slides && law.friction == 0.0)) {
      add(equal, body);
    } else if (law.slides) {
      const double angle = view.report.links[i].wrap_angle;
      sentences.push_back(fmt::format(
          "At {} it slides once one tension is more than {} times the other: e^({} x {}).", body,
          short_number(std::exp(law.friction * angle)), short_number(law.friction),
          short_number(angle)));
    } else {
      add(held, body);
    }
  }
  if (!equal.empty()) {
    sentences.push_back(
        fmt::format("At {} the tension is the same on both sides.", joined_names(equal)));
  }
  if (held.empty()) return;
  sentences.push_back(
      fmt::format("It rolls without slip over {}, so {} tensions on both sides "
                  "differ by what turns the wheel.",
                  joined_names(held), held.size() == 1 ? "the" : "their"));
}

/// The bodies at the cable's ends that wind it up, driven ones among them.
void append_drums(const CableView& view, Sentences& sentences) {
  for (const std::size_t i : {std::size_t{0}, view.cable.links.size() - 1}) {
    const LinkReport& link = view.report.links[i];
    if (!view.is_end(i) || link.winding == 0 || !(link.radius > 0.0)) continue;
    sentences.push_back(fmt::format("{} winds {} m of it per radian at its present radius.",
                                    view.body(i), short_number(link.radius)));
  }
}

/// Ratios between the cable and the coordinates of the machine.
void append_ratios(const CableView& view, const std::vector<MachineCoordinate>& coordinates,
                   const ModalMatrix& arms, Eigen::Index row, Sentences& sentences) {
  std::vector<Eigen::Index> moved;
  for (Eigen::Index i = 0; i < arms.cols(); ++i) {
    if (std::abs(arms(row, i)) > least_arm) moved.push_back(i);
  }
  std::vector<std::string> parts;
  for (const Eigen::Index i : moved) {
    const MachineCoordinate& own = coordinates[static_cast<std::size_t>(i)];
    const double arm = arms(row, i);
    parts.push_back(fmt::format("{} {} m per {} of {}", arm > 0.0 ? "needs" : "frees",
                                short_number(std::abs(arm)), own.angle ? "radian" : "metre",
                                own.name));
  }
  if (parts.empty()) return;
  sentences.push_back(
      fmt::format("Its course {}, the other coordinates at rest.", joined_names(parts)));
  const bool drives = moved.size() == 1;
  if (moved.size() != 2 && !drives) return;
  const MachineCoordinate& load = coordinates[static_cast<std::size_t>(moved[0])];
  const double arm = arms(row, moved[0]);
  if (!drives) {
    const MachineCoordinate& other = coordinates[static_cast<std::size_t>(moved[1])];
    sentences.push_back(
        fmt::format("While it is taut and does not stretch, the rate of {} is {} times that of {}.",
                    other.name, short_number(-arm / arms(row, moved[1])), load.name));
    return;
  }
  for (const std::size_t i : {std::size_t{0}, view.cable.links.size() - 1}) {
    const LinkReport& drum = view.report.links[i];
    const int body = view.simulation.world.bodies().index(view.cable.links[i]->body);
    const bool driven = body < view.simulation.world.bodies().count() &&
                        view.simulation.world.bodies()[body].prescribed();
    if (!view.is_end(i) || !driven || !(drum.radius > 0.0)) continue;
    sentences.push_back(fmt::format(
        "While it is taut and does not stretch, {} moves by {} {} per radian of {}.", load.name,
        short_number(drum.radius / std::abs(arm)), load.angle ? "rad" : "m", view.body(i)));
  }
}

}  // namespace

Sentences explain_cables(const Scene& scene, Simulation& simulation) {
  Sentences sentences;
  if (scene.cables.empty()) return sentences;
  const std::vector<CableReport> reports = simulation.cable_reports();
  std::optional<CableArms> arms;
  std::vector<MachineCoordinate> coordinates;
  if (freedom_names(simulation).size() <= static_cast<std::size_t>(JointSpace::most_freedoms)) {
    if (Result<JointSpace> space = JointSpace::create(simulation)) {
      arms = space->cable_arms();
      coordinates = space->coordinates();
    }
  }
  for (std::size_t c = 0; c < scene.cables.size(); ++c) {
    if (c == most_explained) {
      sentences.push_back(
          fmt::format("There are {} more cables.", scene.cables.size() - most_explained));
      break;
    }
    const CableView view{scene.model, simulation, scene.cables[c], reports[c]};
    sentences.push_back(way_sentence(view));
    sentences.push_back(material_sentence(view));
    sentences.push_back(tension_sentence(view));
    append_sliding(view, sentences);
    append_drums(view, sentences);
    if (arms) {
      append_ratios(view, coordinates, arms->arms, static_cast<Eigen::Index>(c), sentences);
    }
  }
  return sentences;
}

}  // namespace sheave::command
