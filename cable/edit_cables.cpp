// Edits that split, open, join, attach and detach cables.

#include <algorithm>
#include <cmath>

#include "cable/cable_transfer.h"
#include "cable/edit_draft.h"
#include "cable/links/attachment.h"
#include "engine/field_check.h"
#include "engine/index.h"

namespace sheave {
namespace {

/// Nearest multiple of the quantum.
double quantised(double length, double quantum) {
  return CompiledCable::quantised(length, quantum, 1.0 / quantum);
}

bool same_settings(const CableDef& a, const CableDef& b) {
  return a.compliance == b.compliance && a.axial_stiffness == b.axial_stiffness &&
         a.strain_table == b.strain_table && a.tension_table == b.tension_table &&
         a.unloading_stiffness == b.unloading_stiffness && a.unloading_table == b.unloading_table &&
         a.transition_strain == b.transition_strain && a.damping == b.damping &&
         a.axial_damping == b.axial_damping && a.tangent_update == b.tangent_update &&
         a.wrap_friction == b.wrap_friction && a.linear_density == b.linear_density &&
         a.axial_inertia == b.axial_inertia && a.floor == b.floor &&
         a.floor_friction == b.floor_friction && a.most_wraps == b.most_wraps &&
         a.breaking_tension == b.breaking_tension;
}

bool same_number(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

/// Whether the controls are equal.
bool same_controls(const CableControl& a, const CableControl& b) {
  return same_number(a.compliance, b.compliance) &&
         same_number(a.breaking_tension, b.breaking_tension) &&
         same_number(a.wrap_friction, b.wrap_friction);
}

/// Index of the listed link at an end.
std::size_t end_of(const RunningCable& cable, CableEnd end) {
  return cable.place_of(end == CableEnd::first ? 0 : cable.listed_count() - 1);
}

std::size_t number(CableEnd end) { return end == CableEnd::first ? 0 : 1; }
std::string_view name_of(CableEnd end) { return end == CableEnd::first ? "first" : "last"; }

/// The last link before `end` that the cable touches.
std::size_t last_touched(const std::vector<RunningLink>& links, std::size_t end) {
  std::size_t place = end - 1;
  while (place > 0 && !links[place].is_on_course()) --place;
  return place;
}

/// Removes the last link with the span and the wraps before it; returns their length.
double take_last(RunningCable& cable) {
  std::vector<RunningLink>& links = cable.links;
  double length = links.back().stored_length;
  const bool touched = links.back().is_on_course();
  links.pop_back();
  if (!touched || links.empty()) return length;
  std::size_t place = last_touched(links, links.size());
  while (links[place].is_wrap()) {
    length += links[place].stored_length + links[place].span.value_or(RunningSpan{}).rest_length;
    links.erase(links.begin() + static_cast<std::ptrdiff_t>(place));
    place = last_touched(links, place);
  }
  length += links[place].span.value_or(RunningSpan{}).rest_length;
  links[place].span.reset();
  return length;
}

double take_first(RunningCable& cable) {
  double length = 0.0;
  do {
    const RunningLink& link = cable.links.front();
    length += link.stored_length + link.span.value_or(RunningSpan{}).rest_length;
    cable.links.erase(cable.links.begin());
  } while (!cable.links.empty() && cable.links.front().is_wrap());
  return length;
}

double take_end(RunningCable& cable, CableEnd end) {
  return end == CableEnd::first ? take_first(cable) : take_last(cable);
}

}  // namespace

bool holds_by_itself(const RunningLink& link) {
  return link.is_listed() && link.link->type() == AttachmentLink::type_name;
}

std::string run_off(DraftCable& cable) {
  for (const CableEnd end : {CableEnd::first, CableEnd::last}) {
    std::optional<double>& loose = cable.loose[number(end)];
    while (loose && !cable.running.links.empty()) {
      const std::size_t place = end_of(cable.running, end);
      const bool other_end = cable.running.listed_count() == 1 && !cable.loose[1 - number(end)];
      if (holds_by_itself(cable.running.links[place]) || other_end) break;
      *loose += take_end(cable.running, end);
    }
  }
  if (cable.running.links.empty()) {
    // One loose piece of cable, which no link holds.
    cable.loose[0] = cable.loose[0].value_or(0.0) + cable.loose[1].value_or(0.0);
    cable.loose[1] = 0.0;
    return {};
  }
  for (const CableEnd end : {CableEnd::first, CableEnd::last}) {
    if (cable.definition.closed || !cable.running.links[end_of(cable.running, end)].is_fresh)
      continue;
    return "cable \"" + cable.definition.name + "\" would have an inserted link at its " +
           std::string(name_of(end)) + " end, where no span is left for it; attach the cable there";
  }
  return {};
}

std::string EditDraft::cable_name(CableHandle handle) const {
  const auto own = own_cables.find(handle.slot);
  return own != own_cables.end() ? own->second.definition.name
                                 : before.records[at(handle.slot)].definition.name;
}

DraftCable* EditDraft::running(CableHandle handle, bool may_be_cut) {
  if (!check(cables, handle, "cable")) return nullptr;
  const std::string name = "cable \"" + cable_name(handle) + "\"";
  auto found = own_cables.find(handle.slot);
  if (found == own_cables.end()) {
    const CableRecord& record = before.records[at(handle.slot)];
    if (record.definition.has_memory()) {
      fail(name +
           " remembers how it was stretched, and an edit that takes it apart would lose that; cut "
           "it instead, or take unloading_table and unloading_stiffness out of the scene");
      return nullptr;
    }
    DraftCable own;
    own.definition = record.definition;
    own.loose = record.loose;
    own.running = record.running;
    if (record.place >= 0) {
      const State& state = before.world().state();
      const Substep now(before.world().bodies(), state, model.step.dt, 1);
      TakenCable taken = CableTransfer(*before.system())
                             .take_apart(record.place, record.definition, state.features.back(),
                                         state.controls, now);
      own.running = std::move(taken.running);
      own.running.control.added_length = 0.0;
      spans_before.insert(spans_before.end(), taken.spans.begin(), taken.spans.end());
      own.excess = taken.excess;
    }
    own.runs = true;
    own.definition.rest_lengths.clear();
    own.definition.pretension.reset();
    own.definition.pretensions.clear();
    found = own_cables.emplace(handle.slot, std::move(own)).first;
  }
  DraftCable& cable = found->second;
  if (!cable.runs) {
    fail(name + " is added by this edit; put the change into its definition");
    return nullptr;
  }
  if (cable.running.is_cut && !may_be_cut) {
    fail(name + " is cut; split it into two cables, or open it if it is a belt");
    return nullptr;
  }
  return &cable;
}

/// Index of the link behind which the cable is to be parted. None and a fault if that is
/// impossible.
std::optional<std::size_t> EditDraft::place_to_part(const DraftCable& cable, int span,
                                                    double share) {
  const std::string who = "cable \"" + cable.definition.name + "\"";
  const RunningCable& running = cable.running;
  if (!(share >= 0.0 && share <= 1.0)) {
    fail(who + ": the fraction of the span at which it is parted must be from 0 to 1, not " +
         number_text(share));
    return std::nullopt;
  }
  if (running.is_cut) span = running.cut_span;
  const int spans = running.listed_count() - (cable.definition.closed ? 0 : 1);
  if (span >= 0 && span < spans && running.links[running.place_of(span)].span) {
    const std::size_t place = running.place_of(span);
    const std::size_t next = running.place_of((span + 1) % running.listed_count());
    if (!running.links[place].is_fresh && !running.links[next].is_fresh) return place;
    fail(who + " has a new link beside its span number " + std::to_string(span) +
         ", whose length is known only at the end of the edit; part the cable first, or in an " +
         "edit of its own");
    return std::nullopt;
  }
  fail(who + " has no span number " + std::to_string(span) + " in which it could be parted");
  return std::nullopt;
}

CableHandle Edit::split(CableHandle cable, int span, double share, std::string name) {
  DraftCable* whole = draft_.running(cable, true);
  if (whole == nullptr) return {};
  if (whole->definition.closed) {
    draft_.fail("cable \"" + whole->definition.name +
                "\" is closed and cannot be split in two; open it");
    return {};
  }
  const std::optional<std::size_t> parted = draft_.place_to_part(*whole, span, share);
  if (!parted) return {};
  const std::size_t place = *parted;
  RunningCable& running = whole->running;
  DraftCable rest;
  rest.runs = true;
  rest.excess = whole->excess;
  rest.definition = whole->definition;
  rest.definition.name = std::move(name);
  rest.definition.cut_time.reset();
  rest.running.quantum = running.quantum;
  rest.running.links.assign(running.links.begin() + static_cast<std::ptrdiff_t>(place) + 1,
                            running.links.end());
  running.links.resize(place + 1);
  const double length = running.links[place].span->rest_length;
  running.links[place].span.reset();
  // Wraps directly behind the split belong to the piece that comes off them.
  double both = length;
  while (!rest.running.links.empty() && rest.running.links.front().is_wrap()) {
    both += take_first(rest.running);
  }
  const double first =
      quantised(std::min(running.cut_at.value_or(share * length), both), running.quantum);
  rest.loose = {both - first, whole->loose[1]};
  whole->loose[1] = first;
  whole->definition.cut_time.reset();
  running.forget_cut();
  rest.running.control = running.control;
  const CableHandle handle = draft_.cables.add(-1, draft_.next_generation++);
  draft_.cables.set_index(at(handle.slot), handle.slot);
  draft_.own_cables[handle.slot] = std::move(rest);
  return handle;
}

void Edit::open(CableHandle belt, int span, double share) {
  DraftCable* own = draft_.running(belt, true);
  if (own == nullptr) return;
  if (!own->definition.closed) {
    return draft_.fail("cable \"" + own->definition.name + "\" is open; split it");
  }
  const std::optional<std::size_t> place = draft_.place_to_part(*own, span, share);
  if (!place) return;
  RunningCable& running = own->running;
  RunningSpan& parted = *running.links[*place].span;
  const double chosen = running.cut_at.value_or(share * parted.rest_length);
  double both = parted.rest_length;
  running.links[*place].span.reset();
  std::rotate(running.links.begin(),
              running.links.begin() + static_cast<std::ptrdiff_t>(*place) + 1, running.links.end());
  // Wraps directly behind the opening are not listed and hold no cable.
  while (running.links.front().is_wrap()) both += take_first(running);
  const double last = quantised(std::min(chosen, both), running.quantum);
  own->loose = {both - last, last};
  own->definition.closed = false;
  own->definition.cut_time.reset();
  running.forget_cut();
}

void EditDraft::close(DraftCable& cable) {
  const std::string who = "cable \"" + cable.definition.name + "\"";
  RunningCable& running = cable.running;
  if (!cable.loose[0] || !cable.loose[1]) {
    return fail(who + " cannot be joined to itself: both its ends must be loose; detach them");
  }
  if (running.listed_count() < 2) {
    return fail(who + " cannot be joined to itself: a belt needs at least 2 links");
  }
  RunningSpan span;
  span.rest_length = *cable.loose[0] + *cable.loose[1];
  running.links[last_touched(running.links, running.links.size())].span = span;
  cable.loose = {};
  cable.definition.closed = true;
}

void Edit::join(CableHandle cable, CableHandle next) {
  DraftCable* first = draft_.running(cable);
  DraftCable* second = draft_.running(next);
  if (first == nullptr || second == nullptr) return;
  const std::string names =
      "cables \"" + first->definition.name + "\" and \"" + second->definition.name + "\"";
  if (first == second) return draft_.close(*first);
  if (!first->loose[1] || !second->loose[0]) {
    return draft_.fail(names +
                       " cannot be joined: the last end of the one and the first end of the "
                       "other must be loose; detach them first");
  }
  if (!same_settings(first->definition, second->definition) ||
      !same_controls(first->running.control, second->running.control)) {
    return draft_.fail(names +
                       " have different settings; only cables with equal settings can be joined");
  }
  if (first->running.links.empty() || second->running.links.empty()) {
    return draft_.fail(names +
                       " cannot be joined: one of them is fixed to nothing; attach it first");
  }
  RunningCable& one = first->running;
  RunningCable& other = second->running;
  // Both lengths are multiples of the finer quantum. If the sum is too long for it, the coarser one
  // is used and lengths are rounded.
  constexpr double most = 4503599627370496.0;  // 2^52
  const double finer = std::min(one.quantum, other.quantum);
  const bool fits =
      one.length() + other.length() + *first->loose[1] + *second->loose[0] < most * finer;
  one.quantum = fits ? finer : std::max(one.quantum, other.quantum);
  RunningSpan span;
  span.rest_length = quantised(*first->loose[1] + *second->loose[0], one.quantum);
  one.links[last_touched(one.links, one.links.size())].span = span;
  for (RunningLink& link : other.links) {
    if (link.span) link.span->rest_length = quantised(link.span->rest_length, one.quantum);
    link.stored_length = quantised(link.stored_length, one.quantum);
    one.links.push_back(std::move(link));
  }
  first->loose[1] = second->loose[1];
  first->excess += second->excess;
  const std::string name = second->definition.name;
  draft_.cables.remove(next, name);
  draft_.own_cables.erase(next.slot);
}

void Edit::detach(CableHandle cable, CableEnd end) {
  DraftCable* own = draft_.running(cable);
  if (own == nullptr) return;
  const std::string who = "cable \"" + own->definition.name + "\"";
  if (own->definition.closed) return draft_.fail(who + " is closed and has no ends");
  if (own->loose[number(end)]) {
    return draft_.fail("the " + std::string(name_of(end)) + " end of " + who + " is loose already");
  }
  own->loose[number(end)] = take_end(own->running, end);
}

void Edit::attach(CableHandle cable, CableEnd end, BodyId body, const Vector3& point) {
  DraftCable* own = draft_.running(cable);
  if (own == nullptr) return;
  const std::string who = "cable \"" + own->definition.name + "\"";
  std::optional<double>& loose = own->loose[number(end)];
  if (!loose) {
    return draft_.fail("the " + std::string(name_of(end)) + " end of " + who +
                       " is attached already; detach it first");
  }
  if (!point.allFinite()) return draft_.fail(who + ": the point it is attached to must be finite");
  auto link = std::make_shared<AttachmentLink>();
  link->body = body;
  link->point = point;
  RunningLink running;
  running.link = std::move(link);
  std::vector<RunningLink>& links = own->running.links;
  if (links.empty()) {
    // The loose piece hangs from this attachment now.
    std::optional<double>& other = own->loose[1 - number(end)];
    other = other.value_or(0.0) + *loose;
    links.push_back(std::move(running));
  } else if (end == CableEnd::first) {
    running.span = RunningSpan{*loose, 0.0, {}};
    links.insert(links.begin(), std::move(running));
  } else {
    links[last_touched(links, links.size())].span = RunningSpan{*loose, 0.0, {}};
    links.push_back(std::move(running));
  }
  loose.reset();
}

void Edit::pay_out(CableHandle cable, int span, double length) {
  DraftCable* own = draft_.running(cable);
  if (own == nullptr) return;
  const std::string who = "cable \"" + own->definition.name + "\"";
  RunningCable& running = own->running;
  const bool there = span >= 0 && span < running.listed_count() &&
                     running.links[running.place_of(span)].span.has_value();
  if (!there) return draft_.fail(who + " has no span number " + std::to_string(span) + " now");
  double& rest_length = running.links[running.place_of(span)].span->rest_length;
  const double longer = rest_length + quantised(length, running.quantum);
  if (!std::isfinite(length) || !(longer >= 0.0)) {
    return draft_.fail(who + " cannot give " + number_text(-length) + " m out of span " +
                       std::to_string(span) + ", which has " + number_text(rest_length) + " m");
  }
  rest_length = longer;
}

void Edit::insert(CableHandle cable, int span, std::shared_ptr<const LinkDef> link) {
  DraftCable* own = draft_.running(cable);
  if (own == nullptr) return;
  const std::string who = "cable \"" + own->definition.name + "\"";
  if (link == nullptr) return draft_.fail(who + ": a link that is inserted must not be null");
  RunningCable& running = own->running;
  const bool there = span >= 0 && span < running.listed_count() &&
                     running.links[running.place_of(span)].span.has_value();
  if (!there) return draft_.fail(who + " has no span number " + std::to_string(span) + " now");
  const std::size_t place = running.place_of(span);
  RunningLink inserted;
  inserted.link = std::move(link);
  inserted.is_fresh = true;
  // The span before the link keeps the whole length until the path over the link is known.
  inserted.span = RunningSpan{0.0, running.links[place].span->tension, {}};
  running.links.insert(running.links.begin() + static_cast<std::ptrdiff_t>(place) + 1,
                       std::move(inserted));
}

void Edit::remove_link(CableHandle cable, int link) {
  DraftCable* own = draft_.running(cable);
  if (own == nullptr) return;
  const std::string who = "cable \"" + own->definition.name + "\"";
  RunningCable& running = own->running;
  if (link <= 0 || link + 1 >= running.listed_count()) {
    return draft_.fail(who + " has no link number " + std::to_string(link) +
                       " between its ends; detach an end instead");
  }
  const std::size_t place = running.place_of(link);
  const RunningLink& gone = running.links[place];
  if (gone.is_on_course()) {
    std::size_t before = last_touched(running.links, place);
    // The predecessor of the first touched link of a belt is the last touched link.
    if (!running.links[before].is_on_course()) {
      before = last_touched(running.links, running.links.size());
    }
    running.links[before].span->rest_length +=
        gone.stored_length + gone.span.value_or(RunningSpan{}).rest_length;
  }
  running.links.erase(running.links.begin() + static_cast<std::ptrdiff_t>(place));
}

}  // namespace sheave
