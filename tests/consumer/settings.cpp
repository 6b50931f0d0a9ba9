// Somebody else's program that uses Eigen for its own work, with its own settings of Eigen and of
// the compiler. Every variant of it must print the same lines.
//   settings STEPS SCENE...
// One line for a machine that is defined here, one for its vibrations, then one per scene: its file
// and the hash of its state after STEPS steps.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include <sheave/engine/state.h>
#include <sheave/sheave.h>
#include <sheave/statics/modes.h>

#include <Eigen/Dense>

namespace {

/// Work of the program's own, which makes its copies of Eigen's functions and of Sheave's inline
/// functions. A linker that preferred them would run them in the library.
double own_work(double seed) {
  sheave::Vector3 v{seed, 2.0, 3.0};
  sheave::Matrix3 m = v * v.transpose() + sheave::Matrix3::Identity();
  sheave::Quaternion q = sheave::turned(sheave::Quaternion::Identity(), v);
  m = sheave::turned_tensor(q, m) * m.inverse() + q.toRotationMatrix();
  q = q * sheave::rotation_by(m * v).normalized();
  Eigen::MatrixXd large = Eigen::MatrixXd::Identity(20, 20) * seed;
  large.topLeftCorner(3, 3) += m.transpose() * m;
  const Eigen::VectorXd right = Eigen::VectorXd::LinSpaced(20, 0.0, seed);
  const Eigen::VectorXd solved = (large * large.transpose()).ldlt().solve(right);
  const Eigen::SelfAdjointEigenSolver<sheave::Matrix3> principal(m + m.transpose());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(large);
  return solved.norm() + principal.eigenvalues().sum() + spectrum.eigenvalues().norm() +
         sheave::any_perpendicular(v).dot(q * v) + large.fullPivLu().determinant();
}

/// A box on a rod, and a ball on it: bodies that turn in space, with structs that are laid out here.
sheave::Model tumbling_machine() {
  sheave::Model model;
  model.gravity = {0.0, -9.81, 0.0};
  auto shape = std::make_shared<sheave::Box>();
  shape->size = {0.25, 0.5, 1.0};
  sheave::BodyDef box;
  box.name = "box";
  box.density = 100.0;
  box.orientation = {0.5, 0.5, -0.5, 0.5};
  box.angular_velocity = {1.0, 0.5, -0.25};
  box.shapes = {{.shape = shape, .position = {0.125, 0.0, 0.0}}};
  auto round = std::make_shared<sheave::Sphere>();
  round->radius = 0.25;
  sheave::BodyDef ball;
  ball.name = "ball";
  ball.mass = 2.0;
  ball.position = {1.0, -1.0, 0.5};
  ball.shapes = {{round}};
  auto rod = std::make_shared<sheave::DistanceJoint>();
  rod->name = "rod";
  rod->body_b = model.add(box);
  rod->anchor_a = {0.0, 2.0, 0.0};
  auto pin = std::make_shared<sheave::BallJoint>();
  pin->name = "pin";
  pin->body_a = rod->body_b;
  pin->body_b = model.add(ball);
  pin->anchor = {0.5, -0.5, 0.25};
  model.joints = {rod, pin};
  return model;
}

int report(const sheave::Errors& errors) {
  for (const sheave::Error& error : errors) std::puts(error.message.c_str());
  return 1;
}

int print_machine(long steps) {
  auto simulation = sheave::Simulation::create(tumbling_machine(), {});
  if (!simulation) return report(simulation.errors());
  for (long i = 0; i < steps && simulation->step().ok(); ++i) {
  }
  std::printf("machine %016llx\n",
              static_cast<unsigned long long>(sheave::hash(simulation->world.state())));
  return 0;
}

/// A weight on a spring of 900 N/m: the angular frequency is sqrt(900 / 4) = 15 rad/s.
int print_vibration() {
  sheave::Model model;
  sheave::BodyDef weight;
  weight.name = "weight";
  weight.mobility = sheave::Mobility::slider;
  weight.axis = sheave::Vector3::UnitY();
  weight.position = {0.0, -1.0, 0.0};
  weight.mass = 4.0;
  auto spring = std::make_shared<sheave::DistanceJoint>();
  spring->name = "spring";
  spring->body_b = model.add(weight);
  spring->anchor_b = weight.position;
  spring->compliance = 1.0 / 900.0;
  model.joints = {spring};
  auto simulation = sheave::Simulation::create(model, {});
  if (!simulation) return report(simulation.errors());
  // Matrices of any size come from the library, are copied and changed here, and go back.
  sheave::Modes modes = sheave::find_modes(*simulation);
  const double rate = std::sqrt(-modes.state_matrix(1, 0));
  modes.state_matrix = modes.state_matrix * 2.0;
  modes.motions.resize(50, 70);
  sheave::Modes other = modes;
  modes = sheave::find_modes(*simulation);
  const sheave::ModalVector moved = modes.modes[0].shape * 0.5;
  const sheave::State there = sheave::displaced_state(*simulation, modes, moved, 0.01);
  // The shape has modal mass 1: 0.5 x 0.01 / sqrt(4 kg).
  std::printf("vibration %.9f rad/s, moved by %.9f m\n", rate,
              std::abs(there.bodies[0].position.y() + 1.0));
  return other.motions.cols() == 70 ? 0 : 1;
}

int print_scene(const char* scene, long steps) {
  auto world = sheave::load(scene);
  if (!world) return report(world.errors());
  for (long i = 0; i < steps && world->step().ok(); ++i) {
  }
  std::printf("%s %016llx\n", scene, static_cast<unsigned long long>(sheave::hash(world->state())));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return std::fputs("usage: settings STEPS SCENE...\n", stderr), 2;
  const long steps = std::strtol(argv[1], nullptr, 10);
  if (!std::isfinite(own_work(static_cast<double>(argc)))) return 1;
  int failed = print_machine(steps) | print_vibration();
  for (int i = 2; i < argc; ++i) failed |= print_scene(argv[i], steps);
  return failed;
}
