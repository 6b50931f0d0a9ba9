#include "cable/cable_transfer.h"

#include <algorithm>
#include <cmath>

#include "cable/cut_place.h"
#include "cable/floor_friction.h"
#include "cable/links/attachment.h"
#include "cable/rope_memories.h"
#include "engine/field_check.h"
#include "engine/index.h"

namespace sheave {

RunningLink CableTransfer::running_link(int cable, int link, const FeatureState& own,
                                        const Controls& controls) const {
  const CompiledCable& compiled = system_.cables_[at(cable)];
  const int index = compiled.first_link + link;
  RunningLink running;
  running.stored_length = own.reals[system_.stored_length_index(index)];
  running.slipped = own.reals[system_.slip_index(index)];
  running.angle = own.reals[system_.angle_index(index)];
  if (const int bearing = system_.bearing_of(index); bearing >= 0) {
    running.bearing_torque = own.reals[system_.bearing_index(bearing)];
  }
  running.slip = own.integers[CableSystem::slip_state_index(index)];
  running.mode = own.integers[system_.mode_index(index)];
  if (system_.driven_) running.stall = own.integers[system_.stall_index(index)];
  if (system_.strain_places_[at(index)] >= 0) {
    const auto first =
        own.reals.begin() +
        static_cast<std::ptrdiff_t>(system_.strain_index(system_.strain_places_[at(index)]));
    running.strain.assign(first, first + StoredStrain::real_count + 1);
  }
  if (const int sheath = system_.sheath_places_[at(index)]; sheath >= 0) {
    const auto first =
        own.reals.begin() + static_cast<std::ptrdiff_t>(system_.sheath_index(at(sheath)));
    running.strain.assign(first, first + SheathProfile::real_count + 1);
  }
  if (const LinkControl* set = controls.links.find(index)) running.control = *set;
  if (const std::int64_t wrap = own.integers[system_.wrap_index(index)]; wrap != 0) {
    running.body = compiled.candidates[at(static_cast<int>(std::abs(wrap)) - 1)].body;
    running.winding = wrap > 0 ? 1 : -1;
  } else if (link < compiled.listed_links) {
    running.winding = system_.definitions_[at(index)].side;
  }
  if (const int plane = compiled.planes[at(link)]; plane >= 0) {
    const auto first = own.reals.begin() + static_cast<std::ptrdiff_t>(system_.plane_index(plane));
    std::copy_n(first, running.plane.size(), running.plane.begin());
  }
  running.size = size_of(compiled, index, running.body);
  if (link < compiled.span_count && own.integers[system_.next_index(index)] >= 0) {
    const int span = compiled.first_span + link;
    running.span = RunningSpan{
        own.reals[system_.rest_length_index(span)],
        own.reals[system_.tension_index(span)],
        {own.reals[system_.remainder_index(span, 0)], own.reals[system_.remainder_index(span, 1)]},
        RopeMemories::kept(system_, own, span),
        FloorFriction::kept(system_, own, span)};
  }
  return running;
}

RunningCable CableTransfer::running_cable(int cable, const CableDef& definition,
                                          const FeatureState& own, const Controls& controls) const {
  return course_of(cable, definition, own, controls).running;
}

TakenCable CableTransfer::take_apart(int cable, const CableDef& definition, const FeatureState& own,
                                     const Controls& controls, const Substep& now) {
  const CompiledCable& compiled = system_.cables_[at(cable)];
  Course course = course_of(cable, definition, own, controls);
  std::vector<RunningLink*> by_number(at(compiled.link_count), nullptr);
  for (std::size_t i = 0; i < course.numbers.size(); ++i) {
    by_number[at(course.numbers[i])] = &course.running.links[i];
  }
  TakenCable taken;
  system_.follow_state(now, own);
  for (const int number : course.numbers) {
    const auto next = own.integers[system_.next_index(compiled.first_link + number)];
    if (next < 0) continue;
    const auto span = std::make_shared<const SpanGeometry>(
        system_.geometry_of(now, compiled.first_span + number));
    by_number[at(number)]->went_by = span;
    by_number[static_cast<std::size_t>(next)]->came_by = span;
    taken.spans.push_back(span);
  }
  taken.excess = missing_length(now, own, cable);
  system_.knows_lengths_ = false;
  taken.running = std::move(course.running);
  return taken;
}

CableTransfer::Course CableTransfer::course_of(int cable, const CableDef& definition,
                                               const FeatureState& own,
                                               const Controls& controls) const {
  const CompiledCable& compiled = system_.cables_[at(cable)];
  Course course;
  RunningCable& running = course.running;
  running.quantum = compiled.quantum;
  if (const CableControl* set = controls.cables.find(cable)) running.control = *set;
  const auto parted = CutPlace::of(own.integers[system_.cut_index(cable)]);
  const int cut = parted ? parted->span : -1;
  running.is_cut = cut >= 0;
  const auto next_of = [&](int link) {
    return static_cast<int>(own.integers[system_.next_index(compiled.first_link + link)]);
  };
  const auto append = [&](int link) {
    running.links.push_back(running_link(cable, link, own, controls));
    course.numbers.push_back(link);
  };
  const auto append_wraps = [&](int first, int behind) {
    for (int link = first; link >= compiled.listed_links; link = next_of(link)) {
      if (cut == link) running.cut_span = behind;
      append(link);
      if (next_of(link) == first) break;
    }
  };
  bool touches_listed = false;
  for (int link = 0; link < compiled.listed_links; ++link) {
    append(link);
    running.links.back().link = definition.links[at(link)];
    if (cut == link) running.cut_span = link;
    const bool last = !compiled.closed && link + 1 == compiled.listed_links;
    touches_listed = touches_listed || last || next_of(link) >= 0;
    append_wraps(next_of(link), link);
  }
  if (parted && parted->share) {
    running.cut_at = length_to(*parted, system_, compiled, own) -
                     length_to({running.cut_span, 0.0}, system_, compiled, own);
  }
  if (touches_listed) return course;
  // The belt has left all its listed links, so its course begins at a wrap.
  for (int place = compiled.listed_links; place < compiled.link_count; ++place) {
    if (next_of(place) < 0) continue;
    append_wraps(place, 0);
    break;
  }
  return course;
}

double CableTransfer::size_of(const CompiledCable& cable, int link, int body) const {
  if (body < 0) {
    const LinkGeometry& definition = system_.definitions_[at(link)];
    // The radius of a geodesic link is that of its bend, which differs from place to place.
    // The tension in a sheath is that of its length and friction.
    if (definition.sheath) {
      return definition.sheath->length + definition.sheath->friction * definition.sheath->bend;
    }
    if (definition.geodesic) return definition.geodesic->surface.reach();
    return definition.perimeter();
  }
  const auto candidate =
      std::find_if(cable.candidates.begin(), cable.candidates.end(),
                   [&](const WrapCandidate& known) { return known.body == body; });
  return candidate != cable.candidates.end() ? candidate->reach : 0.0;
}

std::string CableTransfer::size_fault(const CompiledCable& cable, int link,
                                      const RunningLink& running) const {
  if (!running.size || !running.is_on_course()) return {};
  if (size_of(cable, link, running.body) == *running.size) return {};
  return "cable \"" + cable.name + "\" lies on link " + std::to_string(link - cable.first_link) +
         ", which would have another size; remove the link before the change and insert it again";
}

void CableTransfer::put_link(int cable, int link, const RunningLink& running, FeatureState& own) {
  const CompiledCable& compiled = system_.cables_[at(cable)];
  const int index = compiled.first_link + link;
  own.reals[system_.stored_length_index(index)] = running.stored_length;
  own.reals[system_.slip_index(index)] = running.slipped;
  own.reals[system_.angle_index(index)] = running.angle;
  if (const int bearing = system_.bearing_of(index); bearing >= 0) {
    own.reals[system_.bearing_index(bearing)] = running.bearing_torque;
  }
  own.integers[CableSystem::slip_state_index(index)] = running.slip;
  own.integers[system_.mode_index(index)] = running.mode;
  if (system_.driven_) own.integers[system_.stall_index(index)] = running.stall;
  const int place = system_.strain_places_[at(index)];
  if (place >= 0 && !running.strain.empty()) {
    std::copy(running.strain.begin(), running.strain.end(),
              own.reals.begin() + static_cast<std::ptrdiff_t>(system_.strain_index(place)));
  } else if (place >= 0 && running.is_fresh) {
    system_.fit_strain(index, StoredStrain::End::outgoing, running.stored_strain, own);
  }
  if (const int sheath = system_.sheath_places_[at(index)];
      sheath >= 0 && !running.strain.empty()) {
    std::copy(running.strain.begin(), running.strain.end(),
              own.reals.begin() + static_cast<std::ptrdiff_t>(system_.sheath_index(at(sheath))));
  }
  if (running.is_wrap()) {
    const auto candidate =
        std::find_if(compiled.candidates.begin(), compiled.candidates.end(),
                     [&](const WrapCandidate& c) { return c.body == running.body; });
    const auto number = candidate - compiled.candidates.begin() + 1;
    own.integers[system_.wrap_index(index)] = running.winding * static_cast<std::int64_t>(number);
  }
  // A new surface link has no geodesic in `running`; the compiler has found its geodesic.
  const bool laid = std::any_of(running.plane.begin(), running.plane.end(),
                                [](double number) { return number != 0.0; });
  if (const int plane = compiled.planes[at(link)]; plane >= 0 && laid) {
    std::copy(running.plane.begin(), running.plane.end(),
              own.reals.begin() + static_cast<std::ptrdiff_t>(system_.plane_index(plane)));
  }
  if (link >= compiled.span_count) return;
  const int span = compiled.first_span + link;
  const RunningSpan there = running.span.value_or(RunningSpan{});
  own.reals[system_.rest_length_index(span)] = there.rest_length;
  own.reals[system_.tension_index(span)] = there.tension;
  own.reals[system_.remainder_index(span, 0)] = there.remainder[0];
  own.reals[system_.remainder_index(span, 1)] = there.remainder[1];
  RopeMemories::put(system_, there.memory, span, own);
  FloorFriction::put(system_, there.laid, span, own);
}

namespace {

/// Moves the path by which a contact has moved from the span to the link.
void move_contact(double way, StoredStrain::End end, const CompiledCable& cable, RunningLink& link,
                  RunningSpan& span) {
  const double strain = cable.strain_under(span.tension);
  double length = way / (1.0 + strain);
  StoredStrain stored;
  if (!link.strain.empty()) {
    stored = StoredStrain(std::span<const double>(link.strain).first(StoredStrain::real_count));
    if (way < 0.0) length = -stored.rest_of(end, -way, strain);
  }
  length = cable.quantised(length);
  link.stored_length += length;
  span.rest_length -= length;
  if (link.strain.empty()) return;
  stored.fit(end, link.stored_length, strain, cable.strain_energy());
  stored.save(std::span<double>(link.strain).first(StoredStrain::real_count));
}

/// A link on the course of a running cable.
struct TransferStop {
  int number;         // of the link within the cable, and of the span behind it
  std::size_t place;  // index in the running cable
};

std::vector<TransferStop> stops_of(const RunningCable& running, int listed_links) {
  std::vector<TransferStop> course;
  int listed = 0;
  int wrap = listed_links;
  for (std::size_t i = 0; i < running.links.size(); ++i) {
    const RunningLink& link = running.links[i];
    const int number = link.is_listed() ? listed++ : wrap++;
    if (link.is_on_course()) course.push_back({number, i});
  }
  return course;
}

}  // namespace

void CableTransfer::move_contacts(int cable, RunningCable& running, const Substep& now) {
  system_.follow_state(now, system_.initial_);
  system_.settle_geodesics(now, system_.links_, system_.spans_);
  const CompiledCable& own = system_.cables_[at(cable)];
  const std::vector<TransferStop> course = stops_of(running, own.listed_links);
  const auto geometry_at = [&](const TransferStop& stop) -> const LinkGeometry& {
    return system_.links_[at(own.first_link + stop.number)];
  };
  const auto moved = [&](const TransferStop& stop, const SpanGeometry& was, const SpanGeometry& is,
                         StoredStrain::End end, RunningSpan& span) {
    const bool exits = end == StoredStrain::End::outgoing;
    const LinkGeometry& geometry = geometry_at(stop);
    const double way =
        geometry.side * contact_shift(now, geometry, was, is, exits) * (exits ? 1.0 : -1.0);
    move_contact(way, end, own, running.links[stop.place], span);
  };
  const std::size_t spans = course.empty() || own.closed ? course.size() : course.size() - 1;
  for (std::size_t i = 0; i < spans; ++i) {
    const TransferStop& first = course[i];
    const TransferStop& second = course[(i + 1) % course.size()];
    const auto left_by = running.links[first.place].went_by.lock();
    const auto met_by = running.links[second.place].came_by.lock();
    if (left_by == met_by) continue;  // the same span as before, or new links
    // New links have no length of their own yet; the link before them holds it.
    std::size_t holder = first.place;
    while (holder > 0 && running.links[holder].is_fresh) --holder;
    if (!running.links[holder].span) continue;
    RunningSpan& span = *running.links[holder].span;
    const SpanGeometry is = system_.geometry_of(now, own.first_span + first.number);
    if (!is.has_tangent) continue;
    if (left_by && geometry_at(first).wraps()) {
      moved(first, *left_by, is, StoredStrain::End::outgoing, span);
    }
    if (met_by && geometry_at(second).wraps()) {
      moved(second, *met_by, is, StoredStrain::End::incoming, span);
    }
  }
  // A geodesic depends on the positions of both neighbours. A new link gets its cable later
  // (cable/fresh_links.h).
  for (const TransferStop& stop : course) {
    RunningLink& link = running.links[stop.place];
    const auto& geodesic = geometry_at(stop).geodesic;
    if (!geodesic || !geodesic->settled || !link.span || link.is_fresh) continue;
    const double longer =
        geodesic->length - system_.stored_arc(system_.initial_, own.first_link + stop.number);
    constexpr double rounding = 1e-12;
    if (std::abs(longer) <= rounding * geometry_at(stop).perimeter()) continue;
    move_contact(longer, StoredStrain::End::outgoing, own, link, *link.span);
  }
  // The shorter way round may give a stored length below 0. A belt on one or two links cannot leave
  // its wheel, so the cable lies on it with one more turn.
  for (const TransferStop& stop : course) {
    RunningLink& link = running.links[stop.place];
    const LinkGeometry& geometry = geometry_at(stop);
    if (!own.closed || course.size() > 2 || !geometry.wraps() || !link.span) continue;
    if (link.stored_length >= 0.0) continue;
    move_contact(geometry.perimeter(), StoredStrain::End::outgoing, own, link, *link.span);
  }
  system_.knows_lengths_ = false;
}

std::string CableTransfer::put_cable(int cable, const RunningCable& running, FeatureState& own) {
  CompiledCable& compiled = system_.cables_[at(cable)];
  compiled.quantum = running.quantum;
  compiled.start_length = running.length();
  const std::string name = "cable \"" + compiled.name + "\"";
  int listed = 0;
  int wrap = compiled.listed_links;
  int first = -1;
  int before = -1;
  for (int i = 0; i < compiled.link_count; ++i) {
    own.integers[system_.next_index(compiled.first_link + i)] = -1;
    own.integers[system_.wrap_index(compiled.first_link + i)] = 0;
  }
  for (const RunningLink& link : running.links) {
    const bool known = link.is_listed() ||
                       std::any_of(compiled.candidates.begin(), compiled.candidates.end(),
                                   [&](const WrapCandidate& c) { return c.body == link.body; });
    if (!known) return name + " lies on a body that it could no longer wrap";
    if (!link.is_listed() && wrap >= compiled.link_count) {
      return name + " lies on more bodies than its most_wraps, " +
             std::to_string(compiled.link_count - compiled.listed_links) + ", would allow";
    }
    const int index = link.is_listed() ? listed++ : wrap++;
    std::string fault = size_fault(compiled, compiled.first_link + index, link);
    if (!fault.empty()) return fault;
    put_link(cable, index, link, own);
    if (system_.definitions_[at(compiled.first_link + index)].feeds)
      compiled.start_length -= link.slipped;
    if (link.is_listed() && link.mode >= RunningLink::lifted_mode) continue;
    if (before >= 0) own.integers[system_.next_index(compiled.first_link + before)] = index;
    if (first < 0) first = index;
    before = index;
  }
  if (compiled.closed) own.integers[system_.next_index(compiled.first_link + before)] = first;
  own.integers[system_.cut_index(cable)] = 0;
  if (running.is_cut) {
    CutPlace place{running.cut_span};
    const auto& span = running.links[running.place_of(running.cut_span)].span;
    // Behind a wrap of the world before, the cut moves to the end of the listed span.
    if (running.cut_at && span && span->rest_length > 0.0)
      place.share = *running.cut_at / span->rest_length;
    own.integers[system_.cut_index(cable)] = place.code();
  }
  return {};
}

bool CableTransfer::has_layout_of(int cable, const CableSystem& before, int then) const {
  const CompiledCable& a = system_.cables_[at(cable)];
  const CompiledCable& b = before.cables()[at(then)];
  return a.link_count == b.link_count && a.span_count == b.span_count &&
         std::equal(
             a.candidates.begin(), a.candidates.end(), b.candidates.begin(), b.candidates.end(),
             [](const WrapCandidate& c, const WrapCandidate& d) { return c.body == d.body; });
}

std::string CableTransfer::copy_cable(int cable, CableSystem& before, int then,
                                      const FeatureState& from, FeatureState& own) {
  CompiledCable& now = system_.cables_[at(cable)];
  now.quantum = before.cables()[at(then)].quantum;
  now.start_length = before.cables()[at(then)].start_length;
  const Controls none;
  for (int i = 0; i < now.link_count; ++i) {
    RunningLink link = CableTransfer(before).running_link(then, i, from, none);
    const int old_index = before.cables()[at(then)].first_link + i;
    const int index = now.first_link + i;
    std::string fault = size_fault(now, index, link);
    if (!fault.empty()) return fault;
    // Copies everything unchanged, wraps by their numbers.
    if (i < now.span_count) {
      const int span = before.cables()[at(then)].first_span + i;
      link.span = RunningSpan{from.reals[before.rest_length_index(span)],
                              from.reals[before.tension_index(span)],
                              {from.reals[before.remainder_index(span, 0)],
                               from.reals[before.remainder_index(span, 1)]},
                              RopeMemories::kept(before, from, span),
                              FloorFriction::kept(before, from, span)};
    }
    put_link(cable, i, link, own);
    own.integers[system_.next_index(index)] = from.integers[before.next_index(old_index)];
    own.integers[system_.wrap_index(index)] = from.integers[before.wrap_index(old_index)];
  }
  own.integers[system_.cut_index(cable)] = from.integers[before.cut_index(then)];
  return {};
}

LinkWays CableTransfer::ways_of(int cable) const {
  const CompiledCable& own = system_.cables_[at(cable)];
  const std::vector<double>& reals = system_.initial_.reals;
  LinkWays ways;
  for (int i = 0; i < own.listed_links; ++i) {
    const bool ends = !own.closed && i + 1 == own.listed_links;
    ways.arcs.push_back(reals[system_.stored_length_index(own.first_link + i)]);
    ways.spans.push_back(ends ? 0.0 : reals[system_.rest_length_index(own.first_span + i)]);
  }
  return ways;
}

std::string CableTransfer::put_changed(int cable, const RunningCable& changed, const Substep& now) {
  RunningCable running = changed;
  const bool any_fresh = std::any_of(running.links.begin(), running.links.end(),
                                     [](const RunningLink& link) { return link.is_fresh; });
  const LinkWays ways = any_fresh ? ways_of(cable) : LinkWays{};
  std::string fault = put_cable(cable, running, system_.initial_);
  if (!fault.empty()) return fault;
  move_contacts(cable, running, now);
  if (any_fresh) fault = share_with_fresh_links(system_.cables_[at(cable)], ways, running);
  if (fault.empty()) fault = put_cable(cable, running, system_.initial_);
  return fault;
}

Errors CableTransfer::continue_from(const TransferFrom& from, const Substep* now,
                                    std::span<const CableStart> starts) {
  Errors errors;
  CableSystem* const before = from.system;
  for (std::size_t c = 0; c < starts.size(); ++c) {
    const auto cable = static_cast<int>(c);
    const CableStart& start = starts[c];
    std::string fault;
    if (start.running != nullptr) {
      fault = put_changed(cable, *start.running, *now);
    } else if (start.same_as >= 0 && has_layout_of(cable, *before, start.same_as)) {
      fault = copy_cable(cable, *before, start.same_as, *from.state, system_.initial_);
    } else if (start.same_as >= 0) {
      // A body that the cable can touch was added or removed.
      CableDef listed;
      listed.links.assign(at(system_.cables_[c].listed_links),
                          std::make_shared<const AttachmentLink>());
      RunningCable running =
          CableTransfer(*before).running_cable(start.same_as, listed, *from.state, Controls{});
      fault = put_cable(cable, running, system_.initial_);
      system_.cables_[c].start_length = before->cables()[at(start.same_as)].start_length;
    }
    if (!fault.empty()) errors.push_back({"/cables/" + std::to_string(c), std::move(fault)});
  }
  return errors;
}

double CableTransfer::missing_length(const Substep& now, const FeatureState& own, int cable) const {
  double most = 0.0;
  system_.for_each_run(system_.cables_[at(cable)], [&](CableSystem::Run run) {
    double missing = 0.0;
    int k = run.first;
    for (int i = 0; i < run.count; ++i, k = system_.next_span(system_.cables_[at(cable)], k)) {
      missing += system_.geometry_of(now, k).length - own.reals[system_.rest_length_index(k)];
    }
    most = std::max(most, missing);
  });
  return most;
}

std::string CableTransfer::start_fault(const Substep& now, int cable, double allowed) {
  system_.follow_state(now, system_.initial_);
  const double excess = missing_length(now, system_.initial_, cable);
  system_.knows_lengths_ = false;
  const CompiledCable& own = system_.cables_[at(cable)];
  const std::string name = "cable \"" + own.name + "\"";
  const bool rigid = own.compliance == 0.0 && own.inverse_stiffness == 0.0;
  const double slop = 1e-9 * now.bodies.scale();
  if (rigid && excess > allowed + slop) {
    return name + " is " + number_text(excess - allowed) + " m too short for that, and it is rigid";
  }
  for (int k = own.first_span; k < own.first_span + own.span_count; ++k) {
    if (!system_.spans_[at(k)].active) continue;
    const std::string span = " at its span " + std::to_string(k - own.first_span);
    const SpanSetup& setup = system_.spans_[at(k)];
    if (!(system_.initial_.reals[system_.rest_length_index(k)] >= 0.0))
      return name + " would need a negative rest length" + span;
    if (!system_.geometry_of(now, k).has_tangent) return name + " would run through a wheel" + span;
    const LinkGeometry& a = system_.links_[at(setup.first)];
    const LinkGeometry& b = system_.links_[at(setup.second)];
    const bool idle = a.body == b.body && !a.wraps() && !b.wraps() && !a.passes() && !b.passes() &&
                      !a.sheath && !b.sheath;
    if (on_one_outline(a, b)) return name + " would run over one body twice in a row" + span;
    if (idle) return name + " would join two points of one body" + span;
  }
  return {};
}

}  // namespace sheave
