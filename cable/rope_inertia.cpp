// Ropes with axial inertia.
//
// Velocity of the rope. A point of the rope keeps its unstretched coordinate S. Where the rope meets
// an attachment or a wheel on which it does not slip, it has the velocity u of the body's material
// there. Along a straight span of the rest length L,
//
//   u(S) = u0 + s (u1 - u0),   s = (S - S0) / L,
//
// because the span stays straight and evenly stretched. Rope on a wheel moves with the wheel. So with
// the density r, the mean U = (u0 + u1) / 2 and the difference D = u1 - u0, the kinetic energy is
//
//   span:   r L U^2 / 2 + r L D^2 / 24            (as r L (u0^2 + u0 u1 + u1^2) / 6)
//   wheel:  m |v_c + w x c|^2 / 2 + m (R^2 - c^2) w^2 / 2,   m c = r R^2 (t_in - t_out),
//
// with the velocity v_c of the wheel's centre, the stored mass m, the centre c of its arc, which
// follows from the directions of the spans, and c = 0 on a drum at the end of the rope, as for its
// weight. The whole field of velocities is continuous, and the wheels and attachments do not slip, so
// the rope adds a Lagrangian of the bodies' coordinates: T = sum of m_i (g_i v)^2 / 2.
//
// Forces. By d'Alembert the rope acts on the bodies with -r times the integral of its acceleration
// times the virtual displacement, which is even along the span, too. The acceleration of a point of
// the rope is that of the field at a constant S:
//
//   du/dt + s' D,   s' = -((1 - s) S0' + s S1') / L,
//
// where S0' and S1' are the rates at which rope passes the ends. The forces along U and D are
//
//   -r L (dU/dt - D (S0' + S1') / 2 L)   and   -(r L / 12) (dD/dt - D (S1' - S0') / L).
//
// The second terms are the flux of momentum: with rope that comes in at u0 and goes out at u1 the sum
// over both ends is r (S1' u1 - S0' u0), so momentum is neither made nor lost, and neither is energy,
// because rope that comes onto a wheel has the velocity of its rim. On a wheel the acceleration is
// that of the wheel's material at the arc, so the centre of mass has w x (w x c), however c moves in
// the wheel's frame.
//
// The strain of rope that comes off a wheel differs from that of the span by the step that a wheel
// without slip keeps (cable/cable_material.cpp). The velocity of the rope then has a step of about
// this strain times the speed, which is left out.
//
// Rows. -m d(g v)/dt as an implicit force is a bilateral row with the regularisation 1 / m: its
// residual is the displacement g dx less that of the velocity at the start. With u = g v and the
// acceleration a of the terms above,
//
//   xpbd:    l / h   = -m (g1 dx / h - u0 + h a)
//   rattle:  l / h   = -m (g0 dx / h + k - u0 + h a / 2)        half of the substep, along g0
//            impulse = -m (u1 - g1 dx / h + k + h a / 2)        the other half, along g1
//
// k = (g1 - g0) dx / 2 h is half the change of g v by the turning of the gradient. Both halves of
// `rattle` have the mass of the middle, the accelerations a of the middle and the velocity dx / h, so
// the map is its own inverse under reversal of time, and of second order. The sum of both impulses is
// exactly -m (u1 - u0) - m h a. The regularisation makes the rows implicit: bodies much lighter than
// their rope are no difficulty. In a search for rest there are no rows.

#include "cable/rope_inertia.h"

#include <algorithm>
#include <cmath>

#include "cable/link_contact.h"
#include "engine/index.h"

namespace sheave {
namespace {

/// A residual of these rows is an impulse, which does work and accumulates, so it counts more than the
/// distance by which a rigid row is off.
constexpr double residual_scale = 100.0;

/// Share of half a span's weight that counts as no tension.
constexpr double loose_share = 0.01;

Vector3 axis_of(std::size_t i) { return Vector3::Unit(static_cast<Eigen::Index>(i)); }

/// g v with velocities of a state.
double velocity_along(const Row& row, std::span<const BodyState> bodies) {
  double rate = 0.0;
  for (const RowTerm& term : row.active_terms()) {
    if (at(term.body) >= bodies.size()) continue;
    const BodyState& body = bodies[at(term.body)];
    rate += dot(term.linear, body.velocity) + dot(term.angular, body.angular_velocity);
  }
  return rate;
}

/// Substep length times g v at the end of a substep of `xpbd`, whose turn is not exactly that of the
/// angular velocity at the end.
double end_way(const Substep& substep, const Row& row) {
  double way = 0.0;
  for (const RowTerm& term : row.active_terms()) {
    const MovingBody& body = substep.moving[at(term.body)];
    way += dot(term.linear, body.position - body.start_position);
    if (at(term.body) >= substep.predicted.size()) continue;
    const Vector3 corrected = body.turn - substep.predicted_turn[at(term.body)];
    const Vector3& free = substep.predicted[at(term.body)].angular_velocity;
    way += dot(term.angular, substep.h * free + corrected);
  }
  return way;
}

}  // namespace

std::unique_ptr<RopeInertia> RopeInertia::create(const CableSystem& cables) {
  std::unique_ptr<RopeInertia> made(new RopeInertia(cables));
  for (const CompiledCable& cable : cables.cables_) {
    if (!cable.axial_inertia) continue;
    const int spans = cable.listed_spans;
    const int first = static_cast<int>(made->spans_.size());
    for (int i = 0; i < spans; ++i) made->spans_.push_back(cable.first_span + i);
    for (int i = 0; i < cable.listed_links; ++i) {
      if (!cables.definitions_[at(cable.first_link + i)].wraps()) continue;
      Wheel wheel;
      wheel.link = cable.first_link + i;
      if (i > 0 || cable.closed) wheel.before = first + (i > 0 ? i : spans) - 1;
      if (i < spans) wheel.after = first + i;
      made->wheels_.push_back(wheel);
    }
  }
  if (made->spans_.empty()) return nullptr;
  made->multipliers_.resize(made->wheel_row(made->wheels_.size()));
  return made;
}

std::unique_ptr<ConstraintBatch> RopeInertia::copy() const {
  std::unique_ptr<RopeInertia> other(new RopeInertia(*this));
  other->cable_state_ = nullptr;
  return other;
}

FeatureState RopeInertia::initial_state() const {
  FeatureState state;
  state.reals.assign(multipliers_.size(), 0.0);
  return state;
}

void RopeInertia::adopt(const ConstraintBatch& before, const FeatureState& from,
                        FeatureState& own) const {
  const auto* other = dynamic_cast<const RopeInertia*>(&before);
  if (other == nullptr) return;
  const auto copy = [&](std::size_t to, std::size_t first, int count) {
    std::copy_n(from.reals.begin() + static_cast<std::ptrdiff_t>(first), count,
                own.reals.begin() + static_cast<std::ptrdiff_t>(to));
  };
  // Ropes with as many spans and wheels under the same name.
  for (const CompiledCable& cable : cables_.cables_) {
    for (const CompiledCable& old : other->cables_.cables_) {
      if (old.name != cable.name || old.listed_spans != cable.listed_spans) continue;
      for (std::size_t i = 0; i < spans_.size(); ++i) {
        for (std::size_t k = 0; k < other->spans_.size(); ++k) {
          const int place = spans_[i] - cable.first_span;
          if (place < 0 || place >= cable.listed_spans) continue;
          if (other->spans_[k] - old.first_span == place) {
            copy(rows_per_span * i, rows_per_span * k, rows_per_span);
          }
        }
      }
      for (std::size_t i = 0; i < wheels_.size(); ++i) {
        for (std::size_t k = 0; k < other->wheels_.size(); ++k) {
          const int place = wheels_[i].link - cable.first_link;
          if (place < 0 || place >= cable.listed_links) continue;
          if (other->wheels_[k].link - old.first_link == place) {
            copy(wheel_row(i), other->wheel_row(k), rows_per_wheel);
          }
        }
      }
    }
  }
}

RopeInertia::Course RopeInertia::course_of(const Substep& substep, const FeatureState& own) const {
  CableSystem::Geometry geometry;
  cables_.find_geometry(substep, own, geometry);
  return {std::move(geometry.links), std::move(geometry.spans)};
}

std::array<double, 2> RopeInertia::gained(const FeatureState& own, std::size_t place,
                                          const SpanTransport& arcs) const {
  const SpanSetup& setup = course_.spans[at(spans_[place])];
  const auto gain = [&](int link, double arc) {
    double strain = strains_[place];
    // Rope comes off a wheel with the strain that it has there.
    if (arc > 0.0 && cables_.strain_places_[at(link)] >= 0) {
      strain = cables_.stored_strain(own, link).total().strain();
    }
    return arc / (1.0 + strain);
  };
  return {gain(setup.first, arcs.from_first), gain(setup.second, arcs.from_second)};
}

void RopeInertia::find_span(const Substep& substep, const Course& course, const FeatureState& own,
                            bool moved, std::size_t place, Pose& pose) const {
  const int k = spans_[place];
  const SpanSetup& setup = course.spans[at(k)];
  if (!setup.active) return;
  const LinkGeometry& first = course.links[at(setup.first)];
  const LinkGeometry& second = course.links[at(setup.second)];
  Span& span = pose.spans[place];
  SpanTransport arcs;
  span.geometry = moved ? moved_span(substep, setup, first, second, references_[place], arcs)
                        : span_geometry(substep, setup, first, second);
  if (moved) span.gained = gained(own, place, arcs);
  span.rest_length =
      std::max(own.reals[cables_.rest_length_index(k)] + span.gained[0] + span.gained[1], 0.0);
  const double mass = cables_.cables_[at(setup.cable)].linear_density * span.rest_length;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Element& mean = pose.elements[at(rows_per_span) * place + axis];
    Element& difference = pose.elements[at(rows_per_span) * place + 3 + axis];
    const Vector3 along = axis_of(axis);
    add_link_force(substep, mean.row, first, span.geometry.start, 0.5 * along);
    add_link_force(substep, mean.row, second, span.geometry.end, 0.5 * along);
    add_link_force(substep, difference.row, first, span.geometry.start, -along);
    add_link_force(substep, difference.row, second, span.geometry.end, along);
    mean.mass = mass;
    difference.mass = mass / 12.0;
    mean.frame = mean.row;
    difference.frame = difference.row;
  }
}

void RopeInertia::find_wheel(const Substep& substep, const Course& course, const FeatureState& own,
                             std::size_t place, Pose& pose) const {
  const Wheel& wheel = wheels_[place];
  const LinkGeometry& link = course.links[at(wheel.link)];
  double stored = own.reals[cables_.stored_length_index(wheel.link)];
  Vector3 turned = Vector3::Zero();  // t_in - t_out
  double density = 0.0;
  const auto count = [&](int beside, std::size_t end, double sign) {
    if (beside < 0) return;
    const Span& span = pose.spans[at(beside)];
    const SpanSetup& setup = course.spans[at(spans_[at(beside)])];
    if (!setup.active) return;
    density = cables_.cables_[at(setup.cable)].linear_density;
    stored -= span.gained[end];
    turned += sign * span.geometry.direction;
  };
  count(wheel.before, 1, 1.0);
  count(wheel.after, 0, -1.0);
  stored = std::max(stored, 0.0);
  const double radius = std::abs(link.signed_radius);
  const double mass = density * stored;
  Vector3 arm = Vector3::Zero();
  if (wheel.before >= 0 && wheel.after >= 0 && stored > 0.0) {
    arm = radius * radius / stored * turned;
    if (arm.norm() > radius) arm *= radius / arm.norm();
  }
  const Vector3 center = center_of(substep, link, 0);
  const std::size_t first = wheel_row(place);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Element& way = pose.elements[first + axis];
    add_link_force(substep, way.row, link, center + arm, axis_of(axis));
    add_link_force(substep, way.frame, link, center, axis_of(axis));
    way.mass = mass;
    way.arm = arm[static_cast<Eigen::Index>(axis)];
  }
  Element& rotation = pose.elements[first + 3];
  rotation.mass = mass * std::max(radius * radius - arm.squaredNorm(), 0.0);
  const Vector3 axle = rotated(substep.orientation(link.carrier), link.normal);
  substep.add_torque(rotation.row, link.body, axle);
  rotation.row.lever = radius;
  rotation.frame = rotation.row;
}

void RopeInertia::find_pose(const Substep& substep, const Course& course, const FeatureState& own,
                            bool moved, Pose& pose) const {
  pose.spans.assign(spans_.size(), {});
  pose.elements.resize(multipliers_.size());
  for (Element& element : pose.elements) {
    element.row.clear();
    element.frame.clear();
    element.mass = element.arm = 0.0;
  }
  for (std::size_t i = 0; i < spans_.size(); ++i) {
    find_span(substep, course, own, moved, i, pose);
  }
  for (std::size_t i = 0; i < wheels_.size(); ++i) find_wheel(substep, course, own, i, pose);
}

std::vector<RopeInertia::Element> RopeInertia::elements(const Substep& now,
                                                        const FeatureState& own) const {
  Pose pose;
  find_pose(now, course_of(now, own), own, false, pose);
  return std::move(pose.elements);
}

double RopeInertia::kinetic_energy(const BodySet& bodies, const State& state) const {
  const Substep now(bodies, state, 1.0, 1);
  double energy = 0.0;
  for (const Element& element : elements(now, state.features.back())) {
    const double speed = velocity_along(element.row, state.bodies);
    energy += 0.5 * element.mass * speed * speed;
  }
  return energy;
}

void RopeInertia::begin(const Substep& substep, const FeatureState& /*state*/) {
  std::fill(multipliers_.begin(), multipliers_.end(), 0.0);
  at_rest_ = substep.at_rest;
  if (at_rest_) return;
  cable_state_ = &substep.start.features.back();
  course_ = course_of(substep, *cable_state_);
  references_.resize(spans_.size());
  strains_.resize(spans_.size());
  for (std::size_t i = 0; i < spans_.size(); ++i) {
    const int k = spans_[i];
    const SpanSetup& setup = course_.spans[at(k)];
    if (!setup.active) continue;
    references_[i] = span_reference(substep, setup, course_.links[at(setup.first)],
                                    course_.links[at(setup.second)],
                                    cable_state_->reals[cables_.rest_length_index(k)]);
    strains_[i] = std::max(cable_state_->reals[cables_.tension_index(k)], 0.0) *
                  cables_.cables_[at(setup.cable)].inverse_stiffness;
  }
  find_pose(substep, course_, *cable_state_, false, start_);
}

void RopeInertia::find_motion(const Substep& substep) {
  find_pose(substep, course_, *cable_state_, true, now_);
  const auto velocity = [&](std::size_t i) {
    const double now = substep_change(now_.elements[i].row, substep.moving);
    if (substep.load_share == 1.0) return now / substep.h;
    return 0.5 * (now + substep_change(start_.elements[i].row, substep.moving)) / substep.h;
  };
  accelerations_.assign(multipliers_.size(), 0.0);
  for (std::size_t i = 0; i < spans_.size(); ++i) {
    const Span& span = now_.spans[i];
    const double length = 0.5 * (start_.spans[i].rest_length + span.rest_length);
    if (!(length > 0.0)) continue;
    const double first = -span.gained[0] / substep.h;
    const double second = span.gained[1] / substep.h;
    const std::size_t row = at(rows_per_span) * i;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double difference = velocity(row + 3 + axis);
      accelerations_[row + axis] = -0.5 * difference * (first + second) / length;
      accelerations_[row + 3 + axis] = -difference * (second - first) / length;
    }
  }
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    const std::size_t row = wheel_row(i);
    const double spin = velocity(row + 3);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double arm = 0.5 * (start_.elements[row + axis].arm + now_.elements[row + axis].arm);
      accelerations_[row + axis] = -spin * spin * arm;
    }
  }
}

void RopeInertia::fill_row(const Substep& substep, std::size_t index, Row& row) const {
  const Element& start = start_.elements[index];
  const Element& now = now_.elements[index];
  const double h = substep.h;
  row = now.row;
  row.index = static_cast<int>(index);
  row.active = true;
  const double mass = 0.5 * (start.mass + now.mass);
  if (!(mass > 0.0)) {
    row.lower = row.upper = 0.0;
    return;
  }
  row.lever *= residual_scale;
  row.softness = 1.0 / mass;
  row.inertial = true;
  const std::span<const BodyState> bodies = substep.start.bodies;
  const auto way = [&](const Row& along) { return substep_change(along, substep.moving); };
  if (substep.load_share == 1.0) {
    const double before = velocity_along(now.row, bodies) - velocity_along(now.frame, bodies) +
                          velocity_along(start.frame, bodies);
    row.value = end_way(substep, now.row) - h * before + h * h * accelerations_[index];
    return;
  }
  const double turning = 0.5 * (way(now.frame) - way(start.frame));
  row.value = way(start.row) + turning - h * velocity_along(start.row, bodies) +
              0.5 * h * h * accelerations_[index];
  row.rate = (turning - way(now.row)) / h + 0.5 * h * accelerations_[index];
}

void RopeInertia::linearise(Substep& substep, RowList& rows) {
  if (at_rest_) return;
  find_motion(substep);
  for (std::size_t i = 0; i < multipliers_.size(); ++i) fill_row(substep, i, rows.emplace_back());
}

double RopeInertia::sweep(Substep& substep) {
  if (at_rest_) return 0.0;
  double correction = 0.0;
  for (std::size_t i = 0; i < multipliers_.size(); ++i) {
    find_motion(substep);
    Row row;
    fill_row(substep, i, row);
    row.compliance = row.softness * substep.h * substep.h;
    correction = std::max(correction, solve_row(row, substep.h, multipliers_[i], substep.moving));
  }
  return correction;
}

void RopeInertia::finish(Substep& substep, FeatureState& next) {
  for (std::size_t i = 0; i < multipliers_.size(); ++i) {
    next.reals[i] = multipliers_[i] / (substep.h * substep.h);
  }
}

// The catenary of a span is that of its weight. Its end tensions along the chord are T +- r L g / 2
// without inertia, and differ from the true ones by the forces of inertia. Where the rope is taut with
// one of them and loose with the other, as a rope with a light end that falls, the catenary is not the
// rope's shape.
std::string RopeInertia::dead_end(const Substep& substep) const {
  if (at_rest_ || is_zero(substep.gravity)) return {};
  const double h = substep.h;
  for (std::size_t i = 0; i < spans_.size(); ++i) {
    const SpanSetup& setup = course_.spans[at(spans_[i])];
    if (!setup.active) continue;
    const CompiledCable& cable = cables_.cables_[at(setup.cable)];
    const Vector3& along = now_.spans[i].geometry.direction;
    const Vector3 half = 0.5 * cable.linear_density * now_.spans[i].rest_length * substep.gravity;
    const double tension = substep.next.features.back().reals[cables_.tension_index(spans_[i])];
    const double* force = multipliers_.data() + at(rows_per_span) * i;
    const double mean = dot(along, Vector3(force[0], force[1], force[2])) / (h * h);
    const double difference = dot(along, Vector3(force[3], force[4], force[5])) / (h * h);
    const std::array<double, 2> still{tension + dot(half, along), tension - dot(half, along)};
    const std::array<double, 2> moving{still[0] + 0.5 * mean - difference,
                                       still[1] - 0.5 * mean - difference};
    const double slop = loose_share * half.norm();
    for (const std::size_t end : {0U, 1U}) {
      if (!(std::min(still[end], moving[end]) < -slop) ||
          !(std::max(still[end], moving[end]) > -0.5 * slop)) {
        continue;
      }
      return "span " + std::to_string(spans_[i] - cable.first_span) + " of the rope \"" +
             cable.name +
             "\" accelerates so much that its weight alone does not tell whether its " +
             (end == 0 ? "first" : "second") +
             " end hangs loose; end the run before that, put a larger load there, or leave "
             "\"axial_inertia\" out";
    }
  }
  return {};
}

std::array<Vector3, 2> RopeInertia::end_forces(const CableSystem& cables, const State& state,
                                               int span) {
  std::array<Vector3, 2> none{Vector3::Zero(), Vector3::Zero()};
  if (!cables.cables_[at(cables.spans_[at(span)].cable)].axial_inertia) return none;
  int place = 0;
  for (const CompiledCable& cable : cables.cables_) {
    if (!cable.axial_inertia) continue;
    if (span < cable.first_span + cable.listed_spans) {
      place += span - cable.first_span;
      break;
    }
    place += cable.listed_spans;
  }
  // The cables are the last feature, and the inertia of their ropes the one before.
  if (state.features.size() < 2) return none;
  const std::vector<double>& reals = state.features[state.features.size() - 2].reals;
  const std::size_t first = at(rows_per_span * place);
  if (reals.size() < first + at(rows_per_span)) return none;
  const Vector3 mean(reals[first], reals[first + 1], reals[first + 2]);
  const Vector3 difference(reals[first + 3], reals[first + 4], reals[first + 5]);
  return {0.5 * mean - difference, 0.5 * mean + difference};
}

}  // namespace sheave
