// Masses of bodies: from <inertial> or from geoms, then the bounds and the scale of <compiler>.

#include <algorithm>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "scenes/import/mjcf/reader.h"

namespace sheave::import::mjcf {
namespace {

/// Applies boundinertia and balanceinertia to the principal moments.
void correct_inertia(const Compiler& compiler, Inertial& inertial) {
  const Eigen::SelfAdjointEigenSolver<Matrix3> principal(inertial.inertia);
  Vector3 moments = principal.eigenvalues().cwiseMax(compiler.least_inertia);
  if (compiler.balances && moments[0] + moments[1] < moments[2]) {
    moments = Vector3::Constant(moments.mean());
  }
  if (moments == principal.eigenvalues()) return;
  const Matrix3& axes = principal.eigenvectors();
  inertial.inertia = axes * moments.asDiagonal() * axes.transpose();
}

}  // namespace

void find_masses(Model& model, Log& log) {
  const Compiler& compiler = model.compiler;
  double total = 0.0;
  for (std::size_t i = 1; i < model.bodies.size(); ++i) {
    Body& body = model.bodies[i];
    const bool by_geoms = compiler.from_geoms == FromGeoms::always ||
                          (compiler.from_geoms == FromGeoms::unless_given && !body.given);
    if (body.given && !by_geoms) {
      body.inertial = *body.given;
    } else if (by_geoms) {
      for (const int geom : body.geoms) {
        body.inertial.add(model.geoms[static_cast<std::size_t>(geom)].inertial);
      }
    }
    body.inertial.mass = std::max(body.inertial.mass, compiler.least_mass);
    if (compiler.least_inertia > 0.0 || compiler.balances) {
      correct_inertia(compiler, body.inertial);
    }
    if (body.given && by_geoms) {
      log.changed(*body.element,
                  "inertiafromgeom: its <inertial> is replaced by that of its geoms");
    }
    total += body.inertial.mass;
  }
  if (!(compiler.total_mass > 0.0) || !(total > 0.0)) return;
  const double scale = compiler.total_mass / total;
  for (Body& body : model.bodies) {
    body.inertial.mass *= scale;
    body.inertial.inertia *= scale;
  }
}

}  // namespace sheave::import::mjcf
