#include "scenes/generators/parts.h"

#include <cstdlib>

#include <fmt/format.h>

#include "cable/links/attachment.h"
#include "cable/links/rolling.h"
#include "engine/shapes/box.h"
#include "engine/shapes/cylinder.h"

namespace sheave::generators {

double tidy(double value) { return std::strtod(fmt::format("{:.12g}", value).c_str(), nullptr); }

Vector3 tidy(const Vector3& value) { return {tidy(value.x()), tidy(value.y()), tidy(value.z())}; }

BodyDef wheel(std::string name, const Vector3& center, double radius, double width, double mass) {
  BodyDef body;
  body.name = std::move(name);
  body.mobility = Mobility::rotor;
  body.position = tidy(center);
  body.mass = tidy(mass);
  auto disc = std::make_shared<Cylinder>();
  disc->radius = tidy(radius);
  disc->length = tidy(width);
  body.shapes.push_back({std::move(disc)});
  return body;
}

BodyDef weight(std::string name, const Vector3& center, const Vector3& size, double mass) {
  BodyDef body;
  body.name = std::move(name);
  body.mobility = Mobility::slider;
  body.axis = Vector3::UnitY();
  body.position = tidy(center);
  body.mass = tidy(mass);
  auto box = std::make_shared<Box>();
  box->size = tidy(size);
  body.shapes.push_back({std::move(box)});
  return body;
}

std::shared_ptr<const LinkDef> attach(BodyId body, const Vector3& point) {
  auto link = std::make_shared<AttachmentLink>();
  link->body = body;
  link->point = tidy(point);
  return link;
}

std::shared_ptr<const LinkDef> roll(BodyId body, Winding winding) {
  auto link = std::make_shared<RollingLink>();
  link->body = body;
  link->winding = winding;
  return link;
}

CheckDef check(std::string quantity, Statistic statistic, double equals, double scale,
               std::string because) {
  CheckDef check;
  check.quantity = std::move(quantity);
  check.statistic = statistic;
  check.equals = tidy(equals);
  check.tolerance = tidy(1e-3 * std::max(std::abs(equals), scale));
  check.because = std::move(because);
  return check;
}

CameraDef side_view() {
  CameraDef camera;
  camera.direction = Vector3(-0.15, -0.12, -1.0);
  return camera;
}

void step_as_the_paper(Scene& scene, double dt, int substeps, int iterations) {
  scene.step_preset.preset = StepPreset::paper;
  scene.model.step = StepSettings::paper();
  scene.model.step.dt = dt;
  scene.model.step.substeps = substeps;
  scene.model.step.iterations = iterations;
}

}  // namespace sheave::generators
