#pragma once
// OpenSim models of the tests, and texts of small ones.

#include <map>
#include <string>
#include <vector>

#include "scenes/import/import.h"
#include "scenes/scene.h"

namespace sheave::test {

/// The text of tests/import/models/NAME.
[[nodiscard]] std::string opensim_text(const std::string& name);
/// The text with these default values of its coordinates; throws if one is not there.
[[nodiscard]] std::string with_coordinates(std::string text,
                                           const std::map<std::string, double>& values);
/// The scene of a text; throws with the first fault.
[[nodiscard]] Scene opensim_scene(const std::string& text);

/// Whether a cable lies on a surface at the start.
[[nodiscard]] bool touches_surface(const CableDef& cable);

/// A document with these sections of its model.
[[nodiscard]] std::string opensim_document(const std::string& sections);
/// A body of 1 kg.
[[nodiscard]] std::string opensim_body(const std::string& name);
/// A joint from ground with coordinates, which have the default value 0 and the range -1 ... 1.
[[nodiscard]] std::string opensim_joint(const std::string& type, const std::string& name,
                                        const std::string& child,
                                        const std::vector<std::string>& coordinates,
                                        const std::string& more = {});
/// A displacement of a CustomJoint.
[[nodiscard]] std::string opensim_axis(const std::string& name, const std::string& coordinate,
                                       const std::string& axis, const std::string& function);

}  // namespace sheave::test
