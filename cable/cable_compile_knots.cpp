// Cables that end at knots: the links and settings with which they can, and the knots of a world.

#include <array>

#include "cable/cable_compiler.h"
#include "cable/knots.h"
#include "engine/index.h"
#include "engine/number_text.h"

namespace sheave {

bool CableCompiler::on_knot(int link) const {
  const int body = links_[at(link)].body;
  return body < bodies_.count() && bodies_[body].mobility == Mobility::knot;
}

void CableCompiler::check_knots(const CableDef& def) {
  const auto count = static_cast<int>(links_.size());
  int knots = 0;
  for (int i = 0; i < count; ++i) {
    if (!on_knot(i)) continue;
    ++knots;
    const std::string field = "/links/" + std::to_string(i);
    const LinkGeometry& link = links_[at(i)];
    if (def.closed || (i > 0 && i + 1 < count)) {
      fail(field, link_name(i) +
                      " is a knot, and cables end at knots: make two cables of it, or take a body "
                      "with a mass");
    } else if (link.wraps() || link.passes() || link.sheath || link.opening) {
      fail(field,
           link_name(i) + " is a knot, which is a point: end the cable there by an attachment");
    } else if (!is_zero(link.center)) {
      fail(field + "/point", link_name(i) + " is a knot, which is a point; leave \"point\" out");
    } else if (link.feeds) {
      fail(field + "/feed_speed", "no cable comes out of a knot; feed the cable at its other end");
    }
  }
  if (knots == 0) return;
  if (knots > 1) {
    fail("/links",
         "the cable joins two knots, and between two knots a body with a mass is needed: "
         "give one of them mobility \"free\" and a mass of some grams");
  }
  check_knotted_settings(def);
  for (int i = 0; i < count; ++i) check_knotted_link(def, i);
}

void CableCompiler::check_knotted_settings(const CableDef& def) {
  const std::string remedy =
      " cannot end at a knot without mass; leave it out, or give the knot mobility \"free\" and a "
      "mass of some grams";
  const std::array<std::pair<bool, const char*>, 4> refused{{
      {def.linear_density > 0.0, "linear_density"},
      {def.damping > 0.0, "damping"},
      {def.axial_damping > 0.0, "axial_damping"},
      {!def.tension_table.empty(), "tension_table"},
  }};
  for (const auto& [given, name] : refused) {
    if (given) fail("/" + std::string(name), "a cable with " + std::string(name) + remedy);
  }
  if (def.tangent_update == TangentUpdate::substep) {
    fail("/tangent_update",
         "a cable with tangent_update \"substep\" cannot end at a knot without mass; take "
         "\"iteration\"");
  }
  if (def.most_wraps > 0 && any_wrappable()) {
    fail("/most_wraps",
         "a cable that ends at a knot without mass does not come to touch wrappable bodies; set "
         "most_wraps to 0");
  }
}

void CableCompiler::check_knotted_link(const CableDef& def, int i) {
  const LinkGeometry& link = links_[at(i)];
  const std::string field = "/links/" + std::to_string(i);
  const std::string knotted = link_name(i) + ": a cable that ends at a knot without mass ";
  if (link.geodesic || link.sheath || link.opening) {
    return fail(field, knotted +
                           "runs over wheels and through pinholes only, not over this link; give "
                           "the knot mobility \"free\" and a mass of some grams");
  }
  if (link.rubs() || link.bearing_arm > 0.0) {
    return fail(field, knotted +
                           "passes links without friction and losses; leave friction, efficiency, "
                           "bending_loss, bearing_friction and passes out");
  }
  if (def.is_elastic() && link.passes()) {
    fail(field, knotted +
                    "and slides over links must be rigid; leave axial_stiffness and compliance "
                    "out, or give the wheel a spin inertia");
  }
}

void CableCompiler::make_knots() {
  CableSystem& s = *system_;
  std::vector<std::vector<cable_parts::KnotEnd>> ends(at(bodies_.count()));
  for (std::size_t c = 0; c < s.cables_.size(); ++c) {
    CompiledCable& cable = s.cables_[c];
    for (const bool at_start : {true, false}) {
      const int link = at_start ? cable.first_link : cable.last_listed_link();
      const int body = s.links_[at(link)].body;
      if (cable.closed || body == bodies_.count()) continue;
      if (bodies_[body].mobility != Mobility::knot) continue;
      cable.knotted = true;
      ends[at(body)].push_back({static_cast<int>(c), at_start});
    }
  }
  std::vector<int> ropes;
  for (const auto& of_body : ends) ropes.push_back(static_cast<int>(of_body.size()));
  Knots::check_counts(bodies_, ropes, errors_);
  for (int i = 0; i < bodies_.count(); ++i) {
    if (ends[at(i)].empty()) continue;
    const auto rigid = [&](const cable_parts::KnotEnd& end) {
      return s.cables_[at(end.cable)].is_rigid();
    };
    const std::vector<cable_parts::KnotEnd>& own = ends[at(i)];
    for (const cable_parts::KnotEnd& end : own) {
      if (rigid(end) == rigid(own.front())) continue;
      errors_.push_back({"/cables/" + std::to_string(end.cable),
                         "knot \"" + bodies_.name(i) + "\": cable \"" +
                             s.cables_[at(own.front().cable)].name + "\" is " +
                             (rigid(own.front()) ? "rigid" : "elastic") + " and cable \"" +
                             s.cables_[at(end.cable)].name +
                             "\" is not; the cables of a knot are all rigid, or all elastic: give "
                             "each an axial_stiffness, or none"});
      break;
    }
    cable_parts::KnotWork& knot = s.knots_.emplace_back();
    knot.body = i;
    knot.ends = own;
    knot.index = static_cast<int>(s.multipliers_.size());
    int most_rows = 0;
    for (const cable_parts::KnotEnd& end : own) most_rows += s.cables_[at(end.cable)].span_count;
    s.multipliers_.resize(s.multipliers_.size() + at(most_rows), 0.0);
  }
  if (!s.knots_.empty()) s.knotted_.assign(s.spans_.size(), 0);
}

void CableCompiler::check_knot_places() {
  CableSystem& s = *system_;
  if (s.knots_.empty()) return;
  constexpr double no_time = 1e-9;  // [s], in which feeds feed nothing
  constexpr double rounding = 1e-6;
  Substep now(bodies_, state_, no_time, 1);
  s.begin(now, s.initial_);
  for (cable_parts::KnotWork& knot : s.knots_) {
    Knots(s).settle(now, knot);
    if (cable_parts::is_undetermined(knot)) {
      errors_.push_back(
          {"/bodies/" + std::to_string(knot.body), cable_parts::undetermined_text(bodies_, knot)});
    }
    const Vector3& point = now.moving[at(knot.body)].position;
    const double off = (point - now.moving[at(knot.body)].start_position).norm();
    // The first substep places a slack knot.
    if (!knot.place.taut || off <= rounding * bodies_.scale()) continue;
    const auto text = [](double value) { return std::string(number_text(value, 9)); };
    errors_.push_back({"/bodies/" + std::to_string(knot.body) + "/position",
                       "knot \"" + bodies_.name(knot.body) +
                           "\": the forces of its cables balance at [" + text(point.x()) + ", " +
                           text(point.y()) + ", " + text(point.z()) + "], " + text(off) +
                           " m from this position; give the knot that position, or its "
                           "cables other rest lengths or pretensions"});
  }
}

}  // namespace sheave
