#include "cable/certificate.h"

#include <algorithm>
#include <cmath>

#include "cable/certificate/checks.h"
#include "cable/simulation.h"
#include "engine/body_set.h"
#include "engine/constraint_batch.h"
#include "engine/joint_feature.h"
#include "engine/joint_report.h"
#include "engine/number_text.h"

namespace sheave {
namespace {

using Kind = CertificateItem::Kind;

std::string number(double value, int digits = 3) { return number_text(value, digits); }

std::string_view what_is_off(Kind kind) {
  switch (kind) {
    case Kind::momentum:
      return "the sum of forces on";
    case Kind::angular_momentum:
      return "the sum of torques on";
    case Kind::joint:
      return "the lock of";
    case Kind::span:
      return "the length of";
    case Kind::drive:
      return "the drive of";
    case Kind::contact:
      return "the gap of";
    case Kind::complementarity:
      return "the complementarity of";
    case Kind::friction:
      return "the friction of";
    case Kind::force_law:
      return "the spring, damper or friction of";
    case Kind::energy:
      return "the energy of";
    case Kind::length:
      return "the cable length of";
    case Kind::tolerance:
      return "the motion of";
  }
  return {};
}

}  // namespace

// Advises settings that are not in use.
std::string certificate_advice(const CertificateItem& item, const StepSettings& step) {
  // No setting reduces rounding errors.
  constexpr double rounding = 1e-9;
  if (item.relative < rounding) return {};
  const bool direct = step.solver == SolverKind::direct;
  const bool rattle = step.integrator == IntegratorKind::rattle;
  const std::string solver = direct ? "more iterations (the direct solver's rounds end at " +
                                          std::to_string(step.iterations) + ")"
                                    : "the solver \"direct\", or more iterations";
  const std::string smaller = "more substeps";
  switch (item.kind) {
    case Kind::momentum:
    case Kind::angular_momentum:
    case Kind::joint:
    case Kind::span:
    case Kind::force_law:
    case Kind::complementarity:
      return solver + ", or " + smaller;
    case Kind::drive:
      return solver + ", or a drive_limit, if the machine cannot follow";
    case Kind::contact:
      return smaller + ", or " + solver;
    case Kind::friction:
      return solver + ", or " + smaller;
    case Kind::energy:
      return rattle ? smaller + ", or " + solver
                    : smaller + ", or the integrator \"rattle\", or " + solver;
    case Kind::length:
      return "a longer cable, if it has run out; otherwise this is a fault of Sheave, please "
             "report "
             "it";
    case Kind::tolerance:
      return "a larger tolerance, or a damper or a compliance where the machine chatters or "
             "impacts "
             "follow each other without end";
  }
  return {};
}

std::string CertificateItem::sentence() const {
  std::string text = "at " + number(time, 6) + " s " + std::string(what_is_off(kind)) + " " + name +
                     " is off by " + number(value) + " " + std::string(unit);
  // A percentage of a scale near 0 would be a meaningless number.
  constexpr double beyond = 1e9;
  text += relative < beyond ? ", " + number(100.0 * relative) + " % of " : " beside ";
  text += number(scale) + " " + std::string(unit);
  if (!advice.empty()) text += "; try " + advice;
  return text;
}

const CertificateItem* Certificate::worst() const {
  const auto worst = std::max_element(items.begin(), items.end(), [](const auto& a, const auto& b) {
    return a.relative < b.relative;
  });
  return worst == items.end() ? nullptr : &*worst;
}

const CertificateItem* Certificate::find(CertificateItem::Kind kind) const {
  const auto found =
      std::find_if(items.begin(), items.end(), [&](const auto& item) { return item.kind == kind; });
  return found == items.end() ? nullptr : &*found;
}

bool Certificate::clean(double trust) const {
  return std::all_of(items.begin(), items.end(),
                     [&](const auto& item) { return item.relative <= trust; });
}

void Certificate::merge(const Certificate& other) {
  substeps += other.substeps;
  for (const CertificateItem& item : other.items) {
    const auto place = std::find_if(items.begin(), items.end(),
                                    [&](const auto& own) { return own.kind >= item.kind; });
    if (place == items.end() || place->kind != item.kind) {
      items.insert(place, item);
    } else if (item.relative > place->relative) {
      *place = item;
    }
  }
}

std::optional<Certificate> Simulation::certificate() const {
  const std::optional<LastSubstep> last = world.last_substep();
  if (!last) return std::nullopt;
  const certify::Evidence evidence(*this, *last);
  certify::Findings findings(world.state().time);
  const std::vector<double> leaks = certify::check_momentum(evidence, findings);
  certify::check_joints(evidence, findings);
  certify::check_rope_motion(evidence, findings);
  certify::check_spans(evidence, findings);
  certify::check_body_drives(evidence, findings);
  certify::check_contacts(evidence, findings);
  certify::check_friction(evidence, findings);
  certify::check_energy(evidence, leaks, findings);
  certify::check_lengths(evidence, findings);
  Certificate certificate;
  certificate.items = findings.take();
  certificate.substeps = 1;
  for (CertificateItem& item : certificate.items) {
    item.advice = certificate_advice(item, world.model().step);
  }
  return certificate;
}

// Costs in instructions, fitted to the counts of callgrind for 34 scenes of the repository with
// three pairs of solver and integrator: the largest cost of a check there, and the smallest cost of
// a substep (docs/explanation/certificate.md).
CertificateSchedule::CertificateSchedule(const Simulation& simulation, double share) {
  const World& world = simulation.world;
  const Model& model = world.model();
  const StepSettings& step = model.step;
  const auto bodies = static_cast<double>(world.bodies().count());
  const auto joints = static_cast<double>(model.joints.size());
  const auto colliders = static_cast<double>(model.colliders.size());
  double spans = 0.0;
  if (simulation.cable_definitions) {
    for (const CableDef& cable : *simulation.cable_definitions) spans += cable.span_count();
  }
  // Rows of joints and spans. Other rows (the floor, places for wraps) cost little while they are
  // not in contact.
  double rows = spans;
  for (const auto& feature : world.features()) {
    if (dynamic_cast<const JointFeature*>(feature.get()) != nullptr) rows += feature->row_count();
  }
  const double check = 10e3 + 5e3 * bodies + 21e3 * spans + 27e3 * joints + 40e3 * colliders;
  const double direct = step.integrator == IntegratorKind::rattle ? 4e3 : 2.4e3;
  const double per_row = step.solver == SolverKind::direct ? direct : 1e3 + 200.0 * step.iterations;
  const double substep = 2e3 * bodies + per_row * rows + 50e3 * colliders;
  const double wanted = check / (share * std::max(step.substeps * substep, 1.0));
  stride_ = static_cast<std::int64_t>(std::ceil(std::min(wanted, 1e9)));
}

bool CertificateSchedule::is_due(bool is_last, std::size_t events, bool suspicious) {
  const bool happened = events != events_;
  events_ = events;
  ++steps_;
  ++since_;
  // Checks after events are taken from the number of checks that the stride allows.
  const bool affordable = checked_ * stride_ <= steps_;
  constexpr int most_suspects = 16;
  const bool suspect = suspicious && (affordable || suspects_ < most_suspects);
  const bool due =
      steps_ == 1 || is_last || suspect || (affordable && (happened || since_ >= stride_));
  if (!due) return false;
  if (suspect && !affordable) ++suspects_;
  ++checked_;
  since_ = 0;
  return true;
}

}  // namespace sheave
