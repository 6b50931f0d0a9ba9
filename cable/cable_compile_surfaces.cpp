// Surface links at time 0: the geodesic of each row of smooth bodies, found before the spans.

#include <span>

#include "cable/cable_compiler.h"
#include "cable/geodesic_row.h"
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
  // the winding says.
  const Vector3 start = center(before);
  const Vector3 way = center(after) - start;
  if (!(way.norm() > 0.0)) return;
  const Vector3 direction = way.normalized();
  const Vector3 outward = cross(direction, geodesic.entry.across());
  if (!(outward.norm() > 1e-6)) return;
  const Vector3 core = core_passage(geodesic.surface, start, direction).core;
  geodesic.entry =
      geodesic.surface.frame(core + geodesic.surface.radius * outward.normalized(), direction);
}

void CableCompiler::check_surface(int link) {
  const GeodesicLink& geodesic = *links_[at(link)].geodesic;
  if (!geodesic.settled) return;  // the spans have failed
  const std::string field = "/links/" + std::to_string(link);
  if (geodesic.length < -1e-9 * links_[at(link)].perimeter()) {
    fail(field, link_name(link) +
                    ": the cable does not reach the body on the side that \"winding\" says; give "
                    "the other \"winding\", or make the body \"wrappable\" and leave the link out");
  } else if (geodesic.surface.beyond_ends(geodesic.entry.point) > 0.0 ||
             geodesic.surface.beyond_ends(geodesic.exit.point) > 0.0) {
    fail(field, link_name(link) +
                    ": the cable lies beyond an end of the cylinder at time 0; make the cylinder "
                    "longer, or move it");
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
