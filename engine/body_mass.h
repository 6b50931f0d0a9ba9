#pragma once
// Mass, centre of mass and inertia of one body, as its definition gives them.

#include "engine/body.h"

namespace sheave {

/// In the body frame, without mounted rotors. Zeros where the definition has neither a mass nor a
/// density.
[[nodiscard]] MassProperties defined_mass_properties(const BodyDef& body);

/// The tensor of `inertia` and `products_of_inertia` [kg m2]; zeros without them.
[[nodiscard]] Matrix3 defined_inertia(const BodyDef& body);

}  // namespace sheave
