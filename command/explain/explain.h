#pragma once
// Sentences that tell a reader of a scene the content of the machine at its start.

#include <string>
#include <vector>

#include "cable/simulation.h"
#include "scenes/scene.h"

namespace sheave::command {

/// Largest number of bodies, joints, cables or other things that a part of the text names one by
/// one. The text gives the number of the others.
inline constexpr std::size_t most_explained = 24;

/// One sentence per line. Texts from outside are printable lines.
using Sentences = std::vector<std::string>;

/// Bodies, joints, controllers, triggers and ground.
[[nodiscard]] Sentences explain_parts(const Scene& scene, const Simulation& simulation);
/// Degrees of freedom: of the bodies, behind the joints, and behind all rigid rows that act.
[[nodiscard]] Sentences explain_freedom(Simulation& simulation);
/// The way of each cable over its links, its stretch, where the cable can slide, and how far the
/// coordinates of the machine move per length of it.
[[nodiscard]] Sentences explain_cables(const Scene& scene, Simulation& simulation);
/// Parts that look like a mistake. Empty if there is none.
[[nodiscard]] Sentences explain_suspicions(const Scene& scene, const Simulation& simulation);

/// "a, b and c"; at most `most_explained` names.
[[nodiscard]] std::string joined_names(const std::vector<std::string>& names);
/// "1 body", "3 bodies".
[[nodiscard]] std::string counted(std::size_t count, const char* one, const char* many);
/// "(0, 1, 0)".
[[nodiscard]] std::string direction_text(const Vector3& direction);
/// Name of a body or "the world".
[[nodiscard]] std::string body_text(const Model& model, BodyId body);

}  // namespace sheave::command
