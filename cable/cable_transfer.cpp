#include "cable/cable_transfer.h"

#include <algorithm>
#include <cmath>

#include "cable/links/attachment.h"
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
  running.slip = own.integers[CableSystem::slip_state_index(index)];
  running.mode = own.integers[system_.mode_index(index)];
  if (system_.driven_) running.stall = own.integers[system_.stall_index(index)];
  if (system_.strain_places_[at(index)] >= 0) {
    const auto first =
        own.reals.begin() +
        static_cast<std::ptrdiff_t>(system_.strain_index(system_.strain_places_[at(index)]));
    running.strain.assign(first, first + StoredStrain::real_count + 1);
  }
  if (const LinkControl* set = controls.links.find(index)) running.control = *set;
  if (const std::int64_t wrap = own.integers[system_.wrap_index(index)]; wrap != 0) {
    running.body = compiled.candidates[at(static_cast<int>(std::abs(wrap)) - 1)].body;
    running.winding = wrap > 0 ? 1 : -1;
    const auto first =
        own.reals.begin() + static_cast<std::ptrdiff_t>(system_.plane_index(
                                compiled.first_plane + link - compiled.listed_links));
    std::copy_n(first, running.plane.size(), running.plane.begin());
  }
  if (link < compiled.span_count && own.integers[system_.next_index(index)] >= 0) {
    const int span = compiled.first_span + link;
    running.span = RunningSpan{
        own.reals[system_.rest_length_index(span)],
        own.reals[system_.tension_index(span)],
        {own.reals[system_.remainder_index(span, 0)], own.reals[system_.remainder_index(span, 1)]}};
  }
  return running;
}

RunningCable CableTransfer::running_cable(int cable, const CableDef& definition,
                                          const FeatureState& own, const Controls& controls) const {
  const CompiledCable& compiled = system_.cables_[at(cable)];
  RunningCable running;
  running.quantum = compiled.quantum;
  if (const CableControl* set = controls.cables.find(cable)) running.control = *set;
  const std::int64_t cut = own.integers[system_.cut_index(cable)];
  running.is_cut = cut != 0;
  const auto next_of = [&](int link) {
    return static_cast<int>(own.integers[system_.next_index(compiled.first_link + link)]);
  };
  const auto append_wraps = [&](int first, int behind) {
    for (int link = first; link >= compiled.listed_links; link = next_of(link)) {
      if (cut == 1 + link) running.cut_span = behind;
      running.links.push_back(running_link(cable, link, own, controls));
      if (next_of(link) == first) break;
    }
  };
  bool touches_listed = false;
  for (int link = 0; link < compiled.listed_links; ++link) {
    running.links.push_back(running_link(cable, link, own, controls));
    running.links.back().link = definition.links[at(link)];
    if (cut == 1 + link) running.cut_span = link;
    const bool last = !compiled.closed && link + 1 == compiled.listed_links;
    touches_listed = touches_listed || last || next_of(link) >= 0;
    append_wraps(next_of(link), link);
  }
  if (touches_listed) return running;
  // A belt that has left all its listed links.
  for (int place = compiled.listed_links; place < compiled.link_count; ++place) {
    if (next_of(place) < 0) continue;
    append_wraps(place, 0);
    break;
  }
  return running;
}

void CableTransfer::put_link(int cable, int link, const RunningLink& running, FeatureState& own) {
  const CompiledCable& compiled = system_.cables_[at(cable)];
  const int index = compiled.first_link + link;
  own.reals[system_.stored_length_index(index)] = running.stored_length;
  own.reals[system_.slip_index(index)] = running.slipped;
  own.reals[system_.angle_index(index)] = running.angle;
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
  if (running.is_wrap()) {
    const auto candidate =
        std::find_if(compiled.candidates.begin(), compiled.candidates.end(),
                     [&](const WrapCandidate& c) { return c.body == running.body; });
    const auto number = candidate - compiled.candidates.begin() + 1;
    own.integers[system_.wrap_index(index)] = running.winding * static_cast<std::int64_t>(number);
    std::copy(running.plane.begin(), running.plane.end(),
              own.reals.begin() + static_cast<std::ptrdiff_t>(system_.plane_index(
                                      compiled.first_plane + link - compiled.listed_links)));
  }
  if (link >= compiled.span_count) return;
  const int span = compiled.first_span + link;
  const RunningSpan there = running.span.value_or(RunningSpan{});
  own.reals[system_.rest_length_index(span)] = there.rest_length;
  own.reals[system_.tension_index(span)] = there.tension;
  own.reals[system_.remainder_index(span, 0)] = there.remainder[0];
  own.reals[system_.remainder_index(span, 1)] = there.remainder[1];
}

std::string CableTransfer::share_with_fresh(int cable, RunningCable& running) const {
  const CompiledCable& compiled = system_.cables_[at(cable)];
  const auto length_at = [&](int listed) {  // as compiled, of spans and links where they are now
    return system_.initial_.reals[system_.rest_length_index(compiled.first_span + listed)];
  };
  const auto arc_at = [&](int listed) {
    return system_.initial_.reals[system_.stored_length_index(compiled.first_link + listed)];
  };
  const std::string name = "cable \"" + compiled.name + "\"";
  std::vector<RunningLink>& links = running.links;
  for (std::size_t place = 0, listed = 0; place < links.size(); ++place) {
    if (!links[place].is_listed()) continue;
    const auto first = static_cast<int>(listed++);
    std::size_t end = place + 1;
    while (end < links.size() && links[end].is_fresh) ++end;
    if (end == place + 1) continue;
    if (end < links.size() && links[end].is_wrap()) {
      return name + " lies on another body behind its span " + std::to_string(first) +
             "; a link can be inserted where it does not";
    }
    const auto fresh = static_cast<int>(end - place) - 1;
    double spans = length_at(first);
    double arcs = 0.0;
    for (int i = 1; i <= fresh; ++i) {
      spans += length_at(first + i);
      arcs += arc_at(first + i);
    }
    const double whole = links[place].span->rest_length;
    // A material is strained on the links, too.
    const bool strained = compiled.inverse_stiffness > 0.0 && whole < spans + arcs;
    const double on_links = strained ? whole / (spans + arcs) : 1.0;
    double left = whole;
    for (int i = 1; i <= fresh; ++i) {
      RunningLink& link = links[place + at(i)];
      link.stored_length = CompiledCable::quantised(on_links * arc_at(first + i), running.quantum,
                                                    1.0 / running.quantum);
      link.stored_strain = strained ? 1.0 / on_links - 1.0 : 0.0;
      left -= link.stored_length;
    }
    if (!(left > 0.0) || !(spans > 0.0)) {
      return name + " has " + number_text(whole) + " m in its span " + std::to_string(first) +
             ", too little to lie on that";
    }
    const double share = left / spans;
    for (int i = 0; i < fresh; ++i) {
      double& rest_length = links[place + at(i)].span->rest_length;
      rest_length = CompiledCable::quantised(share * length_at(first + i), running.quantum,
                                             1.0 / running.quantum);
      left -= rest_length;
    }
    links[end - 1].span->rest_length = left;
  }
  return {};
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
    if (!known) return name + " lies on a body that it could not lie on then";
    if (!link.is_listed() && wrap >= compiled.link_count) {
      return name + " lies on more bodies than its most_wraps, " +
             std::to_string(compiled.link_count - compiled.listed_links) + ", would allow";
    }
    const int index = link.is_listed() ? listed++ : wrap++;
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
  if (running.is_cut) own.integers[system_.cut_index(cable)] = 1 + running.cut_span;
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

void CableTransfer::copy_cable(int cable, CableSystem& before, int then, const FeatureState& from,
                               FeatureState& own) {
  CompiledCable& now = system_.cables_[at(cable)];
  now.quantum = before.cables()[at(then)].quantum;
  now.start_length = before.cables()[at(then)].start_length;
  const Controls none;
  for (int i = 0; i < now.link_count; ++i) {
    RunningLink link = CableTransfer(before).running_link(then, i, from, none);
    const int old_index = before.cables()[at(then)].first_link + i;
    const int index = now.first_link + i;
    // All of it as it is, wraps by their numbers.
    if (i < now.span_count) {
      const int span = before.cables()[at(then)].first_span + i;
      link.span = RunningSpan{from.reals[before.rest_length_index(span)],
                              from.reals[before.tension_index(span)],
                              {from.reals[before.remainder_index(span, 0)],
                               from.reals[before.remainder_index(span, 1)]}};
    }
    put_link(cable, i, link, own);
    own.integers[system_.next_index(index)] = from.integers[before.next_index(old_index)];
    own.integers[system_.wrap_index(index)] = from.integers[before.wrap_index(old_index)];
  }
  own.integers[system_.cut_index(cable)] = from.integers[before.cut_index(then)];
}

Errors CableTransfer::continue_from(CableSystem* before, const FeatureState* from,
                                    std::span<const CableStart> starts) {
  Errors errors;
  for (std::size_t c = 0; c < starts.size(); ++c) {
    const auto cable = static_cast<int>(c);
    const CableStart& start = starts[c];
    std::string fault;
    if (start.running != nullptr) {
      RunningCable running = *start.running;
      fault = share_with_fresh(cable, running);
      if (fault.empty()) fault = put_cable(cable, running, system_.initial_);
    } else if (start.same_as >= 0 && has_layout_of(cable, *before, start.same_as)) {
      copy_cable(cable, *before, start.same_as, *from, system_.initial_);
    } else if (start.same_as >= 0) {
      // A body has come or gone that it could touch.
      CableDef listed;
      listed.links.assign(at(system_.cables_[c].listed_links),
                          std::make_shared<const AttachmentLink>());
      RunningCable running =
          CableTransfer(*before).running_cable(start.same_as, listed, *from, Controls{});
      fault = put_cable(cable, running, system_.initial_);
      system_.cables_[c].start_length = before->cables()[at(start.same_as)].start_length;
    }
    if (!fault.empty()) errors.push_back({"/cables/" + std::to_string(c), std::move(fault)});
  }
  return errors;
}

double CableTransfer::missing_length(const Substep& now, const FeatureState& own, int cable) {
  system_.follow_state(now, own);
  double most = 0.0;
  system_.for_each_run(system_.cables_[at(cable)], [&](CableSystem::Run run) {
    double missing = 0.0;
    int k = run.first;
    for (int i = 0; i < run.count; ++i, k = system_.next_span(system_.cables_[at(cable)], k)) {
      missing += system_.geometry_of(now, k).length - own.reals[system_.rest_length_index(k)];
    }
    most = std::max(most, missing);
  });
  system_.knows_lengths_ = false;
  return most;
}

std::string CableTransfer::start_fault(const Substep& now, int cable, double allowed) {
  const double excess = missing_length(now, system_.initial_, cable);
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
      return name + " has not so much to give" + span;
    if (!system_.geometry_of(now, k).has_tangent) return name + " would run through a wheel" + span;
    const LinkGeometry& a = system_.links_[at(setup.first)];
    const LinkGeometry& b = system_.links_[at(setup.second)];
    const bool idle = a.body == b.body && !a.wraps() && !b.wraps() && !a.passes() && !b.passes();
    if (on_one_outline(a, b)) return name + " would run over one body twice in a row" + span;
    if (idle) return name + " would join two points of one body" + span;
  }
  return {};
}

}  // namespace sheave
