#include "cable/sheath_profile.h"

#include <algorithm>
#include <cmath>

#include "engine/math/portable.h"

namespace sheave {
namespace {

/// Differences of ln T below this are rounding, and would fill the list with fronts of no length.
constexpr double least_pull_step = 1e-13;

/// Gauss-Legendre quadrature over [0, 1].
constexpr std::array<double, 5> loss_places{0.04691007703066800, 0.23076534494715845, 0.5,
                                            0.76923465505284155, 0.95308992296933200};
constexpr std::array<double, 5> loss_weights{0.11846344252809454, 0.23931433524968324,
                                             0.28444444444444444, 0.23931433524968324,
                                             0.11846344252809454};

/// ln(1 + z) for z > -1, to full relative precision.
double log_of_one_and(double z) {
  const double sum = 1.0 + z;
  if (sum == 1.0) return z;
  // The quotient corrects the rounding of the sum (Kahan).
  return portable::log(sum) * (z / (sum - 1.0));
}

/// Integral of x / (1 + x) over a piece of the length `dt`, along which ln x rises by `rise` from x0.
double relative_stretch(double x0, double rise, double dt) {
  const double share = x0 / (1.0 + x0);
  if (std::abs(rise) < 1e-8) {
    // To second order: the derivative of x / (1 + x) by ln x is x / (1 + x)^2.
    return dt * share * (1.0 + 0.5 * rise / (1.0 + x0));
  }
  return dt * (log_of_one_and(share * portable::expm1(rise)) / rise);
}

/// z - ln(1 + z) without cancellation.
double beyond_log(double z) {
  if (std::abs(z) > 0.02) return z - log_of_one_and(z);
  // z^2 / 2 - z^3 / 3 + ...; the ninth term is below 1e-15 of the first.
  double sum = 0.0;
  for (int n = 10; n >= 2; --n) sum = 1.0 / n - z * sum;
  return z * z * sum;
}

/// Integral of x^2 / (1 + x) over such a piece: (x1 - x0 - ln((1 + x1) / (1 + x0))) / y'.
double relative_energy(double x0, double rise, double dt) {
  if (std::abs(rise) < 1e-8) {
    const double share = x0 / (1.0 + x0);
    return dt * x0 * share * (1.0 + 0.5 * rise * (2.0 + x0) / (1.0 + x0));
  }
  const double z = x0 / (1.0 + x0) * portable::expm1(rise);
  return dt * ((z * x0 + beyond_log(z)) / rise);
}

}  // namespace

SheathProfile::SheathProfile(double entry, double exit) {
  if (!(entry > 0.0) || !(exit > 0.0)) return;
  nodes_[0] = {0.0, portable::log(entry)};
  nodes_[1] = {1.0, portable::log(exit)};
  count_ = 2;
}

SheathProfile::SheathProfile(std::span<const double> reals)
    : count_(static_cast<std::size_t>(reals[0])) {
  for (std::size_t i = 0; i < count_; ++i) nodes_[i] = {reals[1 + 2 * i], reals[2 + 2 * i]};
}

void SheathProfile::save(std::span<double> reals) const {
  std::fill(reals.begin(), reals.end(), 0.0);
  reals[0] = static_cast<double>(count_);
  for (std::size_t i = 0; i < count_; ++i) {
    reals[1 + 2 * i] = nodes_[i].t;
    reals[2 + 2 * i] = nodes_[i].y;
  }
}

bool SheathProfile::is_sound(std::span<const double> reals, double exponent) {
  constexpr double excess = 1e-9;      // of the slope, by the rounding of places
  constexpr double most_pull = 690.0;  // e^690 N is near the largest double
  const double count = reals[0];
  if (count == 0.0) return true;
  if (!(count >= 2.0) || !(count <= double{most_pieces + 1}) || count != std::floor(count)) {
    return false;
  }
  const auto last = static_cast<std::size_t>(count) - 1;
  for (std::size_t i = 0; i <= last; ++i) {
    const double t = reals[1 + 2 * i];
    const double y = reals[2 + 2 * i];
    if (!(std::abs(y) <= most_pull) || !(t >= 0.0) || !(t <= 1.0)) return false;
    if (i == 0) continue;
    const double rise = y - reals[2 * i];
    const double step = t - reals[2 * i - 1];
    if (!(step >= 0.0) || !(std::abs(rise) <= exponent * step + excess)) return false;
  }
  return reals[1] == 0.0 && reals[1 + 2 * last] == 1.0;
}

double SheathProfile::most_tension() const {
  double most = slack;
  for (std::size_t i = 0; i < count_; ++i) most = std::max(most, nodes_[i].y);
  return count_ > 0 ? portable::exp(most) : 0.0;
}

double SheathProfile::at(double t) const {
  if (count_ == 0) return slack;
  std::size_t i = 1;
  while (i + 1 < count_ && nodes_[i].t < t) ++i;
  const Node& a = nodes_[i - 1];
  const Node& b = nodes_[i];
  const double step = b.t - a.t;
  return step > 0.0 ? a.y + (b.y - a.y) * ((t - a.t) / step) : b.y;
}

double SheathProfile::limit_from_entry(double y, double exponent) {
  if (y == slack) {
    count_ = 0;
    return 1.0;
  }
  const double old = entry();
  if (std::abs(y - old) <= least_pull_step) return 0.0;
  const double slope = y > old ? -exponent : exponent;
  // The height of a node over the line of the front: along a profile that obeys the law it changes
  // in one direction only.
  const double way = y > old ? 1.0 : -1.0;
  const auto height = [&](const Node& node) { return way * (node.y - y - slope * node.t); };
  std::size_t kept = 0;  // the first node beyond the front
  while (kept < count_ && height(nodes_[kept]) < 0.0) ++kept;
  if (kept == count_) {
    nodes_[0] = {0.0, y};
    nodes_[1] = {1.0, y + slope};
    count_ = 2;
    return 1.0;
  }
  const double low = -height(nodes_[kept - 1]);
  const double high = height(nodes_[kept]);
  const double share = low / (low + high);
  const double front = nodes_[kept - 1].t + share * (nodes_[kept].t - nodes_[kept - 1].t);
  if (front >= 1.0) kept = count_;
  const std::size_t left = count_ - kept;
  std::array<Node, most_pieces + 5> rest = nodes_;
  nodes_[0] = {0.0, y};
  nodes_[1] = {front, y + slope * front};
  std::copy_n(rest.begin() + static_cast<std::ptrdiff_t>(kept), left, nodes_.begin() + 2);
  count_ = 2 + left;
  // A front that ends on a node replaces the node.
  if (count_ > 2 && nodes_[2].t <= front) {
    std::copy(nodes_.begin() + 3, nodes_.begin() + static_cast<std::ptrdiff_t>(count_),
              nodes_.begin() + 2);
    --count_;
    nodes_[1].t = front;
  }
  if (count_ == 2) nodes_[1].t = 1.0;
  return front;
}

double SheathProfile::limit_from_exit(double y, double exponent) {
  if (y == slack) {
    count_ = 0;
    return 0.0;
  }
  const double old = exit();
  if (std::abs(y - old) <= least_pull_step) return 1.0;
  const double slope = y > old ? -exponent : exponent;  // per way from the exit
  const double way = y > old ? 1.0 : -1.0;
  const auto height = [&](const Node& node) { return way * (node.y - y - slope * (1.0 - node.t)); };
  std::size_t left = count_;  // number of nodes before the front
  while (left > 0 && height(nodes_[left - 1]) < 0.0) --left;
  if (left == 0) {
    nodes_[0] = {0.0, y + slope};
    nodes_[1] = {1.0, y};
    count_ = 2;
    return 0.0;
  }
  const double low = -height(nodes_[left]);
  const double high = height(nodes_[left - 1]);
  const double share = low / (low + high);
  const double front = nodes_[left].t - share * (nodes_[left].t - nodes_[left - 1].t);
  if (nodes_[left - 1].t >= front) --left;
  nodes_[left] = {front, y + slope * (1.0 - front)};
  nodes_[left + 1] = {1.0, y};
  count_ = left + 2;
  if (left == 0) nodes_[0].t = 0.0;
  return front;
}

template <class Visit>
void SheathProfile::visit_pieces(double from, double to, Visit visit) const {
  for (std::size_t i = 1; i < count_; ++i) {
    const Node& a = nodes_[i - 1];
    const Node& b = nodes_[i];
    const double step = b.t - a.t;
    const double first = std::max(from, a.t);
    const double last = std::min(to, b.t);
    if (!(last > first)) continue;
    const double slope = (b.y - a.y) / step;
    visit(a.y + slope * (first - a.t), slope * (last - first), last - first);
  }
}

double SheathProfile::stretch(const SheathLaw& law, double from, double to) const {
  double sum = 0.0;
  visit_pieces(from, to, [&](double y, double rise, double dt) {
    sum += relative_stretch(law.yield * portable::exp(y), rise, dt);
  });
  return law.length * sum;
}

double SheathProfile::energy(const SheathLaw& law, double from, double to) const {
  double sum = 0.0;
  visit_pieces(from, to, [&](double y, double rise, double dt) {
    sum += relative_energy(law.yield * portable::exp(y), rise, dt);
  });
  return 0.5 * law.length / law.yield * sum;
}

double SheathProfile::work(const SheathLaw& law, double y, bool at_exit) const {
  const auto way_in = [&](const Node& node) { return at_exit ? 1.0 - node.t : node.t; };
  const double from = at_exit ? exit() : entry();
  if (!(std::abs(y - from) > least_pull_step)) return 0.0;
  const double slope = y > from ? law.exponent : -law.exponent;
  const auto gained = [&](double pull) {
    SheathProfile moved = *this;
    double first = 0.0;
    double last = 1.0;
    if (at_exit) {
      first = moved.limit_from_exit(pull, law.exponent);
    } else {
      last = moved.limit_from_entry(pull, law.exponent);
    }
    return stretch(law, first, last) - moved.stretch(law, first, last);
  };
  const auto brought = [&](double pull) {
    const double tension = portable::exp(pull);
    return tension + 0.5 * law.yield * tension * tension;
  };
  // g M - the integral of M dg, in parts within which the front passes no node.
  std::array<double, most_pieces + 6> ends{};
  std::size_t count = 0;
  ends[count++] = from;
  const auto reach = [&](double pull) {
    if ((pull - ends[count - 1]) * slope > 0.0 && (y - pull) * slope > 0.0) ends[count++] = pull;
  };
  for (std::size_t i = 0; i < count_; ++i) {
    const Node& node = nodes_[at_exit ? count_ - 1 - i : i];
    reach(node.y + slope * way_in(node));
  }
  ends[count++] = y;
  double sum = brought(y) * gained(y);
  for (std::size_t i = 1; i < count; ++i) {
    const double range = ends[i] - ends[i - 1];
    const int parts = static_cast<int>(std::clamp(std::ceil(2.0 * std::abs(range)), 1.0, 100.0));
    for (int part = 0; part < parts; ++part) {
      for (std::size_t n = 0; n < loss_places.size(); ++n) {
        const double pull = ends[i - 1] + range * (part + loss_places[n]) / parts;
        const double tension = portable::exp(pull);
        const double rate = tension + law.yield * tension * tension;  // dg / dy
        sum -= loss_weights[n] * range / parts * rate * gained(pull);
      }
    }
  }
  return sum;
}

double SheathProfile::work_at_entry(const SheathLaw& law, double y) const {
  return work(law, y, false);
}

double SheathProfile::work_at_exit(const SheathLaw& law, double y) const {
  return work(law, y, true);
}

void SheathProfile::shorten(const SheathLaw& law) {
  while (piece_count() > most_pieces) {
    std::size_t least = 1;
    double least_change = std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i + 1 < count_; ++i) {
      const Node& a = nodes_[i - 1];
      const Node& b = nodes_[i + 1];
      const double before = stretch(law, a.t, b.t);
      const double x = law.yield * portable::exp(a.y);
      const double after = law.length * relative_stretch(x, b.y - a.y, b.t - a.t);
      const double change = std::abs(after - before);
      if (change >= least_change) continue;
      least_change = change;
      least = i;
    }
    std::copy(nodes_.begin() + static_cast<std::ptrdiff_t>(least) + 1,
              nodes_.begin() + static_cast<std::ptrdiff_t>(count_),
              nodes_.begin() + static_cast<std::ptrdiff_t>(least));
    --count_;
  }
}

FrontStretch front_stretch(const SheathLaw& law, double tension, double rise, double front) {
  const double x = law.yield * tension;
  const double turned = rise * front;
  const double end = 1.0 + x * portable::exp(turned);
  // Derivative by x: the integral of (dx / x) x / (1 + x)^2 = (x1 - x0) / ((1 + x0) (1 + x1) y').
  const double grown =
      std::abs(turned) < 1e-8 ? 1.0 + 0.5 * turned : portable::expm1(turned) / turned;
  return {law.length * relative_stretch(x, turned, front),
          law.length * law.yield * front * grown / ((1.0 + x) * end)};
}

}  // namespace sheave
