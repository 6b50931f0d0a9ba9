#include "engine/solvers/affine_kernels.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/math/packs.h"

namespace sheave {
namespace {

// The number of terms is a template argument, so each loop consists of sums only.

template <std::size_t terms>
struct Rows {
  const int* numbers;
  const double* gradients;
  std::size_t rows;

  [[nodiscard, gnu::always_inline]] inline double along(std::size_t i, const double* x) const {
    double sum = gradients[i] * x[numbers[i]];
    for (std::size_t p = 1; p < terms; ++p) {
      sum += gradients[p * rows + i] * x[numbers[p * rows + i]];
    }
    return sum;
  }
};

template <class Visit>
[[gnu::always_inline]] inline void visit_rows(const AffineGradients& from, Visit visit) {
  if (from.terms == 2) return visit(Rows<2>{from.numbers, from.gradients, from.rows});
  visit(Rows<4>{from.numbers, from.gradients, from.rows});
}

template <std::size_t terms>
[[gnu::always_inline]] inline void respond_in(const AffineResponses& to,
                                              const double* __restrict multipliers,
                                              double* __restrict x) {
  const int* const rows = to.rows;
  const double* const responses = to.responses;
  const std::size_t count = to.numbers;
  for (std::size_t d = 0; d < count; ++d) {
    double sum = x[d];
    for (std::size_t p = 0; p < terms; ++p) {
      sum += responses[p * count + d] * multipliers[rows[p * count + d]];
    }
    x[d] = sum;
  }
}

struct Rates {
  const double* x;
  double* __restrict out;
  template <class Slices>
  [[gnu::always_inline]] inline void operator()(const Slices& rows) const {
    for (std::size_t i = 0; i < rows.rows; ++i) out[i] = rows.along(i, x);
  }
};

struct Shortfalls {
  const double* x;
  const double* constants;
  double* __restrict out;
  template <class Slices>
  [[gnu::always_inline]] inline void operator()(const Slices& rows) const {
    for (std::size_t i = 0; i < rows.rows; ++i) out[i] = -(constants[i] + rows.along(i, x));
  }
};

struct Residuals {
  const double* x;
  const double* constants;
  const double* softness;
  const double* multipliers;
  double* __restrict out;
  template <class Slices>
  [[gnu::always_inline]] inline void operator()(const Slices& rows) const {
    for (std::size_t i = 0; i < rows.rows; ++i) {
      out[i] = std::abs(constants[i] + rows.along(i, x) + softness[i] * multipliers[i]);
    }
  }
};

}  // namespace

SHEAVE_IN_PACKS
void find_rates(const AffineGradients& along, const double* x, double* rates) {
  visit_rows(along, Rates{x, rates});
}

SHEAVE_IN_PACKS
void find_shortfalls(const AffineGradients& along, const double* constants, const double* x,
                     double* shortfalls) {
  visit_rows(along, Shortfalls{x, constants, shortfalls});
}

SHEAVE_IN_PACKS
void respond(const AffineResponses& to, const double* multipliers, double* x) {
  if (to.terms == 2) return respond_in<2>(to, multipliers, x);
  if (to.terms == 4) return respond_in<4>(to, multipliers, x);
  respond_in<8>(to, multipliers, x);
}

SHEAVE_IN_PACKS
double largest_residual(const AffineGradients& along, const double* constants,
                        const double* softness, const double* multipliers, const double* x,
                        double* residuals) {
  visit_rows(along, Residuals{x, constants, softness, multipliers, residuals});
  std::array<double, pack_lanes> most{};
  std::size_t i = 0;
  for (; i + pack_lanes <= along.rows; i += pack_lanes) {
    for (std::size_t l = 0; l < pack_lanes; ++l) most[l] = std::max(most[l], residuals[i + l]);
  }
  for (; i < along.rows; ++i) most[0] = std::max(most[0], residuals[i]);
  return *std::max_element(most.begin(), most.end());
}

SHEAVE_IN_PACKS
double take_positive(std::size_t count, const double* unknowns, double* __restrict multipliers) {
  std::array<double, pack_lanes> least{};
  std::size_t i = 0;
  for (; i + pack_lanes <= count; i += pack_lanes) {
    for (std::size_t l = 0; l < pack_lanes; ++l) {
      least[l] = std::min(least[l], unknowns[i + l]);
      multipliers[i + l] = std::max(unknowns[i + l], 0.0);
    }
  }
  for (; i < count; ++i) {
    least[0] = std::min(least[0], unknowns[i]);
    multipliers[i] = std::max(unknowns[i], 0.0);
  }
  return *std::min_element(least.begin(), least.end());
}

SHEAVE_IN_PACKS
void find_opposites(std::size_t count, const double* x, double* __restrict opposites) {
  for (std::size_t i = 0; i < count; ++i) opposites[i] = -x[i];
}

SHEAVE_IN_PACKS
void add_product(std::size_t count, double factor, const double* x, double* __restrict sums) {
  for (std::size_t i = 0; i < count; ++i) sums[i] += factor * x[i];
}

}  // namespace sheave
