#include "bench/peers/problem.h"

#include <utility>

#include "cable/simulation.h"
#include "engine/body_set.h"
#include "scenes/generators.h"

namespace sheave::peers {
namespace {

/// One problem from a scene; coordinates in the order of the cable.
Result<Problem> finished(std::string name, Scene scene, std::vector<Coordinate> coordinates) {
  Problem problem;
  problem.name = std::move(name);
  problem.gravity = scene.model.gravity.norm();
  scene.model.step.dt = problem.dt;
  scene.duration = problem.duration();
  const Result<Simulation> simulation = Simulation::create(scene.model, scene.cables);
  if (!simulation) return simulation.errors();
  problem.scale = simulation->world.bodies().scale();
  for (Coordinate& coordinate : coordinates) {
    const BodyProperties& body = simulation->world.bodies()[coordinate.body];
    const double r = coordinate.radius;
    coordinate.mass = r > 0.0 ? body.axis_inertia / (r * r) : body.mass;
  }
  problem.coordinates = std::move(coordinates);
  problem.scene = std::move(scene);
  return problem;
}

Result<Problem> train(std::string name, int wheels) {
  WheelTrainOptions options;
  options.wheels = wheels;
  Result<Scene> scene = generate_wheel_train(options);
  if (!scene) return scene.errors();
  // Bodies stand in the order of the cable: a weight, the wheels, the other weight.
  std::vector<Coordinate> coordinates{{0.0, -1.0, 0.0, 0, 1.0}};
  for (int k = 0; k < wheels; ++k) {
    const bool over = k % 2 == 0 || k == wheels - 1;
    coordinates.push_back({0.0, 0.0, options.radius, k + 1, over ? -1.0 : 1.0});
  }
  coordinates.push_back({0.0, 1.0, 0.0, wheels + 1, -1.0});
  return finished(std::move(name), std::move(scene).value(), std::move(coordinates));
}

Result<Problem> simple(const std::string& source_folder) {
  SceneResult scene = load_scene(source_folder + "/scenes/paper/simple.json");
  if (!scene) return Error{"", to_string(scene.errors.front())};
  for (BodyDef& body : scene.scene->model.bodies) {
    if (body.mobility != Mobility::planar) continue;
    body.mobility = Mobility::slider;
    body.axis = Vector3::UnitY();
  }
  constexpr double radius = 0.5;  // of both wheels, as the scene says
  return finished("simple", std::move(*scene.scene),
                  {{0.0, -1.0, 0.0, 0, 1.0},
                   {0.0, -1.0, 0.0, 1, 1.0},
                   {0.0, 0.0, radius, 2, -1.0},
                   {0.0, 0.0, radius, 3, -1.0},
                   {0.0, 1.0, 0.0, 4, -1.0}});
}

}  // namespace

double Problem::acceleration() const {
  double force = 0.0;
  double mass = 0.0;
  for (const Coordinate& coordinate : coordinates) {
    force += coordinate.pull * coordinate.mass * gravity;
    mass += coordinate.mass;
  }
  return force / mass;
}

Result<std::vector<Problem>> all_problems(const std::string& source_folder) {
  std::vector<Problem> problems;
  Errors errors;
  for (Result<Problem>& problem :
       std::vector<Result<Problem>>{train("Atwood", 1), simple(source_folder),
                                    train("wheel train, 64", 64), train("wheel train, 256", 256)}) {
    if (problem) {
      problems.push_back(std::move(problem).value());
    } else {
      errors.insert(errors.end(), problem.errors().begin(), problem.errors().end());
    }
  }
  if (!errors.empty()) return errors;
  return problems;
}

}  // namespace sheave::peers
