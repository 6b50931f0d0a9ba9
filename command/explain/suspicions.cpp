#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "cable/cable_system.h"
#include "cable/start_warnings.h"
#include "command/explain/explain.h"
#include "command/run/summary.h"
#include "command/text/table.h"
#include "engine/body_set.h"
#include "scenes/start_warnings.h"

namespace sheave::command {
namespace {

/// Bodies that a joint, a cable, an axle or a collider connects with others.
std::set<int> connected_bodies(const Scene& scene) {
  std::set<int> found;
  const auto add = [&](BodyId body) {
    if (!body.is_world()) found.insert(body.index);
  };
  for (const auto& joint : scene.model.joints) {
    add(joint->body_a);
    add(joint->body_b);
    add(joint->carrier_body());
  }
  for (const CableDef& cable : scene.cables) {
    for (const auto& link : cable.links) {
      add(link->body);
      add(link->exit_body());
    }
  }
  for (const ColliderDef& collider : scene.model.colliders) add(collider.body);
  for (std::size_t i = 0; i < scene.model.bodies.size(); ++i) {
    const BodyDef& body = scene.model.bodies[i];
    if (!body.mount) continue;
    add(*body.mount);
    found.insert(static_cast<int>(i));
  }
  return found;
}

std::string loose_text(const Scene& scene, const BodyDef& body) {
  const bool falls = scene.model.gravity.norm() > 0.0 && !scene.model.ground;
  switch (body.mobility) {
    case Mobility::free:
    case Mobility::planar:
    case Mobility::slider:
      return falls ? fmt::format(
                         "Body \"{}\" has no joint, no cable and no contact, so nothing "
                         "can hold it",
                         body.name)
                   : "";
    case Mobility::rotor:
      return body.drive == DriveKind::none
                 ? fmt::format("Wheel \"{}\" has no cable, no joint and no drive", body.name)
                 : "";
    default:
      return "";
  }
}

/// Elastic cables that start without stretch, and rise to their tension with a bounce.
void append_unstretched(const Scene& scene, const Simulation& simulation, Sentences& sentences) {
  if (scene.start == Start::rest || scene.start_state != nullptr) return;
  if (!(scene.model.gravity.norm() > 0.0)) return;
  const std::vector<CableReport> reports = simulation.cable_reports();
  for (std::size_t c = 0; c < scene.cables.size(); ++c) {
    const CableDef& cable = scene.cables[c];
    const bool stretched = std::any_of(
        reports[c].spans.begin(), reports[c].spans.end(),
        [](const SpanReport& span) { return span.length > span.rest_length * (1.0 + 1e-12); });
    if (!cable.is_elastic() || stretched) continue;
    sentences.push_back(fmt::format(
        "Elastic cable \"{}\" starts without stretch, so its load bounces at first; give it a "
        "pretension, or the scene \"start\": \"rest\".",
        cable.name));
  }
}

}  // namespace

Sentences explain_suspicions(const Scene& scene, const Simulation& simulation) {
  Sentences sentences;
  std::vector<Warning> warnings;
  if (simulation.cables != nullptr) append_winding_warnings(*simulation.cables, warnings);
  for (const Warning& warning : strain_warnings(scene)) warnings.push_back(warning);
  for (const Warning& warning : warnings) sentences.push_back(warning.message + ".");
  for (const Warning& warning : magnitude_warnings(scene)) {
    sentences.push_back(warning.subject + ": " + warning.message + ".");
  }
  const std::set<int> connected = connected_bodies(scene);
  for (std::size_t i = 0; i < scene.model.bodies.size(); ++i) {
    if (connected.contains(static_cast<int>(i))) continue;
    const std::string text = loose_text(scene, scene.model.bodies[i]);
    if (!text.empty()) sentences.push_back(text + ".");
  }
  append_unstretched(scene, simulation, sentences);
  if (sentences.size() > most_explained) {
    const std::size_t more = sentences.size() - most_explained;
    sentences.resize(most_explained);
    sentences.push_back(fmt::format("There are {} more such parts.", more));
  }
  return sentences;
}

}  // namespace sheave::command
