#include "python/bindings/batch.h"

#include <algorithm>
#include <atomic>

#include <fmt/format.h>

#include "python/bindings/warnings.h"
#include "scenes/control/scene_supervisor.h"

namespace sheave::python {
namespace {

/// A world under construction.
struct Making {
  std::optional<Simulation> simulation;
  std::shared_ptr<const Scene> scene;
  std::vector<SceneError> errors;
};

void make_world(std::shared_ptr<const Scene> scene, const std::string& name, Making& making) {
  Result<Simulation> made = create_simulation(*scene);
  if (made) {
    making.scene = std::move(scene);
    making.simulation.emplace(std::move(*made));
    return;
  }
  for (const Error& error : made.errors()) {
    SceneError fault;
    fault.file = name;
    fault.pointer = error.path;
    fault.message = error.message;
    making.errors.push_back(std::move(fault));
  }
}

SceneResult read_scene(const Batch::Source& source, const std::vector<Override>& overrides) {
  return source.is_file ? load_scene(source.text, overrides)
                        : load_scene_text(source.text, source.name, overrides);
}

bool is_same(const Simulation& a, const std::vector<std::string>& names) {
  return ObservableSet(a).names() == names;
}

// Small enough for a quick reaction to an interrupt, and large enough that one step with a check
// among this many costs little.
constexpr std::int64_t most_unseen = 63;

}  // namespace

std::unique_ptr<Batch> Batch::create(const Source& source, std::size_t count,
                                     const std::vector<Override>& overrides,
                                     const std::vector<Variation>& variations, std::size_t threads,
                                     Faults& faults) {
  const std::string name = source.is_file ? source.text : source.name;
  SceneResult common = read_scene(source, variations.empty() ? overrides : std::vector<Override>());
  if (!common) {
    faults.errors = common.errors;
    return nullptr;
  }
  const auto first = std::make_shared<const Scene>(std::move(*common.scene));
  std::vector<Making> makings(count);
  const auto make = [&](std::size_t i) {
    if (variations.empty()) return make_world(first, name, makings[i]);
    std::vector<Override> own = overrides;
    for (const Variation& variation : variations) {
      own.push_back({variation.pointer, variation.values[i],
                     fmt::format("vary {}, world {}", variation.pointer, i)});
    }
    SceneResult scene = read_scene(source, own);
    if (scene) {
      auto varied = std::make_shared<const Scene>(std::move(*scene.scene));
      return make_world(std::move(varied), name, makings[i]);
    }
    makings[i].errors = std::move(scene.errors);
  };
  ThreadPool(threads).for_each(count, make);
  std::vector<World> worlds;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < count; ++i) {
    Making& making = makings[i];
    if (i == 0 && making.simulation) names = ObservableSet(*making.simulation).names();
    if (making.simulation && !variations.empty() && !is_same(*making.simulation, names)) {
      SceneError fault;
      fault.file = name;
      fault.message = "the worlds of a batch must have the same observables as the first one";
      making.errors.push_back(std::move(fault));
    }
    if (!making.errors.empty()) {
      faults = {std::move(making.errors), i};
      return nullptr;
    }
    State start = making.simulation->world.state();
    worlds.push_back(
        {std::move(*making.simulation), std::move(making.scene), std::move(start), {}, false});
  }
  return std::unique_ptr<Batch>(new Batch(std::move(worlds), std::move(common.notice), threads));
}

Batch::Batch(std::vector<World> worlds, std::string notice, std::size_t threads)
    : worlds_(std::move(worlds)),
      notice_(std::move(notice)),
      duration_(worlds_.front().scene->duration),
      quantities_(std::make_shared<const QuantityIndex>(worlds_.front().simulation)),
      pool_(threads) {}

void Batch::step(std::int64_t count, std::span<const char> chosen,
                 const std::function<bool()>& goes_on) {
  std::atomic<bool> ends = false;
  const auto steps = [&](std::size_t i) {
    World& world = worlds_[i];
    if (chosen[i] == 0 || has_diverged(i) || world.stopped) return;
    const Supervisor* supervisor = world.simulation.supervisor.get();
    for (std::int64_t k = 0; k < count && !ends.load(std::memory_order_relaxed); ++k) {
      k += world.simulation.leap(std::min(count - k - 1, most_unseen));
      const StepReport report = world.simulation.step();
      add_troubles(report.statistics, world.troubles);
      if (report.divergence) {
        world.divergence = report.divergence->message;
        return;
      }
      world.stopped =
          supervisor != nullptr && supervisor->has_stopped(world.simulation.world.state());
      if (world.stopped) return;
    }
  };
  pool_.for_each(size(), steps, [&] {
    if (!goes_on()) ends = true;
    return !ends;
  });
}

std::vector<Warning> Batch::warnings(std::size_t index) const {
  const World& world = worlds_[index];
  std::vector<Warning> warnings = warnings_at_start(*world.scene, notice_);
  append_run_warnings(world.simulation, world.troubles, warnings);
  return warnings;
}

void Batch::observe(const QuantityList& list, std::span<double> values) {
  const std::size_t width = list.size();
  for_each([&](std::size_t i) {
    list.observe(worlds_[i].simulation, values.subspan(i * width, width));
  });
}

Result<const std::vector<ControlPoint>*> Batch::control(const std::string& name) {
  const auto known = controls_.find(name);
  if (known != controls_.end()) return &known->second;
  std::vector<ControlPoint> points;
  for (const World& world : worlds_) {
    const Result<ControlPoint> point = find_control(name, world.simulation);
    if (!point) return point.errors();
    points.push_back(*point);
  }
  return &controls_.emplace(name, std::move(points)).first->second;
}

Errors Batch::set(const std::string& name, std::span<const double> values,
                  std::optional<double> over, std::span<const char> chosen) {
  const Result<const std::vector<ControlPoint>*> points = control(name);
  if (!points) return points.errors();
  // Excitations are no part of Controls, so all are checked before any is set.
  for (std::size_t i = 0; i < size() && !values.empty(); ++i) {
    ControlPoint point = (**points)[i];
    if (chosen[i] == 0 || point.kind != ControlPoint::Kind::excitation) continue;
    point.item = -1;
    const Errors errors = point.set(worlds_[i].simulation, values[i], 0.0, over);
    if (!errors.empty()) return {{"", fmt::format("world {}: {}", i, errors.front().message)}};
  }
  std::vector<Controls> before;  // of the worlds already set
  for (std::size_t i = 0; i < size(); ++i) {
    if (chosen[i] == 0) continue;
    Simulation& simulation = worlds_[i].simulation;
    const ControlPoint& point = (**points)[i];
    const double step = simulation.world.model().step.dt;
    before.push_back(simulation.world.state().controls);
    const Errors errors =
        values.empty() ? point.clear(simulation) : point.set(simulation, values[i], step, over);
    if (errors.empty()) continue;
    take_back(chosen, before);
    return {{"", fmt::format("world {}: {}", i, errors.front().message)}};
  }
  return {};
}

void Batch::take_back(std::span<const char> chosen, const std::vector<Controls>& before) {
  std::size_t next = 0;
  for (std::size_t i = 0; i < size() && next < before.size(); ++i) {
    if (chosen[i] == 0) continue;
    worlds_[i].simulation.world.controls_of_features() = before[next++];
  }
}

Errors Batch::restore(std::size_t index, const State& state) {
  World& world = worlds_[index];
  Errors errors = world.simulation.world.restore(state);
  if (!errors.empty()) return errors;
  world.divergence.clear();
  world.troubles = {};
  const Supervisor* supervisor = world.simulation.supervisor.get();
  world.stopped = supervisor != nullptr && supervisor->has_stopped(state);
  return {};
}

Errors Batch::reset(std::span<const char> chosen) {
  for (std::size_t i = 0; i < size(); ++i) {
    if (chosen[i] == 0) continue;
    Errors errors = restore(i, worlds_[i].start);
    if (!errors.empty()) return errors;
  }
  return {};
}

void Batch::mark_start(std::span<const char> chosen) {
  for (std::size_t i = 0; i < size(); ++i) {
    if (chosen[i] != 0) worlds_[i].start = worlds_[i].simulation.world.state();
  }
}

}  // namespace sheave::python
