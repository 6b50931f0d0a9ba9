#pragma once

#include "engine/joints/coordinate.h"
#include "tests/property/random_machine.h"
#include "tests/support/random.h"

namespace sheave::test {

/// What acts along a coordinate: springs, dampers, dry friction, stops, drives that may stall; all
/// of the size of some newtons (newton metres times `arm`) and `size` metres or radians.
[[nodiscard]] JointCoordinate random_coordinate(Random& random, double size, double arm);

/// A joint of any type between two bodies of the model; null if none fits. `flat`: in the plane z =
/// 0, with axes along z or in it.
[[nodiscard]] std::shared_ptr<JointDef> random_joint(Random& random, const Model& model, bool flat);

}  // namespace sheave::test
