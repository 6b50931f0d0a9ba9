#include "statics/slipping_link.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "cable/cable_system.h"
#include "engine/body_set.h"
#include "engine/field_check.h"
#include "engine/index.h"

namespace sheave {
namespace {

constexpr int few_digits = 4;

struct SlippingLink {
  std::size_t cable = 0;
  std::size_t link = 0;
  std::size_t tight = 0;  ///< span with the larger tension
  std::size_t loose = 0;
  double tight_tension = 0.0;  ///< [N]
  double loose_tension = 0.0;  ///< [N]

  [[nodiscard]] double difference() const { return tight_tension - loose_tension; }
};

/// A setting of the link by its name; nothing if the link has no such setting.
std::optional<double> setting_of(const LinkDef& link, std::string_view name) {
  const auto types = link_types();
  const auto type = std::ranges::find(types, link.type(), &TypeEntry<LinkDef>::name);
  if (type == types.end()) return {};
  for (const Field& field : type->fields()) {
    if (field.name != name) continue;
    // Slots serve reading and writing; this code only reads.
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast)
    const FieldSlot slot = field.slot(const_cast<void*>(link.settings()));
    if (const auto* real = std::get_if<double*>(&slot)) return **real;
    if (const auto* real = std::get_if<std::optional<double>*>(&slot)) return **real;
  }
  return {};
}

/// Whether this link of the scene slips, with friction between its two spans.
std::optional<SlippingLink> slip_at(const CableReport& report, const CableDef& definition,
                                    std::size_t link) {
  const std::size_t spans = report.spans.size();
  const std::size_t before = (link + spans - 1) % spans;
  if ((!definition.closed && (link == 0 || link >= spans)) || !report.links[link].touched)
    return {};
  const double first = report.spans[before].tension;
  const double second = report.spans[link].tension;
  if (first >= second) return SlippingLink{0, link, before, link, first, second};
  return SlippingLink{0, link, link, before, second, first};
}

std::optional<SlippingLink> worst_slip(const Simulation& simulation, const State& state,
                                       const std::vector<CableReport>& reports) {
  const FeatureState& own = state.features.back();
  std::optional<SlippingLink> worst;
  for (std::size_t c = 0; c < reports.size(); ++c) {
    const CompiledCable& cable = simulation.cables->cables()[c];
    const CableDef& definition = (*simulation.cable_definitions)[c];
    for (std::size_t i = 0; i < definition.links.size(); ++i) {
      const auto index = CableSystem::slip_state_index(cable.first_link + static_cast<int>(i));
      if (own.integers[index] == 0) continue;
      std::optional<SlippingLink> slip = slip_at(reports[c], definition, i);
      // Without friction cable passes whatever the loads are.
      if (!slip || !(slip->difference() > 0.0) || !(slip->loose_tension > 0.0)) continue;
      if (worst && worst->difference() >= slip->difference()) continue;
      slip->cable = c;
      worst = slip;
    }
  }
  return worst;
}

/// "friction 0.2 holds at 180 degrees", "efficiency 0.95 holds"; "the link holds" for other links.
/// The angle of a link that slides follows from `ratio`, that of the tensions.
std::string bound_text(const LinkDef& link, double ratio) {
  const auto text = [](double value) { return number_text(value, few_digits); };
  const double friction = setting_of(link, "friction").value_or(0.0);
  if (friction > 0.0) {
    return "friction " + text(friction) + " holds at " +
           text(std::log(ratio) / friction * 180.0 / pi) + " degrees; more friction, another turn";
  }
  const std::optional<double> efficiency = setting_of(link, "efficiency");
  if (efficiency) return "efficiency " + text(*efficiency) + " holds; a brake on the wheel";
  const bool rubs = setting_of(link, "bearing_friction").value_or(0.0) > 0.0;
  if (rubs || setting_of(link, "bending_loss").value_or(0.0) > 0.0) {
    return std::string(rubs ? "bearing_friction" : "bending_loss") + " holds; a brake on the wheel";
  }
  return "the link holds; more friction";
}

}  // namespace

std::string slipping_text(const Simulation& simulation, const State& state) {
  if (simulation.cables == nullptr) return "";
  const BodySet& bodies = simulation.world.bodies();
  const std::vector<CableReport> reports =
      simulation.cables->report(bodies, state, state.features.back());
  const std::optional<SlippingLink> slip = worst_slip(simulation, state, reports);
  if (!slip) return "";
  const CableDef& cable = (*simulation.cable_definitions)[slip->cable];
  const LinkDef& link = *cable.links[slip->link];
  const std::string body =
      link.body.is_world() ? "the world" : "\"" + bodies.name(link.body.index) + "\"";
  const double ratio = slip->tight_tension / slip->loose_tension;
  return "cable \"" + cable.name + "\" slides over link " + std::to_string(slip->link) + " on " +
         body + ", where the tension of span " + std::to_string(slip->tight) + " is " +
         number_text(ratio, few_digits) + " times that of span " + std::to_string(slip->loose) +
         ", all that " + bound_text(link, ratio) + " or loads nearer to balance may hold it";
}

}  // namespace sheave
