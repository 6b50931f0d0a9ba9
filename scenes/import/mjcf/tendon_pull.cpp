// The first variation of a shortest way: its length grows with the motion of an end along the way,
// and motions of the geom that it wraps count as opposite motions of both ends.

#include "scenes/import/mjcf/tendon_pull.h"

#include <algorithm>
#include <cmath>

#include "engine/index.h"
#include "scenes/import/mjcf/wrap.h"

namespace sheave::import::mjcf {
namespace {

/// Where the way from a site leaves for the geom: the tangent point, in the frame of the geom.
/// `sense`: 1 if the way runs counter-clockwise from the site, -1 otherwise. `rise`: of the way up to
/// that point along the axis of a cylinder [m].
Vector3 tangent_point(const Geom& geom, const Vector3& site, const Vector3& normal, double sense,
                      double rise) {
  const double radius = geom.size[0];
  const Vector3 across = site - normal.dot(site) * normal;
  const double distance = across.norm();
  const double cosine = radius / distance;
  const double sine = std::sqrt(std::max(1.0 - cosine * cosine, 0.0));
  const Vector3 out = across / distance;
  const Vector3 round = radius * (cosine * out + sense * sine * normal.cross(out));
  return geom.type == GeomType::cylinder ? Vector3(round + (site.z() + rise) * normal) : round;
}

class PullSum {
 public:
  PullSum(const Model& model, const Pose& pose) : pose_(pose) {
    sum_.pulls.resize(model.bodies.size());
  }

  void add_straight(const Site& from, const Site& to) {
    const Vector3 p = place(from);
    const Vector3 way = place(to) - p;
    const double length = way.norm();
    sum_.length += length;
    if (!(length > 0.0)) return;
    add_end(from.body, p, -way / length);
    add_end(to.body, p, way / length);
  }

  /// False if the side site lies in the geom.
  bool add_wrap(const Geom& geom, const Site& from, const Site& to, const Site* side) {
    const Frame frame = pose_.bodies[at(geom.body)].frame * geom.frame;
    const auto own = [&](const Site& site) -> Vector3 {
      return frame.orientation.conjugate() * (place(site) - frame.position);
    };
    std::optional<Vector3> beside;
    if (side != nullptr) beside = own(*side);
    if (beside) {
      const bool round = geom.type == GeomType::cylinder;
      if ((round ? beside->head<2>().norm() : beside->norm()) < geom.size[0]) return false;
    }
    const Vector3 p = own(from);
    const Vector3 q = own(to);
    const Wrap wrap = wrap_over(geom, p, q, beside);
    if (!wrap.touches) {
      add_straight(from, to);
      return true;
    }
    const double whole = wrap.before + wrap.on + wrap.after;
    sum_.length += whole;
    const double sense = wrap.counter_clockwise ? 1.0 : -1.0;
    const double rise = q.z() - p.z();
    const Vector3 first =
        tangent_point(geom, p, wrap.normal, sense, rise * wrap.before / whole) - p;
    const Vector3 last =
        tangent_point(geom, q, wrap.normal, -sense, -rise * wrap.after / whole) - q;
    const auto pull = [&](const Site& site, const Vector3& towards) {
      const double length = towards.norm();
      if (!(length > 0.0)) return;
      const Vector3 away = frame.orientation * (-towards / length);
      add_end(site.body, place(site), away);
      add_end(geom.body, place(site), -away);
    };
    pull(from, first);
    pull(to, last);
    return true;
  }

  /// The sum over the divisor.
  TendonPull take(double divisor) {
    sum_.length /= divisor;
    for (Screw& pull : sum_.pulls) {
      pull.linear /= divisor;
      pull.angular /= divisor;
    }
    return std::move(sum_);
  }

 private:
  [[nodiscard]] Vector3 place(const Site& site) const {
    return pose_.bodies[at(site.body)].frame.point(site.frame.position);
  }

  void add_end(int body, const Vector3& point, const Vector3& force) {
    Screw& own = sum_.pulls[at(body)];
    own.linear += force;
    own.angular += point.cross(force);
  }

  const Pose& pose_;
  TendonPull sum_;
};

}  // namespace

std::optional<TendonPull> tendon_pull(const Model& model, const Pose& pose, const Tendon& tendon) {
  if (tendon.path.empty() || !tendon.branches.empty() || !tendon.joints.empty()) return {};
  PullSum sum(model, pose);
  const std::vector<PathPoint>& path = tendon.path;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    if (path[i].site < 0) continue;
    const Site& from = model.sites[at(path[i].site)];
    if (path[i + 1].site >= 0) {
      sum.add_straight(from, model.sites[at(path[i + 1].site)]);
      continue;
    }
    const PathPoint& over = path[i + 1];
    const Site* const side = over.side_site < 0 ? nullptr : &model.sites[at(over.side_site)];
    const Site& to = model.sites[at(path[i + 2].site)];
    if (!sum.add_wrap(model.geoms[at(over.geom)], from, to, side)) return {};
  }
  return sum.take(tendon.divisor);
}

}  // namespace sheave::import::mjcf
