// A cable robot: two winches lead a platform round a circle, by inverse kinematics.

#include <cmath>
#include <cstdio>

#include <sheave/sheave.h>

using namespace sheave;
constexpr double duration = 4.0, radius = 0.2, dt = 0.01;

/// Where the platform is to be: on a circle of 0.4 m, from rest to rest.
Vector3 path(double time) {
  const double turn = 2.0 * pi * time / duration, phase = turn - std::sin(turn);
  return {0.4 * std::sin(phase), -1.0 - 0.4 * std::cos(phase), 0.0};
}

/// How the drum on the `side` -1 or 1 has to stand for that: by the length of the free cable, r /
/// tan(lean), and its direction.
double angle(int side, double time) {
  const Vector3 way = path(time) - Vector3{1.5 * side, 1.0, 0.0};
  const double lean = std::asin(radius / way.norm());
  return -side * (1.0 / std::tan(lean) + std::atan2(way.y(), -side * way.x()) + lean);
}

int main() {
  Model model;
  model.gravity = {0.0, -9.81, 0.0}, model.step.dt = dt;
  auto shape = std::make_shared<Cylinder>();
  shape->radius = radius;
  BodyDef platform;
  platform.name = "platform", platform.mobility = Mobility::planar, platform.mass = 2.0;
  platform.position = path(0.0), platform.shapes = {{shape}};
  auto hook = std::make_shared<AttachmentLink>();
  hook->body = model.add(platform);
  std::vector<CableDef> cables;
  for (const int side : {-1, 1}) {
    BodyDef drum = platform;
    drum.name = side < 0 ? "left" : "right", drum.position = {1.5 * side, 1.0, 0.0};
    drum.mobility = Mobility::rotor, drum.drive = DriveKind::angle, drum.drive_values = {0.0};
    auto spool = std::make_shared<SpoolLink>();
    spool->body = model.add(drum), spool->stored_length = 3.0;
    spool->winding = side < 0 ? Winding::counter_clockwise : Winding::clockwise;
    cables.emplace_back().name = drum.name;
    cables.back().links = {spool, hook};
  }
  auto robot = LiveWorld::create(model, cables);
  if (!robot) return std::puts(robot.errors()[0].message.c_str()), 1;
  double error = 0.0;
  while (robot->time() < duration - 0.5 * dt) {
    const double next = robot->time() + dt;
    for (const int side : {-1, 1}) {
      const double rate = (angle(side, next + 1e-4) - angle(side, next - 1e-4)) / 2e-4;
      const DriveTarget target{angle(side, next) - angle(side, 0.0), dt, rate};
      if (!robot->set_angle(*robot->body(side < 0 ? "left" : "right"), target).empty()) return 1;
    }
    if (!robot->step().ok()) return 1;
    error = std::max(error, (robot->pose(*robot->body("platform"))->position - path(next)).norm());
  }
  return std::printf("the platform was off its path by %.1e m\n", error), error < 1e-9 ? 0 : 1;
}
