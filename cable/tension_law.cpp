#include "cable/tension_law.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/field_check.h"

namespace sheave {
namespace {

/// Least stiffness as a share of that of the chord of the piece. Only the number of rounds of a
/// solver depends on it: rounds end where the tension fits the strain.
constexpr double least_chord_share = 1e-3;

TimeTable table_of(const CableDef& cable) {
  return TimeTable::of(cable.strain_table, cable.tension_table, Interpolation::monotone);
}

std::string point_fault(const CableDef& cable, std::size_t i) {
  const double strain = cable.strain_table[i];
  const double tension = cable.tension_table[i];
  if (i == 0) {
    return strain == 0.0 && tension == 0.0
               ? ""
               : "a table begins with the strain 0 and the tension 0 N; this one begins with " +
                     number_text(strain) + " and " + number_text(tension) + " N";
  }
  if (!(strain > cable.strain_table[i - 1])) {
    return "strains must rise; " + number_text(strain) + " follows on " +
           number_text(cable.strain_table[i - 1]);
  }
  if (strain > TensionLaw::most_strain) {
    return "a strain is the stretch over the rest length and at most " +
           number_text(TensionLaw::most_strain) + "; this one is " + number_text(strain);
  }
  if (!(tension > cable.tension_table[i - 1])) {
    return "tensions must rise, so that a tension belongs to one strain; " + number_text(tension) +
           " N follows on " + number_text(cable.tension_table[i - 1]) + " N";
  }
  return {};
}

}  // namespace

std::optional<TensionLaw::Fault> TensionLaw::fault_of(const CableDef& cable) {
  const std::size_t count = cable.strain_table.size();
  if (count == 0 && cable.tension_table.empty()) return {};
  if (count != cable.tension_table.size()) {
    return Fault{"/tension_table", "one tension per strain is needed, " + std::to_string(count) +
                                       "; there are " + std::to_string(cable.tension_table.size())};
  }
  if (count < 2 || count > most_points) {
    return Fault{"/strain_table", "a table has 2 to " + std::to_string(most_points) +
                                      " points; this one has " + std::to_string(count)};
  }
  for (std::size_t i = 0; i < count; ++i) {
    std::string fault = point_fault(cable, i);
    if (fault.empty()) continue;
    const bool of_strain = i == 0 ? cable.strain_table[0] != 0.0 : fault[0] != 't';
    return Fault{(of_strain ? "/strain_table/" : "/tension_table/") + std::to_string(i),
                 std::move(fault)};
  }
  if (!(table_of(cable).rate(cable.strain_table.back()) > 0.0)) {
    return Fault{"/tension_table/" + std::to_string(count - 1),
                 "the curve through the points would end level, so no tension would hold a larger "
                 "load; give another point beyond the last one, or points nearer to each other "
                 "where the curve bends"};
  }
  return {};
}

TensionLaw::TensionLaw(const CableDef& cable)
    : table_(table_of(cable)),
      last_slope_(table_.rate(last_strain())),
      last_energy_(table_.integral(0.0, last_strain())),
      scale_(table_.values[1] / table_.times[1]) {}

double TensionLaw::tension(double strain) const {
  if (!(strain > 0.0)) return 0.0;
  if (strain <= last_strain()) return table_.at(strain);
  return table_.values.back() + last_slope_ * (strain - last_strain());
}

double TensionLaw::stiffness(double strain) const {
  if (strain > last_strain()) return last_slope_;
  const double inside = std::max(strain, std::numeric_limits<double>::min());
  const auto after = std::lower_bound(table_.times.begin(), table_.times.end(), inside);
  const auto i = static_cast<std::size_t>(after - table_.times.begin());
  const double chord =
      (table_.values[i] - table_.values[i - 1]) / (table_.times[i] - table_.times[i - 1]);
  return std::max(table_.rate(inside), least_chord_share * chord);
}

double TensionLaw::energy(double strain) const {
  if (!(strain > 0.0)) return 0.0;
  if (strain <= last_strain()) return table_.integral(0.0, strain);
  const double beyond = strain - last_strain();
  return last_energy_ + beyond * (table_.values.back() + 0.5 * last_slope_ * beyond);
}

double TensionLaw::strain(double tension) const {
  if (!(tension > 0.0)) return 0.0;
  if (tension >= table_.values.back()) {
    return last_strain() + (tension - table_.values.back()) / last_slope_;
  }
  const auto after = std::upper_bound(table_.values.begin(), table_.values.end(), tension);
  const auto i = static_cast<std::size_t>(after - table_.values.begin());
  double low = table_.times[i - 1];
  double high = table_.times[i];
  // Newton's method, and halves of the piece where it would leave the bounds. 200 halves end at
  // neighbouring numbers.
  double strain = 0.5 * (low + high);
  for (int round = 0; round < 200; ++round) {
    const double missing = tension - table_.at(strain);
    (missing > 0.0 ? low : high) = strain;
    double next = strain + missing / stiffness(strain);
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (next == strain) break;
    strain = next;
  }
  return strain;
}

double TensionLaw::mean(double from, double to) const {
  const double low = std::max(std::min(from, to), 0.0);
  const double high = std::max(std::max(from, to), 0.0);
  if (!(high > low)) return tension(high);
  const double last = last_strain();
  double sum = 0.0;  // shares of the way, so that small ways cancel nothing
  double left = low;
  const double inside = std::min(high, last);
  const auto add = [&](double right) {
    const double share = (right - left) / (high - low);
    sum += share *
           ((table_.at(left) + 4.0 * table_.at(0.5 * (left + right)) + table_.at(right)) / 6.0);
    left = right;
  };
  for (auto corner = std::upper_bound(table_.times.begin(), table_.times.end(), low);
       corner != table_.times.end() && *corner < inside; ++corner) {
    add(*corner);
  }
  if (left < inside) add(inside);
  if (left < high) sum += (high - left) / (high - low) * tension(0.5 * (left + high));
  return sum;
}

double TensionLaw::mean_stiffness(double from, double to) const {
  // The quotient cancels for small ways, over which the law is almost straight.
  constexpr double small = 1e-6;
  const double way = to - from;
  if (std::abs(way) <= small * std::max(std::abs(to), std::abs(from))) return 0.5 * stiffness(to);
  const double slope = (tension(to) - mean(from, to)) / way;
  return std::max(slope, 0.5 * least_chord_share * stiffness(to));
}

std::optional<double> spring_tension(const CableDef& cable, double length, double rest_length) {
  const double stretch = std::max(length - rest_length, 0.0);
  if (cable.has_material() && rest_length > 0.0) {
    return cable.axial_stiffness ? *cable.axial_stiffness * stretch / rest_length
                                 : TensionLaw(cable).tension(stretch / rest_length);
  }
  if (cable.compliance.value_or(0.0) > 0.0) return stretch / *cable.compliance;
  return {};
}

}  // namespace sheave
