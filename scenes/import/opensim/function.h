#pragma once
// Functions of one coordinate, as OpenSim has them.

#include <array>
#include <optional>
#include <vector>

#include "scenes/import/mjcf/model.h"
#include "scenes/import/opensim/properties.h"

namespace sheave::import::opensim {

/// A polynomial, or values at knots with straight lines or a cubic spline between.
class Function {
 public:
  /// A polynomial; factors of the powers 0, 1, ...
  explicit Function(std::vector<double> factors = {0.0}) : factors_(std::move(factors)) {}
  /// Through points with x that increase, at least 2. A spline has continuous second derivatives;
  /// in its first interval the third derivative is that of the cubic through the first four points,
  /// and the same at its end. Beyond the points the function is straight.
  static Function through(std::vector<double> x, std::vector<double> y, bool spline);

  [[nodiscard]] double operator()(double x) const;
  /// Whether it has no knots.
  [[nodiscard]] bool is_polynomial() const { return x_.empty(); }
  /// Factors of its powers; only of a polynomial.
  [[nodiscard]] const std::vector<double>& factors() const { return factors_; }
  [[nodiscard]] bool is_constant() const;
  /// Whether it is a straight line that is not level.
  [[nodiscard]] bool is_linear() const;
  /// The function of x whose value is that of this one at a x + b; a is not 0.
  [[nodiscard]] Function of_line(double a, double b) const;
  /// The same times a number.
  [[nodiscard]] Function scaled(double factor) const;

 private:
  void set_curvatures();

  std::vector<double> factors_;
  std::vector<double> x_, y_;
  std::vector<double> curvatures_;  ///< second derivatives at the knots; none: straight lines
};

/// A polynomial in place of a function.
struct Fit {
  mjcf::Polynomial factors{};
  double deviation = 0.0;  ///< largest difference of the values between both ends
};
/// The polynomial of the lowest degree that differs from the function by at most `allowed` between
/// `least` and `most`, else that of the highest degree.
[[nodiscard]] Fit fit_polynomial(const Function& function, double least, double most,
                                 double allowed);
/// p(a x + b) as a polynomial of x.
[[nodiscard]] mjcf::Polynomial of_line(const mjcf::Polynomial& p, double a, double b);

/// Reads the function of an object: the child <`tag`> that holds one, or a child of this name.
/// None if there is none; a type that is not known here is an error.
[[nodiscard]] std::optional<Function> read_function(const xml::Element& of, std::string_view tag,
                                                    Properties& properties, Log& log);

}  // namespace sheave::import::opensim
