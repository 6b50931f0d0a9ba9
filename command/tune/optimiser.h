#pragma once
// Searches for the least value of a function without derivatives, by NLopt.

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

namespace sheave::command {

/// The methods of a search: the words of --method. None of them draws random numbers, so a search
/// repeats itself.
enum class TuneMethod {
  /// Linear models on a simplex, with bounds of measures (Powell 1994).
  cobyla,
  /// Quadratic models, for two or more settings without bounds of measures (Powell 2009).
  bobyqa,
  /// Divided rectangles over the whole range (Jones 1993, Gablonsky 2001), then a local method.
  direct,
};
inline constexpr std::array<std::string_view, 3> tune_method_names{"cobyla", "bobyqa", "direct"};
[[nodiscard]] constexpr std::string_view name_of(TuneMethod method) {
  return tune_method_names[static_cast<std::size_t>(method)];
}

/// One search in the unit cube.
struct SearchSettings {
  TuneMethod method = TuneMethod::cobyla;
  std::vector<double> start;  ///< in [0, 1] each; its length is the number of variables
  double step = 0.25;         ///< first change of each variable; not of `direct`
  double tolerance = 1e-4;    ///< ends where no variable changes by more; not of `direct`
  std::size_t bounds = 0;     ///< number of values of g
};

/// Computes f(x), and g(x) with g <= 0 where a bound is kept; all values must be finite. False ends
/// the search.
using SearchFunction =
    std::function<bool(std::span<const double> x, double& f, std::span<double> g)>;

/// How a search ended.
enum class SearchEnd {
  converged,  ///< within the tolerance, or as exactly as rounding allows
  stopped,    ///< the function returned false
  failed,     ///< the method gave up
};

/// Whether this build has NLopt.
[[nodiscard]] bool has_optimiser();

/// Searches from the start. An exception of the function ends the search and passes through. A
/// Failure (70) without NLopt.
[[nodiscard]] SearchEnd search_least(const SearchSettings& settings,
                                     const SearchFunction& function);

}  // namespace sheave::command
