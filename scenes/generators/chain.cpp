// A chain of rigid links with ball joints, and a ball at its end.
//
//   o==o==o==o==(   )    The first joint is fixed to the world, the last one lies on the ball's
//   |           ( M )    surface. Everything starts at rest on a straight line, at an angle below
//                        the horizontal (drawn: 0), and swings.
//
// No part dissipates energy, so the total energy is conserved: with E0 = 0 at the height of the
// first joint,
//   E = T - g (sum of m_k y_k + M y) = E0.
// The chain moves in a plane, because no force points out of the plane. A link swings across the
// taut chain with up to 2 sqrt(T / m L): under T = 3 M g and a mass ratio of 672 that is 284 rad/s,
// 1.2 rad in 1/240 s. So 16 substeps are the default.

#include <cmath>

#include <fmt/format.h>

#include "engine/field_check.h"
#include "engine/joints/ball.h"
#include "engine/shapes/capsule.h"
#include "engine/shapes/sphere.h"
#include "scenes/generators.h"
#include "scenes/generators/parts.h"

namespace sheave {
namespace {

/// Direction of the chain at the start.
Vector3 chain_direction(const ChainOptions& options) {
  return {std::cos(options.angle), -std::sin(options.angle), 0.0};
}

BodyDef chain_link(const ChainOptions& options, int k) {
  BodyDef link;
  link.name = fmt::format("link {}", k + 1);
  link.position = generators::tidy((k + 0.5) * options.link_length * chain_direction(options));
  // Its own x axis along the chain: the capsule lies along z of its shape.
  const double half = -0.5 * options.angle;
  link.orientation = Quaternion(std::cos(half), 0.0, 0.0, std::sin(half));
  link.mass = generators::tidy(options.link_mass);
  auto capsule = std::make_shared<Capsule>();
  capsule->radius = generators::tidy(options.link_radius);
  capsule->length = generators::tidy(options.link_length);
  const Quaternion along_x(std::sqrt(0.5), 0.0, std::sqrt(0.5), 0.0);
  link.shapes.push_back({std::move(capsule), Vector3::Zero(), along_x});
  return link;
}

}  // namespace

std::span<const Field> ChainOptions::field_table() {
  using Options = ChainOptions;
  static const std::array table{
      field<&Options::links>("links", "", between(1, 10000), optional, "number of links"),
      field<&Options::link_length>("link_length", "m", above(0.0), optional,
                                   "between the joints of a link"),
      field<&Options::link_radius>("link_radius", "m", above(0.0), optional,
                                   "of each link, a capsule"),
      field<&Options::link_mass>("link_mass", "kg", above(0.0), optional, "of each link"),
      field<&Options::mass_ratio>("mass_ratio", "", above(0.0), optional,
                                  "mass of the ball against that of a link"),
      field<&Options::ball_radius>("ball_radius", "m", above(0.0), optional, "of the ball"),
      field<&Options::angle>("angle", "rad", between(0.0, 1.5), optional,
                             "of the chain below the horizontal at the start"),
      field<&Options::gravity>("gravity", "m/s2", above(0.0), optional, "downwards"),
      field<&Options::duration>("duration", "s", above(0.0), optional, "time to simulate"),
      field<&Options::dt>("dt", "s", above(0.0), optional, "time per step"),
      field<&Options::substeps>("substeps", "", between(1, 100000), optional, "per step"),
      field<&Options::iterations>("iterations", "", between(1, 1000000), optional,
                                  "sweeps, or rounds of the direct solver at most"),
  };
  return table;
}

Result<Scene> generate_chain(const ChainOptions& options) {
  Errors errors;
  check_fields(ChainOptions::field_table(), &options, "", errors);
  if (!errors.empty()) return errors;

  Scene scene;
  scene.name = fmt::format("Chain of {} links and a ball", options.links);
  scene.description =
      fmt::format("A chain of rigid links swings with a ball of {} times their mass.",
                  number_text(options.mass_ratio));
  scene.duration = options.duration;
  Model& model = scene.model;
  model.gravity = {0.0, -options.gravity, 0.0};
  model.step.dt = options.dt;
  model.step.substeps = options.substeps;
  model.step.iterations = options.iterations;
  model.step.solver = SolverKind::direct;
  model.step.integrator = IntegratorKind::rattle;

  const Vector3 along = chain_direction(options);
  BodyId carrier;
  const auto join = [&](BodyId next, int k) {
    auto joint = std::make_shared<BallJoint>();
    joint->name = fmt::format("joint {}", k + 1);
    joint->body_a = carrier;
    joint->body_b = next;
    joint->anchor = generators::tidy(k * options.link_length * along);
    model.joints.push_back(std::move(joint));
    carrier = next;
  };
  for (int k = 0; k < options.links; ++k) join(model.add(chain_link(options, k)), k);
  BodyDef ball;
  ball.name = "ball";
  const double length = options.links * options.link_length;
  ball.position = generators::tidy((length + options.ball_radius) * along);
  ball.mass = generators::tidy(options.mass_ratio * options.link_mass);
  auto sphere = std::make_shared<Sphere>();
  sphere->radius = generators::tidy(options.ball_radius);
  ball.shapes.push_back({std::move(sphere)});
  join(model.add(std::move(ball)), options.links);

  // On a short chain a large ball turns over and makes the chain slack; the chain then snaps taut
  // faster than any step can follow.
  if (length >= 2.0 * options.ball_radius) {
    const double swing = options.mass_ratio * options.link_mass * options.gravity * length;
    scene.checks.push_back(generators::check("energy.total", Statistic::range, 0.0, swing,
                                             "nothing takes energy out"));
  }
  scene.checks.push_back(generators::check("ball.z", Statistic::range, 0.0, 0.0,
                                           "nothing pushes it out of the plane"));
  scene.checks.back().tolerance = generators::tidy(1e-9 * length);
  scene.camera = generators::side_view();
  return scene;
}

}  // namespace sheave
