// Checks of the elasticity of a cable: constants, or a table of tensions (cable/tension_law.h).

#include <algorithm>

#include "cable/cable_compiler.h"
#include "cable/cable_system.h"
#include "cable/tension_law.h"
#include "engine/index.h"

namespace sheave {
namespace {

/// Why cable with a table cannot run over a link; empty if it can.
std::string law_link_fault(const LinkGeometry& link, bool damped) {
  if (link.rubs()) {
    return "cable with a tension_table slides over links without friction only; leave friction, "
           "passes and the losses of a massless wheel out, or give the wheel a spin inertia";
  }
  if (link.passes() && damped) {
    return "cable with a tension_table passes pinholes, posts and massless wheels without a damper "
           "only; leave damping and axial_damping out, or give the wheel a spin inertia";
  }
  if (link.layer_pitch > 0.0) {
    return "cable with a tension_table is wound in one layer; leave layer_pitch out";
  }
  if (link.groove) {
    return "cable with a tension_table is wound in one plane; leave lead and turns_per_layer out";
  }
  return {};
}

/// Why a rope that remembers its strain cannot run over a link; empty if it can. On a wheel that turns
/// the rope would keep the memory with which it came on.
std::string memory_link_fault(const LinkGeometry& link) {
  if (link.feeds) {
    return "rope with unloading_table or unloading_stiffness is not fed, because new rope has not "
           "been stretched; leave feed_speed out, or the memory of the rope";
  }
  if (!link.wraps() || link.slides_over()) return {};
  return "rope with unloading_table or unloading_stiffness runs over attachments, and over "
         "pinholes, "
         "posts and smooth bodies without friction; put a pinhole or a post in place of the wheel, "
         "or "
         "leave the memory of the rope out";
}

}  // namespace

void CableCompiler::check_elasticity(const CableDef& def) {
  if (def.compliance && def.axial_stiffness) {
    fail("/axial_stiffness", "compliance and axial_stiffness exclude each other");
  }
  if (def.damping > 0.0 && !def.is_elastic()) {
    fail("/damping",
         "damping acts on an elastic cable only; give compliance, axial_stiffness or "
         "tension_table");
  }
  if (def.axial_damping > 0.0 && !def.has_material()) {
    fail("/axial_damping",
         "the damping of a material acts on a cable with axial_stiffness or tension_table only; "
         "give one of them, or \"damping\" [N s/m] of each span");
  } else if (def.axial_damping > 0.0 && def.damping > 0.0) {
    fail("/axial_damping",
         "damping of each span and axial_damping of the material exclude each other");
  }
  compile_law(def);
}

void CableCompiler::compile_law(const CableDef& def) {
  law_ = nullptr;
  memory_ = nullptr;
  if (const auto fault = TensionLaw::fault_of(def)) return fail(fault->field, fault->message);
  if (def.has_memory()) {
    if (const auto fault = RopeMemory::fault_of(def)) return fail(fault->field, fault->message);
    memory_ = std::make_shared<const RopeMemory>(def);
  }
  if (def.tension_table.empty()) return;
  if (def.axial_stiffness || def.compliance) {
    fail("/tension_table", std::string("a table of tensions and ") +
                               (def.axial_stiffness ? "axial_stiffness" : "compliance") +
                               " exclude each other");
  }
  if (def.linear_density > 0.0) {
    fail("/linear_density",
         "a rope with weight has an axial_stiffness and no tension_table; leave one out");
  }
  if (def.tangent_update == TangentUpdate::substep) {
    fail("/tangent_update",
         "tangents of a cable with a tension_table follow the bodies; leave tangent_update out");
  }
  if (def.wrap_friction > 0.0) {
    fail("/wrap_friction",
         "cable with a tension_table slides over bodies without friction only; leave wrap_friction "
         "out");
  }
  law_ = std::make_shared<const TensionLaw>(def);
}

void CableCompiler::check_law_links(const CableDef& def) {
  for (std::size_t i = 0; i < links_.size(); ++i) {
    std::string fault;
    if (law_) fault = law_link_fault(links_[i], def.is_damped());
    if (fault.empty() && memory_) fault = memory_link_fault(links_[i]);
    if (fault.empty() && def.axial_damping > 0.0 && links_[i].slides_over() &&
        !links_[i].frictionless()) {
      fault =
          "cable with axial_damping slides over an arc without friction only; leave the friction "
          "out, "
          "or give \"damping\" [N s/m] of each span instead";
    }
    if (fault.empty()) continue;
    fail("/links/" + std::to_string(i), link_name(static_cast<int>(i)) + ": " + fault);
  }
}

void CableCompiler::make_memories() {
  CableSystem& s = *system_;
  s.sheaths_in_state = s.sheaths_.size();
  s.memory_places_.assign(s.spans_.size(), -1);
  int places = 0;
  for (const CompiledCable& cable : s.cables_) {
    if (!cable.memory) continue;
    for (int k = 0; k < cable.span_count; ++k) {
      s.memory_places_[at(cable.first_span + k)] = places++;
    }
  }
  s.memories_.assign(places > 0 ? s.spans_.size() : 0, {});
  s.memories_in_state = places;
  s.initial_.reals.resize(s.memory_index(places), 0.0);
}

void CableCompiler::check_law_wraps(const CompiledCable& cable) {
  const bool rubs = cable.axial_damping > 0.0 && cable.wrap_friction > 0.0;
  if (!(law_ && cable.is_damped()) && !rubs) return;
  const auto wrap =
      std::find_if(cable.candidates.begin(), cable.candidates.end(),
                   [](const WrapCandidate& candidate) { return candidate.listed < 0; });
  if (wrap == cable.candidates.end()) return;
  fail("/most_wraps",
       "cable with axial_damping and wrap_friction, or with a tension_table and a damper, cannot "
       "come "
       "to lie on the wrappable body \"" +
           bodies_.name(wrap->body) + "\"; give most_wraps 0, or leave the damper out");
}

}  // namespace sheave
