#include <cmath>

#include "cable/cable_compiler.h"
#include "engine/field_check.h"
#include "engine/index.h"

namespace sheave {

void CableCompiler::compile_links(const CableDef& def) {
  links_.clear();
  for (std::size_t i = 0; i < def.links.size(); ++i) {
    const std::string field = "/links/" + std::to_string(i);
    const std::string path = path_ + field;
    const LinkDef& link = *def.links[i];
    const std::size_t before = errors_.size();
    if (!bodies_.contains(link.body)) {
      fail(field + "/body", "there is no body number " + std::to_string(link.body.index));
      continue;
    }
    // The fields of an unchanged running cable have been checked before.
    for (const auto& entry : link_types()) {
      if (same_) break;
      if (entry.name == link.type()) check_fields(entry.fields(), link.settings(), path, errors_);
    }
    if (errors_.size() > before) continue;
    const Result<LinkGeometry> compiled = link.compile(bodies_, path);
    if (!compiled) {
      errors_.insert(errors_.end(), compiled.errors().begin(), compiled.errors().end());
      continue;
    }
    links_.push_back(*compiled);
    LinkGeometry& placed = links_.back();
    placed.centered = !placed.opening && compiled->center.isZero(0.0);
    placed.still = compiled->carrier == bodies_.count();
    if (placed.is_layered()) {
      // The radius includes the cable wound at time 0; the definition keeps the bare drum.
      bare_radii_[static_cast<int>(system_->links_.size() + i)] = placed.signed_radius;
      wind_drum(placed, given_strain(def, i == 0));
    }
    const bool end = !def.closed && (i == 0 || i + 1 == def.links.size());
    check_stored_length(*compiled, end, field);
    check_passage(*compiled, end, field);
  }
}

double CableCompiler::given_strain(const CableDef& def, bool first) {
  if (!def.axial_stiffness) return 0.0;
  const double tension = def.pretension            ? *def.pretension
                         : def.pretensions.empty() ? 0.0
                         : first                   ? def.pretensions.front()
                                                   : def.pretensions.back();
  return tension / *def.axial_stiffness;
}

void CableCompiler::wind_drum(LinkGeometry& drum, double strain) {
  if (drum.groove) {
    return drum.wind_groove(drum.groove->angle(drum.given_stored_length * (1.0 + strain)));
  }
  const double bare = drum.signed_radius;
  drum.signed_radius =
      drum.side * std::sqrt(bare * bare + drum.layer_pitch * drum.given_stored_length / pi);
}

void CableCompiler::lift_links(const RunningCable& running) {
  std::size_t i = 0;
  for (const RunningLink& link : running.links) {
    if (link.is_listed()) links_[i++].starts_lifted = link.mode >= RunningLink::lifted_mode;
  }
}

void CableCompiler::keep_sides(const RunningCable& running) {
  std::size_t i = 0;
  for (const RunningLink& link : running.links) {
    if (!link.is_listed()) continue;
    LinkGeometry& own = links_[i++];
    // A new link has no side yet.
    if (!own.takes_shortest || link.winding == 0) continue;
    own.takes_shortest = false;
    if (own.side != link.winding) own.take_other_side();
  }
}

void CableCompiler::check_passage(const LinkGeometry& link, bool end, const std::string& field) {
  if (end && link.geodesic) {
    return fail(field,
                "a surface link lies between the ends of a cable; end the cable on a "
                "\"rolling\" link or an attachment");
  }
  if (end && link.slides) {
    const std::string hole = link.opening ? "an opening" : "a pinhole";
    fail(field, "a cable cannot end in " + hole + "; attach it");
  }
  if (end && link.wraps() && !std::isnan(link.friction)) {
    fail(field + "/friction", "a cable cannot slip at its end; leave friction out");
  }
  if (end && link.starts_lifted) {
    fail(field + "/lifted", "a cable cannot be off the wheel at its end");
  }
  if (link.starts_lifted && link.extra_turns > 0) {
    fail(field + "/turns", "a cable that is off the wheel has no turns on it");
  }
  if (!end && link.ends_here) {
    fail(field, "this link is for an end of an open cable; between its ends use \"rolling\"");
  }
  if (!end && link.feeds) {
    fail(field + "/feed_speed", "cable can be fed only at an end of an open cable");
  }
  check_massless(link, end, field);
}

void CableCompiler::check_massless(const LinkGeometry& link, bool end, const std::string& field) {
  if (!link.wraps() && bodies_[link.body].massless()) {
    fail(field + "/body", "nothing can be fixed to \"" + bodies_.name(link.body) +
                              "\", which has no spin inertia: it would turn without resistance");
  }
  if (end && (link.loss_exponent > 0.0 || link.bearing_arm > 0.0)) {
    fail(field + "/efficiency",
         "no cable passes the wheel at its end; leave efficiency, bending_loss and "
         "bearing_friction out");
  }
  if (!link.massless) return;
  const std::string& wheel = bodies_.name(link.touched());
  if (end) fail(field, "a cable cannot end on \"" + wheel + "\", which has no spin inertia");
  if (link.outline) fail(field, "the massless wheel \"" + wheel + "\" must be circular");
  if (!massless_wheels_.insert(link.touched()).second) {
    fail(field, "the massless wheel \"" + wheel +
                    "\" can carry only one cable once: the tensions of two would be undetermined");
  }
}

void CableCompiler::check_stored_length(const LinkGeometry& link, bool end,
                                        const std::string& field) {
  if (!link.wraps()) return;
  const bool given = !std::isnan(link.given_stored_length);
  if (end && !given) {
    fail(field, "a cable that ends on a wheel needs \"stored_length\", the cable wound on it");
  }
  if (!end && given && !link.ends_here) {
    fail(field + "/stored_length",
         "between the ends of a cable the stored length follows from the tangents; use \"turns\" "
         "for whole turns more");
  }
  if (end && link.extra_turns > 0) {
    fail(field + "/turns",
         "at the end of a cable \"stored_length\" contains the turns; leave turns out");
  }
}

std::string CableCompiler::link_name(int link) const {
  return "link " + std::to_string(link) + " on \"" + bodies_.name(links_[at(link)].touched()) +
         "\"";
}

}  // namespace sheave
