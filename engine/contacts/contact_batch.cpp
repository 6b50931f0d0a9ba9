// All points of contact. The points are found anew in every substep and matched with those
// of the last one, so that static friction continues and the solver has a warm start.
//
// A Gauss-Seidel sweep bounds friction by the present normal multiplier. A solver of all rows at
// once takes the bounds from its last round, or from the last substep, and revise() asks for
// another round until bounds and multipliers agree.

#include "engine/contacts/contact_batch.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/contacts/contact_energy.h"
#include "engine/contacts/contact_state.h"
#include "engine/contacts/crowd.h"
#include "engine/contacts/planar_contact.h"
#include "engine/contacts/rebound.h"
#include "engine/friction_rows.h"
#include "engine/instant_feature.h"
#include "engine/instants.h"
#include "engine/math/portable.h"
#include "engine/model.h"

namespace sheave {
namespace {

/// Relative change of a normal force below which the bounds of friction are final.
constexpr double settled_share = 1e-9;
/// Rounding error of a gap, relative to the scene's size. Divided by the softness, this is the
/// precision with which the loads of a box's corners are known.
constexpr double rounding_share = 1e-15;
/// A point of contact matches one of the last substep if their distance on one of the bodies is at
/// most this share of the smaller form.
constexpr double same_point = 0.05;

class ContactBatch final : public ConstraintBatch, public ImpactFeature {
 public:
  ContactBatch(const Model& model, const BodySet& bodies, std::size_t place)
      : place_(place),
        finder_(model, bodies),
        mean_velocities_(model.step.integrator == IntegratorKind::xpbd),
        substep_(model.step.dt / model.step.substeps),
        slop_(instant_slop(model.step)),
        locates_all_(model.step.tolerance > 0.0) {
    for (const ColliderDef& collider : model.colliders) {
      bounces_ = bounces_ || collider.restitution > 0.0;
    }
  }

  [[nodiscard]] std::string_view name() const override { return "contacts"; }
  [[nodiscard]] FeatureState initial_state() const override { return {}; }
  [[nodiscard]] bool has_fixed_size() const override { return false; }
  [[nodiscard]] bool accepts(const FeatureState& state) const override {
    const std::size_t count = contact_count(state);
    if (state.integers.size() != count * ContactRecord::integers) return false;
    if (state.reals.size() != count * ContactRecord::reals) return false;
    const auto forms = static_cast<std::int64_t>(finder_.forms().size());
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t k = 0; k < 2; ++k) {
        const std::int64_t form = state.integers[i * ContactRecord::integers + k];
        if (form < 0 || form >= forms) return false;
      }
    }
    return true;
  }
  [[nodiscard]] int row_count() const override {
    int rows = 0;
    for (const Contact& contact : contacts_) rows += contact.passes ? 0 : contact.rows;
    return rows;
  }

  void adopt(const ConstraintBatch& before, const FeatureState& from,
             FeatureState& own) const override {
    const auto* other = dynamic_cast<const ContactBatch*>(&before);
    if (other == nullptr) return;
    const std::vector<int> places = places_of(other->finder_.forms());
    for (std::size_t i = 0; i < contact_count(from); ++i) {
      ContactRecord record = read_contact(from, i);
      record.forms = {places[at(record.forms.a)], places[at(record.forms.b)]};
      if (record.forms.a >= 0 && record.forms.b >= 0) append_contact(record, own);
    }
  }

  void begin(const Substep& substep, const FeatureState& state) override {
    contacts_.clear();
    crowd_.begin(substep.bodies.count());
    std::size_t old = 0;
    finder_.find(substep, [&](const FormPair& pair, Manifold& manifold) {
      add_manifold(substep, state, pair, manifold, old);
      crowd_.add(substep, finder_.forms()[at(pair.a)].body, finder_.forms()[at(pair.b)].body);
      return !crowd_.too_many();
    });
    // The substep is invalid: see fault().
    if (crowd_.too_many()) contacts_.clear();
    multipliers_.assign(3 * contacts_.size(), 0.0);
    passed_ = -std::numeric_limits<double>::infinity();
    whole_ = locates_ && substep.start.time == expected_.from && substep.next.time == expected_.to;
  }

  double sweep(Substep& substep) override {
    double correction = 0.0;
    Row row;
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      row.clear();
      contacts_[i].evaluate(substep, 0, row);
      double& normal = multipliers_[3 * i];
      if (row.value < 0.0 || normal != 0.0) {
        correction = std::max(correction, solve_row(row, substep.h, normal, substep.moving));
      }
      contacts_[i].pressed = normal;
    }
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      Contact& contact = contacts_[i];
      contact.slips = false;
      if (contact.friction == 0.0) continue;
      const std::span<double> friction = std::span(multipliers_).subspan(3 * i + 1, 2);
      if (contact.pressed == 0.0 && friction[0] == 0.0 && friction[1] == 0.0) continue;
      std::array<Row, 2> rows;
      for (int k = 1; k < contact.rows; ++k) contact.evaluate(substep, k, rows[at(k - 1)]);
      correction =
          std::max(correction, contact.rows == 3
                                   ? solve_friction(rows, friction, substep.moving)
                                   : solve_row(rows[0], substep.h, friction[0], substep.moving));
      note_slip(substep, i);
    }
    return correction;
  }

  void linearise(Substep& substep, RowList& rows) override {
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      const Contact& contact = contacts_[i];
      if (contact.passes) continue;
      for (int k = 0; k < contact.rows; ++k) {
        Row& row = rows.emplace_back();
        contact.evaluate(substep, k, row);
        row.index = static_cast<int>(3 * i) + k;
        row.active = k == 0 ? contact.last_force[0] > 0.0 : contact.stuck || k == 2;
      }
    }
  }
  [[nodiscard]] std::span<double> multipliers() override { return multipliers_; }

  bool revise(Substep& substep) override {
    bool changed = false;
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      Contact& contact = contacts_[i];
      if (contact.friction == 0.0 || contact.passes) continue;
      note_slip(substep, i);
      const double now = multipliers_[3 * i] / substep.load_share;
      // While friction does not need its bound, changes of the bound have no effect.
      const double needed =
          portable::hypot(multipliers_[3 * i + 1], multipliers_[3 * i + 2]) / substep.load_share;
      const bool matters = contact.slips || needed > contact.friction * now;
      const double change = std::abs(now - contact.pressed);
      const double yields = contact.softness[0] + contact.compliance / (substep.h * substep.h);
      const double rounding = rounding_share * substep.bodies.scale() / yields;
      // A change at the level of rounding that no longer decreases has converged.
      const bool rounded =
          change <= rounding && contact.last_change > 0.0 && 2.0 * change >= contact.last_change;
      if (matters && change > settled_share * std::max(now, contact.pressed) && !rounded) {
        changed = true;
      }
      contact.last_change = change;
      contact.pressed = contact.pressure.next(contact.pressed, now);
    }
    return changed || let_go(substep);
  }

  [[nodiscard]] std::string fault() const override { return crowd_.fault(); }
  [[nodiscard]] bool is_stiff() const override { return true; }
  [[nodiscard]] bool meets() const override {
    return std::any_of(contacts_.begin(), contacts_.end(),
                       [](const Contact& contact) { return contact.rebound > 0.0; });
  }
  [[nodiscard]] bool corrects_velocities() const override { return bounces_; }
  void correct_velocities(Substep& substep,
                          std::span<const std::unique_ptr<ConstraintBatch>> features) override {
    for (std::size_t i = 0; i < contacts_.size(); ++i) contacts_[i].slid = is_at_bound(i);
    rebound_.run(substep, contacts_, multipliers_, features, *this);
  }

  // `xpbd` has velocities that are means. With a tolerance each impact ends a part of the motion:
  // within a substep it would be a jump of the velocity, whose error falls no faster than the length.
  [[nodiscard]] bool watches(const Controls& /*controls*/) const override {
    return !mean_velocities_ && (bounces_ || locates_all_);
  }
  void expect(const Expected* part) override {
    locates_ = part != nullptr;
    if (locates_) expected_ = *part;
  }
  [[nodiscard]] double margin(const Substep& /*substep*/,
                              const FeatureState& /*own*/) const override {
    return passed_;
  }

  void await_impacts(Substep& substep,
                     std::span<const std::unique_ptr<ConstraintBatch>> features) override {
    if (!whole_) return;
    bool any = false;
    for (Contact& contact : contacts_) {
      const Vector3 pull =
          finder_.free_acceleration(contact.body_a) - finder_.free_acceleration(contact.body_b);
      const ContactTimes times{substep_, slop_, locates_all_};
      any = can_pass(substep, finder_.material(contact.forms), pull, times, contact) || any;
      if (locates_all_ && contact.passes) contact.rebound = 0.0;
    }
    if (any && !locates_all_) rebound_.keep_passing(substep, contacts_, features, *this);
  }

  void land(Substep& substep, std::span<const std::unique_ptr<ConstraintBatch>> features) override {
    for (const Contact& contact : contacts_) {
      if (contact.passes) passed_ = std::max(passed_, -contact.gap(substep) / contact.closing);
    }
    // No contact lands if one is beyond its impact by more than the shortest part.
    if (!(passed_ > 0.0) || passed_ > 2.0 * slop_) return;
    constexpr double together = 1e-7;  // of a substep
    for (Contact& contact : contacts_) {
      contact.lands =
          contact.passes && contact.gap(substep) <= together * substep_ * contact.closing;
    }
    rebound_.land(substep, contacts_, multipliers_, slow_impact * substep_, features, place_);
  }

  void finish(Substep& substep, FeatureState& next) override {
    next.integers.clear();
    next.reals.clear();
    const double inverse_square = 1.0 / (substep.h * substep.h);
    StepStatistics& statistics = substep.statistics;
    statistics.contacts = std::max(statistics.contacts, static_cast<int>(contacts_.size()));
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      const Contact& contact = contacts_[i];
      ContactRecord record;
      record.forms = contact.forms;
      record.own_a = contact.own_a;
      record.own_b = contact.own_b;
      record.normal = contact.normal;
      record.point =
          substep.point(contact.body_a, contact.own_a) - contact.radius_a * contact.normal;
      // Rounding errors in a shared load may make a multiplier slightly negative.
      record.force = inverse_square * std::max(multipliers_[3 * i], 0.0);
      for (std::size_t k = 0; k < 2 && contact.friction > 0.0; ++k) {
        record.friction += inverse_square * multipliers_[3 * i + 1 + k] * contact.tangents[k];
      }
      record.gap = contact.gap(substep);
      const bool touches = multipliers_[3 * i] > 0.0;
      record.sticks = contact.friction > 0.0 && (touches ? !slides(substep, i) : contact.stuck);
      if (record.sticks && touches && !contact.slid) record.slipped = kept_slip(substep, i);
      statistics.deepest_overlap = std::max(statistics.deepest_overlap, -record.gap);
      append_contact(record, next);
    }
    describe_late_forces(substep);
  }

  [[nodiscard]] double elastic_energy(const BodySet& bodies, const State& state,
                                      const FeatureState& own) const override {
    // A state in which no substep has ended has no records, but may begin with compressed bodies.
    return contact_count(own) > 0 ? energy_of_records(finder_, own)
                                  : energy_of_overlaps(finder_, bodies, state, substep_);
  }

 private:
  /// The indices in this world of another world's forms; -1: the form does not exist here.
  [[nodiscard]] std::vector<int> places_of(std::span<const ContactForm> others) const {
    const std::span<const ContactForm> own = finder_.forms();
    std::map<int, std::size_t> first_of;  // index of each body's first form; the others follow it
    for (std::size_t i = own.size(); i-- > 0;) first_of[own[i].body] = i;
    std::vector<int> places;
    std::size_t within = 0;
    for (std::size_t i = 0; i < others.size(); ++i) {
      within = i > 0 && others[i].body == others[i - 1].body ? within + 1 : 0;
      const auto found = first_of.find(others[i].body);
      const std::size_t place = found == first_of.end() ? own.size() : found->second + within;
      const bool same = place < own.size() && own[place].body == others[i].body &&
                        own[place].shape == others[i].shape;
      places.push_back(same ? static_cast<int>(place) : -1);
    }
    return places;
  }
  /// Appends the points of one pair. `old` is the first record of the state that does not belong to
  /// an earlier pair.
  void add_manifold(const Substep& substep, const FeatureState& state, const FormPair& pair,
                    Manifold& manifold, std::size_t& old) {
    const std::optional<Vector3> plane = plane_of_motion(
        substep.bodies, finder_.forms()[at(pair.a)].body, finder_.forms()[at(pair.b)].body);
    if (plane) merge_behind(*plane, finder_.smaller_spread(pair), manifold);
    const auto key = [](const FormPair& p) { return std::minmax(p.a, p.b); };
    const std::size_t count = contact_count(state);
    records_.clear();
    for (; old < count; ++old) {
      const ContactRecord record = read_contact(state, old);
      if (key(pair) < key(record.forms)) break;
      if (key(pair) == key(record.forms)) records_.push_back(record);
    }
    Vector3 held = Vector3::Zero();
    double pressure = 0.0;
    for (const ContactRecord& record : records_) {
      held += record.friction;
      pressure += record.force;
    }
    for (const ContactPoint& point : manifold.points) {
      Contact& contact = contacts_.emplace_back();
      contact.forms = pair;
      contact.mean_velocities = mean_velocities_;
      contact.body_a = finder_.forms()[at(pair.a)].body;
      contact.body_b = finder_.forms()[at(pair.b)].body;
      contact.normal = manifold.normal;
      contact.start_a = point.core_a;
      contact.start_b = point.core_b;
      contact.radius_a = point.radius_a;
      contact.radius_b = point.radius_b;
      contact.start_gap = point.gap;
      if (plane && lies_in_plane(contact.normal, *plane)) contact.plane_axis = plane;
      contact.own_a = own_point(substep, contact.body_a, point.core_a);
      contact.own_b = own_point(substep, contact.body_b, point.core_b);
      const ContactRecord* last = take_record(contact, manifold.points.size());
      Vector3 friction = Vector3::Zero();
      if (last != nullptr) {
        friction = last->friction;
        contact.stuck = last->sticks;
        contact.slipped = last->slipped;
        contact.pressed = last->force * substep.h * substep.h;
      }
      prepare_contact(
          substep, finder_.material(pair),
          finder_.free_acceleration(contact.body_a) - finder_.free_acceleration(contact.body_b),
          held, pressure, last == nullptr, contact);
      if (last != nullptr) {
        contact.last_force = {last->force, friction.dot(contact.tangents[0]),
                              friction.dot(contact.tangents[1])};
      }
    }
  }

  static Vector3 own_point(const Substep& substep, int body, const Vector3& point) {
    return substep.orientation(body).conjugate() * (point - substep.position(body));
  }

  /// The nearest record that has not been taken, if it is the same point, else null. Taking a
  /// record removes it from further matches.
  const ContactRecord* take_record(const Contact& contact, std::size_t points) {
    ContactRecord* best = nullptr;
    double nearest = std::numeric_limits<double>::infinity();
    for (ContactRecord& record : records_) {
      if (record.forms.a < 0) continue;
      const double distance =
          std::min((record.own_a - contact.own_a).norm(), (record.own_b - contact.own_b).norm());
      if (!(distance < nearest)) continue;
      nearest = distance;
      best = &record;
    }
    if (best == nullptr) return nullptr;
    const double size = finder_.smaller_spread(contact.forms);
    if (nearest > same_point * size && (points > 1 || records_.size() > 1)) return nullptr;
    best->forms.a = -1;
    return best;
  }

  void note_slip(const Substep& substep, std::size_t i) {
    Contact& contact = contacts_[i];
    // The positions of `rattle` carry half of the force.
    const double limit = (1.0 - 1e-9) * substep.load_share * contact.friction * contact.pressed;
    contact.slips = portable::hypot(multipliers_[3 * i + 1], multipliers_[3 * i + 2]) >= limit;
  }

  /// Whether friction is at its bound by the normal force found. `late` has been added to the
  /// multipliers since [kg m] and is subtracted.
  [[nodiscard]] bool is_at_bound(std::size_t i, const std::array<double, 3>& late = {}) const {
    const double* own = &multipliers_[3 * i];
    const double limit = (1.0 - settled_share) * contacts_[i].friction * (own[0] - late[0]);
    return portable::hypot(own[1] - late[1], own[2] - late[2]) >= limit;
  }

  /// Gives sliding friction, from the start of the substep on, to points that move although their
  /// static friction is at its bound. Returns whether there were any.
  bool let_go(const Substep& substep) {
    bool any = false;
    if (substep.tentative || substep.at_rest) return any;
    for (Contact& contact : contacts_) {
      if (!contact.slips || contact.friction == contact.sliding_friction) continue;
      if (!contact.moves(substep)) continue;
      contact.friction = contact.sliding_friction;
      any = true;
    }
    return any;
  }

  /// Whether the point slides at the end of the substep. A sticking point starts to slide if it is
  /// at its bound and moves. (Other points may hold it still at its bound.) A sliding point slides
  /// until it does not move; rounding may leave its friction slightly below the bound.
  [[nodiscard]] bool slides(const Substep& substep, std::size_t i) const {
    const Contact& contact = contacts_[i];
    if (contact.stuck && !contact.slips && !is_at_bound(i)) return false;
    // Velocities of `xpbd` are those of the displacement.
    if (contact.moves(substep)) return true;
    return substep.load_share != 1.0 && contact.moves_on(substep);
  }

  /// Contact::slipped of a sticking point for the next substep. A point at its bound that moved
  /// starts from 0. A point at its bound that others held keeps at most the displacement that
  /// softness allows.
  [[nodiscard]] Vector3 kept_slip(const Substep& substep, std::size_t i) const {
    const Contact& contact = contacts_[i];
    const bool full = contact.slips || is_at_bound(i) || has_slid(substep, i);
    if (full && contact.moves(substep)) return Vector3::Zero();
    const Vector3 slip = contact.held_slip(substep);
    const double most = contact.yielding(substep);
    const double size = slip.norm();
    return full && size > most ? Vector3(slip * (most / size)) : slip;
  }

  /// Whether friction was at its bound in the motion of the substep. The second half of `rattle`
  /// may bring such a point to rest, but not back.
  [[nodiscard]] bool has_slid(const Substep& substep, std::size_t i) const {
    if (place_ >= substep.late_forces.size() || substep.late_forces[place_].empty()) return false;
    const double square = substep.h * substep.h;
    const double* own = &substep.late_forces[place_][3 * i];
    return is_at_bound(i, {square * own[0], square * own[1], square * own[2]});
  }

  /// Converts the forces of the substep's second half to four numbers per contact: the normal force
  /// and the friction vector.
  void describe_late_forces(Substep& substep) {
    if (place_ >= substep.late_forces.size() || substep.late_forces[place_].empty()) return;
    late_.clear();
    const std::vector<double>& own = substep.late_forces[place_];
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      Vector3 friction = Vector3::Zero();
      for (std::size_t k = 0; k < 2 && contacts_[i].friction > 0.0; ++k) {
        friction += own[3 * i + 1 + k] * contacts_[i].tangents[k];
      }
      late_.insert(late_.end(), {own[3 * i], friction[0], friction[1], friction[2]});
    }
    substep.late_forces[place_] = late_;
  }

  std::size_t place_;  // among the world's features
  ContactFinder finder_;
  bool mean_velocities_ = true;
  double substep_;  // length of the settings [s]
  double slop_;     // shortest part [s]
  bool bounces_ = false;
  bool locates_all_;      // impacts of free bodies and without restitution, too
  bool locates_ = false;  // the world locates impacts in `expected_`
  Expected expected_;
  // Scratch of a substep.
  std::vector<Contact> contacts_;
  std::vector<double> multipliers_;  // three per contact
  std::vector<ContactRecord> records_;
  std::vector<double> late_;
  bool whole_ = false;   // the substep is the expected part, and no share of it
  double passed_ = 0.0;  // time since the first impact that is left to the end [s]; below 0 before
  Crowd crowd_;
  Rebound rebound_;
};

}  // namespace

std::unique_ptr<ConstraintBatch> make_contact_batch(const Model& model, const BodySet& bodies,
                                                    std::size_t place) {
  return std::make_unique<ContactBatch>(model, bodies, place);
}

std::vector<ContactReport> report_contacts(const Model& model, const BodySet& bodies,
                                           const FeatureState& state) {
  const ContactFinder finder(model, bodies);
  const auto body_of = [&](int form) { return BodyId{finder.forms()[at(form)].body}; };
  std::vector<ContactReport> reports;
  for (std::size_t i = 0; i < contact_count(state); ++i) {
    const ContactRecord record = read_contact(state, i);
    reports.push_back({body_of(record.forms.a), body_of(record.forms.b), record.point,
                       record.normal, record.gap, record.force, record.friction, record.sticks,
                       record.own_a, record.own_b});
  }
  return reports;
}

}  // namespace sheave
