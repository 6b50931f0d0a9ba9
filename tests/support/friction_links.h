#pragma once
// Links with friction, posts, and the tensions beside them.

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cable/links/pinhole.h"
#include "tests/support/builders.h"

namespace sheave::test {

/// A hole with a capstan coefficient.
inline std::shared_ptr<PinholeLink> eyelet(BodyId body, const Vector3& point = Vector3::Zero(),
                                           double friction = 0.0) {
  auto link = std::make_shared<PinholeLink>();
  link->body = body;
  link->point = point;
  link->friction = friction;
  return link;
}

/// A wheel that cable can slide over.
inline std::shared_ptr<RollingLink> wrapped(BodyId body, Winding winding, double friction) {
  auto link = roll(body, winding);
  link->friction = friction;
  return link;
}

/// A round post that nothing moves, along z.
inline BodyDef post(std::string name, const Vector3& center, double radius) {
  BodyDef body = wheel(std::move(name), center, radius, 1.0);
  body.mobility = Mobility::fixed;
  return body;
}

/// Of all spans [N].
inline std::vector<double> tensions(const CableReport& report) {
  std::vector<double> all;
  for (const SpanReport& span : report.spans) all.push_back(span.tension);
  return all;
}

}  // namespace sheave::test
