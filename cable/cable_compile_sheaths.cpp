// Ropes in sheaths at time 0: the links that they can have, and the tension in each sheath.

#include <algorithm>
#include <cmath>

#include "cable/cable_compiler.h"
#include "cable/sheaths.h"
#include "engine/field_check.h"
#include "engine/index.h"
#include "engine/math/portable.h"

namespace sheave {

bool CableCompiler::has_sheath() const {
  return std::any_of(links_.begin(), links_.end(),
                     [](const LinkGeometry& link) { return link.sheath != nullptr; });
}

void CableCompiler::check_sheaths(const CableDef& def) {
  if (!has_sheath()) return;
  if (!def.axial_stiffness) {
    fail("/axial_stiffness",
         "a cable in a sheath needs \"axial_stiffness\" [N], because its stretch in the sheath "
         "follows from it; 1e11 Pa times the section of the wires suits a steel rope");
  }
  if (def.linear_density > 0.0) {
    fail("/linear_density", "a rope with weight cannot run through a sheath; leave it out");
  }
  if (def.is_damped()) {
    fail(def.damping > 0.0 ? "/damping" : "/axial_damping",
         "the spans of a cable in a sheath have no dampers, since the friction of the sheath damps "
         "the cable; leave the damper out");
  }
  if (def.closed) fail("/closed", "a closed cable cannot run through a sheath; cut it open");
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const LinkGeometry& link = links_[i];
    const std::string field = "/links/" + std::to_string(i);
    const bool end = i == 0 || i + 1 == links_.size();
    if (end && link.sheath)
      fail(field, "a cable cannot end in a sheath; attach it behind the sheath");
    if (link.sheath) {
      check_reach(link, field);
      continue;
    }
    if (link.passes() || link.geodesic) {
      fail(field, link_name(static_cast<int>(i)) +
                      ": a cable that runs through a sheath can have links of the types "
                      "\"attachment\", \"sheath\", \"spool\" and \"hybrid\", and \"rolling\" "
                      "without friction on "
                      "wheels with inertia; for a hole use a short \"sheath\" with the bend 0");
    }
  }
}

void CableCompiler::check_reach(const LinkGeometry& link, const std::string& field) {
  if (link.exit_body() == link.body) return;
  const double apart = Sheaths::reach(*now_, link);
  constexpr double rounding = 1e-9;
  if (apart <= link.sheath->length * (1.0 + rounding)) return;
  fail(field + "/length", "the sheath is " + number_text(link.sheath->length) +
                              " m long, and its ends are " + number_text(apart) +
                              " m apart at time 0; give a length of at least that distance");
}

double CableCompiler::start_in_sheath(const CableDef& def, int link) {
  const SheathCurve& curve = *links_[at(link)].sheath;
  const int index = static_cast<int>(system_->links_.size()) + link;
  if (!def.axial_stiffness) return curve.length;
  const SheathLaw law{curve.length, curve.friction * curve.bend, 1.0 / *def.axial_stiffness};
  const auto tension = [&](int span) {
    if (given_lengths_.empty()) return 0.0;
    const double strain = geometry_[at(span)].length / given_lengths_[at(span)] - 1.0;
    // The rounding of the length of a span that is just taut counts as no strain.
    constexpr double rounding = 1e-13;
    return strain > rounding ? strain * *def.axial_stiffness : 0.0;
  };
  const double before = tension(link - 1);
  const double behind = tension(link);
  start_sheaths_[index] = SheathProfile(before, behind);
  constexpr double least = 1e-9;  // of the ratio of the tensions, by the rounding of lengths
  const double most = std::max(before, behind);
  const double held = std::min(before, behind) * portable::exp(law.exponent);
  if (!runs_ && most > held * (1.0 + least) + least * *def.axial_stiffness) {
    fail("/rest_lengths", "at time 0 the spans beside " + link_name(link) + " have tensions of " +
                              number_text(before) + " N and " + number_text(behind) +
                              " N, and the friction of the sheath holds at most the ratio " +
                              number_text(portable::exp(law.exponent)) +
                              "; change rest_lengths, or give one pretension");
  }
  return curve.length - start_sheaths_[index].stretch(law);
}

void CableCompiler::make_sheaths() {
  CableSystem& s = *system_;
  s.sheath_places_.assign(s.links_.size(), -1);
  for (const CompiledCable& cable : s.cables_) {
    for (int i = cable.first_link; i < cable.first_link + cable.listed_links; ++i) {
      const auto& curve = s.links_[at(i)].sheath;
      if (!curve) continue;
      s.sheath_places_[at(i)] = static_cast<int>(s.sheaths_.size());
      cable_parts::SheathWork& sheath = s.sheaths_.emplace_back();
      sheath.link = i;
      sheath.law = {curve->length, curve->friction * curve->bend, cable.inverse_stiffness};
    }
  }
  s.notes_.torn_sheaths.resize(s.sheaths_.size());
  s.initial_.reals.resize(s.sheath_index(s.sheaths_.size()), 0.0);
  for (std::size_t i = 0; i < s.sheaths_.size(); ++i) {
    const auto found = start_sheaths_.find(s.sheaths_[i].link);
    if (found == start_sheaths_.end()) continue;
    found->second.save(
        std::span(s.initial_.reals).subspan(s.sheath_index(i), SheathProfile::real_count));
  }
}

}  // namespace sheave
