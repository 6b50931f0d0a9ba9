#include "cable/winding_kernels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "cable/compiled_cable.h"
#include "engine/math/packs.h"

namespace sheave {

SHEAVE_IN_PACKS
void find_values(const WindingSpans& spans, const double* rest_lengths, const double* remainders,
                 double* __restrict values) {
  const double* const lengths = spans.lengths.data();
  const std::size_t count = spans.lengths.size();
  for (std::size_t k = 0; k < count; ++k) {
    values[k] = rest_lengths[k] + (remainders[2 * k] + remainders[2 * k + 1]) - lengths[k];
  }
}

SHEAVE_IN_PACKS
bool find_active(std::size_t count, const double* tensions, char* __restrict active) {
  std::uint64_t slack = 0;
  for (std::size_t k = 0; k < count; ++k) slack |= tensions[k] > 0.0 ? 0U : 1U;
  if (slack == 0) {
    std::fill(active, active + count, static_cast<char>(1));
    return true;
  }
  for (std::size_t k = 0; k < count; ++k) active[k] = tensions[k] > 0.0 ? 1 : 0;
  return false;
}

SHEAVE_IN_PACKS
WoundCable wind_cable(const WindingSpans& spans, const WindingCable& cable, const double* motion,
                      const double* rest_lengths, const double* remainders,
                      double* __restrict end_rest_lengths, double* __restrict end_remainders,
                      double* __restrict moved) {
  const int* const first_wheels = spans.wheels[0].data();
  const int* const second_wheels = spans.wheels[1].data();
  const double* const first_given = spans.given[0].data();
  const double* const second_given = spans.given[1].data();
  const double quantum = cable.quantum;
  const double inverse = 1.0 / quantum;
  for (std::size_t k = cable.first; k < cable.last; ++k) {
    const double first = first_given[k] * motion[first_wheels[k]];
    const double second = second_given[k] * motion[second_wheels[k]];
    const double first_rest = remainders[2 * k];
    const double second_rest = remainders[2 * k + 1];
    const double first_moved = CompiledCable::quantised_small(first + first_rest, quantum, inverse);
    const double second_moved =
        CompiledCable::quantised_small(second + second_rest, quantum, inverse);
    end_remainders[2 * k] = first_rest + (first - first_moved);
    end_remainders[2 * k + 1] = second_rest + (second - second_moved);
    moved[2 * k] = first_moved;
    moved[2 * k + 1] = second_moved;
    end_rest_lengths[k] = rest_lengths[k] + first_moved + second_moved;
  }
  WoundCable wound;
  std::array<double, pack_lanes> least{};
  std::size_t k = cable.first;
  for (; k + pack_lanes <= cable.last; k += pack_lanes) {
    for (std::size_t l = 0; l < pack_lanes; ++l) {
      least[l] = std::min(least[l], end_rest_lengths[k + l]);
    }
  }
  for (; k < cable.last; ++k) least[0] = std::min(least[0], end_rest_lengths[k]);
  wound.shortest = *std::min_element(least.begin(), least.end());
  std::array<double, pack_lanes> most{};
  std::size_t e = 2 * cable.first;
  for (; e + pack_lanes <= 2 * cable.last; e += pack_lanes) {
    for (std::size_t l = 0; l < pack_lanes; ++l) {
      most[l] = std::max(most[l], std::abs(moved[e + l]));
    }
  }
  for (; e < 2 * cable.last; ++e) most[0] = std::max(most[0], std::abs(moved[e]));
  wound.most_moved = *std::max_element(most.begin(), most.end());
  return wound;
}

SHEAVE_IN_PACKS
double find_tensions(std::size_t count, double inverse_square, const double* multipliers,
                     double* __restrict tensions) {
  std::array<double, pack_lanes> most{};
  std::size_t k = 0;
  for (; k + pack_lanes <= count; k += pack_lanes) {
    for (std::size_t l = 0; l < pack_lanes; ++l) {
      tensions[k + l] = multipliers[k + l] * inverse_square;
      most[l] = std::max(most[l], tensions[k + l]);
    }
  }
  for (; k < count; ++k) {
    tensions[k] = multipliers[k] * inverse_square;
    most[0] = std::max(most[0], tensions[k]);
  }
  return *std::max_element(most.begin(), most.end());
}

SHEAVE_IN_PACKS
bool take_from_links(const WindingSpans& spans, const double* stored, const double* moved,
                     double* __restrict end_stored) {
  const int* const before = spans.link_ends[0].data();
  const int* const after = spans.link_ends[1].data();
  const double* const least = spans.least_stored.data();
  const std::size_t count = spans.least_stored.size();
  std::uint64_t short_of = 0;
  for (std::size_t i = 0; i < count; ++i) {
    end_stored[i] = stored[i] - moved[before[i]] - moved[after[i]];
    short_of |= end_stored[i] >= least[i] ? 0U : 1U;
  }
  return short_of == 0;
}

}  // namespace sheave
