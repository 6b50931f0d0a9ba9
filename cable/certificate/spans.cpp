// Spans against their rest lengths, and springs against their tensions.
//
// Where cable passes from span to span only the sum of a chain's lengths is asked for, so the law
// of a spring is that of chains of spans joined by links over which cable may come; a rigid span
// keeps its own length either way. With the stretch x = l - L, the compliance a and the damping b,
// XPBD asks for a T = x + a b (change of x) / h at the end of the substep, `rattle` for the mean of
// both ends; a tension below 0 is none.

#include <algorithm>

#include "cable/certificate/checks.h"
#include "cable/certificate/pushes.h"

namespace sheave::certify {
namespace {

double compliance_of(const CableDef& cable, double rest_length) {
  if (cable.axial_stiffness) return std::max(rest_length, 0.0) / *cable.axial_stiffness;
  return cable.compliance.value_or(0.0);
}

bool is_rigid(const CableDef& cable) {
  return !cable.axial_stiffness && !(cable.compliance.value_or(0.0) > 0.0);
}

/// Change of the stretch as damping sees it: what a unit of tension works at the end, backwards.
/// Where a wheel's plane is not that of the span, that is more than the way of its ends along it.
double linear_stretch(const Evidence& evidence, SpanEvidence span, bool guided) {
  span.force[last_end] = 1.0;
  const SpanPushes pushes = pushes_of(span, last_end, guided);
  double work = 0.0;
  for (int i = 0; i < pushes.count; ++i) {
    const SpanPush& push = pushes.all[at(i)];
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
    for (const SpanEvidence& span : cable_.spans) {
      check_slack(span);
      if (rigid) check_rigid(span);
    }
    if (!rigid) check_chains();
  }

 private:
  static constexpr double rounding = 1e-13;

  /// The reported ends lie on their circles, and the span touches them there.
  void check_geometry(const SpanEvidence& span) {
    if (!span.has_tangent || span.length[last_end] <= 0.0 ||
        cable_.definition->tangent_update != TangentUpdate::iteration) {
      return;
    }
    double off = std::abs((span.to.point[last_end] - span.from.point[last_end]).norm() -
                          span.length[last_end]);
    for (const SpanSide* side : {&span.from, &span.to}) {
      if (side->outlined || !(side->radius > 0.0)) continue;
      const SpanSide& other = side == &span.from ? span.to : span.from;
      const Vector3 arm = side->point[last_end] - side->center[last_end];
      off = std::max(off, std::abs(arm.norm() - side->radius));
      off = std::max(off, std::abs(arm.dot(side->normal[last_end])));
      // Seen along the plane's normal the other end lies on the tangent.
      const Vector3 to_other = other.point[last_end] - side->point[last_end];
      off = std::max(off, std::abs(to_other.dot(arm)) / side->radius);
      const double way = side->winding * side->normal[last_end].cross(arm).dot(
                                             side == &span.from ? to_other : Vector3(-to_other));
      if (way < 0.0) off = std::max(off, span.length[last_end]);
    }
    note(CertificateItem::Kind::span, "m", off, size_, rounding * 100.0 * e_.bodies.scale(), span);
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
    // What was taut for a part of the substep has pulled.
    const double slack =
        -(e_.rattle && !is_rigid(*cable_.definition) ? std::max(stretch0, stretch1) : stretch1);
    if (!(slack > 0.0) || !(tension > 0.0)) {
      note(CertificateItem::Kind::complementarity, "N", 0.0, e_.largest_force, 0.0, span);
      return;
    }
    // A slack of the whole size lets all of the tension count, one that trust cannot see none.
    const double share = std::min(1.0, slack / size_);
    note(CertificateItem::Kind::complementarity, "N", tension * share, std::max(largest_, tension),
         std::max(tension * rounding * 100.0, e_.force_rounding), span);
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
          // A link that holds divides what shares a tension.
          if (!pass.passes || (pass.friction > 0.0 && pass.slip == 0.0)) continue;
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

  void check_chain(const CableDef& cable, const std::vector<std::size_t>& chain) {
    double before = 0.0;
    double now = 0.0;
    double wanted = 0.0;
    double pulled = 0.0;
    double most = 0.0;
    double softest = 0.0;
    double deflection = 0.0;
    double damping = 0.0;
    double moved = 0.0;
    for (const std::size_t k : chain) {
      const SpanEvidence& span = cable_.spans[k];
      if (!span.has_tangent) return;
      // What is fed in a substep is there from its start.
      double start = span.length[first_end] - span.rest_length[first_end] - span.fed;
      // A material's force is the mean of both ends', whatever the length is at either.
      if (cable.axial_stiffness && span.rest_length[first_end] > 0.0) {
        start *= span.rest_length[last_end] / span.rest_length[first_end];
      }
      before += start;
      double stretch = span.length[last_end] - span.rest_length[last_end];
      if (cable.tangent_update == TangentUpdate::substep) {
        // What acted is between attachments that keep their places on the bodies; what rolls is in
        // their distance.
        const double apart = (span.to.point[last_end] - span.from.point[last_end]).norm();
        stretch = apart - span.rest_length[first_end] - span.fed;
      }
      now += stretch;
      const double a = compliance_of(cable, span.rest_length[last_end]);
      wanted += a * span.tension();
      pulled += span.tension();
      most = std::max({most, std::abs(stretch), a * span.tension()});
      // Each span has its share of what stretches all of them.
      deflection += a * span.tension();
      damping += a * a * span.tension() * cable.damping;
      softest = std::max(softest, a);
      if (cable.damping > 0.0 && !e_.rattle) {
        moved += linear_stretch(e_, span, cable.tangent_update == TangentUpdate::iteration);
      }
    }
    const double gamma = (deflection > 0.0 ? damping / deflection : softest * cable.damping) / e_.h;
    double given = now + gamma * moved;
    if (e_.rattle) {
      // A spring that was slack counts from 0.
      before = std::max(before, 0.0);
      given = 0.5 * (before + now) + gamma * (now - before);
    }
    const double off = pulled == 0.0 ? std::max(given, 0.0) : std::abs(given - wanted);
    note(CertificateItem::Kind::span, "m", off, std::max(most, 1e-6 * size_),
         rounding * 1e3 * e_.bodies.scale(), cable_.spans[chain.front()]);
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
};

}  // namespace

void check_spans(const Evidence& evidence, Findings& findings) {
  for (const CableEvidence& cable : evidence.cables) {
    if (!cable.start.cut && !cable.end.cut) SpanCheck(evidence, cable, findings).check();
  }
}

}  // namespace sheave::certify
