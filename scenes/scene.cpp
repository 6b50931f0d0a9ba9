#include "scenes/scene.h"

#include <cmath>

#include <fmt/format.h>

namespace sheave {

std::span<const Field> CameraDef::field_table() {
  static const std::array table{
      choice_field<&CameraDef::projection>("projection", projection_names, optional,
                                           "how the world is mapped to the picture"),
      field<&CameraDef::position>(
          "position", "m", any_number(), optional,
          "position of the eye; needs target; default: all bodies are in view"),
      field<&CameraDef::target>("target", "m", any_number(), optional,
                                "point in the middle of the picture; needs position"),
      field<&CameraDef::direction>("direction", "", any_number(), optional,
                                   "to look along, with the distance chosen automatically; "
                                   "excludes position and target"),
      field<&CameraDef::up>("up", "", any_number(), optional,
                            "up in the picture; default: against gravity"),
      field<&CameraDef::vertical_fov>("vertical_fov", "rad", Range{0.0, pi, false, false}, optional,
                                      "perspective: full vertical opening angle"),
      field<&CameraDef::height>(
          "height", "m", above(0.0), optional,
          "orthographic: height of the picture; needs position; default: all bodies are in view"),
      field<&CameraDef::labels>("labels", "", {}, optional,
                                "write the tensions [N] beside the cables"),
      field<&CameraDef::joints>("joints", "", {}, optional,
                                "draw pins, rods and rails of the joints"),
      field<&CameraDef::axes>(
          "axes", "", {}, optional,
          "draw the directions of x, y and z in the corner of stills and films, "
          "as pages always do"),
      field<&CameraDef::time_line>("time_line", "", {}, optional,
                                   "write the duration beside the time in stills and films, and "
                                   "draw a line with a mark for the time, as pages always do"),
      field<&CameraDef::cable_radius>(
          "cable_radius", "m", above(0.0), optional,
          "radius with which cables are drawn; default: by the size of the scene"),
      field<&CameraDef::tension_max>("tension_max", "N", above(0.0), optional,
                                     "tension at the top of the colour scale; default: 98 % of the "
                                     "run's tensions are below it"),
  };
  return table;
}

std::span<const Field> StepPresetDef::field_table() {
  static const std::array table{
      choice_field<&StepPresetDef::preset>(
          "preset", step_preset_names, optional,
          "source of settings that are not given; standard: the defaults below; paper: "
          "gauss-seidel, xpbd, dt 1/60 s, substeps 1, iterations 10, as in \"Cable Joints\" "
          "(2018)"),
  };
  return table;
}

std::span<const Field> PaintDef::field_table() {
  static const std::array table{
      field<&PaintDef::body>("body", "", {}, required, "body to be painted, once at most"),
      field<&PaintDef::color>("color", "", between(0.0, 1.0), required,
                              "red, green and blue as on a screen (sRGB)"),
  };
  return table;
}

std::span<const Field> CheckDef::field_table() {
  static const std::array table{
      field<&CheckDef::quantity>(
          "quantity", "", {}, required,
          "an observable, as in the columns of a CSV file, or an expression"),
      choice_field<&CheckDef::statistic>(
          "statistic", statistic_names, optional,
          "at: value at the step nearest to the time at; mean, minimum, maximum: of the values at "
          "the ends of the steps in the window; rate: (last - first value) / time between them; "
          "range: maximum - minimum; "
          "drift: last - first value; integral: by the trapezium rule, a power's is work"),
      field<&CheckDef::at>("at", "s", at_least(0.0), optional,
                           "time for the statistic at; default: the end"),
      field<&CheckDef::from>("from", "s", at_least(0.0), optional,
                             "start of the window of all other statistics; default: 0"),
      field<&CheckDef::to>("to", "s", at_least(0.0), optional,
                           "end of that window; default: the end"),
      field<&CheckDef::equals>(
          "equals", "", any_number(), required,
          "the right value, in the observable's unit (per second for a rate, times seconds for an "
          "integral)"),
      field<&CheckDef::tolerance>("tolerance", "", at_least(0.0), optional,
                                  "largest error that passes, in the same unit"),
      field<&CheckDef::relative_tolerance>(
          "relative_tolerance", "", at_least(0.0), optional,
          "the same as a fraction of |equals|; of the two tolerances the larger counts, and one "
          "must be given"),
      field<&CheckDef::because>("because", "", {}, optional, "the closed form, as a text"),
  };
  return table;
}

double CheckDef::allowed_error() const {
  double allowed = std::nan("");
  if (tolerance) allowed = *tolerance;
  if (relative_tolerance) allowed = std::fmax(allowed, *relative_tolerance * std::abs(equals));
  return allowed;
}

std::span<const Field> Scene::field_table() {
  static const std::array table{
      choice_field<&Scene::format>("format", scene_format_names, required, "version of the format"),
      field<&Scene::name>("name", "", {}, optional, "title of the scene"),
      field<&Scene::description>("description", "", {}, optional, "explanation of the scene"),
      Field{"gravity",
            "m/s2",
            any_number(),
            required,
            "acceleration of free fall; \"up\" is "
            "against it",
            {},
            [](void* scene) -> FieldSlot { return &static_cast<Scene*>(scene)->model.gravity; }},
      field<&Scene::duration>("duration", "s", above(0.0), required, "time to simulate"),
      choice_field<&Scene::start>(
          "start", start_names, optional,
          "pose: the bodies start where they are placed, with their velocities; rest: in the "
          "equilibrium near that pose, with drives in their places; default: pose, with a warning "
          "where an elastic cable starts far from its rest"),
  };
  return table;
}

std::string to_string(const SceneError& error) {
  std::string text = error.file;
  if (error.line > 0) text += fmt::format(":{}:{}", error.line, error.column);
  if (!error.pointer.empty()) text += ": " + error.pointer;
  if (!error.value.empty()) text += ": value " + error.value;
  text += ": " + error.message;
  if (!error.allowed.empty() && error.message.find(error.allowed) == std::string::npos) {
    text += "; allowed: " + error.allowed;
  }
  return text;
}

}  // namespace sheave
