// Rest lengths at time 0 of spans between which an elastic rope passes freely.
//
// Rope passes a link without friction until the tensions on both sides are equal. The exchange moves
// no body and takes no time, so a state with unequal tensions is no state of a motion: its energy is
// above that of the rope, and the excess vanishes at once. With a given sum of rest lengths S, equal
// tensions are those of least energy. Rope with an axial stiffness or a table has equal tensions with
// equal strains, L_i = l_i S / sum l; rope of the compliance c in each span with equal stretches,
// L_i = l_i - c T with T = (sum l - S) / n c, where no L_i is below 0. A run without tension stays as
// it is, except that spans without stretch give spans with stretch their spare length.
//
// Dampers limit the exchange, so rope with dampers may begin uneven. A wheel without inertia turns as
// rope passes it, so its exchange is a motion and happens in the first substep.

#include <algorithm>
#include <cmath>

#include "cable/cable_compiler.h"
#include "engine/index.h"

namespace sheave {
namespace {

/// Rest lengths that differ by less than this share are even but for rounding.
constexpr double even_share = 1e-9;

struct FreeSpan {
  double length = 0.0;  ///< [m]
  double rest = 0.0;    ///< [m]
};

double rest_of(const std::vector<FreeSpan>& run) {
  double sum = 0.0;
  for (const FreeSpan& span : run) sum += span.rest;
  return sum;
}

/// Spans that are stretched by the same length, or wholly if they are shorter.
void share_stretch(std::vector<FreeSpan>& run) {
  const double rest = rest_of(run);
  std::vector<FreeSpan*> order;
  for (FreeSpan& span : run) order.push_back(&span);
  std::sort(order.begin(), order.end(),
            [](const FreeSpan* a, const FreeSpan* b) { return a->length > b->length; });
  double length = 0.0;
  double stretch = 0.0;
  double count = 0.0;
  for (const FreeSpan* span : order) {
    if (count > 0.0 && span->length <= stretch) break;
    length += span->length;
    stretch = (length - rest) / ++count;
  }
  for (FreeSpan& span : run) span.rest = std::max(span.length - stretch, 0.0);
}

void share_strain_of(std::vector<FreeSpan>& run, double length) {
  const double ratio = rest_of(run) / length;
  for (FreeSpan& span : run) span.rest = ratio * span.length;
}

/// Spans without stretch give the spans with stretch their spare length, in proportion.
void share_slack(std::vector<FreeSpan>& run) {
  double missing = 0.0;
  double spare = 0.0;
  for (const FreeSpan& span : run) {
    (span.rest < span.length ? missing : spare) += std::abs(span.length - span.rest);
  }
  for (FreeSpan& span : run) {
    span.rest = span.rest < span.length
                    ? span.length
                    : span.length + (span.rest - span.length) * (1.0 - missing / spare);
  }
}

/// The same spans with the rest lengths of one tension.
std::vector<FreeSpan> shared(std::vector<FreeSpan> run, bool by_strain) {
  double length = 0.0;
  for (const FreeSpan& span : run) length += span.length;
  if (rest_of(run) >= length) {
    share_slack(run);
  } else if (by_strain) {
    share_strain_of(run, length);
  } else {
    share_stretch(run);
  }
  return run;
}

}  // namespace

void CableCompiler::share_strain(const CableDef& def) {
  if (def.rest_lengths.empty() || !def.is_elastic()) return;
  if (def.damping > 0.0 || def.axial_damping > 0.0) return;
  std::vector<int> spans;  // those that exist at time 0
  for (int k = 0; k < def.span_count(); ++k) {
    if (!links_[at(k)].starts_lifted) spans.push_back(k);
  }
  const int count = static_cast<int>(spans.size());
  // Whether rope passes freely from the span before to span number `i`.
  const auto joins = [&](int i) {
    const int link = spans[at(i)];
    const LinkGeometry& geometry = links_[at(link)];
    return geometry.frictionless() && !geometry.massless && (def.closed || i > 0);
  };
  int begin = 0;
  while (def.closed && begin + 1 < count && joins(begin)) ++begin;
  for (int done = 0; done < count;) {
    std::vector<int> run;
    do {
      run.push_back(spans[at((begin + done++) % count)]);
    } while (done < count && joins((begin + done) % count));
    share_run_strain(def, run);
  }
}

void CableCompiler::share_run_strain(const CableDef& def, const std::vector<int>& run) {
  std::vector<FreeSpan> spans;
  bool stretched = false;
  for (const int k : run) {
    spans.push_back({geometry_[at(k)].length, given_lengths_[at(k)]});
    stretched = stretched || spans.back().rest < spans.back().length * (1.0 - even_share);
  }
  if (run.size() < 2 || !stretched) return;
  const std::vector<FreeSpan> even = shared(spans, def.has_material());
  bool changes = false;
  for (std::size_t i = 0; i < run.size(); ++i) {
    changes = changes || std::abs(even[i].rest - spans[i].rest) > even_share * spans[i].length;
  }
  if (!changes) return;
  for (std::size_t i = 0; i < run.size(); ++i) given_lengths_[at(run[i])] = even[i].rest;
}

}  // namespace sheave
