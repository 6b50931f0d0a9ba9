// Links that take the side on which the cable is shortest.
//
// The length of a span depends on the sides of the two links at its ends, and an arc on those of
// three links in a row. The length of the cable is therefore a sum along the cable in which only
// neighbours meet, and dynamic programming over pairs of neighbouring sides finds the least sum in
// a time proportional to the number of links, where trying all sides would take 2^n.

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "cable/cable_compiler.h"
#include "cable/link_contact.h"
#include "engine/index.h"

namespace sheave {
namespace {

constexpr double no_way = std::numeric_limits<double>::infinity();
/// Two lengths that differ by less than this share are equal: rounding of lengths and arcs.
constexpr double equal_share = 1e-9;

/// Largest number of links of a cable with the shortest side. The search for a second shortest way
/// takes time in proportion to the square.
constexpr std::size_t most_links = 2000;

/// The index of a side in the tables below.
int side_number(int side) { return side < 0 ? 1 : 0; }

/// Lengths of the parts of a cable by the sides of its links.
struct SideTable {
  bool closed = false;
  /// Per touched link: whether it may lie on the left and on the right.
  std::vector<std::array<bool, 2>> allowed;
  /// Per span, by the sides of its first and second link [m].
  std::vector<std::array<std::array<double, 2>, 2>> spans;
  /// Per link, by the sides of the link before, of its own and of the one behind [m].
  std::vector<std::array<std::array<std::array<double, 2>, 2>, 2>> arcs;

  [[nodiscard]] std::size_t count() const { return allowed.size(); }
};

/// The least length by the sides of a link and of the one behind it, and for each of them the best
/// side of the link before.
struct SideStep {
  std::array<std::array<double, 2>, 2> length{};
  std::array<std::array<int, 2>, 2> before{};
};

struct ShortestSides {
  double length = no_way;
  std::vector<int> sides;  ///< indices of sides, per touched link
};

/// One more link: `link` is the second one of the pair in `last`.
SideStep next_step(const SideTable& table, std::size_t link, const SideStep& last) {
  const std::size_t behind = (link + 1) % table.count();
  SideStep step;
  for (int own = 0; own < 2; ++own) {
    for (int after = 0; after < 2; ++after) {
      double& best = step.length[at(own)][at(after)];
      best = no_way;
      if (!table.allowed[behind][at(after)]) continue;
      for (int before = 0; before < 2; ++before) {
        const double length = last.length[at(before)][at(own)] +
                              table.arcs[link][at(before)][at(own)][at(after)] +
                              table.spans[link][at(own)][at(after)];
        if (!(length < best)) continue;
        best = length;
        step.before[at(own)][at(after)] = before;
      }
    }
  }
  return step;
}

/// The sides of the shortest cable whose first two links have these sides.
ShortestSides shortest_from(const SideTable& table, int first, int second) {
  const std::size_t count = table.count();
  std::vector<SideStep> steps(1);
  for (auto& lengths : steps[0].length) lengths.fill(no_way);
  if (table.allowed[0][at(first)] && table.allowed[1][at(second)]) {
    steps[0].length[at(first)][at(second)] = table.spans[0][at(first)][at(second)];
  }
  // A ring ends with the pair with which it begins.
  const std::size_t last = table.closed ? count : count - 2;
  for (std::size_t link = 1; link <= last; ++link) {
    steps.push_back(next_step(table, link % count, steps.back()));
  }
  ShortestSides found;
  std::array<int, 2> pair{first, second};
  for (int own = 0; own < 2; ++own) {
    for (int after = 0; after < 2; ++after) {
      if (table.closed && (own != first || after != second)) continue;
      const double length = steps.back().length[at(own)][at(after)];
      if (!(length < found.length)) continue;
      found.length = length;
      pair = {own, after};
    }
  }
  if (found.length == no_way) return found;
  if (table.closed) found.length -= table.spans[0][at(first)][at(second)];  // counted twice
  std::vector<int> sides{pair[1], pair[0]};
  for (std::size_t i = steps.size(); i-- > 1;) {
    const int before = steps[i].before[at(pair[0])][at(pair[1])];
    pair = {before, pair[0]};
    sides.push_back(before);
  }
  std::reverse(sides.begin(), sides.end());
  sides.resize(count);
  found.sides = std::move(sides);
  return found;
}

ShortestSides shortest_sides(const SideTable& table) {
  ShortestSides best;
  for (int first = 0; first < 2; ++first) {
    for (int second = 0; second < 2; ++second) {
      ShortestSides found = shortest_from(table, first, second);
      if (found.length < best.length) best = std::move(found);
    }
  }
  return best;
}

/// Finds the geometry of the parts of a cable for all sides of its links.
class SideMeasure {
 public:
  using Join = std::function<SpanGeometry(int, int)>;
  using Arc = std::function<double(int, const SpanGeometry&, const SpanGeometry&)>;

  SideMeasure(std::vector<LinkGeometry>& links, std::vector<int> touched, bool closed)
      : links_(links), touched_(std::move(touched)) {
    table_.closed = closed;
    for (const int link : touched_) {
      const LinkGeometry& own = links_[at(link)];
      const bool both = own.takes_shortest;
      table_.allowed.push_back({both || own.side >= 0, both || own.side < 0});
    }
  }

  const SideTable& measure(const Join& join, const Arc& arc) {
    const std::size_t count = touched_.size();
    const std::size_t spans = table_.closed ? count : count - 1;
    std::vector<std::array<std::array<SpanGeometry, 2>, 2>> geometry(spans);
    table_.spans.resize(spans);
    table_.arcs.resize(count);
    for (std::size_t k = 0; k < spans; ++k) {
      for_sides({k, next(k)}, [&](const std::array<int, 3>& s) {
        const LinkGeometry& a = links_[at(touched_[k])];
        const LinkGeometry& b = links_[at(touched_[next(k)])];
        SpanGeometry& span = geometry[k][at(s[0])][at(s[1])];
        span = join(touched_[k], touched_[next(k)]);
        const bool exists = span.has_tangent && !on_one_outline(a, b);
        table_.spans[k][at(s[0])][at(s[1])] = exists ? span.length : no_way;
      });
    }
    for (std::size_t i = table_.closed ? 0 : 1; i < (table_.closed ? count : count - 1); ++i) {
      const std::size_t before = (i + count - 1) % count;
      for_sides({before, i, next(i)}, [&](const std::array<int, 3>& s) {
        const bool exists = table_.spans[before][at(s[0])][at(s[1])] < no_way &&
                            table_.spans[i][at(s[1])][at(s[2])] < no_way;
        table_.arcs[i][at(s[0])][at(s[1])][at(s[2])] =
            exists && links_[at(touched_[i])].wraps()
                ? arc(touched_[i], geometry[before][at(s[0])][at(s[1])],
                      geometry[i][at(s[1])][at(s[2])])
                : 0.0;
      });
    }
    return table_;
  }

  /// Lays the touched links on these sides.
  void lay(const std::vector<int>& sides) {
    for (std::size_t i = 0; i < touched_.size(); ++i) put(i, sides[i]);
  }

 private:
  [[nodiscard]] std::size_t next(std::size_t link) const { return (link + 1) % touched_.size(); }
  void put(std::size_t touched, int side) {
    LinkGeometry& link = links_[at(touched_[touched])];
    if (link.wraps() && side_number(link.side) != side) link.take_other_side();
  }
  /// Calls `use` for all sides of two or three links, and lays the links back.
  template <class Use>
  void for_sides(const std::vector<std::size_t>& own, const Use& use) {
    std::array<int, 3> before{};
    for (std::size_t i = 0; i < own.size(); ++i) {
      before[i] = side_number(links_[at(touched_[own[i]])].side);
    }
    for (int number = 0; number < 1 << own.size(); ++number) {
      std::array<int, 3> sides{};
      bool may = true;
      for (std::size_t i = 0; i < own.size(); ++i) {
        sides[i] = (number >> i) & 1;
        may = may && table_.allowed[own[i]][at(sides[i])];
      }
      // In a ring of two links the link before and the one behind are the same.
      may = may && (own.size() < 3 || own[0] != own[2] || sides[0] == sides[2]);
      if (!may) continue;
      for (std::size_t i = 0; i < own.size(); ++i) put(own[i], sides[i]);
      use(sides);
    }
    for (std::size_t i = 0; i < own.size(); ++i) put(own[i], before[i]);
  }

  std::vector<LinkGeometry>& links_;
  std::vector<int> touched_;
  SideTable table_;
};

/// Index of a touched link that may lie on either side of the cable without making it longer than
/// `best`; the number of links if there is none.
std::size_t undecided_link(SideTable table, const ShortestSides& best) {
  for (std::size_t i = 0; i < table.count(); ++i) {
    const std::array<bool, 2> allowed = table.allowed[i];
    if (!allowed[0] || !allowed[1]) continue;
    table.allowed[i][at(best.sides[i])] = false;
    if (shortest_sides(table).length <= best.length * (1.0 + equal_share)) return i;
    table.allowed[i] = allowed;
  }
  return table.count();
}

}  // namespace

void CableCompiler::choose_sides(const CableDef& def) {
  std::vector<int> touched;
  bool asked = false;
  for (int i = 0; i < static_cast<int>(links_.size()); ++i) {
    const LinkGeometry& link = links_[at(i)];
    const std::string field = "/links/" + std::to_string(i) + "/side";
    if (link.takes_shortest && link.starts_lifted) {
      return fail(field, link_name(i) +
                             ": the cable does not touch a lifted wheel, so no side of it is the "
                             "shortest; give \"left\" or \"right\"");
    }
    asked = asked || link.takes_shortest;
    if (!link.starts_lifted) touched.push_back(i);
  }
  if (!asked || touched.size() < 2) return;
  if (touched.size() > most_links) {
    return fail("/links", "a cable with a shortest side can have at most " +
                              std::to_string(most_links) + " links, and there are " +
                              std::to_string(touched.size()) + "; give \"left\" or \"right\"");
  }
  for (const int i : touched) {
    if (!links_[at(i)].geodesic) continue;
    return fail("/links/" + std::to_string(i),
                link_name(i) +
                    ": in a cable with a surface link no side is taken by its length; give "
                    "\"left\" or \"right\" to the links with the shortest side");
  }
  SideMeasure measure(links_, touched, def.closed);
  const SideTable& table = measure.measure(
      [&](int first, int second) {
        SpanSetup setup;
        choose_kind(setup, links_[at(first)], links_[at(second)]);
        return span_geometry(*now_, setup, links_[at(first)], links_[at(second)]);
      },
      [&](int link, const SpanGeometry& in, const SpanGeometry& out) {
        return arc(link, in, out);
      });
  const ShortestSides best = shortest_sides(table);
  if (best.sides.empty()) return;  // the check of the spans names the missing tangent
  measure.lay(best.sides);
  for (std::size_t i = 0; i < touched.size(); ++i) {
    const auto drum = bare_radii_.find(static_cast<int>(system_->links_.size()) + touched[i]);
    if (drum != bare_radii_.end()) {
      drum->second = std::copysign(drum->second, links_[at(touched[i])].signed_radius);
    }
  }
  const std::size_t undecided = undecided_link(table, best);
  if (undecided == touched.size()) return;
  const int link = touched[undecided];
  fail("/links/" + std::to_string(link) + "/side",
       link_name(link) +
           ": the cable is equally long on both sides of the wheel; give \"left\" or \"right\"" +
           (def.closed ? ", here or at another wheel of the belt, which gives the belt its way"
                       : ""));
}

}  // namespace sheave
