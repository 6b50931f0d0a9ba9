#include "cable/cut_place.h"

#include <algorithm>
#include <cmath>

namespace sheave {
namespace {

// The lower half of a code is 1 + the span. The upper half is 0 for a share that was not chosen,
// else 1 + the share in units of 2^-30.
constexpr int half = 32;
constexpr std::int64_t lower_half = (std::int64_t{1} << half) - 1;
constexpr std::int64_t whole_span = std::int64_t{1} << 30;

}  // namespace

std::int64_t CutPlace::code() const {
  const std::int64_t lower = 1 + static_cast<std::int64_t>(span);
  if (!share) return lower;
  const double units = std::round(std::clamp(*share, 0.0, 1.0) * static_cast<double>(whole_span));
  return lower + ((1 + static_cast<std::int64_t>(units)) << half);
}

std::optional<CutPlace> CutPlace::of(std::int64_t code) {
  if (code == 0) return std::nullopt;
  CutPlace place{static_cast<int>(code & lower_half) - 1};
  const std::int64_t upper = code >> half;
  if (upper > 0) place.share = static_cast<double>(upper - 1) / static_cast<double>(whole_span);
  return place;
}

bool CutPlace::is_code(std::int64_t code, int spans) {
  if (code == 0) return true;
  if (code < 0 || (code >> half) > whole_span + 1) return false;
  const std::int64_t lower = code & lower_half;
  return lower >= 1 && lower <= spans;
}

std::vector<FreeStretch> free_stretches(const CableStateLayout& layout, const CompiledCable& cable,
                                        const FeatureState& own) {
  std::vector<FreeStretch> stretches;
  const auto real = [&](std::size_t index) { return own.reals[index]; };
  const auto next_of = [&](int link) {
    return static_cast<int>(own.integers[layout.next_index(cable.first_link + link)]);
  };
  int first = 0;
  while (first < cable.link_count && next_of(first) < 0) ++first;
  double from = 0.0;
  for (int link = first; link < cable.span_count;) {
    from += real(layout.stored_length_index(cable.first_link + link));
    const int next = next_of(link);
    if (next < 0) break;
    const double length = real(layout.rest_length_index(cable.first_span + link));
    stretches.push_back({link, from, length});
    from += length;
    link = next;
    if (link == first) break;
  }
  return stretches;
}

double length_to(const CutPlace& place, const CableStateLayout& layout, const CompiledCable& cable,
                 const FeatureState& own) {
  for (const FreeStretch& one : free_stretches(layout, cable, own)) {
    if (one.span != place.span) continue;
    return one.from + place.share.value_or(0.5) * one.length;
  }
  return 0.0;
}

}  // namespace sheave
