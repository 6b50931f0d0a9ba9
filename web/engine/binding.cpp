#include <emscripten.h>
#include <string>
#include "scenes/scene.h"
#include "engine/state.h"
#include "scenes/control/scene_supervisor.h"
using namespace sheave;
static std::string text;
extern "C" {
EMSCRIPTEN_KEEPALIVE const char* sheave_run_hash(const char* json, double duration) {
  auto scene = load_scene_text(json, "scene");
  if (!scene) { text = to_string(scene.errors[0]); return text.c_str(); }
  auto sim = create_simulation(*scene);
  if (!sim) { text = sim.errors()[0].message; return text.c_str(); }
  const double end = duration > 0 ? duration : scene->duration;
  const auto steps = static_cast<long long>(end / scene->model.step.dt + 0.5);
  while (sim->world.state().steps < steps) {
    if (!sim->step().ok()) break;
    if (sim->supervisor && sim->supervisor->has_stopped(sim->world.state())) break;
  }
  char buf[64];
  snprintf(buf, sizeof buf, "%016llx %lld", static_cast<unsigned long long>(hash(sim->world.state())), static_cast<long long>(sim->world.state().steps));
  text = buf;
  return text.c_str();
}
}
