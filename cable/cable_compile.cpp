#include <algorithm>

#include "cable/cable_compiler.h"
#include "engine/field_check.h"
#include "engine/index.h"

namespace sheave {

void CableCompiler::go_to(const BodyFrames& frames) {
  if (now_ && frames == frames_) return;
  frames_ = frames;
  state_ = bodies_.state_in(frames);
  now_.emplace(bodies_, state_, 1.0, 1);
}

void CableCompiler::add(const CableDef& def, const CableStart& start) {
  if (start.same_as >= 0 && before_ != nullptr) {
    take(start.same_as);
    return;
  }
  go_to(start.defined_in);
  same_ = start.same_as >= 0;
  runs_ = same_ || start.running != nullptr;
  path_ = "/cables/" + std::to_string(index_++);
  name_ = def.name;
  const std::size_t before = errors_.size();
  for (std::size_t i = 0; i < def.links.size(); ++i) {
    if (def.links[i] != nullptr) continue;
    fail("/links/" + std::to_string(i), "there is no link: the pointer is null");
  }
  if (errors_.size() > before) return;
  check_settings(def);
  compile_links(def);
  if (errors_.size() > before) return;
  if (start.running != nullptr) keep_sides(*start.running);
  if (start.running != nullptr) lift_links(*start.running);
  check_weight(def);
  check_inertia(def);
  check_floor(def);
  check_law_links(def);
  check_sheaths(def);
  check_openings(def);
  check_grooves(def);
  check_knots(def);
  choose_sides(def);
  if (errors_.size() > before) return;
  const auto lifted = std::count_if(links_.begin(), links_.end(),
                                    [](const LinkGeometry& link) { return link.starts_lifted; });
  if (static_cast<int>(links_.size()) - lifted < 2) {
    fail("/links", "a cable must touch at least 2 links at time 0");
    return;
  }
  compile_spans(def);
  if (errors_.size() > before) return;
  if (!runs_) check_windings(def);
  if (errors_.size() > before) return;
  store(def);
}

void CableCompiler::take(int then) {
  CableSystem& s = *system_;
  const CompiledCable& was = before_->cables_[at(then)];
  CompiledCable cable = was;
  const CableControl& defined = before_->defined_[at(then)];
  cable.compliance = defined.compliance;
  cable.breaking_tension = defined.breaking_tension;
  cable.wrap_friction = defined.wrap_friction;
  cable.added_length = 0.0;
  cable.first_link = static_cast<int>(s.links_.size());
  cable.first_span = static_cast<int>(s.spans_.size());
  number_planes(cable);
  for (int& link : cable.driven_links) link += cable.first_link - was.first_link;
  for (int& link : cable.grips) link += cable.first_link - was.first_link;
  for (int& link : cable.openings) link += cable.first_link - was.first_link;
  cable.course_changes = !cable.candidates.empty() || std::isfinite(cable.breaking_tension) ||
                         std::isfinite(cable.cut_time);
  path_ = "/cables/" + std::to_string(index_++);
  name_ = cable.name;
  for (int i = 0; i < cable.link_count; ++i) {
    LinkGeometry link = before_->definitions_[at(was.first_link + i)];
    cable.course_changes = cable.course_changes || link.lifts;
    const bool end = !cable.closed && (i == 0 || i + 1 == cable.listed_links);
    if (i < cable.listed_links) check_massless(link, end, "/links/" + std::to_string(i));
    if (link.is_layered()) {
      bare_radii_[static_cast<int>(s.links_.size())] = link.signed_radius;
      wind_drum(link, 0.0);
    }
    s.links_.push_back(link);
  }
  for (int k = 0; k < cable.span_count; ++k) {
    SpanSetup setup = before_->span_definitions_[at(was.first_span + k)];
    setup.cable = static_cast<int>(s.cables_.size());
    setup.first += cable.first_link - was.first_link;
    setup.second += cable.first_link - was.first_link;
    s.spans_.push_back(setup);
  }
  rest_lengths_.resize(s.spans_.size(), 0.0);
  remainders_.resize(s.spans_.size(), 0.0);
  stored_lengths_.resize(s.links_.size(), 0.0);
  start_strains_.resize(s.links_.size(), 0.0);
  next_links_.resize(s.links_.size(), -1);
  s.cables_.push_back(std::move(cable));
}

Result<std::unique_ptr<CableSystem>> CableCompiler::finish(bool fresh) {
  if (!errors_.empty()) return errors_;
  CableSystem& s = *system_;
  const std::size_t spans = s.spans_.size();
  const std::size_t links = s.links_.size();
  s.initial_.reals = rest_lengths_;
  s.initial_.reals.insert(s.initial_.reals.end(), stored_lengths_.begin(), stored_lengths_.end());
  s.spans_in_state = spans;
  s.links_in_state = links;
  s.cables_in_state = static_cast<int>(s.cables_.size());
  s.planes_in_state = planes_;
  s.initial_.reals.resize(s.plane_index(planes_), 0.0);
  for (const CompiledCable& cable : s.cables_) {
    for (int i = 0; i < cable.listed_links; ++i) {
      if (cable.planes[at(i)] < 0) continue;
      const GeodesicLink& geodesic = *s.links_[at(cable.first_link + i)].geodesic;
      s.put_plane(cable.planes[at(i)], start_of(geodesic), s.initial_);
    }
  }
  for (std::size_t k = 0; k < remainders_.size(); ++k) {
    s.initial_.reals[s.remainder_index(static_cast<int>(k), 0)] = remainders_[k];
  }
  s.initial_.integers.assign(s.cut_index(static_cast<int>(s.cables_.size())), 0);
  s.driven_ = std::any_of(s.cables_.begin(), s.cables_.end(),
                          [](const CompiledCable& cable) { return !cable.driven_links.empty(); });
  if (s.driven_) s.initial_.integers.resize(s.initial_.integers.size() + links, 0);
  for (std::size_t i = 0; i < links; ++i) {
    const auto link = static_cast<int>(i);
    s.initial_.integers[s.next_index(link)] = next_links_[i];
    if (s.links_[i].starts_lifted) {
      s.initial_.integers[s.mode_index(link)] = RunningLink::lifted_mode;
    }
    if (s.links_[i].changes()) s.changing_links_.push_back(link);
    s.has_layers_ = s.has_layers_ || s.links_[i].is_layered();
  }
  s.definitions_ = s.links_;
  for (const auto& [link, radius] : bare_radii_) s.definitions_[at(link)].signed_radius = radius;
  s.span_definitions_ = s.spans_;
  for (const CompiledCable& cable : s.cables_) {
    s.defined_.push_back({cable.compliance, cable.breaking_tension, cable.wrap_friction, 0.0});
  }
  s.course_changes_ = std::any_of(s.cables_.begin(), s.cables_.end(),
                                  [](const CompiledCable& cable) { return cable.course_changes; });
  make_room();
  make_knots();
  store_strains();
  make_sheaths();
  make_memories();
  make_floors(fresh);
  if (fresh && errors_.empty()) check_knot_places();
  if (!errors_.empty()) return errors_;
  return std::move(system_);
}

void CableCompiler::make_room() {
  CableSystem& s = *system_;
  const std::size_t spans = s.spans_.size();
  const std::size_t links = s.links_.size();
  s.references_.resize(spans);
  s.strains_.resize(spans);
  s.end_strains_.assign(spans, -1.0);
  s.bearing_places_.assign(links, -1);
  for (std::size_t i = 0; i < links; ++i) {
    if (!(s.definitions_[i].bearing_arm > 0.0)) continue;
    s.bearing_places_[i] = static_cast<int>(s.bearings_.size());
    cable_parts::Bearing& bearing = s.bearings_.emplace_back();
    bearing.link = static_cast<int>(i);
    bearing.rotor = s.definitions_[i].body;
  }
  s.weighs_ = std::any_of(s.cables_.begin(), s.cables_.end(),
                          [](const CompiledCable& c) { return c.linear_density > 0.0; });
  s.multipliers_.resize(spans + s.bearings_.size() + (s.weighs_ ? spans : 0));
  s.hanging_.resize(spans);
  s.start_values_.resize(spans);
  s.run_work_.means.resize(s.links_.size());
  s.start_tensions_.resize(spans);
  s.given_.pulls.resize(spans);
  s.is_affine_.resize(spans);
  s.ends_.resize(spans);
  s.run_work_.rest_lengths.resize(spans);
  s.start_spans_.resize(spans);
  s.start_exponents_.resize(links);
  s.notes_.fallbacks.resize(spans);
  s.sides_.resize(spans);
  s.faces_.resize(links);
  s.fed_.resize(spans);
  s.drive_work_.feed_shares.resize(spans);
  s.drive_work_.feed_rates.resize(spans);
  s.drive_work_.stalled.resize(links);
  s.drive_work_.locked.resize(links);
  s.drive_work_.slid.resize(links);
  s.notes_.stalls.resize(links);
  s.notes_.besides.resize(links);
  s.notes_.slides_at.resize(links);
  s.slip_.assign(links, 0);
  s.held_.assign(links, 0);
  s.pending_slip_ = s.flips_ = s.slip_;
  s.sweeps_.assign(s.cables_.size(), 0);
  s.notes_.crowded.resize(s.cables_.size());
  s.notes_.leans.resize(s.cables_.size());
  s.notes_.off_ends.resize(s.cables_.size());
  s.notes_.hollows.resize(s.cables_.size());
  if (s.has_layers_) s.notes_.fleets.resize(links);
  s.notes_.edition = 1;
  s.stored_arcs_.resize(links);
  s.geodesic_starts_.resize(links);
}

void CableCompiler::store_strains() {
  CableSystem& s = *system_;
  s.strain_places_.assign(s.links_.size(), -1);
  int places = 0;
  for (const CompiledCable& cable : s.cables_) {
    if (cable.inverse_stiffness == 0.0) continue;
    for (int i = cable.first_link; i < cable.first_link + cable.link_count; ++i) {
      const bool place_for_wrap = i >= cable.first_link + cable.listed_links;
      if (place_for_wrap || s.links_[at(i)].wraps()) s.strain_places_[at(i)] = places++;
    }
  }
  s.stored_.resize(at(places));
  s.strains_in_state = places;
  s.bearings_in_state = static_cast<int>(s.bearings_.size());
  s.initial_.reals.resize(s.sheath_index(0), 0.0);
  for (std::size_t i = 0; i < s.links_.size(); ++i) {
    s.fit_strain(static_cast<int>(i), StoredStrain::End::outgoing, start_strains_[i], s.initial_);
  }
}

void CableCompiler::fail(const std::string& field, const std::string& message) {
  Error error{path_ + field, "cable \"" + name_ + "\": " + message};
  // Both spans beside a link may find the same fault.
  if (!errors_.empty() && errors_.back().path == error.path &&
      errors_.back().message == error.message) {
    return;
  }
  errors_.push_back(std::move(error));
}

void CableCompiler::check_settings(const CableDef& def) {
  if (!same_) check_fields(CableDef::field_table(), &def, path_, errors_);
  if (def.name.empty()) fail("/name", "a cable needs a name that is not empty");
  if (!names_.insert(def.name).second)
    fail("/name", "two cables have this name; names must differ");
  check_elasticity(def);
  if (def.linear_density > 0.0 && !def.has_material()) {
    fail("/linear_density",
         "a rope with weight needs \"axial_stiffness\" [N]: the force that would stretch it to "
         "twice its length, about 1e11 Pa times the section of the wires of a steel rope");
  }
  if (def.links.size() < 2) {
    fail("/links", "a cable needs at least 2 links; it has " + std::to_string(def.links.size()));
  }
  if (!def.rest_lengths.empty() && static_cast<int>(def.rest_lengths.size()) != def.span_count()) {
    fail("/rest_lengths", "one rest length per span is needed, " +
                              std::to_string(def.span_count()) + "; there are " +
                              std::to_string(def.rest_lengths.size()));
  }
  check_pretension(def);
}

void CableCompiler::check_pretension(const CableDef& def) {
  if (!def.pretension && def.pretensions.empty()) return;
  const std::string field = def.pretension ? "/pretension" : "/pretensions";
  if (def.pretension && !def.pretensions.empty()) {
    fail("/pretensions",
         "pretension is that of all spans and pretensions those of each; leave one "
         "out");
  }
  if (!def.rest_lengths.empty()) {
    fail(field, "the rest lengths follow from a pretension; leave rest_lengths out");
  }
  if (!def.pretensions.empty() && static_cast<int>(def.pretensions.size()) != def.span_count()) {
    fail("/pretensions", "one pretension per span is needed, " + std::to_string(def.span_count()) +
                             "; there are " + std::to_string(def.pretensions.size()));
  }
  if (!def.is_elastic()) {
    fail(field,
         "a rigid cable has no stretch that a pretension could follow from; give it an "
         "axial_stiffness, a tension_table or a compliance");
  }
  if (!def.breaking_tension) return;
  double most = def.pretension.value_or(0.0);
  for (const double tension : def.pretensions) most = std::max(most, tension);
  if (most < *def.breaking_tension) return;
  fail(field, "the pretension of " + number_text(most) + " N must be below the breaking tension, " +
                  number_text(*def.breaking_tension) + " N");
}

Result<std::unique_ptr<CableSystem>> CableSystem::create(const std::vector<CableDef>& cables,
                                                         const BodySet& bodies,
                                                         std::span<const CableStart> starts,
                                                         const CableSystem* before) {
  CableCompiler compiler(bodies, before);
  for (std::size_t c = 0; c < cables.size(); ++c) {
    compiler.add(cables[c], starts.empty() ? CableStart{} : starts[c]);
  }
  return compiler.finish(starts.empty());
}

}  // namespace sheave
