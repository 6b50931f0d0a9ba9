// Surface links at time 0: the geodesic of each row of smooth bodies, found before the spans.

#include <span>

#include "cable/cable_compiler.h"
#include "cable/geodesic_row.h"
#include "cable/wrap_candidate.h"
#include "engine/index.h"

namespace sheave {

void CableCompiler::guess_geodesic(int before, int link, int after) {
  LinkGeometry& own = links_[at(link)];
  GeodesicLink& geodesic = *own.geodesic;
  const Quaternion to_own = now_->orientation(own.carrier).conjugate();
  const auto center = [&](int other) -> Vector3 {
    return to_own * (link_center(*now_, links_[at(other)]) - now_->position(own.carrier));
  };
  // A geodesic of length 0 where the line between the neighbours passes the body, on the side that
  // the link says.
  const Vector3 start = center(before);
  const Vector3 way = center(after) - start;
  if (!(way.norm() > 0.0)) return;
  const Vector3 direction = way.normalized();
  const SmoothSurface& surface = geodesic.surface;
  const Vector3 core =
      core_passage(surface, start, direction, geodesic.beside ? &*geodesic.beside : nullptr).core;
  const bool exact = surface.is_ball() || surface.is_capsule() ||
                     surface.form == SurfaceForm::cylinder;  // the entry's frame has the winding
  Vector3 outward = cross(direction, exact ? geodesic.entry.across() : geodesic.about);
  double least = 1e-6;
  if (geodesic.beside) {
    outward = *geodesic.beside - core;
    outward -= dot(outward, direction) * direction;
    least *= surface.radius;
  }
  if (!(outward.norm() > least)) return;
  geodesic.entry = touched_frame(surface, core, outward.normalized(), direction);
}

bool CableCompiler::fail_if_inside(int link, int neighbour) {
  const LinkGeometry& own = links_[at(link)];
  const LinkGeometry& body = links_[at(neighbour)];
  if (!body.geodesic || own.outline) return false;
  const SmoothSurface surface = surface_now(*now_, body.carrier, body.geodesic->surface);
  const auto lies_inside = [&](const Vector3& point) {
    // Rounding must not decide about bodies that touch.
    const double slop = 1e-9 * surface.radius;
    const Vector3 inwards = surface.core(point) - point;
    const double distance = inwards.norm();
    return surface.contains(point) &&
           (distance == 0.0 || surface.contains(point - slop / distance * inwards));
  };
  const std::string field = "/links/" + std::to_string(link);
  if (own.geodesic) {
    // Without a geodesic the entry is that of the guess.
    const bool overlaps =
        lies_inside(now_->point(own.carrier, own.geodesic->entry.point)) ||
        (own.geodesic->settled && lies_inside(now_->point(own.carrier, own.geodesic->exit.point)));
    if (own.carrier == body.carrier || !overlaps) return false;
    fail(field, link_name(link) + ": the cable comes onto the body inside the body of " +
                    link_name(neighbour) + "; move the bodies apart, or make them smaller");
    return true;
  }
  if (own.wraps() || !lies_inside(link_center(*now_, own))) return false;
  fail(field, link_name(link) + " lies inside the body of " + link_name(neighbour) +
                  "; move it out, or make the body smaller");
  return true;
}

void CableCompiler::check_surface(int link) {
  const GeodesicLink& geodesic = *links_[at(link)].geodesic;
  if (!geodesic.settled) return;  // the spans have failed
  const int next = next_touched(link);
  if (fail_if_inside(link, next) || fail_if_inside(next, link)) return;
  const std::string field = "/links/" + std::to_string(link);
  if (geodesic.length < -1e-9 * links_[at(link)].perimeter()) {
    fail(field, link_name(link) +
                    ": the cable does not reach the body on the side that \"winding\", \"side\" or "
                    "\"side_point\" says; give the other side, or make the body \"wrappable\" "
                    "and leave the link out");
  } else if (geodesic.surface.beyond_ends(geodesic.entry.point) > 0.0 ||
             geodesic.surface.beyond_ends(geodesic.exit.point) > 0.0) {
    fail(field, link_name(link) + ": the cable lies beyond an end of the " +
                    (geodesic.surface.form == SurfaceForm::cone ? "cone" : "cylinder") +
                    " at time 0; make it longer, or move it");
  }
}

namespace {

/// A guess of length 0 finds a wrap of more than half a turn as one that winds back. The same limit
/// as for wheels decides which is meant: a cable that does not reach the body lacks less than a
/// quarter of a turn. Returns whether a link has been wound on by a whole turn.
bool wind_on(std::span<LinkGeometry* const> row) {
  constexpr double least_turns = 0.25;
  bool any = false;
  for (LinkGeometry* const link : row) {
    GeodesicLink& geodesic = *link->geodesic;
    if (!geodesic.settled || !(geodesic.length < -least_turns * link->perimeter())) continue;
    geodesic.length += link->perimeter();
    any = true;
  }
  return any;
}

}  // namespace

void CableCompiler::lay_surfaces(bool closed) {
  const auto count = static_cast<int>(links_.size());
  const auto smooth = [&](int link) {
    return links_[at(link)].geodesic && !links_[at(link)].starts_lifted;
  };
  const auto before = [&](int link) {
    int other = link;
    do {
      other = (other + count - 1) % count;
    } while (links_[at(other)].starts_lifted && other != link);
    return other;
  };
  int start = -1;  // of a row
  bool any = false;
  for (int i = 0; i < count; ++i) {
    if (!smooth(i)) continue;
    any = true;
    guess_geodesic(before(i), i, next_touched(i));
    if (!smooth(before(i))) start = i;
  }
  if (!any) return;
  if (start < 0) {
    return fail("/links",
                "nothing holds a belt on smooth bodies alone; give it a \"rolling\" link");
  }
  std::vector<LinkGeometry*> row;
  int last = start;
  for (int walked = 0; walked < count; ++walked) {
    const int link = last;
    last = next_touched(link);
    if (smooth(link)) row.push_back(&links_[at(link)]);
    if (row.empty() || (smooth(last) && last != start)) continue;
    const int front = static_cast<int>(row.front() - links_.data());
    const int first = before(front);
    SpanSetup in;
    SpanSetup out;
    choose_kind(in, links_[at(first)], *row.front());
    choose_kind(out, *row.back(), links_[at(last)]);
    if (closed || (first < front && link < last)) {
      const auto settle = [&] {
        settle_row(*now_, row, {in, links_[at(first)], out, links_[at(last)]});
      };
      settle();
      if (wind_on(row)) settle();
    }
    row.clear();
  }
}

}  // namespace sheave
