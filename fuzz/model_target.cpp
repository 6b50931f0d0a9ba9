#include <algorithm>

#include "cable/simulation.h"
#include "fuzz/target.h"
#include "scenes/import/import.h"
#include "scenes/scene.h"

namespace sheave::fuzz {

void try_model(Bytes bytes) {
  std::string text(bytes.begin(), bytes.end());
  import::Options options;
  // A cable robot has two texts, which follow each other here.
  const std::size_t second = text.find("<cables");
  if (text.starts_with("<bodies_system") && second != std::string::npos) {
    options.other_text = text.substr(second);
    text.resize(second);
  }
  import::Limits limits;
  limits.includes = 0;  // no file of this machine is an input
  const import::Outcome made = import::import_model(text, "fuzzed.xml", options, limits);
  const auto lines = 1 + std::count(bytes.begin(), bytes.end(), '\n');
  for (const SceneError& error : made.errors) {
    require(!error.message.empty(), "a fault without a message");
    require(error.line >= 1 && error.line <= lines, "a fault without a place: " + error.message);
  }
  require(made.errors.empty() != made.json.empty(), "a scene with faults, or neither");
  require(!import::report(made).empty(), "an import without a report");
  if (made.json.empty()) return;
  SceneResult scene = load_scene_text(made.json, "made");
  if (!scene) {
    import::locate(scene.errors, "made", made);
    for (const SceneError& error : scene.errors) {
      require(error.code != FaultCode::syntax && error.code != FaultCode::unknown_key &&
                  error.code != FaultCode::missing_key && error.code != FaultCode::wrong_type &&
                  error.code != FaultCode::unknown_body && error.code != FaultCode::bad_name &&
                  error.code != FaultCode::duplicate_name,
              "an import made what no scene is: " + to_string(error));
      require(error.line >= 1 && error.line <= lines,
              "a fault of the made scene without a place: " + to_string(error));
    }
    return;
  }
  require(Simulation::check(scene->model, scene->cables).empty(),
          "a scene from a model does not build");
}

}  // namespace sheave::fuzz
