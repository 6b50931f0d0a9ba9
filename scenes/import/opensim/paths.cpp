// <GeometryPath>: points as sites, and the segment of the path that wraps over each surface.
//
// OpenSim looks at each moment for the segment between two points that a surface bends. A cable has
// its links in one order: the segment here is the one that the surface bends at the start, or else
// in most of some poses in the ranges of the coordinates.

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "engine/index.h"
#include "engine/number_text.h"
#include "scenes/import/mjcf/wrap.h"
#include "scenes/import/opensim/reader.h"

namespace sheave::import::opensim {
namespace {

constexpr std::size_t most_points = 1000;
constexpr std::size_t most_wraps = 20;
constexpr int sampled_poses = 24;

/// Poses in the ranges of the coordinates, the start first.
std::vector<mjcf::Pose> sample_poses(const Reader& reader) {
  std::vector<mjcf::Pose> poses;
  std::vector<double> values;
  for (const Coordinate& one : reader.coordinates) values.push_back(one.start);
  poses.push_back(mjcf::pose_of(reader.model, positions_at(values, reader), {}));
  std::uint64_t state = 1;
  for (int i = 0; i < sampled_poses; ++i) {
    for (std::size_t c = 0; c < values.size(); ++c) {
      const Coordinate& one = reader.coordinates[c];
      // Knuth's generator of MMIX.
      state = 6364136223846793005ULL * state + 1442695040888963407ULL;
      const double part = static_cast<double>(state >> 11U) * 0x1p-53;
      values[c] = one.range[0] + part * (one.range[1] - one.range[0]);
    }
    poses.push_back(mjcf::pose_of(reader.model, positions_at(values, reader), {}));
  }
  return poses;
}

class PathReader {
 public:
  PathReader(const xml::Element& path, mjcf::Tendon& tendon, Reader& reader)
      : path_(path), tendon_(tendon), reader_(reader) {}

  bool read() {
    const auto points = reader_.properties.objects(path_, "PathPointSet");
    if (points.size() > most_points) {
      return fail(fmt::format("a path has at most {} points", most_points));
    }
    for (const xml::Element* const point : points) add_point(*point);
    if (sites_.size() < 2) return fail("a path needs at least two points");
    behind_.resize(sites_.size() - 1);
    const auto wraps = reader_.properties.objects(path_, "PathWrapSet");
    for (std::size_t i = 0; i < wraps.size(); ++i) {
      if (i < most_wraps) {
        add_wrap(*wraps[i]);
      } else {
        reader_.log.skipped(*wraps[i], fmt::format("a path has at most {} wraps", most_wraps));
      }
    }
    if (is_on_one_body()) return fail("all its points are on one body, so it does nothing");
    for (std::size_t segment = 0; segment < behind_.size(); ++segment) leave_ends(segment);
    for (std::size_t i = 0; i < sites_.size(); ++i) {
      tendon_.path.push_back({points_[i], sites_[i], -1, -1});
      if (i < behind_.size()) {
        for (const mjcf::PathPoint& wrap : behind_[i]) tendon_.path.push_back(wrap);
      }
    }
    return true;
  }

 private:
  bool fail(const std::string& reason) {
    reader_.log.skipped(path_, reason);
    return false;
  }

  /// Whether all points are on one body with its parts.
  [[nodiscard]] bool is_on_one_body() const {
    const auto body = [&](int site) {
      return reader_.carriers[at(reader_.model.sites[at(site)].body)];
    };
    return std::all_of(sites_.begin(), sites_.end(),
                       [&](int site) { return body(site) == body(sites_.front()); });
  }

  /// Takes cylinders out of a segment that lies beyond their ends at the start.
  void leave_ends(std::size_t segment) {
    std::vector<mjcf::PathPoint>& list = behind_[segment];
    while (!list.empty()) {
      const mjcf::Pose& start = reader_.sampled.front();
      std::vector<mjcf::Obstacle> obstacles;
      for (const mjcf::PathPoint& point : list) {
        const mjcf::Geom& geom = reader_.model.geoms[at(point.geom)];
        obstacles.push_back({&geom, start.bodies[at(geom.body)].frame * geom.frame, {}});
        if (point.side_site < 0) continue;
        mjcf::Obstacle& own = obstacles.back();
        own.side = own.frame.orientation.conjugate() *
                   (position(start, point.side_site) - own.frame.position);
      }
      const std::vector<mjcf::Wrap> wraps = mjcf::wrap_over_all(
          obstacles, position(start, sites_[segment]), position(start, sites_[segment + 1]));
      std::size_t k = 0;
      while (k < wraps.size() &&
             !(wraps[k].touches && obstacles[k].geom->type == mjcf::GeomType::cylinder &&
               wraps[k].height > obstacles[k].geom->size[1])) {
        ++k;
      }
      if (k == wraps.size()) return;
      reader_.log.skipped(*list[k].element,
                          "at the start the path lies beyond an end of the cylinder");
      list.erase(list.begin() + static_cast<std::ptrdiff_t>(k));
    }
  }

  /// Where a site is in the world.
  [[nodiscard]] Vector3 position(const mjcf::Pose& pose, int site) const {
    const mjcf::Site& one = reader_.model.sites[at(site)];
    return pose.bodies[at(one.body)].frame.point(one.frame.position);
  }

  void add_point(const xml::Element& element) {
    const FixedFrame frame = frame_of_point(element, reader_);
    if (frame.body < 0) return;
    mjcf::Site site;
    site.element = &element;
    if (const auto moving = reader_.moving_points.find(&element);
        moving != reader_.moving_points.end()) {
      site.body = moving->second;
      return add_site(std::move(site));
    }
    Vector3 point = reader_.properties.vector(element, "location").value_or(Vector3::Zero());
    if (element.tag == "ConditionalPathPoint") {
      if (!is_active(element)) return;
    } else if (element.tag == "MovingPathPoint") {
      point = moving_point(element);
    } else if (element.tag != "PathPoint") {
      reader_.log.skipped(element,
                          "no point that is known here; known are PathPoint, "
                          "ConditionalPathPoint and MovingPathPoint");
      return;
    }
    site.body = reader_.bodies[at(frame.body)].number;
    site.frame.position = frame.frame.point(point);
    add_site(std::move(site));
  }

  void add_site(mjcf::Site site) {
    points_.push_back(site.element);
    sites_.push_back(static_cast<int>(reader_.model.sites.size()));
    reader_.model.sites.push_back(std::move(site));
  }

  bool is_active(const xml::Element& element) {
    const int number = coordinate_of_point(element, "", reader_);
    const auto range = reader_.properties.numbers(element, "range", 2, 2);
    if (number < 0 || range.empty()) {
      reader_.log.error(element, "a coordinate and a range of two numbers are needed", {},
                        FaultCode::missing_key);
      return false;
    }
    const Coordinate& coordinate = reader_.coordinates[at(number)];
    // Points whose coordinate stays in the range are points like others.
    const auto contains = [&](double value) { return value >= range[0] && value <= range[1]; };
    const bool at_start = contains(coordinate.start);
    const bool always = coordinate.locked ? at_start
                                          : contains(coordinate.range[0]) &&
                                                contains(coordinate.range[1]) && at_start;
    if (always) return true;
    const std::string where =
        fmt::format("while \"{}\" is in {} ... {}", coordinate.name.substr(0, 100),
                    number_text(range[0], 6), number_text(range[1], 6));
    if (at_start) {
      reader_.log.changed(element, "always a point of the path; in OpenSim " + where);
    } else {
      reader_.log.skipped(element, "never a point of the path; in OpenSim " + where);
    }
    return at_start;
  }

  Vector3 moving_point(const xml::Element& element) {
    Vector3 point;
    double most = 0.0;
    for (int i = 0; i < 3; ++i) {
      const std::string axis(1, static_cast<char>('x' + i));
      const int number = coordinate_of_point(element, axis, reader_);
      const auto function =
          read_function(element, axis + "_location", reader_.properties, reader_.log);
      if (!function || (number < 0 && !function->is_constant())) {
        reader_.log.error(
            element, fmt::format("a coordinate and a function are needed for {}_location", axis),
            {}, FaultCode::missing_key);
        return Vector3::Zero();
      }
      const Coordinate none{};
      const Coordinate& coordinate = number < 0 ? none : reader_.coordinates[at(number)];
      point[i] = (*function)(coordinate.start);
      if (coordinate.locked || number < 0) continue;
      constexpr int samples = 100;
      for (int k = 0; k <= samples; ++k) {
        const auto [least, greatest] = coordinate.range;
        const double value = (*function)(least + (greatest - least) * k / samples);
        most = std::max(most, std::abs(value - point[i]));
      }
    }
    if (most > 0.0) {
      reader_.log.changed(element,
                          fmt::format("stays where it is at the start; in OpenSim it moves "
                                      "along an axis by up to {} m",
                                      number_text(most, 3)));
    }
    return point;
  }

  void add_wrap(const xml::Element& element) {
    const std::string name = reader_.properties.text(element, "wrap_object");
    static_cast<void>(reader_.properties.child(element, "method"));
    const auto found = reader_.wraps.find(name);
    if (found == reader_.wraps.end()) {
      reader_.log.error(element, "<wrap_object> must be the name of a wrap object", name,
                        FaultCode::meaning);
      return;
    }
    const WrapSurface& surface = found->second;
    if (surface.geom < 0 || !surface.active) {
      reader_.log.skipped(
          element, surface.active ? "its wrap object is skipped" : "its wrap object is not active");
      return;
    }
    // Points are counted from 1 in the range; -1: the first or the last one.
    std::size_t first = 0;
    std::size_t last = behind_.size();
    const auto range = reader_.properties.numbers(element, "range", 2, 2);
    if (!range.empty() && range[0] >= 1.0 && range[0] <= static_cast<double>(last)) {
      first = static_cast<std::size_t>(range[0]) - 1;
    }
    if (!range.empty() && range[1] >= 1.0 && range[1] <= static_cast<double>(last)) {
      last = std::max(static_cast<std::size_t>(range[1]) - 1, first + 1);
    }
    const std::size_t segment = best_segment(surface, first, last);
    if (reader_.model.geoms[at(surface.geom)].type == mjcf::GeomType::ellipsoid) {
      reader_.log.changed(element,
                          "the shortest way over the ellipsoid; OpenSim's way is in a "
                          "plane that its method chooses");
    }
    reader_.log.same(element, "a surface link of the cable");
    if (last - first > 1) {
      reader_.log.changed(
          element, fmt::format("wraps between points {} and {} alone", segment + 1, segment + 2));
    }
    insert(segment, {&element, -1, surface.geom, surface.side_site});
  }

  [[nodiscard]] mjcf::Wrap wrap_in(const mjcf::Pose& pose, const WrapSurface& surface,
                                   std::size_t segment) const {
    const mjcf::Model& model = reader_.model;
    const mjcf::Geom& geom = model.geoms[at(surface.geom)];
    const mjcf::Frame frame = pose.bodies[at(geom.body)].frame * geom.frame;
    const auto own = [&](int site) -> Vector3 {
      return frame.orientation.conjugate() * (position(pose, site) - frame.position);
    };
    std::optional<Vector3> side;
    if (surface.side_site >= 0) side = own(surface.side_site);
    return mjcf::wrap_over(geom, own(sites_[segment]), own(sites_[segment + 1]), side);
  }

  std::size_t best_segment(const WrapSurface& surface, std::size_t first, std::size_t last) {
    if (last - first == 1) return first;
    static_cast<void>(start_pose(reader_));
    std::size_t best = first;
    int most = -1;
    for (std::size_t segment = first; segment < last; ++segment) {
      int touches = 0;
      for (std::size_t i = 0; i < reader_.sampled.size(); ++i) {
        // Touching at the start outweighs all other poses.
        if (!wrap_in(reader_.sampled[i], surface, segment).touches) continue;
        touches += i == 0 ? sampled_poses + 1 : 1;
      }
      if (touches > most) best = segment;
      most = std::max(most, touches);
    }
    return best;
  }

  /// Inserts a wrap in the order of the surfaces along the segment at the start.
  void insert(std::size_t segment, const mjcf::PathPoint& wrap) {
    const mjcf::Pose& start = start_pose(reader_);
    const mjcf::Model& model = reader_.model;
    const Vector3 from = position(start, sites_[segment]);
    const Vector3 way = position(start, sites_[segment + 1]) - from;
    const auto along = [&](const mjcf::PathPoint& one) {
      const mjcf::Geom& geom = model.geoms[at(one.geom)];
      return way.dot(start.bodies[at(geom.body)].frame.point(geom.frame.position) - from);
    };
    std::vector<mjcf::PathPoint>& list = behind_[segment];
    const auto place = std::find_if(list.begin(), list.end(), [&](const mjcf::PathPoint& other) {
      return along(other) > along(wrap);
    });
    list.insert(place, wrap);
  }

  const xml::Element& path_;
  mjcf::Tendon& tendon_;
  Reader& reader_;
  std::vector<const xml::Element*> points_;
  std::vector<int> sites_;                            ///< of the points
  std::vector<std::vector<mjcf::PathPoint>> behind_;  ///< wraps behind each point
};

}  // namespace

std::vector<double> positions_at(const std::vector<double>& values, const Reader& reader) {
  std::vector<double> positions = mjcf::reference_positions(reader.model);
  for (std::size_t j = 0; j < reader.driven.size(); ++j) {
    const Driven& driven = reader.driven[j];
    if (driven.coordinate < 0) continue;
    const Function function({driven.factors.begin(), driven.factors.end()});
    positions[at(reader.model.joints[j].qpos)] = function(values[at(driven.coordinate)]);
  }
  for (const auto& [joint, turn] : reader.ball_starts) {
    double* const q = &positions[at(reader.model.joints[at(joint)].qpos)];
    q[0] = turn.w();
    q[1] = turn.x();
    q[2] = turn.y();
    q[3] = turn.z();
  }
  return positions;
}

const mjcf::Pose& start_pose(Reader& reader) {
  if (reader.sampled.empty()) reader.sampled = sample_poses(reader);
  return reader.sampled.front();
}

FixedFrame frame_of_point(const xml::Element& element, Reader& reader) {
  const std::string body = reader.properties.text(element, "body");
  if (body.empty()) return frame_of(element, "parent_frame", "", reader);
  const auto found = reader.body_names.find(body);
  if (found == reader.body_names.end()) {
    reader.log.error(element, "<body> must be the name of a body", body, FaultCode::meaning);
    return {};
  }
  return {found->second, {}};
}

int coordinate_of_point(const xml::Element& element, const std::string& axis, Reader& reader) {
  const std::string plain = axis + (axis.empty() ? "" : "_") + "coordinate";
  for (const std::string& name :
       {"socket_" + plain, "socket_" + plain + "_connectee_name", plain}) {
    const std::string path = reader.properties.text(element, name);
    if (path.empty()) continue;
    const std::size_t slash = path.rfind('/');
    return reader.coordinate(slash == std::string::npos ? path : path.substr(slash + 1));
  }
  return -1;
}

bool read_path(const xml::Element& object, mjcf::Tendon& tendon, Reader& reader) {
  const xml::Element* path = reader.properties.child(object, {"GeometryPath", "path"});
  if (path != nullptr && path->tag == "path" && path->children.size() == 1) {
    path = &path->children.front();
    reader.properties.mark(*path);
  }
  if (path == nullptr) {
    reader.log.skipped(object, "<GeometryPath> is missing");
    return false;
  }
  const std::string* const name = object.value("name");
  tendon.element = &object;
  tendon.name = name == nullptr ? "" : *name;
  if (!PathReader(*path, tendon, reader).read()) {
    reader.log.skipped(object, "its path is skipped");
    tendon.path.clear();
    return false;
  }
  reader.log.same(*path, "the path of a cable");
  return true;
}

}  // namespace sheave::import::opensim
