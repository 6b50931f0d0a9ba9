#pragma once
// The same machine with bodies that have more or fewer degrees of freedom of their own.
//
// A rotor on an axle is one coordinate, and so is a body on a rail: nothing has to keep it in
// place. As a full body it has six, and a joint whose five rows take five of them away again, in
// every iteration. Both are the same machine: what the joint leaves open is the solver's error, and
// the time it takes is what the mobility saves.

#include "scenes/scene.h"

namespace sheave::measure {

/// Makes a free body with a hinge of each rotor that has inertia, on a fixed axle or on its mount.
/// The motion is the same: on a fixed axle only the inertia about the axle counts, so where
/// `spin_inertia` replaces that of the shapes the body gets it about all axes. A mounted rotor
/// keeps its own across the axle; one whose `spin_inertia` leaves no physical body, or whose centre
/// of mass is not at its frame's origin, stays a rotor. A drive becomes that of the hinge. Returns
/// their number.
[[nodiscard]] int hinge_rotors(Scene& scene);

/// Makes a free body with a slider joint to the world of each body with mobility slider. Where it
/// has neither shape nor inertia it gets that of a radius of gyration of 1 m, about which it never
/// turns.
[[nodiscard]] int join_sliders(Scene& scene);

/// Confines free bodies to the plane of the scene's first wheel with a cable, or to z = constant if
/// there is none.
[[nodiscard]] int confine_to_plane(Scene& scene);
/// Gives planar bodies all six degrees of freedom; where nothing pushes them out of the plane they
/// stay in it.
[[nodiscard]] int free_from_plane(Scene& scene);

}  // namespace sheave::measure
