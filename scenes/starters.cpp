#include "scenes/starters.h"

#include <array>

#include <scene_starters.h>

namespace sheave {

std::span<const Starter> starters() {
  static constexpr std::array<Starter, 4> all{{
      {"crane", "a winch that lifts a load on two parts of a rope", starter_texts::crane},
      {"elevator", "a traction sheave with a cabin and a counterweight", starter_texts::elevator},
      {"hand", "fingers that tendons bend against springs", starter_texts::hand},
      {"robot", "a platform on eight cables with a pretension", starter_texts::robot},
  }};
  return all;
}

}  // namespace sheave
