// Masses that a scene cannot have: none at all of a body that moves, and moments of inertia of which
// one is greater than the sum of the other two.

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "engine/index.h"
#include "engine/number_text.h"
#include "scenes/import/mjcf/reader.h"

namespace sheave::import::mjcf {
namespace {

constexpr double least_body_mass = 1e-15;  // of a body that moves [kg]; MuJoCo has the same bound
constexpr double least_square = 1e-18;     // of a radius of gyration [m2]; less is rounding
constexpr double small_gyration = 0.01;    // of a body that gets a mass [m]

/// Whether the principal moments are those of a body.
bool is_sound(const Vector3& moments) {
  // The slack is that of a scene's check.
  return moments[0] > 1e-12 * moments[2] &&
         moments[2] <= moments[0] + moments[1] + 1e-9 * moments.sum();
}

Vector3 principal_moments(const Inertial& inertial) {
  return Eigen::SelfAdjointEigenSolver<Matrix3>(inertial.inertia, Eigen::EigenvaluesOnly)
      .eigenvalues();
}

/// Gives a body without mass the least one.
void add_mass(double mass, Body& body, Log& log) {
  const double moment = mass * small_gyration * small_gyration;
  body.inertial.add({mass, Vector3::Zero(), moment * Matrix3::Identity()});
  log.changed(*body.element, fmt::format("without mass or inertia in the model; here it has {} "
                                         "kg more with a radius of gyration of 1 cm",
                                         number_text(mass, 6)));
}

void balance(Body& body, Log& log) {
  const double mean = body.inertial.inertia.trace() / 3.0;
  if (!(mean > 0.0)) return;
  body.inertial.inertia = mean * Matrix3::Identity();
  log.changed(*body.element, fmt::format("no body has its moments of inertia; here all three are "
                                         "their mean, {} kg m2",
                                         number_text(mean, 6)));
}

void check_moments(const Body& body, const Inertial& carried, Log& log) {
  const Vector3 moments = principal_moments(carried);
  if (is_sound(moments)) return;
  log.error(*body.element,
            fmt::format("no body has the principal moments of inertia [{}, {}, {}] kg m2: all must "
                        "be above 0, and each at most the sum of the other two; correct them, or "
                        "--balance-inertia puts their mean in their place",
                        number_text(moments[0], 6), number_text(moments[1], 6),
                        number_text(moments[2], 6)),
            {}, FaultCode::out_of_range);
}

}  // namespace

std::vector<Inertial> carried_masses(const Model& model) {
  std::vector<Inertial> masses(model.bodies.size());
  for (std::size_t i = model.bodies.size(); i-- > 1;) {
    const Body& body = model.bodies[i];
    masses[i].add(body.inertial);
    if (body.joints.empty()) masses[at(body.parent)].add(masses[i].seen_from(body.frame));
  }
  return masses;
}

void mend_masses(const Options& options, Model& model, Log& log) {
  const auto moves = [&](const Body& body) { return !body.joints.empty(); };
  if (options.balances) {
    for (Body& body : model.bodies) {
      if (body.inertial.mass > least_body_mass && !is_sound(principal_moments(body.inertial))) {
        balance(body, log);
      }
    }
  }
  std::vector<Inertial> carried = carried_masses(model);
  for (std::size_t i = 1; i < model.bodies.size(); ++i) {
    Body& body = model.bodies[i];
    if (!moves(body)) continue;
    const bool has_inertia = carried[i].inertia.trace() > least_square * carried[i].mass;
    if (carried[i].mass > least_body_mass && has_inertia) {
      check_moments(body, carried[i], log);
    } else if (options.least_mass > 0.0) {
      add_mass(options.least_mass, body, log);
    } else {
      log.error(*body.element,
                "a body that moves needs mass and inertia: give it some, or --least-mass gives "
                "each such body a small one",
                {}, FaultCode::meaning);
    }
  }
}

}  // namespace sheave::import::mjcf
