#include "cable/links/spool.h"

#include <cmath>
#include <limits>

#include "cable/link_geometry.h"
#include "engine/body_set.h"
#include "engine/number_text.h"

namespace sheave {

std::span<const Field> SpoolLink::field_table() {
  static const std::array table = joined(
      wheel_fields<SpoolLink>(),
      std::array{
          field<&SpoolLink::stored_length>("stored_length", "m", at_least(0.0), required,
                                           "cable wound on the drum at time 0"),
          field<&SpoolLink::layer_pitch>("layer_pitch", "m", at_least(0.0), optional,
                                         "growth of the drum's radius with every turn on it"),
          field<&SpoolLink::lead>(
              "lead", "m", any_number(), optional,
              "of a helical groove: way of the rope along the normal with every turn that is wound "
              "on; every second layer goes back; excludes layer_pitch"),
          field<&SpoolLink::turns_per_layer>(
              "turns_per_layer", "", at_least(1.0), optional,
              "turns with which a layer is full; default: one layer without end"),
          field<&SpoolLink::layer_height>(
              "layer_height", "m", above(0.0), optional,
              "growth of the drum's radius with every layer; needed with turns_per_layer"),
          field<&SpoolLink::layers>(
              "layers", "", between(0, DrumGroove::most_layers), optional,
              "layers that fit between the flanges; when they are full, the run has the event "
              "\"full\", and further layers follow; 0: any number"),
          field<&SpoolLink::groove_start>(
              "groove_start", "m", any_number(), optional,
              "place of the rope along the normal, from the center, when nothing is stored; "
              "default: -lead turns_per_layer / 2, and 0 without turns_per_layer"),
          field<&SpoolLink::most_fleet_angle>(
              "most_fleet_angle", "rad", above(0.0), optional,
              "angle of the rope to the plane of the drum above which the run warns"),
      });
  return table;
}

Errors SpoolLink::groove_faults(bool round, const std::string& path) const {
  Errors faults;
  const auto refuse = [&](const std::string& field, const std::string& message) {
    faults.push_back({path + "/" + field, message});
  };
  if (!has_groove()) {
    for (const auto& [name, given] :
         {std::pair("layer_height", layer_height.has_value()), std::pair("layers", layers > 0),
          std::pair("groove_start", groove_start.has_value()),
          std::pair("most_fleet_angle", most_fleet_angle.has_value())}) {
      if (!given) continue;
      refuse(name, std::string(name) + " is of a drum with a groove; give \"lead\" [m per turn]");
    }
    return faults;
  }
  if (!round) refuse("lead", "only a round drum has a groove; give the link a \"radius\"");
  if (layer_pitch > 0.0) {
    refuse("layer_pitch",
           "the radius of a drum with a groove grows with every full layer; leave layer_pitch "
           "out, and give \"turns_per_layer\" and \"layer_height\" [m]");
  }
  if (turns_per_layer && !layer_height) {
    refuse("layer_height",
           "layers of \"turns_per_layer\" turns need \"layer_height\" [m], for wire rope in a "
           "groove about 0.9 of its diameter");
  }
  if (!turns_per_layer && layer_height) {
    refuse("layer_height", "a drum without \"turns_per_layer\" has one layer without end");
  }
  if (!turns_per_layer && layers > 0) {
    refuse("layers", "a drum without \"turns_per_layer\" has one layer without end");
  }
  return faults;
}

Result<LinkGeometry> SpoolLink::compile(const BodySet& bodies, const std::string& path) const {
  Result<LinkGeometry> link = place(bodies, path);
  if (!link) return link;
  Errors faults = groove_faults(!link->outline, path);
  if (!faults.empty()) return faults;
  if (link->outline && layer_pitch > 0.0) {
    return Error{path + "/layer_pitch", "only a round drum can be wound in layers"};
  }
  if (!link->outline) link->hold_end();  // the end is fixed to the drum
  link->ends_here = true;
  link->given_stored_length = stored_length;
  link->layer_pitch = layer_pitch;
  if (!has_groove()) return link;
  constexpr double none = std::numeric_limits<double>::infinity();
  DrumGroove groove;
  groove.radius = std::abs(link->signed_radius);
  groove.lead = lead.value_or(0.0);
  groove.turns = turns_per_layer.value_or(none);
  groove.height = layer_height.value_or(0.0);
  groove.layers = layers;
  groove.start = groove_start.value_or(turns_per_layer ? -0.5 * groove.lead * groove.turns : 0.0);
  groove.most_fleet_angle = most_fleet_angle.value_or(none);
  if (stored_length > groove.full_length()) {
    return Error{path + "/stored_length",
                 "the " + std::to_string(layers) + " layers of the drum hold " +
                     number_text(groove.full_length(), 6) + " m of rope, and not " +
                     number_text(stored_length, 6) +
                     " m; store less, or give more \"layers\" or \"turns_per_layer\""};
  }
  link->groove = std::make_shared<const DrumGroove>(groove);
  return link;
}

}  // namespace sheave
