#pragma once
// The loops over spans between wheels on fixed axles that every substep goes through
// (cable/cable_affine_motion.cpp).

#include <array>
#include <cstddef>
#include <vector>

namespace sheave {

/// What every substep needs of such spans, per span; `wheels` and `given` of both ends.
struct WindingSpans {
  std::array<std::vector<int>, 2> wheels;    ///< number of the wheel; 0: none
  std::array<std::vector<double>, 2> given;  ///< cable that it gives the span per radian [m]
  std::vector<double> lengths;               ///< of those that do not slide [m]
  // Where a link's cable goes: the place of the end of a span among twice the spans, in their
  // order. 2 x spans: none.
  std::array<std::vector<int>, 2> link_ends;  ///< per link
  std::vector<double> least_stored;           ///< per link [m]
};

/// Spans of one cable: from `first` to before `last`.
struct WindingCable {
  std::size_t first = 0;
  std::size_t last = 0;
  double quantum = 1.0;  ///< of lengths [m]
};

/// What checks need of a cable after a substep.
struct WoundCable {
  double shortest = 0.0;    ///< the least rest length, or 0 [m]
  double most_moved = 0.0;  ///< by one wheel [m]
};

/// C = L - l of each span; remainders are two per span, of its ends.
void find_values(const WindingSpans& spans, const double* rest_lengths, const double* remainders,
                 double* values);
/// Whether each span has a tension; true if all have.
bool find_active(std::size_t count, const double* tensions, char* active);
/// Moves what wheels give and take as they turn by `motion` [rad], in whole quanta; what is moved
/// at each end goes to `moved`, two per span.
[[nodiscard]] WoundCable wind_cable(const WindingSpans& spans, const WindingCable& cable,
                                    const double* motion, const double* rest_lengths,
                                    const double* remainders, double* end_rest_lengths,
                                    double* end_remainders, double* moved);
/// Tensions from multipliers, mean forces times h squared; the largest of them.
[[nodiscard]] double find_tensions(std::size_t count, double inverse_square,
                                   const double* multipliers, double* tensions);
/// What links store after their spans have taken what was moved; `moved` has one more, 0, at its
/// end. False if it is less than some may store.
[[nodiscard]] bool take_from_links(const WindingSpans& spans, const double* stored,
                                   const double* moved, double* end_stored);

}  // namespace sheave
