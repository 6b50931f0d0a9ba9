#pragma once
// CableSystem::for_each_run(); included by cable/cable_system.h.

#include "cable/cable_system.h"

namespace sheave {

template <class Visit>
void CableSystem::for_each_run(const CompiledCable& cable, Visit visit) const {
  int first = first_active_span(cable, spans_);
  if (first < 0) return;
  int left = 0;
  for (int k = cable.first_span; k < cable.first_span + cable.span_count; ++k) {
    if (spans_[at(k)].active) ++left;
  }
  if (cable.closed) {
    // A ring's runs begin behind a link that no cable passes. Without such a link the ring is one
    // run.
    for (int k = cable.first_span; k < cable.first_span + cable.span_count; ++k) {
      if (!spans_[at(k)].active || shared(spans_[at(k)].second)) continue;
      first = next_span(cable, k);
      break;
    }
  }
  while (left > 0) {
    Run run{first, 1};
    int last = first;
    while (run.count < left && shared(spans_[at(last)].second)) {
      last = next_span(cable, last);
      ++run.count;
    }
    visit(run);
    left -= run.count;
    first = next_span(cable, last);
  }
}

}  // namespace sheave
