#include "command/tune/optimiser.h"

#include <algorithm>
#include <exception>
#include <memory>

#include "command/failure.h"

#if SHEAVE_HAS_NLOPT
#include <nlopt.h>
#endif

namespace sheave::command {

#if SHEAVE_HAS_NLOPT

namespace {

/// NLopt asks for f and for g at the same place one after the other; both are computed once.
class Evaluation {
 public:
  Evaluation(nlopt_opt search, const SearchSettings& settings, const SearchFunction& function)
      : search_(search), function_(function), x_(settings.start.size()), g_(settings.bounds) {}

  /// Called through C, which exceptions must not pass.
  void at(const double* x) noexcept {
    const std::span<const double> place(x, x_.size());
    if (known_ && std::equal(place.begin(), place.end(), x_.begin())) return;
    x_.assign(place.begin(), place.end());
    known_ = true;
    try {
      if (ended_ || !function_(x_, f_, g_)) end();
    } catch (...) {
      fault_ = std::current_exception();
      end();
    }
  }
  [[nodiscard]] double f() const { return f_; }
  [[nodiscard]] const std::vector<double>& g() const { return g_; }
  [[nodiscard]] bool ended() const { return ended_; }
  void rethrow() const {
    if (fault_) std::rethrow_exception(fault_);
  }

 private:
  void end() {
    ended_ = true;
    nlopt_force_stop(search_);
  }

  nlopt_opt search_;
  const SearchFunction& function_;
  std::vector<double> x_;
  double f_ = 0.0;
  std::vector<double> g_;
  bool known_ = false;
  bool ended_ = false;
  std::exception_ptr fault_;
};

double objective(unsigned /*count*/, const double* x, double* /*gradient*/, void* data) {
  auto& evaluation = *static_cast<Evaluation*>(data);
  evaluation.at(x);
  return evaluation.f();
}

void bounds(unsigned count, double* values, unsigned /*variables*/, const double* x,
            double* /*gradient*/, void* data) {
  auto& evaluation = *static_cast<Evaluation*>(data);
  evaluation.at(x);
  std::copy_n(evaluation.g().begin(), count, values);
}

nlopt_algorithm algorithm_of(const SearchSettings& settings) {
  switch (settings.method) {
    case TuneMethod::cobyla:
      return NLOPT_LN_COBYLA;
    case TuneMethod::bobyqa:
      return NLOPT_LN_BOBYQA;
    case TuneMethod::direct:
      break;
  }
  return settings.bounds > 0 ? NLOPT_GN_ORIG_DIRECT_L : NLOPT_GN_DIRECT_L;
}

void require(nlopt_result result) {
  if (result < 0) throw Failure(ExitCode::internal, nlopt_result_to_string(result));
}

}  // namespace

bool has_optimiser() { return true; }

SearchEnd search_least(const SearchSettings& settings, const SearchFunction& function) {
  const auto count = static_cast<unsigned>(settings.start.size());
  const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> search(
      nlopt_create(algorithm_of(settings), count), nlopt_destroy);
  if (!search) throw Failure(ExitCode::internal, "NLopt has no memory");
  Evaluation evaluation(search.get(), settings, function);
  require(nlopt_set_min_objective(search.get(), objective, &evaluation));
  require(nlopt_set_lower_bounds1(search.get(), 0.0));
  require(nlopt_set_upper_bounds1(search.get(), 1.0));
  if (settings.bounds > 0) {
    const std::vector<double> exact(settings.bounds, 0.0);
    require(nlopt_add_inequality_mconstraint(search.get(), static_cast<unsigned>(settings.bounds),
                                             bounds, &evaluation, exact.data()));
  }
  if (settings.method != TuneMethod::direct) {
    require(nlopt_set_initial_step1(search.get(), settings.step));
    require(nlopt_set_xtol_abs1(search.get(), settings.tolerance));
  }
  std::vector<double> x = settings.start;
  double f = 0.0;
  const nlopt_result result = nlopt_optimize(search.get(), x.data(), &f);
  evaluation.rethrow();
  if (evaluation.ended()) return SearchEnd::stopped;
  return result > 0 || result == NLOPT_ROUNDOFF_LIMITED ? SearchEnd::converged : SearchEnd::failed;
}

#else

bool has_optimiser() { return false; }

SearchEnd search_least(const SearchSettings& /*settings*/, const SearchFunction& /*function*/) {
  throw Failure(ExitCode::internal,
                "this build has no optimiser: install NLopt (Debian: libnlopt-dev) and configure "
                "again");
}

#endif  // SHEAVE_HAS_NLOPT

}  // namespace sheave::command
