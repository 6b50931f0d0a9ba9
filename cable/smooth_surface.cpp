#include "cable/smooth_surface.h"

#include <algorithm>
#include <cmath>

#include "cable/span_geometry.h"
#include "engine/math/portable.h"

namespace sheave {
namespace {

/// A part of the surface on which one closed form holds.
enum class Patch { side, upper_cap, lower_cap };

double sense_of(Patch cap) { return cap == Patch::upper_cap ? 1.0 : -1.0; }

Patch patch_at(const SmoothSurface& surface, double height, double rise) {
  if (!surface.round_ends) return Patch::side;
  if (surface.half_length == 0.0) return Patch::upper_cap;
  // On the seam the geodesic counts to the part that it enters.
  const bool seam = std::abs(std::abs(height) - surface.half_length) <= 1e-15 * surface.half_length;
  const bool outwards = seam ? height * rise > 0.0 : std::abs(height) > surface.half_length;
  if (!outwards) return Patch::side;
  return height > 0.0 ? Patch::upper_cap : Patch::lower_cap;
}

/// Follows a geodesic, patch by patch.
class Traveller {
 public:
  Traveller(const SmoothSurface& surface, const SurfaceFrame& start, double length)
      : surface_(surface), sense_(length < 0.0 ? -1.0 : 1.0), left_(std::abs(length)) {
    way_.end = start;
    way_.end.tangent *= sense_;
    way_.turned_off_rate = sense_;
  }

  SurfaceWay go() {
    // More than any rope needs: a loop round a capsule has four.
    constexpr int most_patches = 4000;
    Patch patch =
        patch_at(surface_, surface_.height(way_.end.point), dot(surface_.axis, way_.end.tangent));
    for (int k = 0; k < most_patches && (left_ > 0.0 || k == 0); ++k) {
      patch = patch == Patch::side ? over_side() : over_cap(patch);
    }
    way_.end.tangent *= sense_;
    way_.shifted_rate *= sense_;
    way_.turned_off_rate *= sense_;
    way_.turned *= sense_;
    return way_;
  }

 private:
  /// Follows the geodesic to its end, or to the seam; returns the next patch.
  Patch over_side() {
    SurfaceFrame& at = way_.end;
    const double rise = dot(surface_.axis, at.tangent);
    const double height = surface_.height(at.point);
    double length = left_;
    const Patch next = rise > 0.0 ? Patch::upper_cap : Patch::lower_cap;
    if (surface_.round_ends && rise != 0.0) {
      length =
          std::min(length, std::max((sense_of(next) * surface_.half_length - height) / rise, 0.0));
    }
    const Vector3 level = at.tangent - rise * surface_.axis;
    const double share = level.norm();
    if (share > 0.0) {
      const double angle = length * share / surface_.radius;
      const double c = portable::cos(angle);
      const double s = portable::sin(angle);
      const Vector3 ahead = level / share;
      const Vector3 outward = at.outward;
      at.outward = c * outward + s * ahead;
      at.tangent = share * (c * ahead - s * outward) + rise * surface_.axis;
      way_.turned += angle * share;
    }
    at.point =
        surface_.center + (height + length * rise) * surface_.axis + surface_.radius * at.outward;
    way_.shifted += length * way_.shifted_rate;
    way_.turned_off += length * way_.turned_off_rate;
    left_ -= length;
    return next;
  }

  Patch over_cap(Patch cap) {
    SurfaceFrame& at = way_.end;
    const Vector3 pole = sense_of(cap) * surface_.axis;
    double length = left_;
    if (surface_.half_length > 0.0) {
      // Height above the seam's plane at the angle a: r (p.n cos a + p.t sin a).
      double angle = portable::atan2(dot(pole, at.outward), -dot(pole, at.tangent));
      if (angle < 0.0) angle = angle < -0.5 * pi ? angle + 2.0 * pi : 0.0;
      length = std::min(length, surface_.radius * angle);
    }
    const double angle = length / surface_.radius;
    const double c = portable::cos(angle);
    const double s = portable::sin(angle);
    const Vector3 outward = at.outward;
    at.outward = c * outward + s * at.tangent;
    at.tangent = c * at.tangent - s * outward;
    at.point = surface_.center + surface_.half_length * pole + surface_.radius * at.outward;
    const auto go_on = [&](double& distance, double& rate) {
      const double before = distance;
      distance = c * before + s * surface_.radius * rate;
      rate = c * rate - s * before / surface_.radius;
    };
    go_on(way_.shifted, way_.shifted_rate);
    go_on(way_.turned_off, way_.turned_off_rate);
    way_.turned += angle;
    left_ -= length;
    return Patch::side;
  }

  const SmoothSurface& surface_;
  double sense_;
  double left_;
  SurfaceWay way_;
};

}  // namespace

Vector3 SmoothSurface::core(const Vector3& point) const {
  const double along = height(point);
  return center + (round_ends ? std::clamp(along, -half_length, half_length) : along) * axis;
}

SurfaceFrame SmoothSurface::frame(const Vector3& point, const Vector3& tangent) const {
  SurfaceFrame at;
  const Vector3 base = core(point);
  at.outward = point - base;
  const double distance = at.outward.norm();
  at.outward = distance > 0.0 ? Vector3(at.outward / distance) : any_perpendicular(axis);
  at.point = base + radius * at.outward;
  at.tangent = tangent - dot(tangent, at.outward) * at.outward;
  const double size = at.tangent.norm();
  at.tangent = size > 0.0 ? Vector3(at.tangent / size) : any_perpendicular(at.outward);
  return at;
}

Vector3 SmoothSurface::bend(const SurfaceFrame& at, const Vector3& motion) const {
  const double rise = dot(axis, at.tangent);
  if (patch_at(*this, height(at.point), rise) != Patch::side) return motion / radius;
  const Vector3 round = cross(axis, at.outward);
  return (dot(round, motion) / radius) * round;
}

double SmoothSurface::beyond_ends(const Vector3& point) const {
  return round_ends ? 0.0 : std::max(std::abs(height(point)) - half_length, 0.0);
}

SurfaceWay straightest_way(const SmoothSurface& surface, const SurfaceFrame& start, double length) {
  return Traveller(surface, start, length).go();
}

WayBetween way_between(const SmoothSurface& surface, const Vector3& from, const Vector3& to,
                       const Vector3& across, double length) {
  WayBetween way;
  const bool ball = surface.round_ends;
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

CorePassage core_passage(const SmoothSurface& surface, const Vector3& start,
                         const Vector3& direction) {
  CorePassage passage;
  const Vector3 apart = surface.center - start;
  const double cosine = dot(surface.axis, direction);
  const double sine_squared = 1.0 - cosine * cosine;
  double height = 0.0;
  if (surface.half_length > 0.0 && sine_squared > 1e-12) {
    height = (cosine * dot(direction, apart) - dot(surface.axis, apart)) / sine_squared;
    passage.beyond =
        surface.round_ends ? 0.0 : std::max(std::abs(height) - surface.half_length, 0.0);
    height = std::clamp(height, -surface.half_length, surface.half_length);
  }
  passage.core = surface.center + height * surface.axis;
  passage.along = dot(direction, passage.core - start);
  passage.point = start + passage.along * direction;
  return passage;
}

}  // namespace sheave
