#include "cable/slack_run.h"

#include <algorithm>

#include "engine/index.h"

namespace sheave {

void pull_slack(std::vector<double>& spare) {
  const auto count = static_cast<int>(spare.size());
  for (int i = 0; i < count; ++i) {
    for (int distance = 1; distance < count && spare[at(i)] < 0.0; ++distance) {
      const auto available = [&](int k) {
        return k >= 0 && k < count ? std::max(spare[at(k)], 0.0) : 0.0;
      };
      const double before = available(i - distance);
      const double after = available(i + distance);
      const double needed = std::min(-spare[at(i)], before + after);
      if (!(needed > 0.0)) continue;
      const double from_before = std::clamp(0.5 * needed, needed - after, before);
      if (from_before > 0.0) spare[at(i - distance)] -= from_before;
      if (needed - from_before > 0.0) spare[at(i + distance)] -= needed - from_before;
      spare[at(i)] += needed;
    }
  }
}

}  // namespace sheave
