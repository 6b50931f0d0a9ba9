#include "statics/relaxation.h"

#include <algorithm>
#include <cmath>
#include <complex>

namespace sheave {
namespace {

/// Relaxation times that differ by less are one; the error is the square of it.
constexpr double same_time = 1e-7;

void add_part(const ForceUnknown::Part& part, std::vector<Relaxation::Group>& groups) {
  const double rate = part.weight / part.damping;
  const double time = part.compliance * part.damping;
  for (Relaxation::Group& group : groups) {
    if (std::abs(time - group.time) > same_time * group.time) continue;
    group.rate += rate;
    return;
  }
  groups.push_back({rate, time});
}

}  // namespace

double Relaxation::rates() const {
  double sum = 0.0;
  for (const Group& group : groups) sum += group.rate;
  return sum;
}

double Relaxation::pull(Eigen::Index g) const {
  return 1.0 / groups[static_cast<std::size_t>(g)].time - 1.0 / last_time();
}

double Relaxation::tension(double stretch, double rate, const VectorX& e) const {
  double sum = rate + stretch / last_time();
  for (Eigen::Index g = 0; g < count(); ++g) sum += pull(g) * e[first + g];
  return sum / rates();
}

double Relaxation::damping_at(double w) const {
  std::complex<double> gives = 0.0;
  for (const Group& group : groups) gives += group.rate / std::complex(1.0 / group.time, w);
  return (1.0 / gives).imag() / w;
}

std::vector<Relaxation> relaxations_of(const Acting& acting) {
  std::vector<Relaxation> relaxations;
  Eigen::Index first = 0;
  for (std::size_t i = 0; i < acting.acts.size(); ++i) {
    const ForceUnknown& unknown = acting.rows.unknowns[i];
    if (acting.acts[i] == 0 || unknown.damper || unknown.parts.size() < 2) continue;
    const bool damped = std::ranges::all_of(unknown.parts, [](const ForceUnknown::Part& part) {
      return part.weight > 0.0 && part.compliance > 0.0 && part.damping > 0.0;
    });
    if (!damped) continue;
    Relaxation relaxation{static_cast<Eigen::Index>(i), {}, first};
    for (const ForceUnknown::Part& part : unknown.parts) add_part(part, relaxation.groups);
    if (relaxation.count() < 1) continue;
    first += relaxation.count();
    relaxations.push_back(std::move(relaxation));
  }
  return relaxations;
}

Eigen::Index count_of(const std::vector<Relaxation>& relaxations) {
  return relaxations.empty() ? 0 : relaxations.back().first + relaxations.back().count();
}

}  // namespace sheave
