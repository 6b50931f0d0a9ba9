// <muscle>, and <general> with the three types of a muscle.

#include <algorithm>

#include <fmt/format.h>

#include "scenes/import/mjcf/reader.h"

namespace sheave::import::mjcf {
namespace {

constexpr std::size_t muscle_parameters = 9;

/// Sets range, force, scale, lmin, lmax, vmax, fpmax and fvmax.
void set_parameters(const std::vector<double>& numbers, MuscleLaw& law) {
  law.range = {numbers[0], numbers[1]};
  law.force = numbers[2];
  law.scale = numbers[3];
  law.shortest = numbers[4];
  law.longest = numbers[5];
  law.max_speed = numbers[6];
  law.passive_force = numbers[7];
  law.lengthening_force = numbers[8];
}

void read_muscle_element(Attributes& attributes, MuscleLaw& law) {
  const auto take = [&](std::string_view name, double& value) {
    if (const auto given = attributes.number(name)) value = *given;
  };
  const auto take_two = [&](std::string_view name, std::array<double, 2>& pair) {
    const auto given = attributes.numbers(name, 2, 2);
    if (!given.empty()) pair = {given[0], given[1]};
  };
  take_two("timeconst", law.time_constants);
  take_two("range", law.range);
  take("force", law.force);
  take("lmin", law.shortest);
  take("lmax", law.longest);
  take("vmax", law.max_speed);
  take("fpmax", law.passive_force);
  take("fvmax", law.lengthening_force);
  take("scale", law.scale);
}

/// Why the numbers of a muscle have no counterpart; empty: they have one.
std::string law_fault(const MuscleLaw& law) {
  if (law.force == 0.0 || (law.force < 0.0 && !(law.scale > 0.0))) {
    return "its force is 0; needed is force above 0, or scale above 0 in place of a force";
  }
  const auto rises = [](const std::array<double, 2>& pair) { return pair[0] < pair[1]; };
  const bool sound =
      rises(law.range) && (!law.length_range || rises(*law.length_range)) && law.max_speed > 0.0 &&
      law.shortest >= 0.0 && law.shortest < 1.0 && law.longest > 1.0 && law.passive_force >= 0.0 &&
      law.lengthening_force >= 1.0 && law.time_constants[0] > 0.0 && law.time_constants[1] > 0.0;
  if (sound) return {};
  return "needed are range and lengthrange that rise, timeconst and vmax above 0, 0 <= lmin < 1 < "
         "lmax, fpmax >= 0 and fvmax >= 1";
}

}  // namespace

bool is_muscle(Attributes& attributes, const xml::Element& element) {
  if (element.tag == "muscle") return true;
  const auto asks = [&](std::string_view name) {
    return attributes.text(name).value_or("") == "muscle";
  };
  return element.tag == "general" && asks("dyntype") && asks("gaintype") && asks("biastype");
}

std::optional<MuscleLaw> read_muscle(Attributes& attributes, const xml::Element& element,
                                     const Compiler& compiler, Log& log) {
  MuscleLaw law;
  std::string fault;
  if (element.tag == "muscle") {
    read_muscle_element(attributes, law);
  } else {
    const auto gains = attributes.numbers("gainprm", 1, 10);
    const auto biases = attributes.numbers("biasprm", 1, 10);
    const auto times = attributes.numbers("dynprm", 1, 10);
    const bool whole = gains.size() >= muscle_parameters && biases.size() >= muscle_parameters;
    if (whole) set_parameters(gains, law);
    if (times.size() >= 2) law.time_constants = {times[0], times[1]};
    if (!whole || !std::equal(gains.begin(), gains.begin() + muscle_parameters, biases.begin())) {
      fault =
          "gainprm and biasprm must be the same 9 numbers: range, force, scale, lmin, lmax, "
          "vmax, fpmax, fvmax";
    } else if (times.size() < 2) {
      fault = "dynprm must be 2 time constants";
    }
  }
  const auto range = attributes.numbers("lengthrange", 2, 2);
  const bool given = !range.empty() && (range[0] != 0.0 || range[1] != 0.0);
  if (given && compiler.length_range.keeps_given) law.length_range = {range[0], range[1]};
  if (attributes.number("tausmooth").value_or(0.0) != 0.0) {
    log.changed(element, "not taken: tausmooth");
  }
  if (fault.empty()) fault = law_fault(law);
  if (fault.empty()) return law;
  log.skipped(element, fault);
  return std::nullopt;
}

}  // namespace sheave::import::mjcf
