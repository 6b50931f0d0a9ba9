#include <string>

#include <nlohmann/json.hpp>

#include "engine/state.h"
#include "fuzz/target.h"
#include "live/session.h"
#include "scenes/control/scene_supervisor.h"
#include "scenes/scene.h"

namespace sheave::fuzz {
namespace {

const Scene& fixed_scene() {
  static const Scene scene = [] {
    SceneResult loaded = load_scene(SHEAVE_SOURCE_DIR "/scenes/machines/brake-failure.json");
    if (!loaded) throw BrokenPromise(to_string(loaded.errors.front()));
    return std::move(*loaded.scene);
  }();
  return scene;
}

std::uint64_t hash_of(const live::Session& session) { return hash(session.world().state()); }

void try_line(live::Session& session, std::string_view line) {
  const std::uint64_t before = hash_of(session);
  const std::string text = session.answer(line);
  const nlohmann::json answer = nlohmann::json::parse(text, nullptr, false);
  require(text.find('\n') == std::string::npos && answer.is_object(), "no answer: " + text);
  const bool ok = answer.value("ok", false);
  require(ok != answer.contains("errors"), "neither done nor refused: " + text);
  require(ok || hash_of(session) == before, "refused, and yet changed: " + text);
  // After any requests the present state can be restored.
  LiveWorld& world = session.state().world;
  const std::uint64_t now = hash_of(session);
  const Errors errors = world.restore(world.snapshot());
  require(errors.empty() && hash_of(session) == now,
          "a state that there is cannot be gone back to, after: " + text);
}

}  // namespace

void try_live(Bytes bytes) {
  std::string log;
  live::Hooks hooks;
  hooks.log = [&](const std::string& line) { log += line + "\n"; };
  hooks.event = [](const std::string& line, bool) {
    require(nlohmann::json::accept(line), "an event that is no JSON: " + line);
  };
  live::Limits limits;
  limits.steps = 4;
  const auto start = [&](const live::Hooks& with) {
    Result<Simulation> simulation = create_simulation(fixed_scene());
    require(simulation.ok(), "the fixed scene is refused");
    return live::Session(fixed_scene(), std::move(*simulation), with, limits);
  };
  live::Session session = start(hooks);
  const std::string text(bytes.begin(), bytes.end());
  for (std::size_t begin = 0; begin <= text.size() && !session.has_quit();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    try_line(session, std::string_view(text).substr(begin, end - begin));
    if (session.is_running()) session.advance();
    begin = end + 1;
  }
  session.finish_log();
  live::Session again = start({});
  for (std::size_t begin = 0; begin < log.size();) {
    const std::size_t end = log.find('\n', begin);
    const std::string line = log.substr(begin, end - begin);
    require(again.answer(line).find("\"ok\":true") != std::string::npos,
            "the log has what cannot be done: " + line);
    begin = end + 1;
  }
  require(hash_of(again) == hash_of(session), "the log leads elsewhere");
}

}  // namespace sheave::fuzz
