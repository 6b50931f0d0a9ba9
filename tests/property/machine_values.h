#pragma once
// Every number of a machine, by the field tables: to change units, or all of them by a little.

#include <functional>

#include "scenes/scaling.h"
#include "tests/property/random_machine.h"

namespace sheave::test {

/// Copies of what a machine shares with others, so that it can be changed.
[[nodiscard]] std::shared_ptr<JointDef> copy_of(const JointDef& joint);
[[nodiscard]] std::shared_ptr<LinkDef> copy_of(const LinkDef& link);
[[nodiscard]] std::shared_ptr<Shape> copy_of(const Shape& shape);

/// The machine with `change` applied to each number of each setting that has a unit. Numbers of
/// vectors one by one.
[[nodiscard]] Machine with_values(const Machine& machine,
                                  const std::function<double(double value, const UnitPowers& powers,
                                                             const Field& field)>& change);

/// Units in which a metre, a kilogram and a second of the machine have these values.
struct Units {
  double length = 1.0;
  double mass = 1.0;
  double time = 1.0;
  [[nodiscard]] double of(const UnitPowers& powers) const;
};
/// The same machine in other units.
[[nodiscard]] Machine in_units(const Machine& machine, const Units& units);

/// The machine with every number times its own random factor of 1 +- `size`; what is 0 stays so.
/// What must fit together still does: joints have their points in common, cables their rest lengths
/// by default.
[[nodiscard]] Machine perturbed(const Machine& machine, double size, std::uint64_t seed);

/// The machine turned about the origin and moved, with everything that stands in the world.
[[nodiscard]] Machine moved(const Machine& machine, const Quaternion& turn, const Vector3& way);

}  // namespace sheave::test
