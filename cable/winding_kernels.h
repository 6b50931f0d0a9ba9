#pragma once
// Loops over spans between wheels on fixed axles, which run in every substep
// (cable/cable_affine_motion.cpp).

#include <array>
#include <cstddef>
#include <vector>

namespace sheave {

/// Data of such spans, one entry per span; `wheels` and `given` for both ends.
struct WindingSpans {
  std::array<std::vector<int>, 2> wheels;    ///< index of the wheel; 0: none
  std::array<std::vector<double>, 2> given;  ///< cable that the wheel gives the span per radian [m]
  std::vector<double> lengths;               ///< lengths of spans that no body slides along [m]
  // The span ends that exchange cable with a link: indices among twice the spans, in their order. 2
  // x spans: none.
  std::array<std::vector<int>, 2> link_ends;  ///< per link
  std::vector<double> least_stored;           ///< per link: least stored length that is allowed [m]
};

/// Spans of one cable: [first, last).
struct WindingCable {
  std::size_t first = 0;
  std::size_t last = 0;
  double quantum = 1.0;  ///< quantum of lengths [m]
};

/// Figures of a cable after a substep, for checks.
struct WoundCable {
  double shortest = 0.0;    ///< least rest length, or 0 if all are above 0 [m]
  double most_moved = 0.0;  ///< most cable moved by one wheel [m]
};

/// C = L - l of each span; remainders are two per span, of its ends.
void find_values(const WindingSpans& spans, const double* rest_lengths, const double* remainders,
                 double* values);
/// Sets `active` per span: whether its tension is above 0. True if all are.
bool find_active(std::size_t count, const double* tensions, char* active);
/// Moves the cable that wheels give and take when they turn by `motion` [rad], in whole quanta.
/// `moved`: length moved at each end, two per span.
[[nodiscard]] WoundCable wind_cable(const WindingSpans& spans, const WindingCable& cable,
                                    const double* motion, const double* rest_lengths,
                                    const double* remainders, double* end_rest_lengths,
                                    double* end_remainders, double* moved);
/// Computes tensions from multipliers, mean forces times h^2, and returns the largest.
[[nodiscard]] double find_tensions(std::size_t count, double inverse_square,
                                   const double* multipliers, double* tensions);
/// Computes stored lengths after the spans have taken the moved lengths. `moved` has an additional
/// 0 at its end. False if a link would store less than it may.
[[nodiscard]] bool take_from_links(const WindingSpans& spans, const double* stored,
                                   const double* moved, double* end_stored);

}  // namespace sheave
