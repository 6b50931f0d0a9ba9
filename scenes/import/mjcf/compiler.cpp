// <compiler> and <option>: units, and numbers of the whole model.

#include <fmt/format.h>

#include "scenes/import/mjcf/reader.h"

namespace sheave::import::mjcf {
namespace {

void read_length_range(const xml::Element& element, LengthRangeSettings& settings, Log& log) {
  Attributes attributes(element, nullptr, log);
  if (const auto mode = attributes.choice("mode", {"none", "muscle", "muscleuser", "all"})) {
    settings.enabled = *mode != "none";
  }
  settings.keeps_given = attributes.flag("useexisting").value_or(settings.keeps_given);
  settings.uses_limits = attributes.flag("uselimit").value_or(settings.uses_limits);
  const auto positive = [&](std::string_view name, double& value) {
    const auto given = attributes.number(name);
    if (!given) return;
    if (*given > 0.0) {
      value = *given;
    } else {
      attributes.error(name, "> 0", FaultCode::out_of_range);
    }
  };
  positive("accel", settings.acceleration);
  positive("timeconst", settings.time_constant);
  positive("timestep", settings.step);
  positive("inttotal", settings.total_time);
  positive("interval", settings.interval);
  positive("inteval", settings.interval);  // as MuJoCo 2 spells it
  positive("tolrange", settings.tolerance);
  settings.most_force = attributes.positive_or_zero("maxforce").value_or(settings.most_force);
  if (settings.interval > settings.total_time) {
    attributes.error("interval", "at most inttotal", FaultCode::out_of_range);
  }
  attributes.finish({});
  log.same(element, "how the lengthrange of muscles is found");
}

}  // namespace

void read_compiler(const xml::Element& element, Compiler& compiler, Log& log) {
  Attributes attributes(element, nullptr, log);
  if (const auto unit = attributes.choice("angle", {"degree", "radian"})) {
    compiler.degrees = *unit == "degree";
  }
  if (attributes.choice("coordinate", {"local", "global"}) == "global") {
    attributes.error("coordinate",
                     "local: a model in global coordinates must be converted first (MuJoCo 2.2.2 "
                     "saves it in local ones)",
                     FaultCode::meaning);
  }
  if (const auto sequence = attributes.text("eulerseq")) {
    if (sequence->size() == 3 && sequence->find_first_not_of("xyzXYZ") == std::string::npos) {
      compiler.euler_sequence = *sequence;
    } else {
      attributes.error("eulerseq", "three letters of xyzXYZ", FaultCode::unknown_choice);
    }
  }
  compiler.auto_limits = attributes.flag("autolimits").value_or(compiler.auto_limits);
  if (const auto from = attributes.choice("inertiafromgeom", {"false", "true", "auto"})) {
    compiler.from_geoms = *from == "true"    ? FromGeoms::always
                          : *from == "false" ? FromGeoms::never
                                             : FromGeoms::unless_given;
  }
  if (const auto groups = attributes.numbers("inertiagrouprange", 2, 2); !groups.empty()) {
    compiler.groups = {groups[0], groups[1]};
  }
  compiler.least_mass = attributes.positive_or_zero("boundmass").value_or(compiler.least_mass);
  compiler.least_inertia =
      attributes.positive_or_zero("boundinertia").value_or(compiler.least_inertia);
  compiler.balances = attributes.flag("balanceinertia").value_or(compiler.balances);
  compiler.total_mass = attributes.number("settotalmass").value_or(compiler.total_mass);
  if (const auto folder = attributes.text("assetdir")) compiler.mesh_folder = *folder;
  if (const auto folder = attributes.text("meshdir")) compiler.mesh_folder = *folder;
  compiler.strip_paths = attributes.flag("strippath").value_or(compiler.strip_paths);
  // The folder of textures is of no use without them; the others speed MuJoCo up.
  attributes.finish({"texturedir", "discardvisual", "convexhull", "usethread", "fusestatic"});
  for (const xml::Element& child : element.children) {
    if (child.tag == "lengthrange") {
      read_length_range(child, compiler.length_range, log);
    } else {
      log.skipped(child, "no part of <compiler> that is known here");
    }
  }
  log.same(element, fmt::format("angles in {}", compiler.degrees ? "degrees" : "radians"));
}

namespace {

void read_flags(const xml::Element& element, Option& option, Log& log) {
  Attributes attributes(element, nullptr, log);
  const auto disabled = [&](std::string_view name) {
    return attributes.choice(name, {"enable", "disable"}) == "disable";
  };
  if (disabled("constraint")) {
    option.limits = option.friction = option.equality = false;
    log.changed(element, "constraint: limits, friction and equalities are left out");
  }
  if (disabled("gravity")) option.gravity.setZero();
  if (disabled("limit")) option.limits = false;
  if (disabled("frictionloss")) option.friction = false;
  if (disabled("passive")) option.passive = false;
  if (disabled("equality")) option.equality = false;
  if (disabled("actuation")) option.actuation = false;
  if (disabled("clampctrl")) option.clamps_controls = false;
  // A scene from a model has no contacts.
  attributes.finish({"contact", "warmstart", "filterparent", "refsafe", "energy", "fwdinv",
                     "sensornoise", "multiccd", "sensor", "midphase", "eulerdamp", "override"});
}

}  // namespace

void read_option(const xml::Element& element, Option& option, Log& log) {
  Attributes attributes(element, nullptr, log);
  option.gravity = attributes.vector("gravity").value_or(option.gravity);
  if (const auto step = attributes.number("timestep")) {
    if (*step > 0.0) {
      option.timestep = *step;
    } else {
      attributes.error("timestep", "> 0 [s]", FaultCode::out_of_range);
    }
  }
  for (const std::string_view name : {"density", "viscosity"}) {
    if (attributes.number(name).value_or(0.0) != 0.0) {
      log.changed(element, fmt::format("{}: a medium does not act on bodies", name));
    }
  }
  constexpr std::size_t groups = 31;
  for (const double group : attributes.numbers("actuatorgroupdisable", 0, groups)) {
    option.idle_actuator_groups.push_back(group);
  }
  // Settings of MuJoCo's own solver.
  attributes.finish({"integrator",       "collision",      "cone",          "jacobian",
                     "solver",           "iterations",     "tolerance",     "noslip_iterations",
                     "noslip_tolerance", "mpr_iterations", "mpr_tolerance", "impratio",
                     "apirate",          "magnetic",       "wind",          "o_margin",
                     "o_solref",         "o_solimp",       "ls_iterations", "ls_tolerance",
                     "ccd_iterations",   "ccd_tolerance",  "o_friction",    "sdf_iterations",
                     "sdf_initpoints"});
  for (const xml::Element& child : element.children) {
    if (child.tag == "flag") {
      read_flags(child, option, log);
    } else {
      log.skipped(child, "no part of <option> that is known here");
    }
  }
  log.same(element, "gravity and time step");
}

}  // namespace sheave::import::mjcf
