#include "cable/links/sheath.h"

#include <algorithm>
#include <cmath>

#include "cable/link_geometry.h"
#include "engine/body_set.h"
#include "engine/field_check.h"
#include "engine/math/portable.h"

namespace sheave {
namespace {

/// Length and bend of a curve through points, and by how much those of a smooth curve may be larger:
/// chords are shorter than arcs, and the bends beside the two ends are not drawn.
struct DrawnCurve {
  double length = 0.0;  ///< [m]
  double bend = 0.0;    ///< [rad]
  double longer = 0.0;
  double more_bent = 0.0;
};

DrawnCurve drawn_curve(const std::vector<Vector3>& points) {
  DrawnCurve curve;
  Vector3 before = Vector3::Zero();
  double most = 0.0;
  int corners = 0;
  double first = 0.0;
  double last = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Vector3 way = points[i] - points[i - 1];
    if (is_zero(way)) continue;
    curve.length += way.norm();
    if (!is_zero(before)) {
      last = portable::atan2(before.cross(way).norm(), before.dot(way));
      if (corners++ == 0) first = last;
      curve.bend += last;
      most = std::max(most, last);
    }
    before = way;
  }
  // An arc of the angle w is longer than its chord by w^2 / 24 of its length.
  curve.longer = curve.length * most * most / 24.0;
  curve.more_bent = 0.5 * (first + last);
  return curve;
}

/// The given value, unless it contradicts that of the points.
double chosen(const std::optional<double>& given, double drawn, double more, bool is_drawn,
              const std::string& field, const char* unit, Errors& errors) {
  constexpr double agreement = 0.01;
  if (!given) return drawn;
  const double off = *given - std::clamp(*given, drawn, drawn + more);
  if (is_drawn && std::abs(off) > agreement * std::max(*given, drawn)) {
    errors.push_back({field, "is " + number_text(*given) + " " + unit + ", and the points give " +
                                 number_text(drawn) + " " + unit +
                                 "; leave it out, or give the two ends as the only points"});
  }
  return *given;
}

}  // namespace

std::span<const Field> SheathLink::field_table() {
  static const std::array table{
      field<&SheathLink::points>(
          "points", "m", any_number(), required,
          "the curve from the cable's entry to its exit, body frame; the two "
          "ends are enough with length and bend"),
      field<&SheathLink::exit>("exit_body", "", {}, optional,
                               "the body that holds the exit, with the last point in its frame; "
                               "default: the link's body"),
      field<&SheathLink::length>(
          "length", "m", above(0.0), optional,
          "of the curve, at least the distance of its ends; default: that of "
          "the points"),
      field<&SheathLink::bend>("bend", "rad", at_least(0.0), optional,
                               "sum of the angles by which the curve bends the cable, even along "
                               "the length; default: that at the points"),
      field<&SheathLink::friction>(
          "friction", "", at_least(0.0), optional,
          "Coulomb's coefficient along the sheath: the tensions at both ends differ by at most "
          "e^(friction x bend); friction x bend is at most 50"),
  };
  return table;
}

void SheathLink::check_exit(const BodySet& bodies, const std::string& path, Errors& errors) const {
  if (!bodies.contains(exit_body())) {
    errors.push_back(
        {path + "/exit_body", "there is no body number " + std::to_string(exit_body().index)});
  } else if (bodies[bodies.index(exit_body())].mobility == Mobility::rotor) {
    errors.push_back({path + "/exit_body", "a sheath cannot end on the rotor \"" +
                                               bodies.name(exit_body().index) +
                                               "\"; end it on the body that carries the rotor"});
  }
  if (points.size() > 2) {
    errors.push_back({path + "/points",
                      "a sheath between two bodies has two points, the entry in the frame of body "
                      "and the exit in the frame of exit_body; there are " +
                          std::to_string(points.size())});
  }
  if (!length || !bend) {
    errors.push_back({path + (length ? "/bend" : "/length"),
                      "a sheath between two bodies needs length [m] and bend [rad], since no "
                      "points draw its curve"});
  }
}

Result<LinkGeometry> SheathLink::compile(const BodySet& bodies, const std::string& path) const {
  if (points.size() < 2 || points.size() > most_points) {
    return Errors{{path + "/points", "a sheath needs 2 to " + std::to_string(most_points) +
                                         " points, from its entry to its exit; there are " +
                                         std::to_string(points.size())}};
  }
  Errors errors;
  const int exit_body = bodies.index(this->exit_body());
  const bool joins = exit_body != bodies.index(body);
  if (joins) check_exit(bodies, path, errors);
  const bool is_drawn = points.size() > 2 && !joins;
  auto curve = std::make_shared<SheathCurve>();
  const DrawnCurve drawn = drawn_curve(points);
  curve->length =
      chosen(length, drawn.length, drawn.longer, is_drawn, path + "/length", "m", errors);
  curve->bend = chosen(bend, drawn.bend, drawn.more_bent, is_drawn, path + "/bend", "rad", errors);
  curve->friction = friction;
  // The places of two bodies are not known here.
  const double apart = joins ? 0.0 : (points.back() - points.front()).norm();
  constexpr double rounding = 1e-9;
  if (!(curve->length > 0.0)) {
    errors.push_back({path + "/points",
                      "all points of the sheath are the same; give it a way, or "
                      "use a \"pinhole\""});
  } else if (curve->length < apart * (1.0 - rounding)) {
    errors.push_back({path + "/length", "the sheath is " + number_text(curve->length) +
                                            " m long, and its ends are " + number_text(apart) +
                                            " m apart; give a length of at least that distance"});
  }
  if (friction * curve->bend > most_exponent) {
    errors.push_back({path + "/friction", "friction x bend is " +
                                              number_text(friction * curve->bend) +
                                              "; it must be at most 50, since a rope cannot be "
                                              "pulled through such a sheath"});
  }
  if (!errors.empty()) return errors;
  Result<LinkGeometry> made{LinkGeometry{}};
  LinkGeometry& link = *made;
  link.body = link.carrier = bodies.index(body);
  link.mounted = bodies[link.body].mount >= 0;
  for (const Vector3& point : points) {
    curve->points.emplace_back(point - bodies[link.body].center_of_mass);
  }
  curve->exit_body = exit_body;
  curve->points.back() = points.back() - bodies[exit_body].center_of_mass;
  link.center = curve->points.front();
  link.given_stored_length = 0.0;
  link.sheath = std::move(curve);
  return made;
}

}  // namespace sheave
