#pragma once
// Edits of a running world: bodies, joints, colliders and cables are added, removed and changed;
// cables are split, joined, attached and detached.
//
//   auto done = world.edit([&](Edit& edit) {
//     edit.detach(rope, CableEnd::last);
//     edit.attach(rope, CableEnd::last, edit.id(hook), {0.0, 0.1, 0.0});
//   });
//   if (!done) report(done.errors());
//
// An edit is all or nothing: if one change is impossible, LiveWorld::edit() returns all faults and
// the world is unchanged. Every object that the edit does not change keeps its state to the last
// bit. An edit takes no simulated time, and no body moves.
//
// A cable that has been split or detached has a loose end: the part beyond the last link that holds
// it, which carries no tension. By the end of the edit the loose end must be attached or joined.
// Otherwise it runs off every wheel and out of every eyelet up to the next link that holds it: an
// attachment, or the drum at the cable's other end. Friction cannot hold it, since the capstan's
// bound is e^(m a) 0 = 0. A cable of which no part lies between two holds carries no tension,
// keeps its handle and its length, and can be attached again.

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "cable/cable.h"
#include "cable/handle.h"
#include "engine/contacts/collider.h"
#include "engine/joint.h"
#include "engine/model.h"
#include "engine/world.h"

namespace sheave {

struct EditDraft;

enum class CableEnd { first, last };

/// Result of an edit.
struct EditReport {
  struct Cable {
    CableHandle cable;
    /// change of the cable's length [m]; < 0: the cable became shorter or was removed
    double added = 0.0;
  };
  Energy energy;  ///< change of each kind of energy [J]
  std::vector<Cable>
      cables;  ///< the cables whose lengths have changed, and those that were added or removed
};

/// The changes of one edit. An Edit exists only while LiveWorld::edit() runs. Definitions refer to
/// bodies by id(). Positions and directions are those of the present moment, in the world frame, as
/// those of a model are those of time 0. Functions of time (drives, motions of kinematic bodies)
/// use the world's time. If one change is impossible, the whole edit fails. The fault of a single
/// change has no path. A fault that appears only when all changes are combined has one,
/// /bodies/3/mass, /joints/0/axis or /cables/2/links/1, with the slot of the handle; the fault of a
/// collider has the slot of its body, /colliders/3.
class Edit {
 public:
  explicit Edit(EditDraft& draft) : draft_(draft) {}

  /// The id by which definitions refer to a body; a default handle gives the world. A body that no
  /// longer exists is a fault of the edit.
  [[nodiscard]] BodyId id(BodyHandle body);

  /// A body at the place and with the velocity of its definition.
  BodyHandle add(BodyDef body);
  /// A joint between the bodies in their present poses, where its coordinates are 0.
  JointHandle add(const std::shared_ptr<JointDef>& joint);
  CableHandle add(CableDef cable);
  /// Gives a body a collider.
  void add(const ColliderDef& collider);
  /// Removes a body with its collider. Its joints, links and mounted rotors must be removed first.
  void remove(BodyHandle body);
  void remove(JointHandle joint);
  void remove(CableHandle cable);
  void remove_collider(BodyHandle body);
  /// Changes a body's settings, except mobility, axis, mount, position, orientation and velocities.
  /// The frame keeps its pose and its velocity.
  void change(BodyHandle body, const std::function<void(BodyDef&)>& change);
  /// Sets solver, integrator, substeps and iterations. dt cannot change, because the world counts
  /// its time in steps of dt.
  void set_step(const StepSettings& step);

  /// Splits a cable in two within the span that begins at listed link `span`, at the fraction
  /// `share` (0 to 1) of the span. The handle stays with the piece that begins at the first link.
  /// The other piece gets `name` and the settings of the whole cable except its cut_time. A piece of
  /// a cut cable that is tied again is as strong as the cable was before LiveWorld::cut(). A cable
  /// that is cut splits in the span of its cut, at its place if it has one (LiveWorld::cut()). A belt
  /// cannot be split; use open().
  CableHandle split(CableHandle cable, int span, double share, std::string name);
  /// Opens a belt within the span that begins at listed link `span`, at the fraction `share` (0 to
  /// 1) of the span, or at its cut if the belt is cut. The result is an open cable with two loose
  /// ends, from the link behind that span to the link before the span.
  void open(CableHandle belt, int span, double share);
  /// Joins the loose last end of one cable to the loose first end of another, which becomes part of
  /// the first. Both cables must have the same settings. A cable that is joined to itself becomes a
  /// belt.
  void join(CableHandle cable, CableHandle next);
  /// Takes an end off its attachment, or off its drum together with all cable wound there.
  void detach(CableHandle cable, CableEnd end);
  /// Fixes a loose end to a point of a body [m, body frame].
  void attach(CableHandle cable, CableEnd end, BodyId body, const Vector3& point);
  /// Adds length to a span [m]; < 0 removes it.
  void pay_out(CableHandle cable, int span, double length);
  /// Inserts a link into a span, behind listed link `span`. The link takes the arc that lies on it
  /// from the span's length. The rest is divided so that the spans on both sides have equal strain.
  void insert(CableHandle cable, int span, std::shared_ptr<const LinkDef> link);
  /// Removes a listed link that is not at an end of the cable. The cable stored on the link goes to
  /// the span.
  void remove_link(CableHandle cable, int link);

  /// The faults so far. If there is one, the edit will change nothing.
  [[nodiscard]] const Errors& errors() const;
  /// Adds a fault, so that the edit fails.
  void fail(std::string message);

 private:
  EditDraft& draft_;
};

}  // namespace sheave
