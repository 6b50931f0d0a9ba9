// Spatial tendons as cables: a site is an attachment or a pinhole, a geom a surface link, or an
// opening if its side site lies within it.
//
// A tendon with a range is a rigid cable of the length of its upper end. One with a stiffness k is
// a cable of the axial stiffness EA = k L0 with the rest length L0, so that its spans and arcs
// together have the compliance 1 / k. One without either has a compliance of 1e12 m/N: it shows its
// length and pulls with less than 1e-9 N. A pulley with the divisor d at the begin of a path of
// length P makes a tendon of length P / d: as a cable of length P it has d times the lengths and,
// because k (P / d - s)^2 / 2 = (k / d^2) (P - d s)^2 / 2, the stiffness k / d^2. Further pulleys
// begin branches, one cable each, which show their lengths. A force of the whole has no counterpart:
// the branches would be several cables with one rest length, whose spans share one tension in the
// ratio of the divisors.

#include <algorithm>

#include <fmt/format.h>

#include "cable/opening.h"
#include "engine/index.h"
#include "engine/number_text.h"
#include "scenes/import/mjcf/scene.h"
#include "scenes/import/mjcf/wrap.h"

namespace sheave::import::mjcf {
namespace {

constexpr double no_force = 1e12;  // compliance of a cable that only shows its length [m/N]
// Beyond this a surface link counts as one that the cable does not reach.
constexpr double most_wrap = 1.5 * pi;

/// The course of a tendon in one pose.
struct Course {
  Json links = Json::array();
  std::vector<double> spans;  ///< free lengths, one per link but the last [m]
  std::vector<bool> used;     ///< false: no span begins at the link, which is not touched
  double arcs = 0.0;          ///< on geoms [m]
  std::string fault;          ///< why it cannot be a cable; empty: it can

  void add(double span, bool is_used = true) {
    spans.push_back(span);
    used.push_back(is_used);
  }
  [[nodiscard]] double free() const {
    double sum = 0.0;
    for (std::size_t i = 0; i < spans.size(); ++i) sum += used[i] ? spans[i] : 0.0;
    return sum;
  }
  [[nodiscard]] double total() const { return free() + arcs; }
};

class Surveyor {
 public:
  Surveyor(const Writer& writer, const Pose& pose, const Tendon& tendon, bool notes)
      : writer_(writer), pose_(pose), tendon_(tendon), notes_(notes) {}

  Course survey() {
    const std::vector<PathPoint>& path = tendon_.path;
    for (std::size_t i = 0; i < path.size() && course_.fault.empty();) {
      const bool end = i == 0 || i + 1 == path.size();
      add_site(path[i].site, end ? "attachment" : "pinhole");
      std::size_t next = i + 1;
      while (next < path.size() && path[next].site < 0) ++next;
      if (next < path.size()) add_way(i, next);
      i = next;
    }
    const bool all = std::all_of(course_.spans.begin(), course_.spans.end(),
                                 [](double length) { return length > 1e-9; });
    if (course_.fault.empty() && !all) {
      course_.fault =
          "two successive parts of its path touch at the start, which leaves a span of "
          "length 0";
    }
    return std::move(course_);
  }

 private:
  [[nodiscard]] Vector3 site_position(int site) const {
    const Site& own = writer_.model.sites[at(site)];
    return pose_.bodies[at(own.body)].frame.point(own.frame.position);
  }

  void add_site(int site, const char* type) {
    const Site& own = writer_.model.sites[at(site)];
    const Carrier& carrier = writer_.carriers[at(own.body)];
    course_.links.push_back(
        {{"type", type},
         {"body", carrier.body == 0 ? "world" : writer_.body_names[at(carrier.body)]},
         {"point", json_of(carrier.frame.point(own.frame.position))}});
    if (notes_) writer_.log.same(*own.element, "a point of cables");
  }

  /// Adds the way between two sites, over the geoms between.
  void add_way(std::size_t first, std::size_t last) {
    const Vector3 from = site_position(tendon_.path[first].site);
    const Vector3 to = site_position(tendon_.path[last].site);
    if (last == first + 2 && is_opening(tendon_.path[first + 1])) {
      return add_opening(tendon_.path[first + 1], from, to);
    }
    std::vector<Obstacle> obstacles;
    for (std::size_t i = first + 1; i < last; ++i) {
      obstacles.push_back(obstacle(tendon_.path[i]));
    }
    if (!course_.fault.empty()) return;
    const std::vector<Wrap> wraps = wrap_over_all(obstacles, from, to);
    const auto touched =
        std::find_if(wraps.begin(), wraps.end(), [](const Wrap& wrap) { return wrap.touches; });
    course_.add(touched == wraps.end() ? (to - from).norm() : touched->before);
    for (std::size_t k = 0; k < wraps.size(); ++k) {
      add_surface(tendon_.path[first + 1 + k], wraps[k]);
      if (!course_.fault.empty()) return;
    }
  }

  /// The geom of a path, without a test of its side site.
  [[nodiscard]] Obstacle found(const PathPoint& point) const {
    const Geom& geom = writer_.model.geoms[at(point.geom)];
    Obstacle made{&geom, pose_.bodies[at(geom.body)].frame * geom.frame, {}};
    if (point.side_site < 0) return made;
    made.side =
        made.frame.orientation.conjugate() * (site_position(point.side_site) - made.frame.position);
    return made;
  }

  /// Whether the side site lies within the geom, so that the tendon passes the inside.
  [[nodiscard]] bool has_side_within(const Obstacle& obstacle) const {
    if (!obstacle.side) return false;
    const Geom& geom = *obstacle.geom;
    const double distance = geom.type == GeomType::cylinder ? obstacle.side->head<2>().norm()
                            : geom.type == GeomType::ellipsoid
                                ? geom.size[0] * obstacle.side->cwiseQuotient(geom.size).norm()
                                : obstacle.side->norm();
    return distance < geom.size[0];
  }

  [[nodiscard]] bool is_opening(const PathPoint& point) const {
    const Obstacle obstacle = found(point);
    const GeomType type = obstacle.geom->type;
    return has_side_within(obstacle) && (type == GeomType::sphere || type == GeomType::cylinder);
  }

  void add_opening(const PathPoint& point, const Vector3& from, const Vector3& to) {
    const Obstacle obstacle = found(point);
    const Geom& geom = *obstacle.geom;
    SmoothSurface surface;
    surface.form = geom.type == GeomType::sphere ? SurfaceForm::rounded : SurfaceForm::cylinder;
    surface.center = obstacle.frame.position;
    surface.axis = obstacle.frame.orientation * Vector3::UnitZ();
    surface.radius = geom.size[0];
    const Vector3 place = opening_point(surface, from, to);
    course_.add((place - from).norm());
    course_.links.push_back({{"type", "opening"},
                             {"body", writer_.body_names[at(writer_.carriers[at(geom.body)].body)]},
                             {"shape", writer_.shapes[at(point.geom)]}});
    course_.add((to - place).norm());
  }

  Obstacle obstacle(const PathPoint& point) {
    Obstacle made = found(point);
    if (has_side_within(made)) {
      course_.fault = fmt::format(
          "line {}: the side site lies in the geom, for a wrap on its inner side, which has a "
          "counterpart for a sphere or a cylinder between two sites",
          point.element->line);
    }
    return made;
  }

  void add_surface(const PathPoint& point, const Wrap& wrap) {
    const Geom& geom = writer_.model.geoms[at(point.geom)];
    const Carrier& carrier = writer_.carriers[at(geom.body)];
    if (wrap.touches && geom.type == GeomType::cylinder && wrap.height > geom.size[1]) {
      course_.fault = fmt::format(
          "line {}: the tendon lies beyond an end of the cylinder; make the "
          "cylinder longer",
          point.element->line);
      return;
    }
    if (wrap.angle > most_wrap) {
      course_.fault = fmt::format("line {}: the tendon wraps by more than 270 degrees at the start",
                                  point.element->line);
      return;
    }
    if (wrap.inside && notes_) {
      writer_.log.changed(*tendon_.element,
                          fmt::format("line {}: a site lies in the geom, which the cable touches "
                                      "once it has come out",
                                      point.element->line));
    }
    course_.add(wrap.touches ? wrap.after : wrap.before, wrap.touches);
    course_.arcs += wrap.on;
    // The link counts in the frame of the carrier.
    const Quaternion to_carrier = carrier.frame.orientation * geom.frame.orientation;
    Json link = {{"type", "surface"},
                 {"body", writer_.body_names[at(carrier.body)]},
                 {"shape", writer_.shapes[at(point.geom)]},
                 {"winding", wrap.counter_clockwise ? "counter-clockwise" : "clockwise"},
                 {"normal", json_of(Vector3(to_carrier * wrap.normal))}};
    if (!wrap.touches) link["lifted"] = true;
    course_.links.push_back(std::move(link));
  }

  const Writer& writer_;
  const Pose& pose_;
  const Tendon& tendon_;
  bool notes_;
  Course course_;
};

/// The spans' rest lengths of a cable of this length without forces.
Json rest_lengths(const Course& course, double length) {
  // A cable that is stretched is stretched evenly; slack lies between the links.
  const double total = course.total();
  const double factor = length < total ? length / total : (length - course.arcs) / course.free();
  Json list = Json::array();
  for (const double span : course.spans) list.push_back(factor * span);
  return list;
}

class CableWriter {
 public:
  /// `actuators` are those on the tendon.
  CableWriter(Writer& writer, Names& names, const Tendon& tendon, const std::vector<int>& actuators)
      : writer_(writer), names_(names), tendon_(tendon), actuators_(actuators) {}

  void write(const Course& course, double reference_length) {
    const double d = tendon_.divisor;
    const std::size_t first = writer_.scene["cables"].size();
    if (tendon_.range) write_rope(course, d * (*tendon_.range)[1]);
    if (tendon_.is_rigid) {
      finish(begin(course, ""),
             fmt::format("a rigid cable of {} m", number_text(course.total(), 6)));
    }
    if (tendon_.stiffness > 0.0) {
      const double rest = tendon_.spring_length ? d * *tendon_.spring_length : reference_length;
      write_spring(course, tendon_.stiffness / (d * d), rest, tendon_.damping / (d * d), "spring");
    } else if (tendon_.damping > 0.0) {
      writer_.log.changed(*tendon_.element, "not taken: damping without stiffness");
    }
    for (const int i : actuators_) {
      if (writer_.model.actuators[at(i)].muscle) continue;
      write_actuator(course, writer_.model.actuators[at(i)], writer_.controls[at(i)]);
    }
    if (writer_.scene["cables"].size() == first) {
      Json cable = begin(course, "");
      cable["compliance"] = no_force;
      finish(std::move(cable), "a cable that shows its length and has no force");
    }
    const std::string path = writer_.scene["cables"][first]["name"].get<std::string>();
    for (const int i : actuators_) {
      const Actuator& actuator = writer_.model.actuators[at(i)];
      if (actuator.muscle) write_muscle(writer_, actuator, at(i), path, d);
    }
  }

 private:
  Json begin(const Course& course, const char* kind) {
    std::string wanted = tendon_.name;
    if (*kind != '\0' && !wanted.empty()) wanted += fmt::format(" {}", kind);
    Json cable = {{"name", names_.take(wanted, *kind != '\0' ? kind : "tendon")},
                  {"most_wraps", 0}};
    cable["links"] = course.links;
    return cable;
  }

  void finish(Json cable, const std::string& text) {
    Json& list = writer_.scene["cables"];
    writer_.log.origin(*tendon_.element, fmt::format("/cables/{}", list.size()));
    writer_.log.same(*tendon_.element,
                     fmt::format("\"{}\": {}", cable["name"].get_ref<const std::string&>(), text));
    list.push_back(std::move(cable));
  }

  void write_rope(const Course& course, double length) {
    const double total = course.total();
    if ((*tendon_.range)[0] > 0.0) {
      writer_.log.changed(*tendon_.element,
                          "the lower end of its range is not taken: a cable does not push");
    }
    if (length < total) {
      writer_.log.changed(*tendon_.element,
                          fmt::format("the cable is {} m long, as at the start; the range ends at "
                                      "{} m",
                                      number_text(total, 6), number_text(length, 6)));
    }
    writer_.log.changed(*tendon_.element, "the upper end of its range is rigid, not soft");
    Json cable = begin(course, "");
    if (length > total) cable["rest_lengths"] = rest_lengths(course, length);
    finish(std::move(cable),
           fmt::format("a rigid cable of {} m", number_text(std::max(length, total), 6)));
  }

  void write_spring(const Course& course, double stiffness, double rest, double damping,
                    const char* kind) {
    if (!(rest > 0.0)) {
      writer_.log.changed(*tendon_.element,
                          fmt::format("not taken: a {} of rest length {} m; a cable needs > 0",
                                      kind, number_text(rest, 6)));
      return;
    }
    Json cable = begin(course, tendon_.range ? kind : "");
    cable["axial_stiffness"] = stiffness * rest;
    // Pieces of the lengths L in a row, each with a damper c / L, have one of c / (sum of L).
    if (damping > 0.0) cable["axial_damping"] = damping * rest;
    cable["rest_lengths"] = rest_lengths(course, rest);
    writer_.log.changed(*tendon_.element, "its spring pulls and does not push");
    finish(std::move(cable), fmt::format("an elastic cable of {} N/m and {} m without force",
                                         number_text(stiffness, 6), number_text(rest, 6)));
  }

  void write_actuator(const Course& course, const Actuator& actuator, double control) {
    const double gear = actuator.gear / tendon_.divisor;
    const double stiffness = -actuator.bias[1] * gear * gear;
    const double damping = -actuator.bias[2] * gear * gear;
    const double force = gear * (actuator.gain * control + actuator.bias[0]);
    if (!(stiffness > 0.0) || !(force / stiffness > 0.0)) {
      writer_.log.skipped(*actuator.element,
                          "a force along a tendon has no counterpart unless it is that of a spring "
                          "to a length > 0; a controller of the scene can set a winch");
      return;
    }
    if (actuator.force_range) writer_.log.changed(*actuator.element, "not taken: forcerange");
    writer_.log.changed(*actuator.element, "an elastic cable, which pulls and does not push");
    write_spring(course, stiffness, force / stiffness, damping, "actuator");
  }

  Writer& writer_;
  Names& names_;
  const Tendon& tendon_;
  const std::vector<int>& actuators_;
};

/// Tells about sites through which no cable passes.
void note_other_sites(const Writer& writer) {
  std::vector<char> sides(writer.model.sites.size(), 0);
  for (const Tendon& tendon : writer.model.tendons) {
    const auto note = [&](const std::vector<PathPoint>& path) {
      for (const PathPoint& point : path) {
        if (point.side_site >= 0) sides[at(point.side_site)] = 1;
      }
    };
    note(tendon.path);
    for (const Branch& branch : tendon.branches) note(branch.path);
  }
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const xml::Element& element = *writer.model.sites[i].element;
    if (sides[i] != 0) {
      writer.log.same(element, "gives the side of a surface link, or makes it an opening");
    } else if (!writer.log.has(element)) {
      writer.log.skipped(element, "no cable passes it");
    }
  }
}

/// Writes a tendon without branches; false if it is skipped.
bool write_tendon(Writer& writer, Names& names, const Tendon& tendon,
                  const std::vector<int>& actuators) {
  const Course course = Surveyor(writer, writer.start, tendon, true).survey();
  if (!course.fault.empty()) {
    writer.log.skipped(*tendon.element, course.fault);
    return false;
  }
  const double reference = Surveyor(writer, writer.reference, tendon, false).survey().total();
  CableWriter(writer, names, tendon, actuators).write(course, reference);
  return true;
}

/// Writes a cable per branch, which shows its length.
void write_branches(Writer& writer, Names& names, const Tendon& tendon,
                    const std::vector<int>& actuators) {
  const char* const reason = "branches that share one force have no counterpart";
  if (tendon.range || tendon.stiffness > 0.0 || tendon.damping > 0.0) {
    writer.log.changed(*tendon.element,
                       fmt::format("not taken: range, stiffness and damping; {}", reason));
  }
  for (const int i : actuators) {
    writer.log.skipped(*writer.model.actuators[at(i)].element,
                       fmt::format("{}; a cable over a sheave on a rail has one", reason));
  }
  std::vector<Branch> all{{tendon.path, tendon.divisor}};
  all.insert(all.end(), tendon.branches.begin(), tendon.branches.end());
  const std::string name = tendon.name.empty() ? "tendon" : tendon.name;
  for (std::size_t k = 0; k < all.size(); ++k) {
    Tendon branch;
    branch.element = tendon.element;
    branch.name = fmt::format("{} branch {}", name, k + 1);
    branch.path = all[k].path;
    branch.divisor = all[k].divisor;
    if (write_tendon(writer, names, branch, {})) {
      writer.log.same(*tendon.element,
                      fmt::format("of which 1 / {} counts", number_text(branch.divisor, 6)));
    }
  }
}

}  // namespace

void write_cables(Writer& writer) {
  const Model& model = writer.model;
  writer.scene["cables"] = Json::array();
  std::vector<std::vector<int>> actuators(model.tendons.size());
  for (std::size_t i = 0; i < model.actuators.size(); ++i) {
    const int tendon = model.actuators[i].tendon;
    if (tendon >= 0) actuators[at(tendon)].push_back(static_cast<int>(i));
  }
  Names names;
  for (std::size_t t = 0; t < model.tendons.size(); ++t) {
    const Tendon& tendon = model.tendons[t];
    if (!tendon.joints.empty()) continue;
    if (!tendon.branches.empty()) {
      write_branches(writer, names, tendon, actuators[t]);
      continue;
    }
    const bool taken = !tendon.path.empty() && write_tendon(writer, names, tendon, actuators[t]);
    for (const int i : actuators[t]) {
      if (!taken) writer.log.skipped(*model.actuators[at(i)].element, "its tendon is skipped");
    }
  }
  note_other_sites(writer);
}

}  // namespace sheave::import::mjcf
