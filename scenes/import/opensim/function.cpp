// The spline is that of Forsythe, Malcolm and Moler, Computer Methods for Mathematical
// Computations (1977), chapter 4, which SimmSpline computes.

#include "scenes/import/opensim/function.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "engine/math/portable.h"

namespace sheave::import::opensim {
namespace {

constexpr std::size_t most_knots = 10'000;

/// The third divided difference of four successive points.
double third_difference(const std::vector<double>& x, const std::vector<double>& y,
                        std::size_t first) {
  std::array<double, 4> d{};
  for (std::size_t i = 0; i < 4; ++i) d[i] = y[first + i];
  for (std::size_t order = 1; order < 4; ++order) {
    for (std::size_t i = 0; i + order < 4; ++i) {
      d[i] = (d[i + 1] - d[i]) / (x[first + i + order] - x[first + i]);
    }
  }
  return d[0];
}

}  // namespace

Function Function::through(std::vector<double> x, std::vector<double> y, bool spline) {
  Function made;
  made.x_ = std::move(x);
  made.y_ = std::move(y);
  if (made.x_.size() == 2) {
    const double slope = (made.y_[1] - made.y_[0]) / (made.x_[1] - made.x_[0]);
    return Function({made.y_[0] - slope * made.x_[0], slope});
  }
  if (spline) made.set_curvatures();
  return made;
}

void Function::set_curvatures() {
  const std::size_t n = x_.size();
  std::vector<double> diagonal(n), right(n), upper(n);
  const auto h = [&](std::size_t i) { return x_[i + 1] - x_[i]; };
  const auto slope = [&](std::size_t i) { return (y_[i + 1] - y_[i]) / h(i); };
  // Rows: the third derivative at both ends, and equal slopes at each inner knot.
  diagonal[0] = -1.0;
  upper[0] = 1.0;
  right[0] = n > 3 ? 6.0 * h(0) * third_difference(x_, y_, 0) : 0.0;
  for (std::size_t i = 1; i < n; ++i) {
    const bool last = i + 1 == n;
    const double lower = last ? -1.0 : h(i - 1);
    diagonal[i] = last ? 1.0 : 2.0 * (h(i - 1) + h(i));
    upper[i] = last ? 0.0 : h(i);
    right[i] = last ? (n > 3 ? 6.0 * h(n - 2) * third_difference(x_, y_, n - 4) : 0.0)
                    : 6.0 * (slope(i) - slope(i - 1));
    const double factor = lower / diagonal[i - 1];
    diagonal[i] -= factor * upper[i - 1];
    right[i] -= factor * right[i - 1];
  }
  curvatures_.resize(n);
  curvatures_[n - 1] = right[n - 1] / diagonal[n - 1];
  for (std::size_t i = n - 1; i-- > 0;) {
    curvatures_[i] = (right[i] - upper[i] * curvatures_[i + 1]) / diagonal[i];
  }
}

double Function::operator()(double x) const {
  if (is_polynomial()) {
    double sum = 0.0;
    for (std::size_t k = factors_.size(); k-- > 0;) sum = sum * x + factors_[k];
    return sum;
  }
  const auto above = std::upper_bound(x_.begin() + 1, x_.end() - 1, x);
  const auto i = static_cast<std::size_t>(above - x_.begin()) - 1;
  const double h = x_[i + 1] - x_[i];
  const double slope = (y_[i + 1] - y_[i]) / h;
  if (curvatures_.empty()) return y_[i] + slope * (x - x_[i]);
  const double first = curvatures_[i];
  const double second = curvatures_[i + 1];
  if (x > x_.back())
    return y_.back() + (slope + h * (first + 2.0 * second) / 6.0) * (x - x_.back());
  const double start = slope - h * (2.0 * first + second) / 6.0;
  const double t = x - x_[i];
  if (t < 0.0) return y_[i] + start * t;
  return y_[i] + t * (start + t * (0.5 * first + t * (second - first) / (6.0 * h)));
}

bool Function::is_constant() const {
  const std::vector<double>& list = is_polynomial() ? factors_ : y_;
  const std::size_t skipped = is_polynomial() ? 1 : 0;
  const double same = is_polynomial() ? 0.0 : y_.front();
  return std::all_of(list.begin() + static_cast<std::ptrdiff_t>(skipped), list.end(),
                     [&](double value) { return value == same; });
}

bool Function::is_linear() const {
  return is_polynomial() && factors_.size() > 1 && factors_[1] != 0.0 &&
         std::all_of(factors_.begin() + 2, factors_.end(), [](double f) { return f == 0.0; });
}

Function Function::of_line(double a, double b) const {
  Function made = *this;
  if (is_polynomial()) {
    mjcf::Polynomial factors{};
    std::copy_n(factors_.begin(), std::min(factors_.size(), factors.size()), factors.begin());
    factors = opensim::of_line(factors, a, b);
    made.factors_.assign(factors.begin(), factors.begin() + static_cast<std::ptrdiff_t>(std::min(
                                                                factors_.size(), factors.size())));
    return made;
  }
  for (double& x : made.x_) x = (x - b) / a;
  for (double& curvature : made.curvatures_) curvature *= a * a;
  if (a < 0.0) {
    for (auto* list : {&made.x_, &made.y_, &made.curvatures_}) {
      std::reverse(list->begin(), list->end());
    }
  }
  return made;
}

Function Function::scaled(double factor) const {
  Function made = *this;
  for (auto* list : {&made.factors_, &made.y_, &made.curvatures_}) {
    for (double& value : *list) value *= factor;
  }
  return made;
}

mjcf::Polynomial of_line(const mjcf::Polynomial& p, double a, double b) {
  // Horner's scheme with the polynomial a x + b as the argument.
  mjcf::Polynomial sum{};
  for (std::size_t k = p.size(); k-- > 0;) {
    mjcf::Polynomial next{};
    for (std::size_t i = 0; i < p.size(); ++i) {
      next[i] += b * sum[i];
      if (i + 1 < p.size()) next[i + 1] += a * sum[i];
    }
    next[0] += p[k];
    sum = next;
  }
  return sum;
}

namespace {

/// The sum of Chebyshev polynomials of u = (x - middle) / half whose coefficients are sums over the
/// zeros of a high one of them: near to the best polynomial of its degree.
class ChebyshevSum {
 public:
  ChebyshevSum(const Function& function, double middle, double half) {
    for (std::size_t j = 0; j < nodes; ++j) {
      u_[j] = portable::cos(pi * (static_cast<double>(j) + 0.5) / static_cast<double>(nodes));
      values_[j] = function(middle + half * u_[j]);
    }
    now_[0] = 1.0;
    at_nodes_.fill(1.0);
  }

  /// Adds the next term; returns the sum in powers of u.
  const mjcf::Polynomial& add() {
    double factor = 0.0;
    for (std::size_t j = 0; j < nodes; ++j) factor += values_[j] * at_nodes_[j];
    factor *= (first_ ? 1.0 : 2.0) / static_cast<double>(nodes);
    for (std::size_t i = 0; i < sum_.size(); ++i) sum_[i] += factor * now_[i];
    // T(k + 1) = 2 u T(k) - T(k - 1), but T(1) = u.
    const double twice = first_ ? 1.0 : 2.0;
    mjcf::Polynomial next{};
    for (std::size_t i = 0; i < next.size(); ++i) {
      next[i] = (i > 0 ? twice * now_[i - 1] : 0.0) - before_[i];
    }
    before_ = now_;
    now_ = next;
    for (std::size_t j = 0; j < nodes; ++j) {
      const double further = twice * u_[j] * at_nodes_[j] - before_at_nodes_[j];
      before_at_nodes_[j] = at_nodes_[j];
      at_nodes_[j] = further;
    }
    first_ = false;
    return sum_;
  }

 private:
  static constexpr std::size_t nodes = 200;
  std::array<double, nodes> u_{}, values_{}, at_nodes_{}, before_at_nodes_{};
  mjcf::Polynomial before_{}, now_{}, sum_{};
  bool first_ = true;
};

double largest_difference(const Function& a, const Function& b, double least, double most) {
  constexpr int samples = 1000;
  double largest = 0.0;
  for (int j = 0; j <= samples; ++j) {
    const double x = least + (most - least) * j / samples;
    largest = std::max(largest, std::abs(a(x) - b(x)));
  }
  return largest;
}

}  // namespace

Fit fit_polynomial(const Function& function, double least, double most, double allowed) {
  Fit fit;
  if (function.is_polynomial() && function.factors().size() <= fit.factors.size()) {
    std::copy(function.factors().begin(), function.factors().end(), fit.factors.begin());
    return fit;
  }
  const double middle = 0.5 * (least + most);
  const double half = 0.5 * (most - least);
  ChebyshevSum sum(function, middle, half);
  for (std::size_t k = 0; k < fit.factors.size(); ++k) {
    fit.factors = of_line(sum.add(), 1.0 / half, -middle / half);
    const Function polynomial({fit.factors.begin(), fit.factors.end()});
    fit.deviation = largest_difference(polynomial, function, least, most);
    if (fit.deviation <= allowed) break;
  }
  return fit;
}

namespace {

std::optional<Function> through_points(const xml::Element& element, bool spline,
                                       Properties& properties, Log& log) {
  std::vector<double> x = properties.numbers(element, "x", 2, most_knots);
  std::vector<double> y = properties.numbers(element, "y", 2, most_knots);
  const bool rises = std::adjacent_find(x.begin(), x.end(), std::greater_equal<>()) == x.end();
  if (x.size() < 2 || x.size() != y.size() || !rises) {
    log.error(element, "x and y must be as many numbers, at least 2, and x must increase", {},
              FaultCode::out_of_range);
    return {};
  }
  return Function::through(std::move(x), std::move(y), spline);
}

std::optional<Function> function_of(const xml::Element& element, Properties& properties, Log& log,
                                    int depth) {
  properties.mark(element);
  if (element.tag == "Constant") {
    return Function({properties.number(element, "value").value_or(0.0)});
  }
  if (element.tag == "LinearFunction" || element.tag == "PolynomialFunction") {
    // From the highest power to the lowest.
    const std::size_t most = element.tag == "LinearFunction" ? 2 : mjcf::Polynomial{}.size();
    std::vector<double> factors = properties.numbers(element, "coefficients", 1, most);
    if (factors.empty()) factors = {1.0, 0.0};
    return Function({factors.rbegin(), factors.rend()});
  }
  if (element.tag == "SimmSpline" || element.tag == "NaturalCubicSpline") {
    return through_points(element, true, properties, log);
  }
  if (element.tag == "PiecewiseLinearFunction") {
    return through_points(element, false, properties, log);
  }
  const xml::Element* const inner =
      element.tag == "MultiplierFunction" ? properties.child(element, "function") : nullptr;
  if (inner != nullptr && inner->children.size() == 1 && depth > 0) {
    const auto found = function_of(inner->children.front(), properties, log, depth - 1);
    if (!found) return {};
    return found->scaled(properties.number(element, "scale").value_or(1.0));
  }
  log.error(element,
            "no function that is known here; allowed are Constant, LinearFunction, "
            "PolynomialFunction of a degree up to 9, SimmSpline, NaturalCubicSpline, "
            "PiecewiseLinearFunction and MultiplierFunction of one of these",
            {}, FaultCode::unknown_choice);
  return {};
}

}  // namespace

std::optional<Function> read_function(const xml::Element& of, std::string_view tag,
                                      Properties& properties, Log& log) {
  constexpr int depth = 4;
  for (const xml::Element& child : of.children) {
    const std::string* const name = child.value("name");
    if (child.tag == tag && child.children.size() == 1) {
      properties.mark(child);
      return function_of(child.children.front(), properties, log, depth);
    }
    if (name != nullptr && *name == tag) return function_of(child, properties, log, depth);
  }
  return {};
}

}  // namespace sheave::import::opensim
