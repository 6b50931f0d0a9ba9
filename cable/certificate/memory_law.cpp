#include "cable/certificate/memory_law.h"

#include <algorithm>
#include <cmath>

namespace sheave::certify {
namespace {

/// Boole's rule over [a, b], exact for polynomials of degree 5. Where the law changes within [a, b],
/// which `branch` tells, the interval is halved until the change has no effect.
template <class Function, class Branch>
double integral(double a, double b, const Function& f, const Branch& branch, int halvings) {
  const double middle = 0.5 * (a + b);
  if (halvings > 0 && (branch(a) != branch(middle) || branch(middle) != branch(b))) {
    return integral(a, middle, f, branch, halvings - 1) +
           integral(middle, b, f, branch, halvings - 1);
  }
  const double quarter = 0.25 * (b - a);
  return (b - a) / 90.0 *
         (7.0 * f(a) + 32.0 * f(a + quarter) + 12.0 * f(middle) + 32.0 * f(b - quarter) +
          7.0 * f(b));
}

/// The same over the pieces of a table, from `low` to `high`.
template <class Function, class Branch>
double integral_by_pieces(const std::vector<double>& strains, double low, double high,
                          const Function& f, const Branch& branch) {
  constexpr int halvings = 50;
  double sum = 0.0;
  double from = low;
  for (const double strain : strains) {
    if (!(strain > from) || !(strain < high)) continue;
    sum += integral(from, strain, f, branch, halvings);
    from = strain;
  }
  return sum + integral(from, high, f, branch, halvings);
}

CableDef with_unloading_table(const CableDef& cable) {
  CableDef other;
  other.strain_table = cable.strain_table;
  other.tension_table = cable.unloading_table;
  return other;
}

}  // namespace

MemoryLaw::MemoryLaw(const CableDef& cable)
    : loading_(cable),
      strains_(cable.strain_table),
      slope_(cable.unloading_stiffness.value_or(0.0)),
      width_(cable.transition_strain.value_or(0.0)) {
  if (!cable.unloading_table.empty()) unloading_.emplace(with_unloading_table(cable));
}

double MemoryLaw::after(double strain, double remembered) const {
  const double e = std::max(strain, 0.0);
  if (unloading_) return std::clamp(remembered, std::max(e - width_, 0.0), e);
  return std::max(remembered, e - loading_.tension(e) / slope_);
}

double MemoryLaw::tension(double strain, double remembered) const {
  if (!(strain > 0.0)) return 0.0;
  const double m = after(strain, remembered);
  if (!unloading_) return std::max(slope_ * (strain - m), 0.0);
  const double share = (strain - m) / width_;
  return share * loading_.tension(strain) + (1.0 - share) * unloading_->tension(strain);
}

double MemoryLaw::work(double from, double to, double remembered) const {
  const double first = std::max(from, 0.0);
  const double last = std::max(to, 0.0);
  const auto branch = [&](double e) {
    const double moved = after(e, remembered) - remembered;
    return (moved > 0.0 ? 1 : moved < 0.0 ? -1 : 0) + (e > slack(remembered) ? 10 : 0);
  };
  const double sum = integral_by_pieces(
      strains_, std::min(first, last), std::max(first, last),
      [&](double e) { return tension(e, remembered); }, branch);
  return first < last ? sum : -sum;
}

double MemoryLaw::stored(double strain, double remembered) const {
  const double e = std::max(strain, 0.0);
  const double m = after(e, remembered);
  if (!unloading_) return 0.5 * slope_ * std::pow(std::max(e - m, 0.0), 2);
  const auto same = [](double) { return 0; };
  const auto along = [&](double x) {
    const double share = (x - m) / width_;
    return share * loading_.tension(x) + (1.0 - share) * unloading_->tension(x);
  };
  return unloading_->energy(m) + (e > m ? integral_by_pieces(strains_, m, e, along, same) : 0.0);
}

double MemoryLaw::stiffness(double strain) const {
  const double least = loading_.stiffness(strain);
  return unloading_ ? std::min(least, unloading_->stiffness(strain)) : least;
}

}  // namespace sheave::certify
