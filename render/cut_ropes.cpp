// The chain is stepped as in position-based dynamics: points move freely, and the lengths of all links
// are then restored at once. The links are neighbours only, so the system for their multipliers is
// tridiagonal.
#include "render/cut_ropes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/body_set.h"
#include "engine/index.h"

namespace sheave::render {
namespace {

constexpr int links_of_chain = 40;
/// A substep is this fraction of sqrt(length / gravity), so that no link turns far in it.
constexpr double substep_share = 0.004;
constexpr double longest_substep = 1.0 / 240.0;  // [s]
constexpr double most_substeps = 400.0;
/// Velocities relative to the held point, or to the mean of a free chain, lose this share in
/// sqrt(length / gravity), so that a chain comes to rest within two swings.
constexpr double friction = 1.0;
/// Width of a wheel on either side of its plane, as a share of its radius.
constexpr double wheel_half_width = 0.3;

using Line = std::vector<Vector3>;

void append_line(Line& line,
                 std::size_t (*write)(const CableReport&, std::size_t, const PolylineOptions&,
                                      std::span<Vector3>),
                 const CableReport& cable, std::size_t index, const PolylineOptions& options) {
  const std::size_t count = write(cable, index, options, {});
  const std::size_t before = line.size();
  line.resize(before + count);
  write(cable, index, options, std::span<Vector3>(line).subspan(before));
}

double length_of_line(std::span<const Vector3> line) {
  double sum = 0.0;
  for (std::size_t k = 1; k < line.size(); ++k) sum += (line[k] - line[k - 1]).norm();
  return sum;
}

/// `count` + 1 points at equal distances along a line.
Line resampled(std::span<const Vector3> line, int count) {
  const double total = length_of_line(line);
  Line points{line.front()};
  double walked = 0.0;
  std::size_t k = 1;
  for (int i = 1; i < count; ++i) {
    const double wanted = total * i / count;
    double step = (line[k] - line[k - 1]).norm();
    while (k + 1 < line.size() && walked + step < wanted) {
      walked += step;
      ++k;
      step = (line[k] - line[k - 1]).norm();
    }
    const double share = step > 0.0 ? std::clamp((wanted - walked) / step, 0.0, 1.0) : 0.0;
    points.emplace_back(line[k - 1] + share * (line[k] - line[k - 1]));
  }
  points.push_back(line.back());
  return points;
}

/// Divides a line at a share of its length.
std::array<Line, 2> divided(const Line& line, double share) {
  const double wanted = share * length_of_line(line);
  std::array<Line, 2> parts;
  double walked = 0.0;
  std::size_t k = 0;
  while (k + 2 < line.size() && walked + (line[k + 1] - line[k]).norm() < wanted) {
    walked += (line[k + 1] - line[k]).norm();
    ++k;
  }
  const double step = (line[k + 1] - line[k]).norm();
  const double part = step > 0.0 ? std::clamp((wanted - walked) / step, 0.0, 1.0) : 0.0;
  const Vector3 middle = line[k] + part * (line[k + 1] - line[k]);
  parts[0].assign(line.begin(), line.begin() + static_cast<std::ptrdiff_t>(k) + 1);
  parts[0].push_back(middle);
  parts[1].push_back(middle);
  parts[1].insert(parts[1].end(), line.begin() + static_cast<std::ptrdiff_t>(k) + 1, line.end());
  return parts;
}

Vector3 gravity_of(const World& world) {
  const Controls& controls = world.state().controls;
  return controls.has_gravity ? controls.gravity : world.model().gravity;
}

LooseChain::Surroundings surroundings(const World& world, const CableReport& cable) {
  LooseChain::Surroundings around;
  around.gravity = gravity_of(world);
  for (const LinkReport& link : cable.links) {
    if (link.radius > 0.0) around.wheels.push_back({link.center, link.normal, link.radius});
  }
  if (const auto& ground = world.model().ground) {
    around.ground = PolylineFloor{ground->point, ground->normal.normalized()};
  }
  return around;
}

Vector3 in_body(const World& world, BodyId body, const Vector3& point) {
  if (body.is_world()) return point;
  return world.orientation(body).conjugate() * (point - world.position(body));
}

Vector3 in_world(const World& world, BodyId body, const Vector3& local) {
  if (body.is_world()) return local;
  return world.position(body) + world.orientation(body) * local;
}

/// The cable on the wheel of an end, up to the point where the free piece begins.
Line wound_line(const LinkReport& link, bool first, const Vector3& hold) {
  CableReport end;
  end.links.resize(2);
  LinkReport& own = end.links[first ? 0 : 1];
  own.center = link.center;
  own.normal = link.normal;
  own.radius = link.radius;
  own.winding = link.winding;
  own.wrap_angle = std::min(link.wrap_angle, 2.0 * pi);  // all turns lie on one another
  own.entry = own.exit = hold;
  Line line;
  append_line(line, &link_polyline, end, first ? 0 : 1, {.tolerance = 0.005 * link.radius + 1e-9});
  return line;
}

/// The line of a whole cable without the cable on the wheels of its ends.
Line free_line_of(const CableReport& listed, double tolerance, const Vector3& gravity) {
  const CableReport cable = listed.with_wraps_in_place();
  const PolylineOptions options{.tolerance = tolerance, .gravity = gravity};
  Line line;
  for (std::size_t k = 0; k < cable.spans.size(); ++k) {
    if (k > 0 || cable.closed) append_line(line, &link_polyline, cable, k, options);
    append_line(line, &span_polyline, cable, k, options);
  }
  return line;
}

}  // namespace

LooseChain::LooseChain(std::span<const Vector3> line, double length, bool held)
    : points_(resampled(line, links_of_chain)),
      before_(points_),
      velocities_(points_.size(), Vector3::Zero()),
      diagonal_(at(links_of_chain)),
      multipliers_(at(links_of_chain)),
      segment_(length / links_of_chain),
      held_(held) {}

void LooseChain::move(double time, const Vector3& hold, const Surroundings& around) {
  const double length = segment_ * links_of_chain;
  const double strength = around.gravity.norm();
  const double swing = strength > 0.0 ? std::sqrt(length / strength) : 1.0;
  const double wanted = std::clamp(substep_share * swing, 1e-9, longest_substep);
  const double count = std::clamp(std::ceil(time / wanted), 1.0, most_substeps);
  const double h = std::min(time / count, longest_substep);
  const double kept = std::exp(-friction * h / swing);
  const Vector3 from = points_.front();
  for (double k = 1.0; k <= count; ++k) {
    const Vector3 carried = held_ ? Vector3((hold - from) / time) : mean_velocity();
    for (Vector3& v : velocities_) v = carried + kept * (v - carried);
    before_ = points_;
    for (std::size_t i = held_ ? 1 : 0; i < points_.size(); ++i) {
      velocities_[i] += h * around.gravity;
      points_[i] += h * velocities_[i];
    }
    if (held_) points_.front() = from + (hold - from) * (k / count);
    substep(h, around);
  }
}

Vector3 LooseChain::mean_velocity() const {
  Vector3 sum = Vector3::Zero();
  for (const Vector3& v : velocities_) sum += v;
  return sum / static_cast<double>(velocities_.size());
}

void LooseChain::substep(double h, const Surroundings& around) {
  constexpr int rounds = 3;
  for (int round = 0; round < rounds; ++round) restore_lengths();
  for (std::size_t i = 0; i < points_.size(); ++i) {
    velocities_[i] = (points_[i] - before_[i]) / h;
  }
  for (std::size_t i = held_ ? 1 : 0; i < points_.size(); ++i) {
    keep_out(around, points_[i], velocities_[i]);
  }
}

// Newton's method for |x(i+1) - x(i)| = d with equal masses: J J^T has 2 in its diagonal, 1 for the
// link at the held point, and -n(i) n(i+1) beside it.
void LooseChain::restore_lengths() {
  const std::size_t n = multipliers_.size();
  Vector3 before = Vector3::Zero();
  for (std::size_t i = 0; i < n; ++i) {
    const Vector3 along = points_[i + 1] - points_[i];
    const double length = along.norm();
    const Vector3 direction = length > 0.0 ? Vector3(along / length) : Vector3::UnitX();
    double diagonal = i == 0 && held_ ? 1.0 : 2.0;
    double value = segment_ - length;
    if (i > 0) {
      const double beside = -direction.dot(before);
      diagonal -= beside * beside / diagonal_[i - 1];
      value -= beside * multipliers_[i - 1] / diagonal_[i - 1];
    }
    // The elimination leaves 1 / (n + 1) at least, where all links of a free chain are in line.
    diagonal_[i] = std::max(diagonal, 0.5 / static_cast<double>(n + 1));
    multipliers_[i] = value;
    before = direction;
  }
  Vector3 later = Vector3::Zero();  // direction times multiplier of the link behind
  Vector3 later_direction = Vector3::Zero();
  double later_multiplier = 0.0;
  for (std::size_t i = n; i-- > 0;) {
    const Vector3 along = points_[i + 1] - points_[i];
    const double length = along.norm();
    const Vector3 direction = length > 0.0 ? Vector3(along / length) : Vector3::UnitX();
    const double beside = -direction.dot(later_direction);
    const double multiplier = (multipliers_[i] - beside * later_multiplier) / diagonal_[i];
    // The point behind the link needs this link's direction before it moves.
    points_[i + 1] += direction * multiplier - later;
    later = direction * multiplier;
    later_direction = direction;
    later_multiplier = multiplier;
  }
  if (!held_) points_.front() -= later;
}

// A push out of a body gives no velocity, which would be energy; it ends the motion into the body.
void LooseChain::keep_out(const Surroundings& around, Vector3& point, Vector3& velocity) {
  for (const Wheel& wheel : around.wheels) {
    const Vector3 arm = point - wheel.center;
    const double along = arm.dot(wheel.normal);
    if (std::abs(along) > wheel_half_width * wheel.radius) continue;
    const Vector3 out = arm - along * wheel.normal;
    const double distance = out.norm();
    if (distance >= wheel.radius || !(distance > 0.0)) continue;
    const Vector3 direction = out / distance;
    point += direction * (wheel.radius - distance);
    velocity -= direction * std::min(0.0, velocity.dot(direction));
  }
  if (!around.ground) return;
  const double height = around.ground->normal.dot(point - around.ground->point);
  if (height > 0.0) return;
  point -= height * around.ground->normal;
  velocity.setZero();  // rough ground
}

void CutRopes::follow(const World& world, std::span<const CableReport> cables) {
  const double time = world.state().time;
  const bool goes_back = time_ && time < *time_;
  if (goes_back || cables_.size() != cables.size()) cables_.assign(cables.size(), {});
  const double passed = time_ && !goes_back ? time - *time_ : 0.0;
  time_ = time;
  const double tolerance = 2e-3 * world.bodies().scale();
  for (std::size_t c = 0; c < cables.size(); ++c) {
    const CableReport& report = cables[c];
    Cable& cable = cables_[c];
    if (!report.cut) {
      cable.free_line = free_line_of(report, tolerance, gravity_of(world));
      cable.pieces.clear();
      cable.lines.clear();
      continue;
    }
    if (cable.pieces.empty() && cable.free_line.size() > 1) part(world, report, cable);
    if (cable.pieces.empty()) hang(world, report, cable);
    const LooseChain::Surroundings around = surroundings(world, report);
    cable.lines.clear();
    for (Piece& piece : cable.pieces) {
      const bool first = piece.link == 0;
      Vector3 hold = piece.chain.points().front();
      if (piece.link >= 0) hold = in_world(world, report.links[at(piece.link)].body, piece.hold);
      if (passed > 0.0) piece.chain.move(passed, hold, around);
      Line line = piece.chain.points();
      if (piece.link >= 0 && report.links[at(piece.link)].radius > 0.0) {
        Line wound = wound_line(report.links[at(piece.link)], first, hold);
        if (!first) std::reverse(wound.begin(), wound.end());
        line.insert(line.begin(), wound.begin(), wound.end());
      }
      cable.lines.push_back(std::move(line));
    }
  }
}

void CutRopes::part(const World& world, const CableReport& report, Cable& cable) const {
  const double whole = report.pieces[0] + report.pieces[1];
  if (report.closed) {
    auto [before, behind] = divided(cable.free_line, report.pieces[0] / whole);
    behind.insert(behind.end(), before.begin(), before.end());
    cable.pieces.push_back({LooseChain(behind, whole, false)});
    return;
  }
  const LinkReport& first = report.links.front();
  const LinkReport& last = report.links.back();
  const std::array<double, 2> lengths{report.pieces[0] - first.stored_length,
                                      report.pieces[1] - last.stored_length};
  std::array<Line, 2> parts =
      divided(cable.free_line, std::clamp(lengths[0] / (lengths[0] + lengths[1]), 0.0, 1.0));
  std::reverse(parts[1].begin(), parts[1].end());
  for (const int end : {0, 1}) {
    if (!(lengths[at(end)] > 0.0)) continue;
    const int link = end == 0 ? 0 : static_cast<int>(report.links.size()) - 1;
    cable.pieces.push_back({LooseChain(parts[at(end)], lengths[at(end)], true), link,
                            in_body(world, report.links[at(link)].body, parts[at(end)].front())});
  }
}

void CutRopes::hang(const World& world, const CableReport& report, Cable& cable) const {
  if (report.closed) return;
  for (const int end : {0, 1}) {
    const int link = end == 0 ? 0 : static_cast<int>(report.links.size()) - 1;
    // Without the wound cable, which is drawn for every picture.
    CableReport bare = report;
    LinkReport& own = bare.links[at(link)];
    bare.pieces[at(end)] -= own.stored_length;
    own.stored_length = own.wrap_angle = 0.0;
    if (own.groove) own.groove->wound = 0.0;
    if (!(bare.pieces[at(end)] > 0.0)) continue;
    Line line;
    append_line(line, &piece_polyline, bare, at(end), {.gravity = gravity_of(world)});
    if (end == 1) std::reverse(line.begin(), line.end());
    cable.pieces.push_back({LooseChain(line, bare.pieces[at(end)], true), link,
                            in_body(world, own.body, line.front())});
  }
}

std::span<const std::vector<Vector3>> CutRopes::pieces(std::size_t cable) const {
  if (cable >= cables_.size()) return {};
  return cables_[cable].lines;
}

}  // namespace sheave::render
