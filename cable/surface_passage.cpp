// How a line passes a smooth body, and paths between two points round one.

#include <algorithm>
#include <cmath>

#include "cable/smooth_surface.h"
#include "cable/span_geometry.h"
#include "engine/math/portable.h"

namespace sheave {
namespace {

/// Coordinates in which an ellipsoid is a ball of radius 1, and back.
Vector3 ball_like(const SmoothSurface& body, const Vector3& vector) {
  Vector3 own = body.to_own(vector);
  for (int i = 0; i < 3; ++i) own[i] /= body.half_axes[i];
  return own;
}
Vector3 from_ball_like(const SmoothSurface& body, Vector3 own) {
  for (int i = 0; i < 3; ++i) own[i] *= body.half_axes[i];
  return body.from_own(own);
}

/// The shortest path over a ball or an endless cylinder.
WayBetween way_round(const SmoothSurface& surface, const Vector3& from, const Vector3& to,
                     const Vector3& across, double length) {
  WayBetween way;
  const bool ball = surface.form == SurfaceForm::rounded;
  Vector3 normal = ball ? cross(from - surface.center, to - surface.center) : surface.axis;
  const double size = normal.norm();
  normal = size > 0.0 ? Vector3(normal / size) : across;
  if (dot(normal, across) < 0.0) normal = -normal;
  // Seen along the normal.
  const auto level = [&](const Vector3& point) -> Vector3 {
    return point - dot(normal, point - surface.center) * normal;
  };
  const SpanGeometry in = planar_span(level(from), 0.0, surface.center, surface.radius, normal);
  const SpanGeometry out = planar_span(surface.center, surface.radius, level(to), 0.0, normal);
  const Vector3 first = (in.end - surface.center) / surface.radius;
  const Vector3 last = (out.start - surface.center) / surface.radius;
  const double angle = unwrapped(angle_between(first, last, normal), length / surface.radius);
  const double round = surface.radius * angle;
  const double start = dot(normal, from - surface.center);
  const double rise = dot(normal, to - surface.center) - start;
  const double whole = in.length + round + out.length;
  const double slope = ball || !(whole > 0.0) ? 0.0 : rise / whole;
  const double stretch = std::sqrt(1.0 + slope * slope);
  way.entry.outward = first;
  way.entry.tangent = (cross(normal, first) + slope * normal) / stretch;
  way.entry.point = in.end + (ball ? 0.0 : start + slope * in.length) * normal;
  way.length = round * stretch;
  return way;
}

/// The path in the section through both points and the centre of an ellipsoid.
WayBetween way_in_section(const SmoothSurface& body, const Vector3& from, const Vector3& to,
                          const Vector3& across, double length) {
  const Vector3 start = ball_like(body, from - body.center);
  const Vector3 end = ball_like(body, to - body.center);
  const Vector3 normal = cross(from - body.center, to - body.center);
  SmoothSurface ball;
  ball.radius = 1.0;
  Vector3 about = cross(start, end);
  if (dot(normal, across) < 0.0) about = -about;
  if (!(about.norm() > 0.0)) about = ball_like(body, across);
  WayBetween way = way_round(ball, start, end, about.normalized(), length / body.radius);
  // The length of the arc of the ellipse, by chords, is good enough.
  constexpr int chords = 32;
  const Vector3 first = way.entry.point;
  const Vector3 ahead = way.entry.tangent;
  const double angle = way.length;
  Vector3 last = from_ball_like(body, first);
  way.entry.point = body.center + last;
  way.entry.tangent = from_ball_like(body, ahead);
  way.length = 0.0;
  for (int i = 1; i <= chords; ++i) {
    const double turn = angle * i / chords;
    const Vector3 next =
        from_ball_like(body, portable::cos(turn) * first + portable::sin(turn) * ahead);
    way.length += (next - last).norm();
    last = next;
  }
  if (angle < 0.0) way.length = -way.length;
  return way;
}

/// A cylinder that is like the body near a point of its surface.
SmoothSurface cylinder_like(const SmoothSurface& body, const SurfaceFrame& at) {
  SmoothSurface bar = body;
  bar.form = SurfaceForm::cylinder;
  if (body.form == SurfaceForm::cone) {
    bar.radius = (at.point - body.core(at.point)).norm();
    return bar;
  }
  // A cable lies round the tube of a torus, or along the tube round the whole.
  const Vector3 core = body.core(at.point);
  const Vector3 along = cross(body.axis, core - body.center) / body.ring;
  if (std::abs(dot(at.tangent, along)) < std::sqrt(0.5)) {
    bar.center = core;
    bar.axis = along;
  } else {
    bar.radius = body.ring + body.radius;
  }
  return bar;
}

}  // namespace

WayBetween way_between(const SmoothSurface& surface, const Vector3& from, const Vector3& to,
                       const SurfaceFrame& at, double length) {
  const Vector3 across = at.across();
  if (surface.form == SurfaceForm::ellipsoid) {
    return way_in_section(surface, from, to, across, length);
  }
  if (surface.form == SurfaceForm::cone || surface.form == SurfaceForm::torus) {
    return way_round(cylinder_like(surface, at), from, to, across, length);
  }
  return way_round(surface, from, to, across, length);
}

namespace {

/// The point of a torus's core that is nearest to a line: Newton's method for the angle on the
/// ring, from the best of a few angles or from `near`.
Vector3 ring_point(const SmoothSurface& torus, const Vector3& start, const Vector3& direction,
                   const Vector3* near) {
  constexpr int samples = 32;
  constexpr double spacing = 2.0 * pi / samples;
  constexpr int most_rounds = 30;
  const Vector3 x = any_perpendicular(torus.axis);
  const Vector3 y = cross(torus.axis, x);
  const Vector3 apart = torus.center - start;
  const auto level = [&](const Vector3& v) -> Vector3 { return v - dot(direction, v) * direction; };
  const auto out = [&](double angle) -> Vector3 {
    return torus.ring * (portable::cos(angle) * x + portable::sin(angle) * y);
  };
  double angle = 0.0;
  if (near != nullptr) {
    angle = portable::atan2(dot(y, *near - torus.center), dot(x, *near - torus.center));
  } else {
    double best = 0.0;
    for (int i = 0; i < samples; ++i) {
      const double distance = level(apart + out(i * spacing)).squaredNorm();
      if (i > 0 && distance >= best) continue;
      best = distance;
      angle = i * spacing;
    }
  }
  for (int round = 0; round < most_rounds; ++round) {
    const Vector3 arm = out(angle);
    const Vector3 motion = cross(torus.axis, arm);
    const Vector3 off = level(apart + arm);
    const double rate = dot(off, motion);
    const double bend = level(motion).squaredNorm() - dot(off, arm);
    double step = bend > 0.0 ? -rate / bend : rate > 0.0 ? -spacing : spacing;
    step = std::clamp(step, -spacing, spacing);
    angle += step;
    if (std::abs(step) < 1e-15) break;
  }
  return torus.center + out(angle);
}

/// How a line rises on a cone: `steep` is the ratio of its rise to that of the cone's side, within
/// bounds, -1 ... 1 for a line that a cone can touch.
struct ConeLine {
  ConeTip tip;
  double rise = 0.0;
  double run = 0.0;  ///< of the line, at right angles to the axis
  double steep = 0.0;
};
ConeLine line_on(const SmoothSurface& cone, const Vector3& direction) {
  ConeLine line;
  line.tip = tip_of(cone);
  line.rise = dot(line.tip.up, direction);
  line.run = (direction - line.rise * line.tip.up).norm();
  constexpr double most = 0.999;
  const double ratio = line.tip.growth * line.rise;
  line.steep = std::clamp(line.run > 0.0 ? ratio / line.run : ratio * 1e300, -most, most);
  return line;
}

}  // namespace

CorePassage core_passage(const SmoothSurface& surface, const Vector3& start,
                         const Vector3& direction, const Vector3* near) {
  CorePassage passage;
  const auto set_along = [&] {
    passage.along = dot(direction, passage.core - start);
    passage.point = start + passage.along * direction;
  };
  if (surface.form == SurfaceForm::torus) {
    passage.core = ring_point(surface, start, direction, near);
    set_along();
    return passage;
  }
  if (surface.form == SurfaceForm::ellipsoid) {
    const Vector3 line = ball_like(surface, direction);
    const Vector3 apart = ball_like(surface, surface.center - start);
    passage.core = surface.center;
    passage.along = dot(line, apart) / dot(line, line);
    passage.point = start + passage.along * direction;
    return passage;
  }
  const Vector3 apart = surface.center - start;
  const double cosine = dot(surface.axis, direction);
  const double sine_squared = 1.0 - cosine * cosine;
  double height = 0.0;
  if (surface.half_length > 0.0 && sine_squared > 1e-12) {
    height = (cosine * dot(direction, apart) - dot(surface.axis, apart)) / sine_squared;
    if (surface.form != SurfaceForm::cone) {
      passage.beyond =
          surface.has_ends() ? std::max(std::abs(height) - surface.half_length, 0.0) : 0.0;
      height = std::clamp(height, -surface.half_length, surface.half_length);
    }
  }
  passage.core = surface.center + height * surface.axis;
  set_along();
  if (surface.form == SurfaceForm::cone) {
    const ConeLine line = line_on(surface, direction);
    const double off = (passage.point - passage.core).norm();
    const double further = off * line.steep / std::sqrt(1.0 - line.steep * line.steep);
    if (line.run > 0.0) passage.along += further / line.run;
    passage.beyond = surface.beyond_ends(start + passage.along * direction);
  }
  return passage;
}

double depth_of(const SmoothSurface& surface, const CorePassage& passage, const Vector3& direction,
                double distance) {
  if (surface.form == SurfaceForm::cone) {
    const ConeLine line = line_on(surface, direction);
    const double level = line.tip.growth * dot(line.tip.up, passage.core - line.tip.point);
    return line.tip.cosine * (level - distance * std::sqrt(1.0 - line.steep * line.steep));
  }
  if (surface.form == SurfaceForm::ellipsoid) {
    const Vector3 out = passage.point - passage.core;
    const double size = ball_like(surface, out).norm();
    return size > 0.0 ? out.norm() / size - distance : surface.radius;
  }
  return surface.radius - distance;
}

SurfaceFrame touched_frame(const SmoothSurface& surface, const Vector3& core,
                           const Vector3& outward, const Vector3& direction) {
  if (surface.form == SurfaceForm::ellipsoid) {
    const Vector3 line = ball_like(surface, direction).normalized();
    Vector3 out = ball_like(surface, outward);
    out -= dot(out, line) * line;
    const Vector3 arm = from_ball_like(surface, out / out.norm());
    return surface.frame(surface.center + arm, direction);
  }
  if (surface.form == SurfaceForm::cone) {
    const ConeLine line = line_on(surface, direction);
    const Vector3 ahead = direction - line.rise * line.tip.up;
    const Vector3 side = cross(line.tip.up, ahead);
    const double sense = dot(side, outward) < 0.0 ? -1.0 : 1.0;
    const double flat = std::sqrt(1.0 - line.steep * line.steep);
    if (!(line.run > 0.0)) return surface.frame(core + surface.radius * outward, direction);
    const double level = dot(line.tip.up, core - line.tip.point) / (flat * flat);
    const Vector3 out = (sense * flat * side + line.steep * ahead) / line.run;
    return surface.frame(line.tip.point + level * line.tip.up + line.tip.growth * level * out,
                         direction);
  }
  return surface.frame(core + surface.radius * outward, direction);
}

}  // namespace sheave
