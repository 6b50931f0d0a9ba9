#include "cable/certificate/law_residual.h"

#include <algorithm>
#include <cmath>

#include "cable/certificate/memory_law.h"
#include "cable/certificate/rope_law.h"
#include "engine/index.h"

namespace sheave::certify {
namespace {

/// The law of a span in a substep.
class SpanLaw {
 public:
  explicit SpanLaw(const CableDef& cable) : plain_(cable) {
    if (cable.has_memory()) memory_.emplace(cable);
  }

  [[nodiscard]] bool remembers() const { return memory_.has_value(); }
  void remember(double strain) { remembered_ = strain; }
  [[nodiscard]] double slack() const { return memory_ ? memory_->slack(remembered_) : 0.0; }
  [[nodiscard]] double tension(double e) const {
    return memory_ ? memory_->tension(e, remembered_) : plain_.tension(e);
  }
  [[nodiscard]] double mean(double from, double to) const {
    constexpr double small = 1e-4;  // of a strain; below, the quotient would be rounding
    if (!memory_) return plain_.mean(from, to);
    if (std::abs(to - from) > small * std::max(from, to)) {
      return memory_->work(from, to, remembered_) / (to - from);
    }
    return (tension(from) + 4.0 * tension(0.5 * (from + to)) + tension(to)) / 6.0;
  }
  /// Energy that the bodies give if the span becomes taut and has the strain e [N].
  [[nodiscard]] double taken(double e) const {
    if (!memory_) return plain_.energy(e);
    return e > slack() ? memory_->work(slack(), e, remembered_) : 0.0;
  }
  /// Energy that the bodies get if the span goes slack [N].
  [[nodiscard]] double given(double e) const {
    if (!memory_) return plain_.energy(e);
    return e > slack() ? -memory_->work(e, slack(), remembered_) : 0.0;
  }
  [[nodiscard]] double stiffness(double e) const {
    return memory_ ? memory_->stiffness(e) : plain_.stiffness(e);
  }
  [[nodiscard]] double after(double e) const { return memory_->after(e, remembered_); }
  [[nodiscard]] double loss(double from, double to) const {
    return memory_->work(from, to, remembered_) -
           (memory_->stored(to, remembered_) - memory_->stored(from, remembered_));
  }
  [[nodiscard]] double stored(double e) const { return memory_->stored(e, remembered_); }

 private:
  RopeLaw plain_;
  std::optional<MemoryLaw> memory_;
  double remembered_ = 0.0;  ///< at the start of the substep
};

/// Sums over the spans that share a tension.
struct ChainSum {
  std::array<double, 2> excess{};  ///< length - length at which the span becomes slack [m]
  double given = 0.0;              ///< SpanLaw::given() of the start [J]
  double taken = 0.0;              ///< SpanLaw::taken() of the end [J]
  double asked = 0.0;              ///< rest length x tension by the law [N m]
  double whole = 0.0;              ///< rest lengths [m]
  double drag = 0.0;               ///< energy that dampers ask for if the spans become taut [J]
  double yield = 0.0;              ///< stretch per tension [m/N]
  double tension = 0.0;            ///< largest that is reported [N]
};

/// `behind`: rope that lies on the link behind the span, at the strain of the span [m].
void add_span(const Evidence& evidence, const CableDef& definition, const SpanEvidence& span,
              double behind, SpanLaw& law, ChainSum& sum, LawResidual& result) {
  law.remember(span.remembered[first_end]);
  std::array<double, 2> strain{};
  for (const End when : {first_end, last_end}) {
    const double rest = span.rest_length[at(when)];
    sum.excess[at(when)] += span.length[at(when)] - rest * (1.0 + law.slack());
    if (rest > 0.0) strain[at(when)] = std::max(span.length[at(when)] / rest - 1.0, 0.0);
  }
  sum.given += span.rest_length[first_end] * law.given(strain[first_end]);
  const double rest = span.rest_length[last_end];
  sum.taken += rest * law.taken(strain[last_end]);
  const double rate = (strain[last_end] - strain[first_end]) / evidence.h;
  const double damper =
      (definition.axial_damping + definition.damping * std::max(rest, 0.0)) * rate;
  const double own = (evidence.rattle ? law.mean(strain[first_end], strain[last_end])
                                      : law.tension(strain[last_end])) +
                     damper;
  sum.asked += rest * own;
  sum.drag += rest * damper * strain[last_end];
  sum.whole += rest;
  sum.yield += rest / law.stiffness(strain[last_end]);
  sum.tension = std::max(sum.tension, span.tension());
  if (!law.remembers()) return;
  const double forgotten = span.remembered[last_end] - law.after(strain[last_end]);
  result.off = std::max(result.off, rest * std::abs(forgotten));
  const double lost = law.loss(strain[first_end], strain[last_end]);
  const double length = rest + behind;
  result.loss += length * lost;
  result.energy +=
      length * (std::abs(lost) + law.stored(strain[first_end]) + law.stored(strain[last_end]));
}

}  // namespace

LawResidual law_residual(const Evidence& evidence, const CableEvidence& cable,
                         const std::vector<std::size_t>& chain) {
  const CableDef& definition = *cable.definition;
  SpanLaw law(definition);
  ChainSum sum;
  LawResidual result;
  for (const std::size_t k : chain) {
    double behind = 0.0;
    for (const PassEvidence& pass : cable.passes) {
      if (pass.stretches && at(pass.before) == k) behind += pass.laid.stored_length;
    }
    add_span(evidence, definition, cable.spans[k], behind, law, sum, result);
  }
  if (!(sum.whole > 0.0)) return result;
  double own = std::max(sum.asked / sum.whole, 0.0);
  const bool was_taut = sum.excess[first_end] > 0.0;
  const bool is_taut = sum.excess[last_end] > 0.0;
  if (evidence.rattle && was_taut != is_taut) {
    // The force takes from the bodies the energy that the spans store, or gives it back.
    const double apart = std::abs(sum.excess[last_end] - sum.excess[first_end]);
    own = (is_taut ? std::max(sum.taken + sum.drag, 0.0) : sum.given) / apart;
  } else if (!is_taut) {
    own = 0.0;
  }
  result.off = std::max(result.off, sum.yield * std::abs(sum.tension - own));
  result.most = std::max({sum.excess[first_end], sum.excess[last_end], sum.yield * sum.tension});
  return result;
}

}  // namespace sheave::certify
