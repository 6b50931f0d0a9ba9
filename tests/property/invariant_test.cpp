// Cable is neither made nor lost, and no machine makes numbers that are not finite.
//
// All lengths are multiples of a power of two of about 1e-15 of the cable (cable/cable_system.h),
// so their sums are exact and the invariant is asked to hold to the last bit. Nothing is fed in
// these machines.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "tests/property/campaign.h"
#include "tests/property/limits.h"
#include "tests/support/rounding.h"

namespace sheave::test {
namespace {

constexpr int invariant_steps = 60;

/// Largest of all lengths of the cable [m].
double longest_length(const CableReport& cable) {
  double longest = 0.0;
  for (const SpanReport& span : cable.spans)
    longest = std::max(longest, std::abs(span.rest_length));
  for (const LinkReport& link : cable.links) {
    longest = std::max(longest, std::abs(link.stored_length));
  }
  return longest;
}

bool driven(const Machine& machine) {
  const std::vector<BodyDef>& bodies = machine.model.bodies;
  return std::any_of(bodies.begin(), bodies.end(),
                     [](const BodyDef& body) { return body.mobility == Mobility::kinematic; });
}

// Exact means up to 8 times the cable, where 53 bits end. Kinematic bodies can tear a rigid cable
// and spin its wheels without limit; once lengths, or what a substep moves, are beyond half of
// that, each of the some 16 sums of a substep may round by eps of the longest.
//
// A machine is followed until a span has no tangent, because wheels that overlap are no machine;
// what is asked of them is in degenerate_test.cpp.
// Nor can a solver satisfy a rigid cable between bodies of which one is driven away and nothing can
// follow. At the dead centre, where a pull no longer turns the wheel that holds the other end, each
// correction turns it the more, until the run ends with a report that it diverged. So a run may end
// if a cable was torn by a hundredth before.
TEST(Property, LengthIsConservedAndStatesAreFinite) {
  run_campaign("length invariant", {}, [](const Machine& machine, std::uint64_t) {
    Simulation s = start(with_single_substeps(machine));
    Finding worst;
    double rounding = 0.0;
    double stretch = 0.0;
    const double whole = s.cable_reports()[0].total_length;
    for (int i = 0; i < 5 * invariant_steps; ++i) {
      const State before = s.world.state();
      const StepReport report = s.world.step();
      if (!s.cables->tangent_warnings().empty()) return worst;
      if (!report.ok() && driven(machine) && stretch > 0.01) return worst;
      if (!report.ok()) return Finding{true, 1.0, 0.0, report.divergence->message};
      const CableReport cable = s.cable_reports()[0];
      stretch = std::max(stretch, cable.max_stretch);
      const double longest = std::max(longest_length(cable), motion_bound(s.world, before));
      if (longest > 4.0 * whole) rounding += 16.0 * eps * longest / whole;
      worst.worsen(std::abs(cable.length_error), rounding,
                   rounding > 0.0 ? "length error of a torn cable" : "length error");
    }
    return worst;
  });
}

/// Not for springs of constant compliance, which follow their law down to a rest length of 0 and
/// beyond, and not for bodies that move whatever pulls at them: they wind up more cable than there
/// is.
constexpr Traits never_negative() {
  Traits traits;
  traits.elastic = false;
  traits.kinematic = false;
  return traits;
}

/// What an outline has been wound on and off, and at which tilt. Of other links nothing.
struct TiltedOutline {
  double stored = 0.0;        ///< [m], at last
  double counted = 0.0;       ///< sum of the changes of that [m]
  double least_cosine = 1.0;  ///< of the angle between a span beside it and its plane

  void follow(const CableReport& cable, std::size_t link) {
    const LinkReport& now = cable.links[link];
    if (now.path.empty()) return;
    counted += std::abs(now.stored_length - stored);
    stored = now.stored_length;
    for (const std::size_t span : {link - 1, link}) {
      if (span >= cable.spans.size()) continue;
      const Vector3 along = cable.spans[span].end - cable.spans[span].start;
      const double out = now.normal.dot(along.normalized());
      least_cosine = std::min(least_cosine, std::sqrt(std::max(1.0 - out * out, 0.0)));
    }
  }
  [[nodiscard]] double left_over() const { return counted * (1.0 / least_cosine - 1.0); }
};

std::vector<TiltedOutline> tilted_outlines(const Simulation& s) {
  std::vector<TiltedOutline> outlines;
  const std::vector<CableReport> reports = s.cable_reports();
  for (const LinkReport& link : reports[0].links) {
    outlines.push_back({link.stored_length, 0.0, 1.0});
  }
  return outlines;
}

// A rest length is at least the length minus what the solver has left over. With 50 iterations that
// is far less than a substep's motion, but rows that fight each other can keep more, so what they
// are short of counts, too. A stored length below 0 makes a hybrid end attach and the cable leave a
// wheel, at the end of the same substep. What is left is what the course's change then moves along
// the neighbouring links: by the substep's motion times radius / span length. A belt does not leave
// the last two links, whatever is stored on them, and is followed no longer when it has come to
// them. An outline whose plane the span leaves by the angle t counts an edge e as between e cos t
// and e, so that no row jumps (tilt_loss() in cable/span_row.cpp). So what is wound on at one tilt
// and off at another may leave up to 1 / cos t - 1 of all that was counted on it and off it.
TEST(Property, NoLengthIsNegative) {
  run_campaign("negative lengths", never_negative(), [](const Machine& random, std::uint64_t) {
    Machine machine = with_single_substeps(random);
    machine.model.step.iterations = 50;
    Simulation s = start(machine);
    std::vector<TiltedOutline> outlines = tilted_outlines(s);
    Finding worst;
    for (int i = 0; i < 3 * invariant_steps; ++i) {
      const State before = s.world.state();
      if (!s.world.step().ok()) return worst;
      const double moved = motion_bound(s.world, before);
      const double shortest = shortest_span(s);
      if (!(shortest > 0.05)) return worst;
      for (const CableReport& cable : s.cable_reports()) {
        const auto touched = std::count_if(cable.links.begin(), cable.links.end(),
                                           [](const LinkReport& link) { return link.touched; });
        if (cable.closed && touched <= 2) return worst;
        for (const SpanReport& span : cable.spans) {
          worst.worsen(-span.rest_length, moved * (1.0 + 0.3 / shortest), "rest length");
        }
        for (std::size_t k = 0; k < cable.links.size(); ++k) {
          outlines[k].follow(cable, k);
          worst.worsen(-cable.links[k].stored_length,
                       moved * (1.0 + 0.3 / shortest) + outlines[k].left_over(), "stored length");
        }
      }
    }
    return worst;
  });
}

}  // namespace
}  // namespace sheave::test
