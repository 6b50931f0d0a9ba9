#pragma once
// Loops of every substep over rows with constant gradients (engine/solvers/affine_motion.h), in
// slices that the processor reads several at a time.

#include <cstddef>

namespace sheave {

/// Gradients by rows: term p of row i is at p x rows + i. Unused places hold a term of number 0
/// with gradient 0.
struct AffineGradients {
  std::size_t rows = 0;
  std::size_t terms = 0;  ///< 2 or 4
  const int* numbers = nullptr;
  const double* gradients = nullptr;
};

/// The responses of each number to the multipliers of its rows, in the order of the rows. Term p of
/// number d is at p x numbers + d. Unused places hold a term of row 0 with response 0.
struct AffineResponses {
  std::size_t numbers = 0;
  std::size_t terms = 0;  ///< 2, 4 or 8
  const int* rows = nullptr;
  const double* responses = nullptr;
};

/// rates = J x.
void find_rates(const AffineGradients& along, const double* x, double* rates);
/// -(constants + J x): the right-hand side of the equations for the multipliers.
void find_shortfalls(const AffineGradients& along, const double* constants, const double* x,
                     double* shortfalls);
/// x += W J^T multipliers.
void respond(const AffineResponses& to, const double* multipliers, double* x);
/// The largest |constants + J x + softness multipliers|; `residuals` is scratch, one per row.
[[nodiscard]] double largest_residual(const AffineGradients& along, const double* constants,
                                      const double* softness, const double* multipliers,
                                      const double* x, double* residuals);
/// Writes max(unknown, 0) to the multipliers; returns the least unknown, or 0 if all are positive.
[[nodiscard]] double take_positive(std::size_t count, const double* unknowns, double* multipliers);

/// -x.
void find_opposites(std::size_t count, const double* x, double* opposites);
/// sums += factor x.
void add_product(std::size_t count, double factor, const double* x, double* sums);

}  // namespace sheave
