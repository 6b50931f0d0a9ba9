#include <cstring>
#include <limits>

#include "fuzz/machine_run.h"
#include "fuzz/target.h"
#include "scenes/control/scene_supervisor.h"
#include "scenes/scene.h"
#include "tests/support/state_bytes.h"

namespace sheave::fuzz {
namespace {

Scene fixed_scene(const char* path) {
  SceneResult scene = load_scene(std::string(SHEAVE_SOURCE_DIR) + path);
  if (!scene) throw BrokenPromise(to_string(scene.errors.front()));
  return std::move(*scene.scene);
}

Simulation start(const Scene& scene) {
  Result<Simulation> simulation = create_simulation(scene);
  require(simulation.ok(), "the fixed scene is refused");
  return std::move(*simulation);
}

/// The state of a scene after some steps of settling.
State settled(const Scene& scene) {
  Simulation simulation = start(scene);
  for (int i = 0; i < 3; ++i) require(simulation.step().ok(), "the fixed scene diverges");
  return simulation.world.state();
}

/// A scene and its settled state in the format of versions without a checksum: damage is not
/// detected by the checksum, and other checks must find it.
struct Settled {
  explicit Settled(const char* path)
      : scene(fixed_scene(path)), written(test::without_checksum(to_bytes(settled(scene)))) {}
  Scene scene;
  std::string written;
};

/// A state's bytes with some words changed. Six bytes describe each change: the word, the kind of
/// change, and a number.
std::string damaged(std::string state, Bytes bytes) {
  while (bytes.size() >= 6) {
    const std::size_t words = state.size() / 8;
    if (words == 0) return state;
    const std::size_t at = 8 * (static_cast<std::size_t>(bytes[0] | bytes[1] << 8) % words);
    const std::uint8_t way = bytes[2];
    const std::uint8_t value = bytes[3];
    const auto whole =
        static_cast<std::int64_t>(static_cast<std::int16_t>(bytes[4] | bytes[5] << 8));
    bytes = bytes.subspan(6);
    constexpr std::array<double, 8> reals{0.0, -1.0, 1e300, -1e300, 5e-324, 1.0, 1e10, -1e-10};
    double real = reals[value % reals.size()];
    if (value >= 250) real = std::numeric_limits<double>::quiet_NaN();
    if (value >= 240 && value < 250) real = std::numeric_limits<double>::infinity();
    switch (way % 6) {
      case 0:
        state[at + value % 8] = static_cast<char>(bytes.empty() ? 0 : bytes[0]);
        break;
      case 1:
        std::memcpy(&state[at], &real, 8);
        break;
      case 2:
        std::memcpy(&state[at], &whole, 8);
        break;
      case 3:
        state.resize(at + value % 8);
        break;
      case 4:
        state.erase(at, 8);
        break;
      default:
        state.insert(at, 8, static_cast<char>(value));
        break;
    }
  }
  return state;
}

/// Continues from an accepted state: no numbers in it may cause a failure.
void go_on(Simulation& simulation) {
  if (const auto* own = dynamic_cast<const SceneSupervisor*>(simulation.supervisor.get())) {
    require(own->refusals(simulation.world.state()) >= 0,
            "controls have refused less than nothing");
  }
  for (int i = 0; i < 3; ++i) {
    const StepReport report = simulation.step();
    if (!report.ok()) {
      require(!report.divergence->message.empty(), "a divergence without a message");
      return;
    }
    StepCheck(simulation, false).check(simulation);
  }
}

}  // namespace

void try_state(Bytes bytes) {
  if (bytes.empty()) return;
  // One scene with features of all kinds, and one whose triggers have memory.
  static const Settled everything("/tests/scenes/corpus/v1/everything.json");
  static const Settled steered("/scenes/machines/brake-failure.json");
  const auto& [scene, written] = bytes.front() < 128 ? everything : steered;
  const bool raw = bytes.front() == 0;
  const Bytes rest = bytes.subspan(1);
  const std::string file = raw ? std::string(rest.begin(), rest.end()) : damaged(written, rest);
  const Result<State> state = state_from_bytes(file);
  if (!state) {
    require(!state.errors().empty() && !state.errors().front().message.empty(),
            "a state is refused without a message");
    return;
  }
  const std::string again = to_bytes(*state);
  require(again == file || test::without_checksum(again) == file || file.starts_with("SHSTATE1"),
          "a state is read otherwise than it was written");
  Simulation simulation = start(scene);
  const std::uint64_t at_start = hash(simulation.world.state());
  const Errors errors = simulation.world.restore(*state);
  for (const Error& error : errors) require(!error.message.empty(), "refused without a message");
  if (!errors.empty()) {
    require(hash(simulation.world.state()) == at_start,
            "a state that is refused has changed the world");
    return;
  }
  go_on(simulation);
}

}  // namespace sheave::fuzz
