// The functions that JavaScript calls: C functions with numbers and texts. web/src/engine.ts gives
// them types.
//
// Returned texts are valid until the next call; answers are JSON. A machine is identified by the
// pointer from sheave_open().

#include <cstdint>
#include <memory>
#include <string>

#include <emscripten.h>

#include "web/engine/playground.h"

namespace {

using sheave::web::Json;
using sheave::web::Playground;

/// The last answer. It is static because the C interface has no other place for a text that
/// outlives the call.
std::string& answer() {
  static std::string text;
  return text;
}

const char* say(const Json& json) {
  answer() = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  return answer().c_str();
}

const char* say(const sheave::Errors& errors) {
  if (errors.empty()) return say(Json{{"ok", true}});
  return say(sheave::web::faults_json(errors));
}

/// Reads settings as the page writes them; a missing setting stays unchanged.
sheave::Errors read_settings(const Json& json, sheave::web::Settings& settings) {
  const auto choice = [&](const char* key, const auto& names, auto& value) -> sheave::Errors {
    if (!json.contains(key)) return {};
    const std::string name = json[key].get<std::string>();
    for (std::size_t k = 0; k < names.size(); ++k) {
      if (names[k] != name) continue;
      value = static_cast<std::remove_reference_t<decltype(value)>>(k);
      return {};
    }
    return {{key, "there is no " + std::string(key) + " \"" + name + "\""}};
  };
  if (auto e = choice("solver", sheave::solver_names, settings.step.solver); !e.empty()) return e;
  if (auto e = choice("integrator", sheave::integrator_names, settings.step.integrator);
      !e.empty()) {
    return e;
  }
  if (json.contains("substeps")) settings.step.substeps = json["substeps"].get<int>();
  if (json.contains("iterations")) settings.step.iterations = json["iterations"].get<int>();
  if (json.contains("gravity")) {
    const auto& g = json["gravity"];
    settings.gravity = sheave::Vector3(g[0].get<double>(), g[1].get<double>(), g[2].get<double>());
  }
  return {};
}

}  // namespace

extern "C" {

/// `overrides`: {"pointer": "JSON text", ...}. Null if there are faults; sheave_text() returns
/// them.
EMSCRIPTEN_KEEPALIVE Playground* sheave_open(const char* text, const char* overrides) {
  std::vector<sheave::Override> list;
  const Json wanted = Json::parse(overrides);
  for (const auto& [pointer, value] : wanted.items()) {
    list.push_back({pointer, value.get<std::string>(), "setting " + pointer});
  }
  Json said = {{"ok", true}};
  auto made = Playground::open(text, list, said);
  say(said);
  return made.release();
}
EMSCRIPTEN_KEEPALIVE void sheave_close(Playground* machine) { delete machine; }
EMSCRIPTEN_KEEPALIVE const char* sheave_text() { return answer().c_str(); }
EMSCRIPTEN_KEEPALIVE const char* sheave_describe(const Playground* machine) {
  return say(machine->describe());
}
/// 0: done, 1: diverged, 2: stopped by a trigger. 4 is added if sheave_text() has events or a
/// reason.
EMSCRIPTEN_KEEPALIVE int sheave_step(Playground* machine) {
  const int ending = static_cast<int>(machine->step(answer()));
  return answer().empty() ? ending : ending + 4;
}
EMSCRIPTEN_KEEPALIVE double sheave_time(const Playground* machine) {
  return machine->world().time();
}
EMSCRIPTEN_KEEPALIVE const double* sheave_sample(Playground* machine) {
  return machine->sample().data();
}
EMSCRIPTEN_KEEPALIVE int sheave_has_new_channels(const Playground* machine) {
  return machine->has_new_channels() ? 1 : 0;
}
EMSCRIPTEN_KEEPALIVE void sheave_keep(Playground* machine) { machine->keep(); }
EMSCRIPTEN_KEEPALIVE int sheave_go_back(Playground* machine, double seconds) {
  return machine->go_back(seconds) ? 1 : 0;
}
EMSCRIPTEN_KEEPALIVE const char* sheave_set(Playground* machine, const char* name, double value) {
  return say(machine->set_control(name, value));
}
EMSCRIPTEN_KEEPALIVE const char* sheave_change(Playground* machine, const char* settings) {
  sheave::web::Settings wanted{machine->world().simulation().world.model().step, {}};
  if (const auto errors = read_settings(Json::parse(settings), wanted); !errors.empty()) {
    return say(errors);
  }
  return say(machine->change(wanted));
}
EMSCRIPTEN_KEEPALIVE const char* sheave_grab(Playground* machine, int body, double x, double y,
                                             double z) {
  return say(machine->grab(body, {x, y, z}));
}
EMSCRIPTEN_KEEPALIVE void sheave_drag(Playground* machine, double x, double y, double z) {
  machine->drag({x, y, z});
}
EMSCRIPTEN_KEEPALIVE void sheave_release(Playground* machine) { machine->release(); }
/// The size of the pointer's force [N].
EMSCRIPTEN_KEEPALIVE double sheave_pull(const Playground* machine) {
  return machine->pointer().force().norm();
}
EMSCRIPTEN_KEEPALIVE const char* sheave_reference(Playground* machine, int refinement) {
  return say(machine->set_reference(refinement));
}
EMSCRIPTEN_KEEPALIVE int sheave_step_reference(Playground* machine) {
  return machine->step_reference() ? 1 : 0;
}
EMSCRIPTEN_KEEPALIVE double sheave_error(const Playground* machine) { return machine->error(); }
EMSCRIPTEN_KEEPALIVE const char* sheave_certificate(Playground* machine, int reset) {
  return say(machine->certificate(reset != 0));
}
EMSCRIPTEN_KEEPALIVE const char* sheave_hash(const Playground* machine) {
  answer() = machine->hash_text();
  return answer().c_str();
}

}  // extern "C"
