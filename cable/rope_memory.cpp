#include "cable/rope_memory.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "engine/field_check.h"

namespace sheave {
namespace {

constexpr double table_rounding = 1e-12;

/// The cable with its unloading curve as its table.
CableDef let_off(const CableDef& cable) {
  CableDef other;
  other.strain_table = cable.strain_table;
  other.tension_table = cable.unloading_table;
  return other;
}

/// A strain at which the unloading curve lies above the loading curve; none if it does nowhere.
std::optional<double> crossing(const CableDef& cable) {
  constexpr int places = 64;  // per piece
  const TensionLaw loading(cable);
  const TensionLaw unloading(let_off(cable));
  const std::vector<double>& strains = cable.strain_table;
  for (std::size_t i = 1; i < strains.size(); ++i) {
    for (int k = 1; k <= places; ++k) {
      const double e = strains[i - 1] + (strains[i] - strains[i - 1]) * k / places;
      if (unloading.tension(e) > (1.0 + table_rounding) * loading.tension(e)) return e;
    }
  }
  const double beyond = 2.0 * strains.back();
  if (unloading.stiffness(beyond) > (1.0 + table_rounding) * loading.stiffness(beyond)) {
    return beyond;
  }
  return {};
}

std::optional<TensionLaw::Fault> unloading_fault(const CableDef& cable) {
  if (cable.unloading_stiffness) {
    return TensionLaw::Fault{"/unloading_stiffness",
                             "unloading_table and unloading_stiffness exclude each other: with the "
                             "first the rope comes back to its length, with the second it yields"};
  }
  if (cable.unloading_table.size() != cable.strain_table.size()) {
    return TensionLaw::Fault{"/unloading_table",
                             "one tension per strain of strain_table is needed, " +
                                 std::to_string(cable.strain_table.size()) + "; there are " +
                                 std::to_string(cable.unloading_table.size())};
  }
  if (auto fault = TensionLaw::fault_of(let_off(cable))) {
    const std::string field = "/tension_table";
    if (fault->field.compare(0, field.size(), field) == 0) {
      fault->field = "/unloading_table" + fault->field.substr(field.size());
    }
    return fault;
  }
  if (!(cable.transition_strain.value_or(0.0) > 0.0)) {
    return TensionLaw::Fault{
        "/transition_strain",
        "a rope with an unloading_table needs transition_strain > 0, the strain over which its "
        "tension goes from one curve to the other; the smaller it is, the sharper a turn"};
  }
  if (const auto strain = crossing(cable)) {
    if (*strain > cable.strain_table.back()) {
      return TensionLaw::Fault{
          "/unloading_table",
          "beyond the last strain the unloading curve rises more steeply than the curve of "
          "tension_table, and would cross it; lower the last tension of unloading_table, or give "
          "both tables another point there"};
    }
    return TensionLaw::Fault{
        "/unloading_table",
        "the unloading curve must not lie above the curve of tension_table; near the strain " +
            number_text(*strain) +
            " it does, and the rope would give more energy than it took; lower the tensions of "
            "unloading_table there"};
  }
  return {};
}

/// The steepest slope of the curve of a table [N].
double steepest_slope(const CableDef& cable) {
  const TimeTable curve =
      TimeTable::of(cable.strain_table, cable.tension_table, Interpolation::monotone);
  double most = curve.rate(curve.times.back());
  for (std::size_t i = 1; i < curve.times.size(); ++i) {
    const double way = curve.times[i] - curve.times[i - 1];
    const double chord = (curve.values[i] - curve.values[i - 1]) / way;
    // The slope is a parabola over the piece; c is its excess in the middle.
    const double middle = curve.rate(curve.times[i - 1] + 0.5 * way);
    const double last = curve.rate(curve.times[i]);
    const double first = 6.0 * chord - 4.0 * middle - last;  // Simpson's rule is exact
    most = std::max({most, first, middle, last});
    const double bend = first - 2.0 * middle + last;
    if (!(bend < 0.0)) continue;
    const double top = std::clamp(0.25 * (first - last) / bend, -0.5, 0.5);
    most = std::max(most, middle + (last - first) * top + 2.0 * bend * top * top);
  }
  return most;
}

}  // namespace

std::optional<TensionLaw::Fault> RopeMemory::fault_of(const CableDef& cable) {
  if (cable.tension_table.empty()) {
    return TensionLaw::Fault{cable.unloading_stiffness       ? "/unloading_stiffness"
                             : cable.unloading_table.empty() ? "/transition_strain"
                                                             : "/unloading_table",
                             "a rope that is let off on another curve needs a strain_table and a "
                             "tension_table, its tensions when it is stretched"};
  }
  if (!cable.unloading_table.empty()) return unloading_fault(cable);
  if (cable.transition_strain) {
    return TensionLaw::Fault{"/transition_strain",
                             "transition_strain leads from tension_table to an unloading_table, "
                             "and there is none; give one, or leave it out"};
  }
  const double steepest = steepest_slope(cable);
  if (steepest <= (1.0 + table_rounding) * *cable.unloading_stiffness) return {};
  return TensionLaw::Fault{"/unloading_stiffness",
                           "a rope that yields is let off at least as steeply as it was stretched: "
                           "unloading_stiffness must be at least " +
                               number_text(steepest) +
                               " N, the steepest slope of the curve of tension_table"};
}

RopeMemory::RopeMemory(const CableDef& cable) : loading_(cable), corners_(cable.strain_table) {
  if (cable.unloading_table.empty()) {
    stiffness_ = *cable.unloading_stiffness;
    return;
  }
  unloading_.emplace(let_off(cable));
  width_ = *cable.transition_strain;
}

double RopeMemory::after(double strain, double m) const {
  const double e = std::max(strain, 0.0);
  if (!unloading_) return std::max(m, e - loading_.tension(e) / stiffness_);
  return std::max(std::min(std::max(m, e - width_), e), 0.0);
}

double RopeMemory::upper(double m) const {
  if (unloading_) return m + width_;
  // e - U(e) / E - m rises from below 0; beyond the table it is a straight line.
  const double last = corners_.back();
  const auto excess = [&](double e) { return e - loading_.tension(e) / stiffness_ - m; };
  if (!(excess(last) > 0.0)) {
    const double rise = 1.0 - loading_.stiffness(2.0 * last) / stiffness_;
    return rise > 0.0 ? last - excess(last) / rise : std::numeric_limits<double>::infinity();
  }
  double low = 0.0;
  double high = last;
  for (int round = 0; round < 200 && low < high; ++round) {
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) break;
    (excess(middle) > 0.0 ? high : low) = middle;
  }
  return low;
}

double RopeMemory::inner(double strain, double m) const {
  if (!unloading_) return stiffness_ * std::max(strain - m, 0.0);
  const double let_off = unloading_->tension(strain);
  return let_off + (strain - m) / width_ * (loading_.tension(strain) - let_off);
}

double RopeMemory::inner_slope(double strain, double m) const {
  if (!unloading_) return stiffness_;
  const double share = (strain - m) / width_;
  return (1.0 - share) * unloading_->stiffness(strain) + share * loading_.stiffness(strain) +
         (loading_.tension(strain) - unloading_->tension(strain)) / width_;
}

double RopeMemory::tension(double strain, double m) const {
  return strain > 0.0 ? inner(strain, after(strain, m)) : 0.0;
}

double RopeMemory::stiffness(double strain, double m) const {
  // Strains of one state that are computed in two ways differ by rounding.
  constexpr double rounding = 1e-12;
  const double e = std::max(strain, 0.0);
  const double moved = after(e, m) - m;
  if (std::abs(moved) <= rounding * (1.0 + e)) return inner_slope(e, std::min(m, e));
  return moved > 0.0 ? loading_.stiffness(e) : unloading_->stiffness(e);
}

template <class Tension>
double RopeMemory::mean_of(double from, double to, const Tension& tension) const {
  constexpr std::array<double, 3> places{0.1127016653792583, 0.5, 0.8872983346207417};
  constexpr std::array<double, 3> weights{5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
  const double low = std::min(from, to);
  const double high = std::max(from, to);
  if (!(high > low)) return tension(low);
  double sum = 0.0;
  double left = low;
  const auto add = [&](double right) {
    for (std::size_t i = 0; i < places.size(); ++i) {
      sum +=
          weights[i] * ((right - left) / (high - low)) * tension(left + places[i] * (right - left));
    }
    left = right;
  };
  for (auto corner = std::upper_bound(corners_.begin(), corners_.end(), low);
       corner != corners_.end() && *corner < high; ++corner) {
    add(*corner);
  }
  add(high);
  return sum;
}

double RopeMemory::mean(double from, double to, double m) const {
  const double first = std::max(from, 0.0);
  const double last = std::max(to, 0.0);
  if (first == last) return tension(last, m);
  const bool loads = last > first;
  const double low = std::min(first, last);
  const double high = std::max(first, last);
  const double turn = std::clamp(loads ? upper(m) : m, low, high);
  const double begin = std::clamp(slack(m), low, high);  // of the tension, if the rope is stretched
  const double taut = loads ? begin : first;
  const double within = std::abs(turn - taut) / (high - low);
  double sum = 0.0;
  if (within > 0.0) sum += within * mean_of(taut, turn, [&](double e) { return inner(e, m); });
  const double outside = std::abs(last - turn) / (high - low);
  if (!(outside > 0.0) || !(loads || unloading_)) return sum;
  const TensionLaw& outer = loads ? loading_ : *unloading_;
  return sum + outside * mean_of(turn, last, [&](double e) { return outer.tension(e); });
}

double RopeMemory::mean_stiffness(double from, double to, double m) const {
  constexpr double small = 1e-6;
  constexpr double least = 1e-3;
  const double way = std::max(to, 0.0) - std::max(from, 0.0);
  const double here = stiffness(to, m);
  if (std::abs(way) <= small * std::max(std::abs(to), std::abs(from))) return 0.5 * here;
  return std::max((tension(to, m) - mean(from, to, m)) / way, least * here);
}

double RopeMemory::stored(double strain, double m) const {
  const double e = std::max(strain, 0.0);
  const double now = after(e, m);
  if (!unloading_) {
    const double stretched = std::max(e - now, 0.0);
    return 0.5 * stiffness_ * stretched * stretched;
  }
  return unloading_->energy(now) +
         (e - now) * mean_of(now, e, [&](double x) { return inner(x, now); });
}

double RopeMemory::returned(double strain, double m) const {
  const double e = std::max(strain, 0.0);
  const double now = after(e, m);
  return unloading_ ? e * mean(e, 0.0, now) : stored(e, now);
}

double RopeMemory::lost(double from, double to, double m) const {
  return mean(from, to, m) * (std::max(to, 0.0) - std::max(from, 0.0)) -
         (stored(to, m) - stored(from, m));
}

double RopeMemory::first_strain(double tension_wanted) const {
  if (!(tension_wanted > 0.0)) return 0.0;
  double low = 0.0;
  double high = corners_.back();
  while (tension(high, 0.0) < tension_wanted) high *= 2.0;
  for (int round = 0; round < 2000; ++round) {  // of halving: ends at neighbouring numbers
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) break;
    (tension(middle, 0.0) < tension_wanted ? low : high) = middle;
  }
  return high;
}

}  // namespace sheave
