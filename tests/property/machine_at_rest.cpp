#include "tests/property/machine_at_rest.h"

#include <iterator>
#include <string>

namespace sheave::test {

void take_out_sources(nlohmann::json& part) {
  if (part.is_array()) {
    for (nlohmann::json& one : part) take_out_sources(one);
  }
  if (!part.is_object()) return;
  for (auto one = part.begin(); one != part.end();) {
    const std::string& key = one.key();
    const bool source = key.find("drive") != std::string::npos || key.starts_with("oscillation") ||
                        key.starts_with("breaking") || key == "velocity" ||
                        key == "angular_velocity" || key == "feed_speed";
    if (!source) take_out_sources(*one);
    one = source ? part.erase(one) : std::next(one);
  }
}

}  // namespace sheave::test
