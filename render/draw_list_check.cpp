// Checks a draw list before it reaches GL. In GL a NaN would only make a part of the picture
// vanish.
#include <cmath>
#include <string>

#include "render/renderer.h"

namespace sheave::render {
namespace {

bool positive(double x) { return std::isfinite(x) && x > 0.0; }
bool not_negative(double x) { return std::isfinite(x) && x >= 0.0; }

/// The fault of a shape; empty if there is none.
std::string fault(const BoxShape& s) {
  const bool good = positive(s.size.x()) && positive(s.size.y()) && positive(s.size.z());
  return good ? "" : "box size must be positive and finite";
}
std::string fault(const SphereShape& s) {
  return positive(s.radius) ? "" : "sphere radius must be positive and finite";
}
std::string fault(const CylinderShape& s) {
  const bool good = positive(s.radius) && positive(s.length);
  return good ? "" : "cylinder radius and length must be positive and finite";
}
std::string fault(const CapsuleShape& s) {
  const bool good = positive(s.radius) && not_negative(s.length);
  return good ? "" : "capsule radius must be positive and length not negative, both finite";
}
std::string fault(const SheaveShape& s) {
  if (!positive(s.radius) || !positive(s.length)) {
    return "sheave radius and length must be positive and finite";
  }
  if (!not_negative(s.cable_radius) || s.cable_radius >= s.radius) {
    return "sheave cable_radius must be at least 0 and less than the radius";
  }
  if (!not_negative(s.groove_width)) return "sheave groove_width must be finite and not negative";
  return s.spokes >= 0 && s.spokes <= 64 ? "" : "sheave spokes must be from 0 to 64";
}
std::string fault(const MeshShape& s) {
  if (!s.mesh) return "mesh must not be null";
  for (const Vector3& v : s.mesh->vertices) {
    if (!v.allFinite()) return "mesh vertices must be finite";
  }
  for (const auto& triangle : s.mesh->triangles) {
    for (const std::uint32_t index : triangle) {
      if (index >= s.mesh->vertices.size()) return "mesh triangles must refer to existing vertices";
    }
  }
  return "";
}

std::string place(const char* list, std::size_t index) {
  return std::string("/") + list + "/" + std::to_string(index);
}

bool unit(const Vector3& v) { return v.allFinite() && std::abs(v.norm() - 1.0) < 1e-3; }

void check_tube(const Tube& tube, const std::string& path, Errors& errors) {
  if (!positive(tube.radius)) {
    errors.push_back({path, "tube: radius must be positive and finite"});
  }
  for (const TubePoint& p : tube.points) {
    if (p.position.allFinite()) continue;
    errors.push_back({path, "tube: points must be finite"});
    return;
  }
}

}  // namespace

Errors validate(const DrawList& list) {
  Errors errors;
  for (std::size_t i = 0; i < list.solids.size(); ++i) {
    const Solid& solid = list.solids[i];
    const std::string wrong = std::visit([](const auto& s) { return fault(s); }, solid.shape);
    if (!wrong.empty()) errors.push_back({place("solids", i), "solid: " + wrong});
    const Eigen::Vector4d q = solid.orientation.coeffs();
    if (!solid.position.allFinite() || !q.allFinite() || std::abs(q.norm() - 1.0) > 1e-3) {
      errors.push_back(
          {place("solids", i), "solid: position must be finite and orientation of unit length"});
    }
  }
  for (std::size_t i = 0; i < list.tubes.size(); ++i) {
    check_tube(list.tubes[i], place("tubes", i), errors);
  }
  for (std::size_t i = 0; i < list.arrows.size(); ++i) {
    if (list.arrows[i].anchor.allFinite()) continue;
    errors.push_back({place("arrows", i), "arrow: anchor must be finite"});
  }
  for (std::size_t i = 0; i < list.labels.size(); ++i) {
    const Label& label = list.labels[i];
    if (!label.anchor.allFinite() || !label.direction.allFinite() || !label.slide.allFinite()) {
      errors.push_back({place("labels", i), "label: anchor, direction and slide must be finite"});
    }
  }
  for (std::size_t i = 0; i < list.planes.size(); ++i) {
    const Plane& plane = list.planes[i];
    if (!plane.point.allFinite() || !unit(plane.normal) || !not_negative(plane.grid_spacing)) {
      errors.push_back(
          {place("planes", i),
           "plane: point must be finite, normal of unit length and grid_spacing not negative"});
    }
  }
  if (list.duration && !positive(*list.duration)) {
    errors.push_back({"/duration", "duration: must be positive and finite"});
  }
  if (list.legend) {
    const bool good = std::isfinite(list.legend->min) && std::isfinite(list.legend->max) &&
                      list.legend->min < list.legend->max;
    if (!good)
      errors.push_back({"/legend", "legend: min and max must be finite and min below max"});
  }
  return errors;
}

}  // namespace sheave::render
