// Residuals of spans: rigid ones against their rest lengths, springs against their tensions.
//
// If cable passes between spans, only the sum of a chain's lengths is determined. The law of a
// spring is therefore checked for chains of spans joined by links over which cable may pass; a
// rigid span keeps its own length in any case. With the stretch x = l - L, the compliance a and the
// damping b, XPBD requires a T = x + a b (change of x) / h at the end of the substep, `rattle` for
// the mean of both ends; a tension below 0 is 0. Each span has its own damper, which the passing
// cable moves, too: with g = a b / h and the stretch x0 at the start the law determines x, and the
// sum of the x is checked. With a material it is a law of strains.

#include <algorithm>
#include <array>

#include "cable/certificate/checks.h"
#include "cable/certificate/hanging.h"
#include "cable/certificate/law_residual.h"
#include "cable/certificate/pushes.h"
#include "engine/math/portable.h"

namespace sheave::certify {
namespace {

double compliance_of(const CableDef& cable, double rest_length) {
  if (cable.axial_stiffness) return std::max(rest_length, 0.0) / *cable.axial_stiffness;
  return cable.compliance.value_or(0.0);
}

bool is_rigid(const CableDef& cable) { return !cable.is_elastic(); }

/// Damper of a span [N s/m].
double damper_of(const CableDef& cable, double rest_length) {
  if (!(cable.axial_damping > 0.0) || !(rest_length > 0.0)) return cable.damping;
  return cable.axial_damping / rest_length;
}

/// Change of the stretch as the damper sees it: minus the work of a unit tension along its
/// direction at the end.
double linear_stretch(const Evidence& evidence, SpanEvidence span) {
  span.force[last_end] = 1.0;
  span.load_from[last_end] = span.load_to[last_end] = Vector3::Zero();
  double work = 0.0;
  for (const SpanPush& push : pushes_of(span, last_end)) {
    work += push.force.dot(evidence.displacement(push.body, push.point, last_end));
  }
  return -work;
}

class SpanCheck {
 public:
  SpanCheck(const Evidence& evidence, const CableEvidence& cable, Findings& findings)
      : e_(evidence),
        cable_(cable),
        findings_(findings),
        size_(std::min(cable.free_length > 0.0 ? cable.free_length : evidence.bodies.scale(),
                       evidence.bodies.scale())) {
    for (const SpanEvidence& span : cable.spans) largest_ = std::max(largest_, span.tension());
  }

  void check() {
    const bool rigid = is_rigid(*cable_.definition);
    for (const SpanEvidence& span : cable_.spans) check_geometry(span);
    if (cable_.has_changed) return;
    if (hangs()) return check_chains();
    for (const SpanEvidence& span : cable_.spans) {
      check_slack(span);
      if (rigid) check_rigid(span);
    }
    if (!rigid) check_chains();
    if (cable_.definition->has_memory()) check_loss();
    for (const PassEvidence& pass : cable_.passes) {
      if (pass.stretches) check_arc(pass);
    }
  }

 private:
  static constexpr double rounding = 1e-13;

  /// The reported ends lie in the planes of their wheels, at the point of the span nearest to the
  /// centre, and the span's moment about the axle is the wheel's radius.
  void check_geometry(const SpanEvidence& span) {
    if (!span.has_tangent || span.length[last_end] <= 0.0) return;
    double off = std::abs((span.to.laid - span.from.laid).norm() - span.length[last_end]);
    for (const SpanSide* side : {&span.from, &span.to}) {
      const double radius = side->radius[last_end];
      if (side->outlined || !(radius > 0.0)) continue;
      const SpanSide& other = side == &span.from ? span.to : span.from;
      const Vector3 arm = side->laid - side->center[last_end];
      const Vector3 to_other = other.laid - side->laid;
      const double moment = side->normal[last_end].dot(arm.cross(to_other)) / to_other.norm();
      if (side->groove) {
        check_groove(*side, std::abs(moment), side->normal[last_end].dot(to_other.normalized()),
                     span);
      } else {
        off = std::max(off, std::abs(std::abs(moment) - radius));
      }
      off = std::max(off, std::abs(arm.dot(side->normal[last_end])));
      // Seen along the plane's normal, the other end lies on the tangent.
      off = std::max(off, std::abs(to_other.dot(arm)) / radius);
      const double way = side->winding * side->normal[last_end].cross(arm).dot(
                                             side == &span.from ? to_other : Vector3(-to_other));
      if (way < 0.0) off = std::max(off, span.length[last_end]);
    }
    note(CertificateItem::Kind::span, "m", off, size_, rounding * 100.0 * e_.bodies.scale(), span);
  }

  /// The span's moment about the axle of a drum with a groove, and the length per radian, relative to
  /// the radius; and the way along the axle in the substep, relative to that of the rope on the drum.
  /// `sine`: of the fleet angle.
  void check_groove(const SpanSide& side, double moment, double sine, const SpanEvidence& span) {
    const GrooveLaw::Place now = side.groove->place(side.wound[last_end]);
    const GrooveLaw::Place then = side.groove->place(side.wound[first_end]);
    const double eps = rounding * 100.0 * e_.bodies.scale();
    const double off = std::max(std::abs(moment - (now.gain - now.slope * sine)),
                                std::abs(side.radius[last_end] - now.gain));
    note(CertificateItem::Kind::span, "m", off, now.gain, eps, span);
    const auto own = [&](End when) {
      return e_.moments[at(when)].own_point(side.body, side.center[at(when)]);
    };
    const Vector3 normal =
        e_.moments[last_end].orientation(side.body).conjugate() * side.normal[last_end];
    const Vector3 travel = own(last_end) - own(first_end) - (now.axial - then.axial) * normal;
    note(CertificateItem::Kind::length, "m", travel.norm(),
         std::max(std::abs(now.length - then.length), 1e-6 * size_), eps, span);
  }

  void check_slack(const SpanEvidence& span) {
    const double tension = span.tension();
    for (const double part : span.force) {
      if (part < 0.0 && tension < 0.0) {
        note(CertificateItem::Kind::complementarity, "N", -tension, e_.largest_force,
             e_.force_rounding, span);
      }
    }
    const double stretch0 = span.length[first_end] - span.rest_length[first_end];
    const double stretch1 = span.length[last_end] - span.rest_length[last_end];
    // A span that was taut for a part of the substep had a tension.
    const double slack =
        -(e_.rattle && !is_rigid(*cable_.definition) ? std::max(stretch0, stretch1) : stretch1);
    if (!(slack > 0.0) || !(tension > 0.0)) {
      note(CertificateItem::Kind::complementarity, "N", 0.0, e_.largest_force, 0.0, span);
      return;
    }
    // A slack as large as the scene counts the whole tension, a slack below the trust level none of
    // it.
    const double share = std::min(1.0, slack / size_);
    note(CertificateItem::Kind::complementarity, "N", tension * share, std::max(largest_, tension),
         std::max(tension * rounding * 100.0, e_.force_rounding), span);
  }

  /// Cable that slides over an arc is stretched together with the spans on both sides. Its strain
  /// changes from that of the one to that of the other by e^(m phi): with the ratio q of the
  /// strains, the unstretched length is arc (1 - ln((1 + e1) / (1 + e0)) / ln q). If links are
  /// judged by the mean strains of a substep, and on outlines, which have no friction between their
  /// corners, only the range of the strains is known. Beside damped spans the cable on the link has
  /// a damper, too: its strain goes from that of the start towards that of a spring with their
  /// tensions.
  void check_arc(const PassEvidence& pass) {
    const SpanEvidence& before = cable_.spans[at(pass.before)];
    const SpanEvidence& after = cable_.spans[at(pass.after)];
    if (!(before.tension() > 0.0) && !(after.tension() > 0.0)) return;
    const bool damped = cable_.definition->is_damped();
    const double first = damped ? spring_strain(before) : strain_of(before, last_end);
    const double last = damped ? spring_strain(after) : strain_of(after, last_end);
    double least = std::min(first, last);
    double most = std::max(first, last);
    const double lies = pass.laid.stored_length;
    const double arc = lies + pass.laid.stored_stretch;
    const bool exact = !damped && (!e_.rattle || !(pass.friction > 0.0));
    if (damped) {
      least = std::min(least, pass.start_strain);
      most = std::max(most, pass.start_strain);
    }
    if (!exact && e_.rattle) {
      for (const SpanEvidence* span : {&before, &after}) {
        least = std::min(least, strain_of(*span, first_end));
        most = std::max(most, strain_of(*span, first_end));
        if (!damped) continue;
        // The tension of `rattle` is the mean of both ends.
        const double last_strain = 2.0 * spring_strain(*span) - strain_of(*span, first_end);
        least = std::min(least, std::max(last_strain, 0.0));
        most = std::max({most, last_strain, strain_of(*span, last_end)});
      }
    }
    double low = arc / (1.0 + most);
    double high = arc / (1.0 + least);
    if (exact && least > 0.0 && pass.laid.path.empty()) {
      const double ratio = portable::log(most / least);
      // For almost equal strains the ratio of logarithms is rounding error.
      constexpr double alike = 1e-6;
      if (ratio > alike) {
        low = high = arc * (1.0 - portable::log((1.0 + most) / (1.0 + least)) / ratio);
      }
    }
    note(CertificateItem::Kind::span, "m", std::abs(lies - std::clamp(lies, low, high)),
         std::max(arc - low, 1e-6 * size_), rounding * 1e3 * e_.bodies.scale(), before);
  }

  [[nodiscard]] bool hangs() const {
    return cable_.definition->linear_density > 0.0 && !is_zero(e_.gravity);
  }

  /// The rest length of a rope with weight is that of a catenary with its tension: with `rattle`, the
  /// mean of the catenaries at both ends of the substep is. Rope that passes freely changes the sum
  /// over the spans of a chain only.
  void check_hanging(const std::vector<std::size_t>& chain) {
    const CableDef& cable = *cable_.definition;
    const double yield = cable.axial_stiffness ? 1.0 / *cable.axial_stiffness : 0.0;
    double residual = 0.0;
    bool moves = false;
    bool slack = false;
    for (const std::size_t k : chain) {
      const SpanEvidence& span = cable_.spans[k];
      moves = moves || std::any_of(span.force.begin(), span.force.end(),
                                   [](double force) { return force != 0.0; });
      if (!(span.told > 0.0) && !cable.floor) return;
      const auto off = [&](End when) {
        const double tension = tension_at(e_, cable, span, when);
        const double rest_length = span.rest_length[at(when)];
        const HungRope rope = rope_of(e_, cable, span, when);
        const HungLength hung = hung_length(rope, span, when, tension);
        slack = slack || hung.slack;
        const double spare = rest_length - hung.length;
        return hangs_in_a_fold(rope, tension, rest_length) ? std::min(spare, 0.0) : spare;
      };
      residual += e_.rattle ? 0.5 * (off(first_end) + off(last_end)) : off(last_end);
    }
    if (!moves) return;  // both ends are fixed
    // The rest of a slack rope lies loose on its floor.
    if (slack) residual = std::min(residual, 0.0);
    const SpanEvidence& first = cable_.spans[chain.front()];
    residual *= 1.0 + yield * spring_tension(e_, cable, first);
    note(CertificateItem::Kind::span, "m", std::abs(residual), size_,
         rounding * 1e3 * e_.bodies.scale(), first);
  }

  void check_rigid(const SpanEvidence& span) {
    const double stretch = span.length[last_end] - span.rest_length[last_end];
    note(CertificateItem::Kind::span, "m", std::max(stretch, 0.0), size_,
         rounding * 100.0 * e_.bodies.scale(), span);
  }

  void check_chains() {
    const CableDef& cable = *cable_.definition;
    std::vector<char> done(cable_.spans.size(), 0);
    for (std::size_t k = 0; k < cable_.spans.size(); ++k) {
      if (done[k] != 0) continue;
      std::vector<std::size_t> chain{k};
      done[k] = 1;
      for (std::size_t i = 0; i < chain.size(); ++i) {
        for (const PassEvidence& pass : cable_.passes) {
          if (!pass.passes || holds(pass)) continue;
          for (const auto& [own, other] :
               {std::pair{pass.before, pass.after}, std::pair{pass.after, pass.before}}) {
            if (at(own) != chain[i] || done[at(other)] != 0) continue;
            done[at(other)] = 1;
            chain.push_back(at(other));
          }
        }
      }
      check_chain(cable, chain);
    }
  }

  /// Whether a link separates the spans on its two sides. A link at its bound need not: the spans
  /// on both sides then obey the law of their sum, as while cable slides. A link without tension on
  /// both sides does not hold.
  [[nodiscard]] bool holds(const PassEvidence& pass) const {
    if (!(pass.friction > 0.0) || pass.slip != 0.0) return false;
    const SpanEvidence& before = cable_.spans[at(pass.before)];
    const SpanEvidence& after = cable_.spans[at(pass.after)];
    const bool forwards = before.tension() < after.tension();
    constexpr double at_bound = 1.0 - 1e-6;
    return std::max(before.tension(), after.tension()) <
           at_bound * carried(pass, forwards ? before : after);
  }

  static double strain_of(const SpanEvidence& span, End when) {
    const double rest = span.rest_length[at(when)];
    return rest > 0.0 ? std::max(span.length[at(when)] / rest - 1.0, 0.0) : 0.0;
  }

  /// Strain at which a spring without a damper has the tension of the span.
  [[nodiscard]] double spring_strain(const SpanEvidence& span) const {
    return std::max(span.tension(), 0.0) / *cable_.definition->axial_stiffness;
  }

  /// Whether cable has begun to slide over an arc, or went slack or taut there: the strains of the
  /// adjacent spans had another ratio at the start of the substep than at its end, or were 0 at one
  /// of them. With `rattle` the arc's own stretch at both ends then matters, too, which spans do not
  /// show.
  [[nodiscard]] bool begins_apart(const std::vector<std::size_t>& chain) const {
    constexpr double alike = 1e-6;
    return std::any_of(cable_.passes.begin(), cable_.passes.end(), [&](const PassEvidence& pass) {
      if (!pass.stretches ||
          std::find(chain.begin(), chain.end(), at(pass.before)) == chain.end()) {
        return false;
      }
      const SpanEvidence& before = cable_.spans[at(pass.before)];
      const SpanEvidence& after = cable_.spans[at(pass.after)];
      const std::array was{strain_of(before, first_end), strain_of(after, first_end)};
      const std::array is{strain_of(before, last_end), strain_of(after, last_end)};
      if ((was[0] + was[1] > 0.0) != (is[0] + is[1] > 0.0)) return true;
      const double as_it_was = was[0] * is[1];
      const double as_it_is = is[0] * was[1];
      return std::abs(as_it_was - as_it_is) > alike * std::max(as_it_was, as_it_is);
    });
  }

  /// The law of a rope takes energy and never gives any; the reported loss is that of the lengths.
  void check_loss() {
    if (!knows_loss_) return;
    const double told = cable_.end.hysteresis_loss - cable_.start.hysteresis_loss;
    const double off = std::abs(told - lost_) + std::max(-lost_, 0.0);
    // Strains are differences of lengths of the size of the scene.
    const double slip = 1e3 * rounding * e_.bodies.scale() * std::max(largest_, 0.0);
    note(CertificateItem::Kind::energy, "J", off, energy_, slip + rounding * energy_,
         cable_.spans.front());
  }

  void check_chain(const CableDef& cable, const std::vector<std::size_t>& chain) {
    if (hangs()) return check_hanging(chain);
    bool judged = !(e_.rattle && begins_apart(chain));
    for (const std::size_t k : chain) judged = judged && cable_.spans[k].has_tangent;
    knows_loss_ = knows_loss_ && judged;
    if (!judged) return;
    if (!cable.tension_table.empty()) {
      const LawResidual law = law_residual(e_, cable_, chain);
      note(CertificateItem::Kind::span, "m", law.off, std::max(law.most, 1e-6 * size_),
           rounding * 1e3 * e_.bodies.scale(), cable_.spans[chain.front()]);
      lost_ += law.loss;
      energy_ += law.energy;
      return;
    }
    ChainSum sum;
    for (const std::size_t k : chain) add_span(cable, k, sum);
    // The stretch of a slack spring counts as 0.
    if (e_.rattle) sum.off += 0.5 * (std::max(sum.before, 0.0) - sum.before);
    const auto counted = [&](double residual) {
      const double given = sum.most_damped * residual;
      return sum.pulled == 0.0 ? std::max(given, 0.0) : std::abs(given);
    };
    double off = counted(sum.off);
    // Damped spans that share a tension keep the midpoint rule.
    if (e_.rattle && (sum.first > 0.0) != (sum.now > 0.0) &&
        !(sum.most_damped > 1.0 && chain.size() > 1)) {
      // The ropes of a knot become taut together, and share the mean force of that substep by the
      // directions at both of its ends.
      if (ends_at_knot()) return;
      const double crossed = counted(crossing(sum) / sum.most_damped);
      // Spans beside a link at its bound may go slack one by one or together.
      const bool by_friction =
          std::any_of(chain.begin(), chain.end(), [&](std::size_t k) { return rubs(k); });
      off = by_friction ? std::min(off, crossed) : crossed;
    }
    // In a slack chain only dampers can hold a span stretched.
    if (sum.pulled == 0.0 && !(sum.now > 0.0)) off = std::max(off, sum.stretched);
    note(CertificateItem::Kind::span, "m", off, std::max(sum.most, 1e-6 * size_),
         rounding * 1e3 * e_.bodies.scale(), cable_.spans[chain.front()]);
  }

  struct ChainSum {
    double off = 0.0;          ///< sum of the residuals of the stretches [m]
    double first = 0.0;        ///< sum of the stretches at the start [m]
    double before = 0.0;       ///< the part of it that counts in full [m]
    double now = 0.0;          ///< sum of the stretches at the end [m]
    double stretched = 0.0;    ///< largest stretch of a span beyond that which its damper holds [m]
    double pulled = 0.0;       ///< sum of the tensions [N]
    double pulls = 0.0;        ///< sum of the stretches by the tensions alone [m]
    double most = 0.0;         ///< largest stretch, or stretch by a tension [m]
    double most_damped = 0.0;  ///< 1 + g
  };

  /// Whether friction acts on the cable at an end of the span.
  [[nodiscard]] bool rubs(std::size_t span) const {
    return std::any_of(cable_.passes.begin(), cable_.passes.end(), [&](const PassEvidence& pass) {
      return pass.friction > 0.0 && (at(pass.before) == span || at(pass.after) == span);
    });
  }

  [[nodiscard]] bool ends_at_knot() const {
    const auto& links = cable_.definition->links;
    return std::any_of(links.begin(), links.end(), [&](const auto& link) {
      return e_.bodies[e_.bodies.index(link->body)].mobility == Mobility::knot;
    });
  }

  /// Residual of spans that go slack or taut [m]. Their force over the substep takes from the bodies
  /// the energy that they store, or gives them the energy that they stored. A damper acts while its
  /// span is taut.
  static double crossing(const ChainSum& sum) {
    const double damping = 0.5 * (sum.most_damped - 1.0);
    const double stretched = std::max(sum.now, 0.0) - std::max(sum.first, 0.0);
    const double asked = acting_mean(sum.first, sum.now) + damping * stretched;
    return std::max(asked, 0.0) - sum.pulls;
  }

  void add_span(const CableDef& cable, std::size_t k, ChainSum& sum) const {
    const SpanEvidence& span = cable_.spans[k];
    const double passed = slid_into(static_cast<int>(k));
    double rest_length = span.rest_length[last_end];
    double stretch = span.length[last_end] - rest_length;
    if (cable_.frozen) {
      // The force acted between attachments that keep their places on the bodies; their distance
      // contains the rolled cable.
      rest_length = span.rest_length[first_end] + span.fed + passed;
      stretch = (span.to.point[last_end] - span.from.point[last_end]).norm() - rest_length;
    }
    const double pull = compliance_of(cable, rest_length) * span.tension();
    // The damper of the passed cable begins in the next substep.
    double own_length = rest_length - passed;
    if (!cable_.frozen && cable.axial_stiffness && cable.is_damped()) {
      own_length =
          spring_length(e_, cable_, span, own_length - span.rest_length[first_end] - span.fed);
    }
    const double share = compliance_of(cable, own_length) * damper_of(cable, own_length) / e_.h;
    const double start = stretch_before(cable, span, stretch, rest_length, passed);
    sum.most = std::max({sum.most, std::abs(stretch), pull});
    sum.pulled += span.tension();
    sum.pulls += pull;
    sum.first += raw_stretch(span, rest_length);
    sum.now += stretch;
    sum.stretched = std::max(sum.stretched, stretch - share / (1.0 + share) * std::max(start, 0.0));
    sum.most_damped = std::max(sum.most_damped, 1.0 + (e_.rattle ? 2.0 : 1.0) * share);
    if (!e_.rattle) {
      sum.off += stretch - (pull + share * start) / (1.0 + share);
      return;
    }
    const double twice = 2.0 * share;
    if (!(share > 0.0)) sum.before += start;
    sum.off += 0.5 * (stretch + ((1.0 - twice) * start - 2.0 * pull) / (1.0 + twice));
  }

  /// Stretch of the span at the start, below 0 if it is slack, with the strain's length at the end [m].
  [[nodiscard]] double raw_stretch(const SpanEvidence& span, double rest_length) const {
    const double length = span.rest_length[first_end];
    const double stretch = span.length[first_end] - length;
    const bool material = cable_.definition->axial_stiffness && length > 0.0 && stretch > 0.0;
    return material ? stretch * rest_length / length : stretch;
  }

  /// Stretch of the span at the start of the substep as its law counts it [m]. `stretch` and
  /// `rest_length` are those at the end.
  double stretch_before(const CableDef& cable, const SpanEvidence& span, double stretch,
                        double rest_length, double passed) const {
    double start = span.length[first_end] - span.rest_length[first_end];
    double length = span.rest_length[first_end];
    if (!e_.rattle) {
      length = rest_length - passed;
      start = stretch + passed;
      if (cable.is_damped()) start -= linear_stretch(e_, span);
    }
    // With a material, cable that passes an end brings its strain.
    if (cable.is_damped() && cable.axial_stiffness && !cable_.frozen) {
      length = span.rest_length[first_end];
      start = span.length[first_end] - length;
    }
    // With a material the force follows from the strain, independent of the length at either end.
    if (cable.axial_stiffness && length > 0.0) start *= rest_length / length;
    // A damper begins where its span becomes taut.
    return cable.is_damped() ? std::max(start, 0.0) : start;
  }

  /// Length that slid into the span over its links [m].
  [[nodiscard]] double slid_into(int span) const {
    double passed = 0.0;
    for (const PassEvidence& pass : cable_.passes) {
      if (pass.after == span) passed += pass.came();
      if (pass.before == span) passed -= pass.left();
    }
    return passed;
  }

  void note(CertificateItem::Kind kind, std::string_view unit, double value, double scale,
            double eps, const SpanEvidence& span) {
    findings_.note(kind, unit, value, scale, eps, [&] { return span.name(); });
  }

  const Evidence& e_;
  const CableEvidence& cable_;
  Findings& findings_;
  double size_;
  double largest_ = 0.0;
  double lost_ = 0.0;    ///< by the laws of ropes with memory [J]
  double energy_ = 0.0;  ///< its scale [J]
  bool knows_loss_ = true;
};

}  // namespace

void check_spans(const Evidence& evidence, Findings& findings) {
  for (const CableEvidence& cable : evidence.cables) {
    if (!cable.start.cut && !cable.end.cut) SpanCheck(evidence, cable, findings).check();
  }
}

}  // namespace sheave::certify
