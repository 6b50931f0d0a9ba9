#include "scenes/validate_parameters.h"

#include <algorithm>
#include <string_view>
#include <unordered_set>

#include <fmt/format.h>

#include "engine/field_check.h"
#include "scenes/expression_words.h"
#include "scenes/format.h"
#include "scenes/unit.h"

namespace sheave {
namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

/// Why no parameter can have this name; empty if one can.
std::string name_fault(std::string_view name) {
  const auto is_of_word = [](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_'; };
  const bool is_word = is_name(name) && std::all_of(name.begin(), name.end(), is_of_word);
  if (!is_word || !is_letter(name.front())) {
    return "a name must be a word of at most 128 letters, digits and \"_\" that begins with a "
           "letter";
  }
  const auto& functions = expression_words::functions;
  const bool is_function = std::any_of(functions.begin(), functions.end(),
                                       [&](const auto& one) { return one.name == name; });
  if (is_function || name == "pi" || name == "t") {
    return "the name is a word of expressions; choose another one";
  }
  return {};
}

}  // namespace

Errors validate_parameters(const Scene& scene) {
  Errors errors;
  std::unordered_set<std::string_view> names;
  for (std::size_t i = 0; i < scene.model.parameters.size(); ++i) {
    const ParameterDef& own = scene.model.parameters[i];
    const std::string path = fmt::format("/parameters/{}", i);
    check_fields(ParameterDef::field_table(), &own, path, errors);
    const auto fail = [&](std::string_view key, std::string_view message) {
      errors.push_back(
          {path + std::string(key), fmt::format("parameter \"{}\": {}", own.name, message)});
    };
    if (const std::string fault = name_fault(own.name); !fault.empty()) {
      fail("/name", fault);
    } else if (!names.insert(own.name).second) {
      fail("/name", "another parameter has this name");
    }
    if (!unit_powers(own.unit)) {
      fail("/unit", fmt::format("\"{}\" is no unit; a unit is made of m, kg, s, rad, N, J, W and "
                                "Hz, as N m, m/s2 or rad/(N m)",
                                own.unit));
    }
  }
  return errors;
}

}  // namespace sheave
