#include "cable/smooth_surface.h"

#include <algorithm>
#include <cmath>

#include "cable/geodesic_flow.h"
#include "engine/math/portable.h"

namespace sheave {
namespace {

/// A part of the surface on which one closed form holds.
enum class Patch { side, upper_cap, lower_cap };

double sense_of(Patch cap) { return cap == Patch::upper_cap ? 1.0 : -1.0; }

Patch patch_at(const SmoothSurface& surface, double height, double rise) {
  if (surface.form == SurfaceForm::cylinder) return Patch::side;
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
    if (surface_.form == SurfaceForm::rounded && rise != 0.0) {
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

/// Unrolled, the geodesic on a cone is a straight line, which passes the tip at one distance.
SurfaceWay way_on_cone(const SmoothSurface& surface, const SurfaceFrame& start, double length) {
  const ConeTip tip = tip_of(surface);
  const Vector3 arm = start.point - tip.point;
  const double far = arm.norm();
  const Vector3 out = arm / far;
  const Vector3 round = cross(tip.up, start.outward) / tip.cosine;
  const double rise = dot(out, start.tangent);
  const double turn = dot(round, start.tangent);
  const double end_far = std::sqrt(far * far + length * (2.0 * far * rise + length));
  const double unrolled = portable::atan2(length * turn, far + length * rise);
  const double angle = unrolled / tip.sine;
  const double c = portable::cos(angle);
  const double s = portable::sin(angle);
  const Vector3 level = cross(round, tip.up);
  const Vector3 end_level = c * level + s * round;
  const Vector3 end_round = c * round - s * level;
  const Vector3 end_out = tip.cosine * tip.up + tip.sine * end_level;
  const double uc = portable::cos(unrolled);
  const double us = portable::sin(unrolled);
  SurfaceWay way;
  way.end.point = tip.point + end_far * end_out;
  way.end.outward = tip.cosine * end_level - tip.sine * tip.up;
  const double end_rise = uc * rise + us * turn;
  way.end.tangent = end_rise * end_out + (uc * turn - us * rise) * end_round;
  way.turned = tip.cosine / tip.sine * (end_rise - rise);
  way.turned_off = length;
  return way;
}

Vector3 core_of_torus(const SmoothSurface& torus, const Vector3& point) {
  const Vector3 arm = point - torus.center;
  const Vector3 level = arm - dot(torus.axis, arm) * torus.axis;
  const double size = level.norm();
  return torus.center +
         torus.ring * (size > 0.0 ? Vector3(level / size) : any_perpendicular(torus.axis));
}

/// Point of a cone or an ellipsoid, with its normal.
void put_on_cone(const SmoothSurface& cone, const Vector3& point, SurfaceFrame& at) {
  const ConeTip tip = tip_of(cone);
  const Vector3 arm = point - tip.point;
  const Vector3 across = arm - dot(tip.up, arm) * tip.up;
  const double off = across.norm();
  const Vector3 level = off > 0.0 ? Vector3(across / off) : any_perpendicular(tip.up);
  const Vector3 out = tip.cosine * tip.up + tip.sine * level;
  constexpr double least = 1e-9;  // the tip itself has no normal
  at.point = tip.point + std::max(dot(out, arm), least * cone.radius) * out;
  at.outward = tip.cosine * level - tip.sine * tip.up;
}

void put_on_ellipsoid(const SmoothSurface& body, const Vector3& point, SurfaceFrame& at) {
  Vector3 own = body.to_own(point - body.center);
  for (int i = 0; i < 3; ++i) own[i] /= body.half_axes[i];
  const double size = own.norm();
  own = size > 0.0 ? Vector3(own / size) : Vector3(Vector3::UnitX());
  Vector3 normal;
  for (int i = 0; i < 3; ++i) {
    normal[i] = own[i] / body.half_axes[i];
    own[i] *= body.half_axes[i];
  }
  at.point = body.center + body.from_own(own);
  at.outward = body.from_own(normal / normal.norm());
}

}  // namespace

ConeTip tip_of(const SmoothSurface& cone) {
  ConeTip tip;
  tip.growth = std::abs(cone.slope);
  tip.up = cone.slope < 0.0 ? Vector3(-cone.axis) : cone.axis;
  tip.point = cone.center - cone.radius / tip.growth * tip.up;
  tip.cosine = 1.0 / std::sqrt(1.0 + tip.growth * tip.growth);
  tip.sine = tip.growth * tip.cosine;
  return tip;
}

Vector3 SmoothSurface::core(const Vector3& point) const {
  if (form == SurfaceForm::ellipsoid) return center;
  if (form == SurfaceForm::torus) return core_of_torus(*this, point);
  const double along = height(point);
  const bool rounded = form == SurfaceForm::rounded;
  return center + (rounded ? std::clamp(along, -half_length, half_length) : along) * axis;
}

SurfaceFrame SmoothSurface::frame(const Vector3& point, const Vector3& tangent) const {
  SurfaceFrame at;
  if (form == SurfaceForm::cone) {
    put_on_cone(*this, point, at);
  } else if (form == SurfaceForm::ellipsoid) {
    put_on_ellipsoid(*this, point, at);
  } else {
    const Vector3 base = core(point);
    at.outward = point - base;
    const double distance = at.outward.norm();
    at.outward = distance > 0.0 ? Vector3(at.outward / distance) : any_perpendicular(axis);
    at.point = base + radius * at.outward;
  }
  at.tangent = tangent - dot(tangent, at.outward) * at.outward;
  const double size = at.tangent.norm();
  at.tangent = size > 0.0 ? Vector3(at.tangent / size) : any_perpendicular(at.outward);
  return at;
}

Vector3 SmoothSurface::bend(const SurfaceFrame& at, const Vector3& motion) const {
  if (form == SurfaceForm::ellipsoid) {
    Vector3 own = to_own(motion);
    Vector3 gradient = to_own(at.point - center);
    for (int i = 0; i < 3; ++i) {
      own[i] /= half_axes[i] * half_axes[i];
      gradient[i] /= half_axes[i] * half_axes[i];
    }
    const Vector3 change = from_own(own) / gradient.norm();
    return change - dot(change, at.outward) * at.outward;
  }
  if (form == SurfaceForm::torus) {
    const Vector3 round = cross(axis, core(at.point) - center) / ring;
    const double cosine = dot(cross(round, axis), at.outward);
    const double turn = dot(round, motion);
    return (motion - turn * round) / radius + turn * cosine / (ring + radius * cosine) * round;
  }
  if (form == SurfaceForm::cone) {
    const ConeTip tip = tip_of(*this);
    const Vector3 round = cross(tip.up, at.outward) / tip.cosine;
    const double level = tip.sine * (at.point - tip.point).norm();
    return dot(round, motion) * tip.cosine / level * round;
  }
  const double rise = dot(axis, at.tangent);
  if (patch_at(*this, height(at.point), rise) != Patch::side) return motion / radius;
  const Vector3 round = cross(axis, at.outward);
  return (dot(round, motion) / radius) * round;
}

double SmoothSurface::bend_radius(const SurfaceFrame& at) const {
  if (form == SurfaceForm::rounded || form == SurfaceForm::cylinder) return radius;
  const bool egg = form == SurfaceForm::ellipsoid;
  const double least = egg ? half_axes.minCoeff() : form == SurfaceForm::torus ? radius : 0.0;
  const double most = egg                          ? half_axes.maxCoeff()
                      : form == SurfaceForm::torus ? ring + radius
                                                   : (at.point - core(at.point)).norm();
  const double curvature = std::abs(dot(at.tangent, bend(at, at.tangent)));
  return curvature * most > 1.0 ? std::max(1.0 / curvature, least) : most;
}

bool SmoothSurface::is_hollow(const SurfaceFrame& at) const {
  constexpr double rounding = 1e-9;  // of the curvature of the tube
  return form == SurfaceForm::torus && dot(at.tangent, bend(at, at.tangent)) * radius < -rounding;
}

double SmoothSurface::beyond_ends(const Vector3& point) const {
  return has_ends() ? std::max(std::abs(height(point)) - half_length, 0.0) : 0.0;
}

bool SmoothSurface::contains(const Vector3& point) const {
  if (form == SurfaceForm::ellipsoid) {
    return to_own(point - center).cwiseQuotient(half_axes).norm() < 1.0;
  }
  const double within = form == SurfaceForm::cone ? radius + slope * height(point) : radius;
  return beyond_ends(point) == 0.0 && (point - core(point)).norm() < within;
}

double SmoothSurface::reach() const {
  if (form == SurfaceForm::ellipsoid) return half_axes.maxCoeff();
  return half_length + radius + ring + half_length * std::abs(slope);
}

SurfaceWay straightest_way(const SmoothSurface& surface, const SurfaceFrame& start, double length) {
  if (surface.form == SurfaceForm::cone) return way_on_cone(surface, start, length);
  if (surface.form == SurfaceForm::torus || surface.form == SurfaceForm::ellipsoid) {
    return integrated_way(surface, start, length);
  }
  return Traveller(surface, start, length).go();
}

}  // namespace sheave
