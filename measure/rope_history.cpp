#include "measure/rope_history.h"

#include <algorithm>
#include <cmath>

#include "engine/vector.h"

namespace sheave::measure {
namespace {

/// The cable's course as places in order: touched links and spans, with their positions along the
/// cable.
struct Place {
  int number = 0;        ///< 2 x link; + 1 for the span behind it
  double start = 0.0;    ///< [m]
  double end = 0.0;      ///< [m]
  double tension = 0.0;  ///< of a link [N]
  double diameter = 0.0;
  Vector3 sense = Vector3::Zero();  ///< axis of the bend
  const SpanReport* span = nullptr;

  /// Tension at a position along the cable [N].
  [[nodiscard]] double tension_at(double position) const {
    if (span == nullptr || !(end > start)) return tension;
    return span->tension_at(std::clamp((position - start) / (end - start), 0.0, 1.0));
  }
};

/// Fraction of a section's length by which its middle must pass an edge to count as elsewhere.
constexpr double edge = 0.1;
/// Cycles below this fraction of the largest tension are left out.
constexpr double least_cycle = 1e-3;

std::vector<Place> places_of(const CableReport& report) {
  std::vector<Place> places;
  double length = -report.links.front().fed;
  double before = 0.0;
  for (std::size_t k = 0; k < report.links.size(); ++k) {
    const LinkReport& link = report.links[k];
    const bool has_span = k < report.spans.size();
    const double after = has_span ? report.spans[k].tension_at(0.0) : before;
    if (!link.touched) continue;
    const auto number = static_cast<int>(2 * k);
    const double tension = k == 0 ? after : has_span ? 0.5 * (before + after) : before;
    Place on_link{
        .number = number, .start = length, .end = length + link.stored_length, .tension = tension};
    if (link.winding != 0) {
      on_link.diameter = 2.0 * link.radius;
      on_link.sense = link.winding * link.normal;
    }
    length = on_link.end;
    places.push_back(on_link);
    if (has_span) {
      const SpanReport& span = report.spans[k];
      const double end = length + span.rest_length;
      places.push_back(
          {.number = number + 1, .start = length, .end = end, .tension = after, .span = &span});
      length = end;
      before = span.tension_at(1.0);
    }
  }
  return places;
}

SectionBends& bends_on(int link, std::vector<SectionBends>& bends) {
  const auto found = std::find_if(bends.begin(), bends.end(),
                                  [&](const SectionBends& one) { return one.link == link; });
  return found != bends.end() ? *found : bends.emplace_back(SectionBends{.link = link});
}

bool covers(const Place& place, double middle, double slop) {
  return middle >= place.start - slop && middle <= place.end + slop;
}

/// The place of a section's middle that was at `before` (-1: unknown). The middle keeps its place
/// until it is clearly beyond an edge.
const Place& place_of(const std::vector<Place>& places, double middle, int before, double slop) {
  for (const Place& place : places) {
    if (place.number == before && covers(place, middle, slop)) return place;
  }
  const auto here = std::find_if(places.begin(), places.end(),
                                 [&](const Place& place) { return middle <= place.end; });
  return here == places.end() ? places.back() : *here;
}

}  // namespace

SectionBends SectionHistory::all_bends() const {
  SectionBends all;
  for (const SectionBends& one : bends) {
    const int count = all.bends + one.bends;
    all.mean_tension += (one.mean_tension - all.mean_tension) * one.bends / count;
    all.least_diameter =
        all.bends == 0 ? one.least_diameter : std::min(all.least_diameter, one.least_diameter);
    all.bends = count;
    all.reverse += one.reverse;
    all.most_tension = std::max(all.most_tension, one.most_tension);
    all.simple_damage += one.simple_damage;
    all.reverse_damage += one.reverse_damage;
  }
  all.diameter = all.least_diameter;
  return all;
}

double SectionHistory::damage() const {
  const SectionBends all = all_bends();
  return all.simple_damage + all.reverse_damage;
}

void RopeHistory::begin(const std::vector<CableReport>& reports) {
  for (const CableReport& report : reports) {
    Cable& cable = cables_.emplace_back();
    cable.told.cable = std::string(report.name);
    cable.told.followed = !report.closed && !report.cut;
    cable.slack_since.assign(report.spans.size(), -1.0);
    for (const LinkReport& link : report.links) cable.stored.push_back(link.stored_length);
    if (!cable.told.followed) continue;
    cable.section_length = report.total_length / sections_;
    for (int i = 0; i < sections_; ++i) {
      Section section;
      section.middle = (i + 0.5) * cable.section_length;
      cable.sections.push_back(std::move(section));
    }
  }
}

void RopeHistory::observe(const Simulation& simulation) {
  const std::vector<CableReport> reports = simulation.cable_reports();
  if (cables_.empty()) begin(reports);
  const State& state = simulation.world.state();
  for (std::size_t i = 0; i < reports.size(); ++i) {
    Cable& cable = cables_[i];
    if (reports[i].cut || !reports[i].wraps.empty()) cable.told.followed = false;
    if (cable.told.followed) follow(reports[i], state.steps > 0, cable);
    if (state.steps > 0) watch_slack(reports[i], state.time, cable);
    watch_drums(reports[i], cable);
  }
}

void RopeHistory::count_bend(const Bend& bend, Section& section) const {
  SectionBends& on = bends_on(bend.link, section.bends);
  const bool reverse = bend.sense.dot(section.sense) < 0.0;
  const bool first = section.sense.isZero(0.0);
  if (first) section.first = bend;
  section.sense = bend.sense;
  on.least_diameter = on.bends == 0 ? bend.diameter : std::min(on.least_diameter, bend.diameter);
  on.diameter = bend.diameter;
  ++on.bends;
  on.most_tension = std::max(on.most_tension, bend.tension);
  on.mean_tension += (bend.tension - on.mean_tension) / on.bends;
  if (!first) add_kind(bend, reverse, on);
}

void RopeHistory::add_kind(const Bend& bend, bool reverse, SectionBends& on) const {
  if (reverse) ++on.reverse;
  if (!life_) return;
  (reverse ? on.reverse_damage : on.simple_damage) +=
      life_->damage(bend.tension, bend.diameter, reverse);
}

std::vector<SectionBends> RopeHistory::repeated_bends(const Section& section) const {
  std::vector<SectionBends> bends = section.bends;
  if (!section.first) return bends;
  const Bend& first = *section.first;
  add_kind(first, section.returned && first.sense.dot(section.sense) < 0.0,
           bends_on(first.link, bends));
  return bends;
}

void RopeHistory::follow(const CableReport& report, bool tensions_known, Cable& cable) const {
  const std::vector<Place> places = places_of(report);
  const double slop = edge * cable.section_length;
  for (Section& section : cable.sections) {
    const Place& place = place_of(places, section.middle, section.place, slop);
    const auto look = [&](const Place& passed) {
      // The section has left its old place and has passed over the places between.
      const int low = std::min(section.place, place.number);
      const int high = std::max(section.place, place.number);
      const bool between = passed.number > low && passed.number < high;
      const bool wheel = passed.number % 2 == 0 && passed.diameter > 0.0;
      if (!wheel || !(between || passed.number == place.number)) return;
      count_bend({passed.number / 2, passed.tension, passed.diameter, passed.sense}, section);
    };
    if (section.place < 0) {
      section.sense = place.sense;
      section.start_place = place.number;
    } else if (section.place < place.number) {
      std::for_each(places.begin(), places.end(), look);
    } else if (section.place > place.number) {
      std::for_each(places.rbegin(), places.rend(), look);
    }
    section.place = place.number;
    section.returned = std::any_of(places.begin(), places.end(), [&](const Place& one) {
      return one.number == section.start_place && covers(one, section.middle, slop);
    });
    if (!tensions_known) continue;
    const double tension = place.tension_at(section.middle);
    section.least_tension =
        section.observed > 0.0 ? std::min(section.least_tension, tension) : tension;
    section.most_tension = std::max(section.most_tension, tension);
    section.observed += 1.0;
    section.mean_tension += (tension - section.mean_tension) / section.observed;
    section.tension.add(tension);
  }
}

void RopeHistory::watch_slack(const CableReport& report, double time, Cable& cable) {
  for (std::size_t k = 0; k < report.spans.size(); ++k) {
    const SpanReport& span = report.spans[k];
    const bool slack = span.tension <= 0.0 && span.length > 0.0;
    double& since = cable.slack_since[k];
    if (!slack) {
      since = -1.0;
      continue;
    }
    if (since < 0.0) since = time;
    auto& told = cable.told.slack;
    auto found = std::find_if(told.begin(), told.end(), [&](const SpanSlack& one) {
      return one.span == static_cast<int>(k);
    });
    if (found == told.end()) {
      told.push_back({static_cast<int>(k), 0.0, 0.0});
      found = told.end() - 1;
    }
    found->longest = std::max(found->longest, time - since);
    found->deepest = std::max(found->deepest, span.rest_length - span.length);
  }
}

void RopeHistory::watch_drums(const CableReport& report, Cable& cable) {
  for (std::size_t k = 0; k < report.links.size(); ++k) {
    const LinkReport& link = report.links[k];
    const double change = std::abs(link.stored_length - cable.stored[k]);
    cable.stored[k] = link.stored_length;
    const bool end = k == 0 || k + 1 == report.links.size();
    if (report.closed || !end || link.winding == 0 || change == 0.0) continue;
    // Turns of one layer of a groove lie side by side.
    const int turns =
        link.groove ? link.groove->layer - 1 : static_cast<int>(link.wrap_angle / (2.0 * pi));
    auto& layers = cable.told.layers;
    auto found = std::find_if(layers.begin(), layers.end(), [&](const LayerTravel& one) {
      return one.link == static_cast<int>(k) && one.turns == turns;
    });
    if (found == layers.end()) {
      layers.push_back({static_cast<int>(k), turns, 0.0});
      found = layers.end() - 1;
    }
    found->travel += change;
  }
}

std::vector<CableHistory> RopeHistory::history() const {
  std::vector<CableHistory> result;
  for (const Cable& cable : cables_) {
    CableHistory told = cable.told;
    for (std::size_t i = 0; told.followed && i < cable.sections.size(); ++i) {
      const Section& section = cable.sections[i];
      SectionHistory history;
      history.from = static_cast<double>(i) * cable.section_length;
      history.to = static_cast<double>(i + 1) * cable.section_length;
      history.bends = repeated_bends(section);
      history.most_tension = section.most_tension;
      history.least_tension = section.least_tension;
      history.mean_tension = section.mean_tension;
      told.returned = told.returned && section.returned;
      history.cycles = section.tension.closed_cycles();
      std::erase_if(history.cycles, [&](const LoadCycle& one) {
        return one.range < least_cycle * section.most_tension;
      });
      told.sections.push_back(std::move(history));
    }
    result.push_back(std::move(told));
  }
  return result;
}

}  // namespace sheave::measure
