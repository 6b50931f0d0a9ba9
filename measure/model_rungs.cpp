// The registry of the model ladder: one line per rung, in the order of reports.

#include <vector>

#include "measure/model_rung.h"
#include "measure/rungs/field_rung.h"
#include "measure/rungs/massless_wheels.h"
#include "measure/rungs/mobility_rungs.h"

namespace sheave::measure {
namespace {

/// Sets the update of all cables; returns the number of changed ones.
int set_tangents(Scene& scene, TangentUpdate update) {
  int count = 0;
  for (CableDef& cable : scene.cables) {
    count += cable.tangent_update != update ? 1 : 0;
    cable.tangent_update = update;
  }
  return count;
}

int remove_colliders(Scene& scene) {
  const auto count = static_cast<int>(scene.model.colliders.size());
  scene.model.colliders.clear();
  return count;
}

int remove_ground(Scene& scene) {
  const int count = scene.model.ground ? 1 : 0;
  scene.model.ground.reset();
  return count;
}

/// Damping of a rod or string acts only if it is elastic, so both are reset together.
int make_joints_rigid(Scene& scene) {
  const int count = reset_joints(scene, {"compliance"});
  for (auto& joint : scene.model.joints) {
    if (count == 0 || joint->type() != "distance") continue;
    Scene one;
    one.model.joints = {joint};
    if (reset_joints(one, {"damping"}) > 0) joint = one.model.joints.front();
  }
  return count;
}

}  // namespace

std::span<const ModelRung> model_rungs() {
  using S = Scene;
  static const std::vector<ModelRung> rungs{
      // clang-format off
      {"massless wheels", "wheels", "no inertia about the axle", make_wheels_massless},
      {"rigid cables", "cables", "neither compliance nor damping", [](S& s) { return reset_cables(s, {"compliance", "axial_stiffness", "strain_table", "tension_table", "unloading_stiffness", "unloading_table", "transition_strain", "damping", "axial_damping"}); }},
      {"undamped cables", "cables", "no damping", [](S& s) { return reset_cables(s, {"damping", "axial_damping"}); }},
      {"wheels without slip", "links", "no capstan friction: the cable rolls", [](S& s) { return reset_links(s, "rolling", {"friction"}); }},
      {"smooth pinholes", "links", "no friction", [](S& s) { return reset_links(s, "pinhole", {"friction"}); }},
      {"tangents per substep", "cables", "tangents follow the bodies once per substep", [](S& s) { return set_tangents(s, TangentUpdate::substep); }},
      {"tangents per iteration", "cables", "tangents follow the bodies in every iteration", [](S& s) { return set_tangents(s, TangentUpdate::iteration); }},
      {"drums without layers", "links", "a radius that does not grow, and no groove", [](S& s) { return reset_links(s, "spool", {"layer_pitch", "lead", "turns_per_layer", "layer_height", "layers", "groove_start", "most_fleet_angle"}); }},
      {"no obstacles", "bodies", "cables go through wrappable bodies", [](S& s) { return reset_bodies(s, {"wrappable"}); }},
      {"smooth obstacles", "cables", "no friction on wrappable bodies", [](S& s) { return reset_cables(s, {"wrap_friction"}); }},
      {"no drag", "bodies", "no damping of bodies and bearings", [](S& s) { return reset_bodies(s, {"damping"}); }},
      {"rigid joints", "joints", "no compliance", make_joints_rigid},
      {"undamped joints", "joints", "no damping", [](S& s) { return reset_joints(s, {"damping"}); }},
      {"joints without friction", "joints", "no dry friction", [](S& s) { return reset_joints(s, {"friction"}); }},
      {"joints without stops", "joints", "coordinates end nowhere", [](S& s) { return reset_joints(s, {"lower", "upper", "swing_limit"}); }},
      {"no contacts", "colliders", "bodies go through each other", remove_colliders},
      {"smooth contacts", "colliders", "no friction", [](S& s) { return reset_colliders(s, {"friction"}); }},
      {"rigid contacts", "colliders", "no compliance", [](S& s) { return reset_colliders(s, {"compliance"}); }},
      {"contacts without bounce", "colliders", "no restitution", [](S& s) { return reset_colliders(s, {"restitution"}); }},
      {"no ground", "grounds", "nothing to fall on", remove_ground},
      {"rotors as bodies with hinges", "rotors", "six degrees of freedom and a joint", hinge_rotors},
      {"sliders as bodies on rails", "bodies", "six degrees of freedom and a joint", join_sliders},
      {"free bodies in a plane", "bodies", "three degrees of freedom instead of six", confine_to_plane},
      {"planar bodies in space", "bodies", "six degrees of freedom instead of three", free_from_plane},
      // clang-format on
  };
  return rungs;
}

}  // namespace sheave::measure
