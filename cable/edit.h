#pragma once
// What can be changed of a world that runs: bodies, joints, colliders and cables come, go and are
// changed, cables are taken apart and put together.
//
//   auto done = world.edit([&](Edit& edit) {
//     edit.detach(rope, CableEnd::last);
//     edit.attach(rope, CableEnd::last, edit.id(hook), {0.0, 0.1, 0.0});
//   });
//   if (!done) report(done.errors());
//
// An edit is done as a whole or not at all: where something of it cannot be, LiveWorld::edit()
// tells all its faults and nothing has changed. What stays goes on as it was, to the last bit of
// its state. It takes no time and nothing moves in it.
//
// A cable that has been split or detached has a loose end: cable that hangs from its last hold and
// that nothing pulls at. By the end of the edit it must be attached again or joined, or it runs off
// every wheel and out of every eyelet up to the next link that holds it: an attachment, or the drum
// at its other end. No more than e^(m a) 0 = 0 could hold it there. A cable of which nothing is
// left between two holds pulls at nothing; it stays, with its handle and its length, and can be
// attached again.

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

/// What an edit did.
struct EditReport {
  struct Cable {
    CableHandle cable;
    double added = 0.0;  ///< to its length [m]; < 0: it has less, or is no more
  };
  Energy energy;  ///< by how much there is more of each kind [J]
  std::vector<Cable>
      cables;  ///< those whose lengths have changed, with those that have come and gone
};

/// A list of changes; exists while LiveWorld::edit() runs. Bodies that definitions refer to are
/// told by id(). Positions and directions are those of now, in the world frame, as those of a model
/// are those of time 0; what is a function of time (drives, motions of kinematic bodies) is one of
/// the world's time, as it has always been. Where a change cannot be, the edit as a whole fails.
/// Faults of a single change have no path. Those that are seen only when all is put together have
/// one, /bodies/3/mass, /joints/0/axis, /cables/2/links/1, with the slot of the handle; that of a
/// collider has its body's, /colliders/3.
class Edit {
 public:
  explicit Edit(EditDraft& draft) : draft_(draft) {}

  /// What definitions call a body; of a default handle the world. One of a body that is no more is
  /// a fault of the edit.
  [[nodiscard]] BodyId id(BodyHandle body);

  /// A body at the place and with the velocity of its definition.
  BodyHandle add(BodyDef body);
  /// A joint of the bodies as they are now, at its coordinates' zero.
  JointHandle add(const std::shared_ptr<JointDef>& joint);
  CableHandle add(CableDef cable);
  /// Makes a body touch others.
  void add(const ColliderDef& collider);
  /// With its collider. Joints, links and rotors that are on it must go before.
  void remove(BodyHandle body);
  void remove(JointHandle joint);
  void remove(CableHandle cable);
  void remove_collider(BodyHandle body);
  /// Changes what is not where it is and how it can move: not mobility, axis, mount, position,
  /// orientation and velocities. Its frame keeps its place and its motion.
  void change(BodyHandle body, const std::function<void(BodyDef&)>& change);
  /// Solver, integrator, substeps, iterations; not dt, which the world counts its time by.
  void set_step(const StepSettings& step);

  /// Splits a cable in two within the span that begins at listed link `span`, at `share` (0 to 1)
  /// of it. The handle stays that of the piece from its first link on; the other one, with the
  /// settings of the whole but for its cut_time, gets `name`. A cable that is cut splits where it
  /// has been cut. A belt is opened instead.
  CableHandle split(CableHandle cable, int span, double share, std::string name);
  /// Opens a belt within the span that begins at listed link `span`, at `share` (0 to 1) of it;
  /// where it has been cut if it is cut. It is an open cable then, with two loose ends, from the
  /// link behind that span to the one before it.
  void open(CableHandle belt, int span, double share);
  /// Joins the loose last end of one cable to the loose first end of another, which is then part of
  /// it. Both must have the same settings. A cable that is joined to itself becomes a belt.
  void join(CableHandle cable, CableHandle next);
  /// Takes an end off what it is fixed to, or off its drum with all that is wound there.
  void detach(CableHandle cable, CableEnd end);
  /// Fixes a loose end to a point of a body [m, body frame].
  void attach(CableHandle cable, CableEnd end, BodyId body, const Vector3& point);
  /// Puts length into a span [m]; < 0: takes it out.
  void pay_out(CableHandle cable, int span, double length);
  /// Leads a span over another link, behind listed link `span`. Of its length the link takes the
  /// arc that lies on it; the rest is shared so that both sides are strained alike.
  void insert(CableHandle cable, int span, std::shared_ptr<const LinkDef> link);
  /// Takes a listed link that is not at an end off a cable; what lies on it comes to the span.
  void remove_link(CableHandle cable, int link);

  /// What cannot be so far; with any of them nothing will be done.
  [[nodiscard]] const Errors& errors() const;
  /// Lets the edit fail.
  void fail(std::string message);

 private:
  EditDraft& draft_;
};

}  // namespace sheave
