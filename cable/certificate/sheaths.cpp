// Ropes in sheaths, checked by bounds that Coulomb's law gives whatever the history.
//
// With t from the entry to the exit, the exponent X and y = ln T, a profile has |y'| <= X. Between the
// end tensions of the two spans beside the sheath it therefore lies above
//   max(ln Ta - X t, ln Tb - X (1 - t)),
// and below the same with + and min. So the ratio of the tensions is at most e^X, and the unstretched
// length in the sheath, which falls with the tension, lies between those of both bounds.
//
// Rope comes in at an end only while the tension there falls, and goes out only while it rises,
// unless the whole rope slides. The tension at a place where rope slides is that of the line from
// the end, and was on the other side of the line before; so it has changed by no more than if it had
// been on the line of the old tension. This limits the length that passes an end.

#include <algorithm>
#include <array>
#include <cmath>

#include "cable/certificate/checks.h"
#include "cable/links/sheath.h"
#include "engine/math/portable.h"

namespace sheave::certify {
namespace {

using Kind = CertificateItem::Kind;

struct SheathEvidence {
  double length = 0.0;    ///< [m]
  double exponent = 0.0;  ///< friction x bend
  double yield = 0.0;     ///< 1 / EA [1/N]
};

SheathEvidence sheath_of(const SheathLink& link, double stiffness) {
  double length = 0.0;
  double bend = 0.0;
  for (std::size_t i = 1; i < link.points.size(); ++i) {
    const Vector3 way = link.points[i] - link.points[i - 1];
    length += way.norm();
    std::size_t k = i;
    while (k > 1 && link.points[k - 1] == link.points[k - 2]) --k;
    if (k < 2 || is_zero(way)) continue;
    const Vector3 before = link.points[k - 1] - link.points[k - 2];
    bend += portable::atan2(before.cross(way).norm(), before.dot(way));
  }
  return {link.length.value_or(length), link.friction * link.bend.value_or(bend), 1.0 / stiffness};
}

/// Unstretched part of a length [m] along which the strain goes from x0 to x1 exponentially.
double unstretched(double length, double x0, double x1) {
  const double rise = x0 > 0.0 && x1 > 0.0 ? portable::log(x1 / x0) : 0.0;
  // The rule of the trapezium is exact enough for a short rise, for which logarithms cancel.
  if (std::abs(rise) < 1e-4) return 0.5 * length * (1.0 / (1.0 + x0) + 1.0 / (1.0 + x1));
  return length * (1.0 - portable::log((1.0 + x1) / (1.0 + x0)) / rise);
}

/// Unstretched rope under the upper or the lower bound of the profile between two strains [m].
double under_bound(const SheathEvidence& sheath, double entry, double exit, bool upper) {
  const double slope = upper ? sheath.exponent : -sheath.exponent;
  if (!(entry > 0.0) || !(exit > 0.0)) return upper ? sheath.length : 0.0;
  if (slope == 0.0) return unstretched(sheath.length, entry, exit);
  const double meets = std::clamp(0.5 + 0.5 * portable::log(exit / entry) / slope, 0.0, 1.0);
  const double there = entry * portable::exp(slope * meets);
  return unstretched(sheath.length * meets, entry, there) +
         unstretched(sheath.length * (1.0 - meets), there, exit);
}

/// Change of the unstretched length if the line from an end goes from one strain to another [m].
double most_change(const SheathEvidence& sheath, double before, double now) {
  const double slope = now > before ? -sheath.exponent : sheath.exponent;
  const double ratio = portable::exp(slope);
  return unstretched(sheath.length, now, now * ratio) -
         unstretched(sheath.length, before, before * ratio);
}

double strain_at(const SpanEvidence& span, End when) {
  const double rest = span.rest_length[at(when)];
  return rest > 0.0 ? std::max(span.length[at(when)] / rest - 1.0, 0.0) : 0.0;
}

class SheathCheck {
 public:
  SheathCheck(const Evidence& evidence, const CableEvidence& cable, const PassEvidence& pass,
              const SheathEvidence& sheath, Findings& findings)
      : e_(evidence), cable_(cable), pass_(pass), sheath_(sheath), findings_(findings) {
    const SpanEvidence& before = cable.spans[at(pass.before)];
    const SpanEvidence& after = cable.spans[at(pass.after)];
    for (const End when : {first_end, last_end}) {
      entry_[at(when)] = strain_at(before, when);
      exit_[at(when)] = strain_at(after, when);
    }
  }

  void check() const {
    const double most = std::max(entry_[last_end], exit_[last_end]);
    const double least = std::min(entry_[last_end], exit_[last_end]);
    const double held = least * portable::exp(sheath_.exponent);
    // Strains have the rounding of lengths over the shorter span.
    const double size = std::min(cable_.free_length, e_.bodies.scale());
    const double off = most - held;
    findings_.note(Kind::friction, "N", std::max(off, 0.0) / sheath_.yield,
                   std::max(most, 1e-9) / sheath_.yield, strain_rounding() / sheath_.yield,
                   [&] { return name(); });
    const LinkReport& link = cable_.end.links[at(pass_.link)];
    const double lies = link.stored_length;
    const double length_off = 1e-12 * (e_.bodies.scale() + cable_.end.total_length);
    findings_.note(Kind::length, "m", std::abs(lies + link.stored_stretch - sheath_.length), size,
                   length_off, [&] { return name(); });
    const double loose = under_bound(sheath_, entry_[last_end], exit_[last_end], false);
    const double tight = under_bound(sheath_, entry_[last_end], exit_[last_end], true);
    const double low = least > 0.0 ? tight : sheath_.length;
    const double high = least > 0.0 ? loose : sheath_.length;
    // A stretch that the bounds exclude is judged by the largest stretch.
    findings_.note(Kind::length, "m", std::abs(lies - std::clamp(lies, low, high)),
                   std::max(sheath_.length - low, 1e-6 * size), content_rounding(length_off),
                   [&] { return name(); });
    const bool slides = !(least > 0.0) || most > held * (1.0 - 1e-6);
    const bool starts = !(entry_[first_end] > 0.0) || !(exit_[first_end] > 0.0);
    if (slides || starts) return;
    check_end(entry_, pass_.left(), length_off);
    check_end(exit_, -pass_.came(), length_off);
  }

 private:
  [[nodiscard]] std::string name() const {
    return "link " + std::to_string(pass_.link) + " of \"" + std::string(cable_.name) + "\"";
  }
  [[nodiscard]] double strain_rounding() const {
    const SpanEvidence& before = cable_.spans[at(pass_.before)];
    const SpanEvidence& after = cable_.spans[at(pass_.after)];
    const double shortest = std::min(before.length[last_end], after.length[last_end]);
    const double length_off = 1e-12 * (e_.bodies.scale() + cable_.end.total_length);
    return shortest > 0.0 ? length_off * portable::exp(sheath_.exponent) / shortest : 1.0;
  }
  /// The bounds have the rounding of the strains, over the whole sheath.
  [[nodiscard]] double content_rounding(double length_off) const {
    return length_off + sheath_.length * strain_rounding();
  }
  /// `came`: unstretched length that has come in at this end [m].
  void check_end(const std::array<double, 2>& strains, double came, double length_off) const {
    const double bound = most_change(sheath_, strains[first_end], strains[last_end]);
    const double off = came - std::clamp(came, std::min(bound, 0.0), std::max(bound, 0.0));
    const double scale = std::max({std::abs(bound), std::abs(came), 1e-9 * sheath_.length});
    findings_.note(Kind::length, "m", std::abs(off), scale, content_rounding(length_off),
                   [&] { return name(); });
  }

  const Evidence& e_;
  const CableEvidence& cable_;
  const PassEvidence& pass_;
  const SheathEvidence& sheath_;
  Findings& findings_;
  std::array<double, 2> entry_{};
  std::array<double, 2> exit_{};
};

}  // namespace

void check_sheaths(const Evidence& evidence, const CableEvidence& cable, Findings& findings) {
  if (cable.has_changed || cable.end.cut || !cable.definition->axial_stiffness) return;
  for (const PassEvidence& pass : cable.passes) {
    if (pass.link < 0) continue;
    const auto* link =
        dynamic_cast<const SheathLink*>(cable.definition->links[at(pass.link)].get());
    if (link == nullptr) continue;
    const SheathEvidence sheath = sheath_of(*link, *cable.definition->axial_stiffness);
    SheathCheck(evidence, cable, pass, sheath, findings).check();
  }
}

}  // namespace sheave::certify
