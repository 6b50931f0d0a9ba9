#include "measure/trajectory.h"

#include <algorithm>
#include <cmath>

#include "engine/body_set.h"
#include "scenes/control/scene_supervisor.h"

namespace sheave::measure {
namespace {

/// Largest distance of the body's surface from its origin that matters for rotation about its axis.
double reach_of(const BodyDef& body) {
  double reach = 0.0;
  for (const PlacedShape& placed : body.shapes) {
    if (!placed.shape->bounded()) continue;
    const double radius = placed.shape->wheel_radius();
    const double own = std::isfinite(radius) ? radius : placed.shape->half_extent().norm();
    reach = std::max(reach, placed.position.norm() + own);
  }
  return reach;
}

bool is_rigid(const CableDef& cable) { return !cable.is_elastic(); }

Frame frame_from(const Simulation& simulation, const std::vector<TrackedBody>& bodies,
                 const std::vector<CableReport>& reports) {
  Frame frame;
  const World& world = simulation.world;
  for (const TrackedBody& body : bodies) {
    const double angle = world.state().bodies[static_cast<std::size_t>(body.id.index)].angle;
    frame.poses.push_back({world.position(body.id), world.orientation(body.id), angle});
  }
  for (const CableReport& cable : reports) {
    for (const SpanReport& span : cable.spans) frame.tensions.push_back(span.tension);
  }
  const Energy energy = world.energy();
  frame.energy = energy.total();
  frame.kinetic_energy = energy.kinetic;
  return frame;
}

/// Adds a frame and its figures of the cables' lengths.
void add_frame(const Scene& scene, const Simulation& simulation, Trajectory& trajectory) {
  const std::vector<CableReport> reports = simulation.cable_reports();
  std::size_t spans = 0;
  for (std::size_t i = 0; i < reports.size(); ++i) {
    const CableReport& cable = reports[i];
    double excess = 0.0;
    spans += cable.spans.size() + cable.wraps.size();
    for (const SpanReport& span : cable.spans) {
      excess += std::max(0.0, span.length - span.rest_length);
    }
    for (const WrapReport& wrap : cable.wraps) {
      excess += std::max(0.0, wrap.span.length - wrap.span.rest_length);
    }
    trajectory.length_error = std::max(trajectory.length_error, std::abs(cable.length_error));
    if (is_rigid(scene.cables[i]) && !cable.cut && cable.total_length > 0.0) {
      trajectory.stretch = std::max(trajectory.stretch, excess / cable.total_length);
    }
  }
  trajectory.most_spans = std::max(trajectory.most_spans, static_cast<int>(spans));
  trajectory.frames.push_back(frame_from(simulation, trajectory.bodies, reports));
}

}  // namespace

std::vector<TrackedBody> tracked_bodies(const BodySet& bodies) {
  std::vector<TrackedBody> tracked;
  for (int i = 0; i < bodies.count(); ++i) {
    const BodyProperties& own = bodies[i];
    const bool given =
        own.mobility == Mobility::fixed || own.mobility == Mobility::kinematic || own.prescribed();
    if (given) continue;
    const bool turns = own.mobility == Mobility::planar || own.mobility == Mobility::rotor;
    tracked.push_back({BodyId{i}, bodies.name(i), reach_of(bodies.definition(i)), turns});
  }
  return tracked;
}

Frame frame_of(const Simulation& simulation, const std::vector<TrackedBody>& bodies) {
  return frame_from(simulation, bodies, simulation.cable_reports());
}

std::array<Trajectory, 2> with_common_bodies(const Trajectory& run, const Trajectory& other) {
  std::array<Trajectory, 2> common{run, other};
  for (Trajectory& one : common) {
    one.bodies.clear();
    for (Frame& frame : one.frames) {
      frame.poses.clear();
      frame.tensions.clear();
    }
  }
  for (std::size_t k = 0; k < other.bodies.size(); ++k) {
    const auto same = std::find_if(run.bodies.begin(), run.bodies.end(), [&](const auto& body) {
      return body.name == other.bodies[k].name;
    });
    if (same == run.bodies.end()) continue;
    const auto i = static_cast<std::size_t>(same - run.bodies.begin());
    const std::array<std::size_t, 2> places{i, k};
    for (std::size_t side = 0; side < 2; ++side) {
      const Trajectory& from = side == 0 ? run : other;
      common[side].bodies.push_back(from.bodies[places[side]]);
      for (std::size_t f = 0; f < from.frames.size(); ++f) {
        common[side].frames[f].poses.push_back(from.frames[f].poses[places[side]]);
      }
    }
  }
  return common;
}

std::int64_t frame_count(const Scene& scene) {
  const std::int64_t first = scene.start_state == nullptr ? 0 : scene.start_state->steps;
  return std::max<std::int64_t>(1, std::llround(scene.duration / scene.model.step.dt) - first);
}

Result<Trajectory> record(const Scene& scene, const FrameObserver& observe,
                          const StopRequest& stop) {
  Result<Simulation> simulation = create_simulation(scene);
  if (!simulation) return simulation.errors();
  Trajectory trajectory;
  trajectory.scale = simulation->world.bodies().scale();
  trajectory.bodies = tracked_bodies(simulation->world.bodies());
  add_frame(scene, *simulation, trajectory);
  const std::int64_t count = frame_count(scene);
  for (std::int64_t i = 1; i <= count; ++i) {
    StepReport report = simulation->step(stop);
    if (report.stopped) return Error{"", "interrupted"};
    trajectory.row_solves += report.statistics.row_solves;
    trajectory.rounds += report.statistics.rounds;
    trajectory.fallbacks += report.statistics.solver_fallbacks +
                            report.statistics.integrator_fallbacks + report.statistics.unconverged;
    if (!report.ok()) {
      trajectory.divergence = std::move(report.divergence);
      break;
    }
    add_frame(scene, *simulation, trajectory);
    if (observe && !observe(i, count)) return Error{"", "interrupted"};
  }
  return trajectory;
}

}  // namespace sheave::measure
