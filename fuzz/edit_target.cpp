#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "cable/links/pinhole.h"
#include "cable/links/spool.h"
#include "cable/live_world.h"
#include "engine/index.h"
#include "engine/joints/hinge.h"
#include "fuzz/edit_model.h"
#include "fuzz/target.h"
#include "tests/support/builders.h"

namespace sheave::fuzz {
namespace {

using Kind = EditModel::Kind;

/// Whether a refusal is due to geometry, which the model does not contain.
bool is_of_geometry(const std::string& fault) {
  constexpr std::array reasons{"would run through a wheel", "would need a negative rest length",
                               "too little for the inserted link", "m too short for that"};
  return std::any_of(reasons.begin(), reasons.end(),
                     [&](const char* reason) { return fault.find(reason) != std::string::npos; });
}

/// A drum, three wheels, two masses and two posts. A rope runs from the drum over a wheel to a
/// mass, another one through an eyelet, and there is a belt. All cables are elastic, so that none
/// is too short for an edit.
test::Machine machine() {
  test::Machine made;
  made.model.gravity = test::down;
  made.model.step = test::direct_settings(IntegratorKind::rattle, 0.01);
  made.model.bodies = {test::wheel("drum", {-4.0, 0.0, 0.0}, 0.3, 1.0),
                       test::wheel("wheel 1", {0.0, 0.5, 0.0}, 0.2, 0.02),
                       test::wheel("wheel 2", {4.0, 0.0, 0.0}, 0.25, 0.02),
                       test::wheel("wheel 3", {8.0, 0.3, 0.0}, 0.2, 0.02),
                       test::lump("lump 1", {2.0, -4.0, 0.0}, 5.0),
                       test::lump("lump 2", {6.0, -4.0, 0.0}, 5.0)};
  made.model.bodies[0].drive = DriveKind::speed;
  made.model.bodies[0].drive_values = {0.5};
  for (const int lump : {4, 5}) {
    made.model.bodies[at(lump)].damping = made.model.bodies[at(lump)].angular_damping = 5.0;
  }
  auto spool = std::make_shared<SpoolLink>();
  spool->body = BodyId{0};
  spool->winding = test::right;
  spool->stored_length = 20.0;
  auto eyelet = std::make_shared<PinholeLink>();
  eyelet->body = BodyId{4};
  made.cables = {
      test::cable("hoist", {spool, test::roll(BodyId{1}, test::right), test::attach(BodyId{4})}),
      test::cable("sling", {test::attach(BodyId::world(), {1.0, 4.0, 0.0}), eyelet,
                            test::attach(BodyId{5})}),
      test::cable("belt", {test::roll(BodyId{2}, test::left), test::roll(BodyId{3}, test::left)})};
  made.cables[2].closed = true;
  for (CableDef& cable : made.cables) cable.compliance = 1e-4;
  return made;
}

EditModel model_of(const test::Machine& made) {
  EditModel model;
  model.bodies.assign(made.model.bodies.size(), 1);
  const auto link = [](Kind kind, int body) { return EditModel::Link{kind, body, false, false}; };
  model.cables.resize(3);
  model.cables[0].links = {link(Kind::spool, 0), link(Kind::rolling, 1), link(Kind::attachment, 4)};
  model.cables[1].links = {link(Kind::attachment, -1), link(Kind::pinhole, 4),
                           link(Kind::attachment, 5)};
  model.cables[2].links = {link(Kind::rolling, 2), link(Kind::rolling, 3)};
  model.cables[2].closed = true;
  return model;
}

class EditTrial {
 public:
  explicit EditTrial(Bytes bytes) : bytes_(bytes), model_(model_of(machine())), world_(start()) {
    for (int i = 0; i < 6; ++i) bodies_.push_back(world_.body_at(i));
    for (int i = 0; i < 3; ++i) cables_.push_back(world_.cable_at(i));
  }

  void run() {
    while (!bytes_.empty() && goes_on_) {
      const int what = pick(8);
      if (what == 0) {
        step(1 + pick(3));
      } else if (what == 1) {
        cut(pick(static_cast<int>(cables_.size())));
      } else {
        edit(1 + pick(4));
      }
    }
  }

 private:
  static LiveWorld start() {
    const test::Machine made = machine();
    Result<LiveWorld> world = LiveWorld::create(made.model, made.cables);
    require(world.ok(), "the fixed machine is refused");
    return std::move(*world);
  }

  int byte() {
    if (bytes_.empty()) return 0;
    const int value = bytes_.front();
    bytes_ = bytes_.subspan(1);
    return value;
  }
  int pick(int count) { return byte() % count; }
  int some_body() { return pick(static_cast<int>(bodies_.size()) + 1) - 1; }
  int some_cable() { return pick(static_cast<int>(cables_.size())); }
  CableEnd some_end() { return pick(2) == 0 ? CableEnd::first : CableEnd::last; }
  std::string new_name() { return "thing " + std::to_string(++names_); }

  void edit(int changes) {
    const std::uint64_t before = hash(world_.state());
    const double length_before = total_length();
    const std::size_t bodies = bodies_.size();
    const std::size_t joints = joints_.size();
    const std::size_t cables = cables_.size();
    EditModel next = model_;
    const Result<EditReport> done = world_.edit([&](Edit& edit) {
      for (int i = 0; i < changes; ++i) change(edit, next);
    });
    next.finish();
    if (!done) {
      const std::string why = done.errors().front().message;
      require(!why.empty(), "an edit is refused without a message");
      require(!next.fault().empty() || is_of_geometry(why), "a legal edit is refused: " + why);
      require(hash(world_.state()) == before, "refused, and yet changed: " + why);
      bodies_.resize(bodies);
      joints_.resize(joints);
      cables_.resize(cables);
      return compare();
    }
    require(next.fault().empty(), "an illegal edit is done: " + next.fault());
    model_ = std::move(next);
    compare();
    double told = 0.0;
    for (const EditReport::Cable& cable : done->cables) told += cable.added;
    const double missing = total_length() - length_before - told;
    require(std::abs(missing) <= 1e-9 * (1.0 + std::abs(length_before)),
            "length that is not told has come or gone: " + std::to_string(missing) + " m");
    go_back();
  }

  /// Restores the present state, which must succeed.
  void go_back() {
    const std::uint64_t before = hash(world_.state());
    const Errors errors = world_.restore(world_.snapshot());
    require(errors.empty(), "a state that there is is refused: " +
                                (errors.empty() ? std::string() : errors.front().message));
    require(hash(world_.state()) == before, "restored, and yet another");
  }

  void change(Edit& edit, EditModel& next) {
    const int what = pick(16);
    if (what < 10) return change_cable(edit, next, what);
    switch (what) {
      case 10: {
        next.add_body();
        BodyDef body = test::lump(new_name(), somewhere(), 1.0);
        if (pick(2) == 0) {
          body.mobility = Mobility::fixed;
        } else {
          body.damping = body.angular_damping = 5.0;
        }
        return bodies_.push_back(edit.add(body));
      }
      case 11: {
        const int body = some_body();
        if (body < 0) return;
        next.remove_body(body);
        return edit.remove(bodies_[at(body)]);
      }
      case 12: {
        const int body = 4 + pick(2);
        auto hinge = std::make_shared<HingeJoint>();
        hinge->name = new_name();
        hinge->body_a = BodyId::world();
        if (next.bodies[at(body)] == 0) return;
        hinge->body_b = edit.id(bodies_[at(body)]);
        next.add_joint(-1, body);
        return joints_.push_back(edit.add(hinge));
      }
      case 13: {
        if (joints_.empty()) return;
        const int joint = pick(static_cast<int>(joints_.size()));
        next.remove_joint(joint);
        return edit.remove(joints_[at(joint)]);
      }
      case 14:
        return add_cable(edit, next);
      default: {
        const int cable = some_cable();
        next.remove_cable(cable);
        return edit.remove(cables_[at(cable)]);
      }
    }
  }

  void change_cable(Edit& edit, EditModel& next, int what) {
    const int cable = some_cable();
    const CableHandle handle = cables_[at(cable)];
    switch (what) {
      case 0: {
        const int span = pick(4);
        const std::size_t before = next.cables.size();
        next.split(cable, span);
        const CableHandle rest = edit.split(handle, span, pick(5) / 4.0, new_name());
        require((rest != CableHandle{}) == (next.cables.size() > before),
                "a cable is split where there is none, or not where there is one");
        if (rest != CableHandle{}) cables_.push_back(rest);
        return;
      }
      case 1: {
        const int span = pick(4);
        next.open(cable, span);
        return edit.open(handle, span, pick(5) / 4.0);
      }
      case 2: {
        const int other = some_cable();
        next.join(cable, other);
        return edit.join(handle, cables_[at(other)]);
      }
      case 3: {
        const CableEnd end = some_end();
        next.detach(cable, end);
        return edit.detach(handle, end);
      }
      case 4:
      case 5:
        return attach(edit, next, cable, some_end());
      case 6: {  // an end goes elsewhere
        const CableEnd end = some_end();
        next.detach(cable, end);
        edit.detach(handle, end);
        return attach(edit, next, cable, end);
      }
      case 7: {
        const int span = pick(4);
        next.pay_out(cable, span);
        return edit.pay_out(handle, span, 0.25 * pick(40));
      }
      case 8: {
        const int span = pick(4);
        return insert(edit, next, cable, span);
      }
      default: {
        const int link = pick(4);
        next.remove_link(cable, link);
        return edit.remove_link(handle, link);
      }
    }
  }

  void attach(Edit& edit, EditModel& next, int cable, CableEnd end) {
    const int body = some_body();
    next.attach(cable, end, body);
    edit.attach(cables_[at(cable)], end, id(edit, next, body), place_on(body));
  }

  void insert(Edit& edit, EditModel& next, int cable, int span) {
    if (pick(2) == 0) {
      const int wheel = 1 + pick(3);
      const Winding winding = pick(2) == 0 ? test::left : test::right;
      next.insert(cable, span, {Kind::rolling, wheel, true, false});
      return edit.insert(cables_[at(cable)], span, test::roll(id(edit, next, wheel), winding));
    }
    const int body = some_body();
    auto eyelet = std::make_shared<PinholeLink>();
    eyelet->body = id(edit, next, body);
    eyelet->point = place_on(body);
    next.insert(cable, span, {Kind::pinhole, body, true, false});
    edit.insert(cables_[at(cable)], span, eyelet);
  }

  void add_cable(Edit& edit, EditModel& next) {
    const int body = some_body();
    if (body < 0) return;
    CableDef rope = test::cable(new_name(), {test::attach(BodyId::world(), somewhere()),
                                             test::attach(id(edit, next, body), place_on(body))});
    rope.compliance = 1e-4;
    EditModel::Cable added;
    added.links = {{Kind::attachment, -1}, {Kind::attachment, body}};
    next.add_cable(std::move(added));
    cables_.push_back(edit.add(rope));
  }

  /// Using a removed body is a fault of the edit from its first mention.
  BodyId id(Edit& edit, EditModel& next, int body) {
    if (body < 0) return BodyId::world();
    if (next.bodies[at(body)] == 0) next.remove_body(body);  // the same fault
    return edit.id(bodies_[at(body)]);
  }

  Vector3 somewhere() { return {0.5 * pick(25) - 4.0, 0.5 * pick(17) - 6.0, 0.25 * pick(5) - 0.5}; }
  Vector3 place_on(int body) {
    if (body < 0) return somewhere();
    if (body < 4) return {0.1, 0.05, 0.0};
    return {0.05 * pick(5) - 0.1, 0.1, 0.0};
  }

  /// Only steps lift cables off wheels and cut them.
  void step(int count) {
    for (int i = 0; i < count && goes_on_; ++i) {
      const LiveReport report = world_.step();
      goes_on_ = report.ok();
      if (!report.ok()) {
        require(report.divergence && !report.divergence->message.empty(),
                "a step is not done, and nobody says why");
        return;
      }
      for (const CableEvent& event : report.events) {
        if (event.kind != CableEvent::Kind::cut) continue;
        for (std::size_t c = 0; c < cables_.size(); ++c) {
          if (!model_.cables[c].there || *world_.name(cables_[c]) != event.cable) continue;
          model_.cables[c].cut = true;
          model_.cables[c].cut_span = event.link;
        }
      }
    }
    look_at_wheels();
    compare();
    go_back();
  }

  void look_at_wheels() {
    const std::vector<CableReport> reports = world_.simulation().cable_reports();
    for (std::size_t c = 0; c < cables_.size(); ++c) {
      EditModel::Cable& own = model_.cables[c];
      if (!own.pulls() || own.cut) continue;
      const std::string name = *world_.name(cables_[c]);
      for (const CableReport& report : reports) {
        if (report.name != name) continue;
        for (std::size_t i = 0; i < own.links.size(); ++i) {
          own.links[i].lifted = !report.links[i].touched;
        }
      }
    }
  }

  /// Breaks a cable by a tiny breaking tension in one step, if it has any tension.
  void cut(int cable) {
    const EditModel::Cable& own = model_.cables[at(cable)];
    const Errors errors = world_.set_breaking_tension(cables_[at(cable)], 1e-300);
    require(errors.empty() == own.pulls(), "a tension is set of a cable that has none, or not");
    if (!errors.empty()) return;
    step(1);
    require(world_.clear_breaking_tension(cables_[at(cable)]).empty(),
            "what is set is not cleared");
  }

  double total_length() {
    double sum = 0.0;
    for (const CableHandle cable : world_.cables()) sum += *world_.length(cable);
    return sum;
  }

  void compare() {
    std::size_t there = 0;
    for (std::size_t c = 0; c < cables_.size(); ++c) {
      const EditModel::Cable& own = model_.cables[c];
      require(world_.name(cables_[c]).ok() == own.there, "a cable is there, or not");
      if (!own.there) continue;
      ++there;
      for (const CableEnd end : {CableEnd::first, CableEnd::last}) {
        const auto loose = world_.loose_length(cables_[c], end);
        const bool is_loose = loose.ok() && loose->has_value();
        require(is_loose == own.loose[end == CableEnd::first ? 0 : 1], "an end is loose, or not");
      }
      require(world_.pulls(cables_[c]) == own.pulls(), "a cable pulls, or not");
      if (own.pulls()) compare(cables_[c], own);
    }
    require(world_.cables().size() == there, "there are more cables, or fewer");
  }

  void compare(CableHandle handle, const EditModel::Cable& own) {
    const std::string name = *world_.name(handle);
    const auto& all = *world_.simulation().cable_definitions;
    const auto found = std::find_if(all.begin(), all.end(),
                                    [&](const CableDef& cable) { return cable.name == name; });
    require(found != all.end(), "a cable that pulls is not in the world");
    require(found->closed == own.closed, "a cable is a belt, or not");
    require(found->links.size() == own.links.size(), "a cable has other links");
    constexpr std::array<std::string_view, 4> types{"attachment", "rolling", "pinhole", "spool"};
    for (std::size_t i = 0; i < own.links.size(); ++i) {
      const EditModel::Link& link = own.links[i];
      const int slot = link.body < 0 ? BodyId::world().index : bodies_[at(link.body)].slot;
      require(found->links[i]->type() == types[static_cast<std::size_t>(link.kind)],
              "a link is of another kind");
      require(found->links[i]->body.index == slot, "a link is on another body");
    }
  }

  Bytes bytes_;
  EditModel model_;
  LiveWorld world_;
  std::vector<BodyHandle> bodies_;  // same indices as in the model
  std::vector<JointHandle> joints_;
  std::vector<CableHandle> cables_;
  bool goes_on_ = true;
  int names_ = 0;
};

}  // namespace

void try_edit(Bytes bytes) { EditTrial(bytes).run(); }

}  // namespace sheave::fuzz
