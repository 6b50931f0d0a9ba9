#pragma once
// The same machine with bodies that have more or fewer degrees of freedom of their own.
//
// A rotor on an axle has one coordinate, and so has a body on a rail; no constraint has to keep it
// in place. As a free body it has six, and a joint removes five of them by five rows in every
// iteration. Both are the same machine: the residual of the joint is the solver's error, and its
// time is the saving by the mobility.

#include "scenes/scene.h"

namespace sheave::measure {

/// Replaces each rotor with inertia, on a fixed axle or on its mount, by a free body with a hinge.
/// The motion is the same. On a fixed axle only the inertia about the axle counts, so if
/// `spin_inertia` replaces that of the shapes, the body gets it about all axes. A mounted rotor
/// keeps its own inertia perpendicular to the axle. A rotor is not replaced if its `spin_inertia` is
/// not possible for a physical body, or if its centre of mass is not at its frame's origin. A drive
/// becomes that of the hinge. Returns the number of replaced rotors.
[[nodiscard]] int hinge_rotors(Scene& scene);

/// Replaces each body with mobility slider by a free body with a slider joint to the world. A body
/// without shape and inertia gets a radius of gyration of 1 m, which has no effect because it does
/// not turn.
[[nodiscard]] int join_sliders(Scene& scene);

/// Restricts free bodies to the plane of the scene's first wheel with a cable, or to z = constant
/// if there is none.
[[nodiscard]] int confine_to_plane(Scene& scene);
/// Gives planar bodies all six degrees of freedom. Bodies stay in the plane if no force pushes them
/// out.
[[nodiscard]] int free_from_plane(Scene& scene);

}  // namespace sheave::measure
