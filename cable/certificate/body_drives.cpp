// Residuals of the drives of bodies.

#include <algorithm>

#include "cable/certificate/checks.h"
#include "engine/body_drive.h"

namespace sheave::certify {

using Kind = CertificateItem::Kind;

namespace {

bool stalls(const Evidence& evidence, int body) {
  for (const CableEvidence& cable : evidence.cables) {
    for (const LinkReport& link : cable.end.links) {
      if (link.stalled && evidence.bodies.index(link.body) == body) return true;
    }
  }
  return false;
}

}  // namespace

void check_body_drives(const Evidence& evidence, Findings& findings) {
  for (int i = 0; i < evidence.bodies.count(); ++i) {
    const BodyProperties& body = evidence.bodies[i];
    const DriveKind kind = body.driven_by();
    if (kind != DriveKind::speed && kind != DriveKind::angle) continue;
    const bool mounted = body.mount >= 0;
    const BodyDrive drive(body, evidence.start.controls, i);
    const double turned = evidence.end.bodies[at(i)].angle - evidence.start.bodies[at(i)].angle;
    const double t0 = evidence.start.time;
    const double t1 = evidence.end.time;
    const bool speed = kind == DriveKind::speed;
    const double asked = speed ? drive.integral(t0, t1) : drive.at(t1) - drive.at(t0);
    // A drive that is reported as stalled may do less than its target, but not more.
    const double least = stalls(evidence, i) ? std::min(asked, 0.0) : asked;
    const double greatest = stalls(evidence, i) ? std::max(asked, 0.0) : asked;
    const double off = std::max({least - turned, turned - greatest, 0.0});
    double most = 0.0;
    for (const double v : body.drive_table.values) most = std::max(most, std::abs(v));
    most = std::max({most, std::abs(drive.at(t0)), std::abs(drive.at(t1))});
    findings.note(Kind::drive, "rad", off, std::max(speed ? most * evidence.h : most, 1e-6),
                  (mounted ? 1e-10 : 1e-13) * (1.0 + std::abs(evidence.end.bodies[at(i)].angle)),
                  [&] { return evidence.body_name(i); });
  }
}

}  // namespace sheave::certify
