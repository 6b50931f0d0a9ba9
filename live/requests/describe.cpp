// Describes the objects in the world and the controls that can be set.

#include <algorithm>
#include <array>
#include <vector>

#include "engine/index.h"
#include "live/request.h"
#include "live/session_state.h"

namespace sheave::live {
namespace {

using ValueKind = AnswerValue::Kind;

const AnswerFormat& described_body_format() {
  static const AnswerFormat format{
      "described body",
      "a body of the world",
      {{"name", {ValueKind::text}, "of the body"},
       {"mobility", {ValueKind::text, {}, mobility_names}, "which motions it has"},
       {"drive",
        {ValueKind::text, {}, std::span(drive_names).subspan(1)},
        "of a driven rotor",
        optional}}};
  return format;
}

const AnswerFormat& described_joint_format() {
  static const AnswerFormat format{
      "described joint",
      "a joint of the world",
      {{"name", {ValueKind::text}, "of the joint"},
       {"type", {ValueKind::text}, "as in scenes"},
       {"bodies", {ValueKind::texts}, "names of the two it joins, or \"world\""},
       {"coordinates", {ValueKind::texts}, "names of its coordinates"}}};
  return format;
}

const AnswerFormat& described_link_format() {
  static const AnswerFormat format{"described link",
                                   "a contact of a cable with a body",
                                   {{"type", {ValueKind::text}, "as in scenes"},
                                    {"body", {ValueKind::text}, "its name, or \"world\""}}};
  return format;
}

const AnswerFormat& described_cable_format() {
  static const AnswerFormat format{
      "described cable",
      "a cable of the world",
      {{"name", {ValueKind::text}, "of the cable"},
       {"closed", {ValueKind::boolean}, "whether it is a belt"},
       {"spans", {ValueKind::integer}, "number of its spans"},
       {"links", {ValueKind::objects, {}, {}, &described_link_format()}, "in order"}}};
  return format;
}

const AnswerFormat& loose_cable_format() {
  static const AnswerFormat format{"loose cable",
                                   "a cable without a part between two holds",
                                   {{"name", {ValueKind::text}, "of the cable"},
                                    {"length", {ValueKind::number, "m"}, "all of it"}}};
  return format;
}

const AnswerFormat& control_format() {
  static const AnswerFormat format{
      "settable control",
      "a control that can be set",
      {{"type", {ValueKind::text}, "of the control"},
       {"body", {ValueKind::text}, "of a body's: its name", optional},
       {"joint", {ValueKind::text}, "of a joint's: its name", optional},
       {"coordinate", {ValueKind::text}, "of a joint's: which one", optional},
       {"cable", {ValueKind::text}, "of a cable's or a link's: its name", optional},
       {"link", {ValueKind::integer}, "of a link's: which one, from 0", optional}}};
  return format;
}

class Describe final : public Request {
 public:
  bool quantities = false;

  static constexpr std::string_view type_name = "describe";
  static constexpr std::string_view type_meaning =
      "parts of the world, and the controls that can be set";
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&Describe::quantities>("quantities", "", {}, optional,
                                     "whether the answer has the names of all quantities, too"),
    };
    return table;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] std::vector<AnswerKey> answer_keys() const override {
    const auto list = [](const AnswerFormat& format) {
      return AnswerValue{ValueKind::objects, {}, {}, &format};
    };
    return {{"bodies", list(described_body_format()),
             "in the order of the scene; parts that were added later may stand between"},
            {"joints", list(described_joint_format()), "likewise"},
            {"cables", list(described_cable_format()), "cables with a part between two holds"},
            {"loose_cables", list(loose_cable_format()), "the others"},
            {"controllers", {ValueKind::texts}, "names"},
            {"triggers", {ValueKind::texts}, "names"},
            {"controls", list(control_format()),
             "controls that can be set, as they stand in `set`, without values"},
            {"quantities", {ValueKind::texts}, "names of all quantities, if requested", optional}};
  }
  [[nodiscard]] Errors run(SessionState& session, Json& answer) const override;
};

std::string name_of(const Model& model, BodyId body) {
  return body.is_world() ? "world" : model.bodies[at(body.index)].name;
}

Json bodies_json(const LiveWorld& world) {
  Json list = Json::array();
  for (const BodyHandle handle : world.bodies()) {
    const BodyDef& body = world.simulation().world.model().bodies[at(handle.slot)];
    Json& told = list.emplace_back(Json{{"name", body.name}});
    told["mobility"] = mobility_names[static_cast<std::size_t>(body.mobility)];
    if (body.drive != DriveKind::none) {
      told["drive"] = drive_names[static_cast<std::size_t>(body.drive)];
    }
  }
  return list;
}

Json joints_json(const Model& model) {
  Json list = Json::array();
  for (const auto& joint : model.joints) {
    Json& told = list.emplace_back(Json{{"name", joint->name}, {"type", joint->type()}});
    told["bodies"] = {name_of(model, joint->body_a), name_of(model, joint->body_b)};
    told["coordinates"] = Json::array();
    for (const JointCoordinateInfo& coordinate : joint->coordinates()) {
      told["coordinates"].push_back(coordinate.name);
    }
  }
  return list;
}

Json cables_json(const Model& model, const std::vector<CableDef>& cables) {
  Json list = Json::array();
  for (const CableDef& cable : cables) {
    Json& told = list.emplace_back(Json{{"name", cable.name}, {"closed", cable.closed}});
    told["spans"] = cable.span_count();
    told["links"] = Json::array();
    for (const auto& link : cable.links) {
      Json& one = told["links"].emplace_back(
          Json{{"type", link->type()}, {"body", name_of(model, link->body)}});
      if (link->exit_body() != link->body) one["exit_body"] = name_of(model, link->exit_body());
    }
  }
  return list;
}

/// Loose cables, with their lengths.
Json loose_json(const LiveWorld& world) {
  Json list = Json::array();
  for (const CableHandle cable : world.cables()) {
    if (world.pulls(cable)) continue;
    list.push_back({{"name", *world.name(cable)}, {"length", *world.length(cable)}});
  }
  return list;
}

/// Finds the controls that can be set by trying to set them.
class Settable {
 public:
  explicit Settable(LiveWorld& world) : world_(world) {}

  /// The controls in the form of the request "set", without their values.
  Json list() {
    list_ = Json::array();
    // The error restores all controls.
    static_cast<void>(world_.set_together([&] {
      bodies();
      joints();
      cables();
      return Errors{{"", "only tried"}};
    }));
    list_.push_back({{"type", "gravity"}});
    return std::move(list_);
  }

 private:
  void note(const Errors& errors, Json control) {
    if (errors.empty()) list_.push_back(std::move(control));
  }
  void bodies() {
    for (const BodyHandle handle : world_.bodies()) {
      const BodyDef& body = world_.simulation().world.model().bodies[at(handle.slot)];
      const auto told = [&](const char* type) { return Json{{"type", type}, {"body", body.name}}; };
      const DriveTarget soon(0.0, 1.0);
      note(world_.set_speed(handle, soon), told("speed"));
      note(world_.set_angle(handle, soon), told("angle"));
      note(world_.set_torque(handle, soon), told("torque"));
      note(world_.set_force(handle, {}), told("force"));
      MotionTarget stay;
      stay.position = world_.pose(handle)->position;
      note(world_.set_motion(handle, stay), told("motion"));
    }
  }
  void joints() {
    const auto& all = world_.simulation().world.model().joints;
    for (int i = 0; i < static_cast<int>(all.size()); ++i) {
      const auto& joint = all[at(i)];
      const JointHandle handle = world_.joint_at(i);
      const auto coordinates = joint->coordinates();
      for (int k = 0; k < static_cast<int>(coordinates.size()); ++k) {
        const auto told = [&](const char* type) {
          return Json{
              {"type", type}, {"joint", joint->name}, {"coordinate", coordinates[at(k)].name}};
        };
        note(world_.set_drive(handle, {0.0, 1.0}, k), told("joint_drive"));
        note(world_.set_drive_limit(handle, 1.0, k), told("joint_drive_limit"));
      }
    }
  }
  void cables() {
    const std::vector<CableDef>& all = *world_.simulation().cable_definitions;
    for (int i = 0; i < static_cast<int>(all.size()); ++i) {
      const CableDef& cable = all[at(i)];
      const CableHandle handle = world_.cable_at(i);
      const auto told = [&](const char* type) {
        return Json{{"type", type}, {"cable", cable.name}};
      };
      note(world_.set_compliance(handle, 1.0), told("compliance"));
      note(world_.set_breaking_tension(handle, 1.0), told("breaking_tension"));
      note(world_.set_wrap_friction(handle, 1.0), told("wrap_friction"));
      for (int k = 0; k < static_cast<int>(cable.links.size()); ++k) {
        const auto told_of_link = [&](const char* type) {
          Json control = told(type);
          control["link"] = k;
          return control;
        };
        note(world_.set_friction(handle, k, 1.0), told_of_link("friction"));
        note(world_.set_feed_speed(handle, k, 0.0), told_of_link("feed_speed"));
      }
    }
  }

  LiveWorld& world_;
  Json list_;
};

Errors Describe::run(SessionState& session, Json& answer) const {
  const Model& model = session.world.simulation().world.model();
  answer["bodies"] = bodies_json(session.world);
  answer["joints"] = joints_json(model);
  answer["cables"] = cables_json(model, *session.world.simulation().cable_definitions);
  answer["loose_cables"] = loose_json(session.world);
  answer["controllers"] = session.about.controllers;
  answer["triggers"] = session.about.triggers;
  answer["controls"] = Settable(session.world).list();
  if (quantities) answer["quantities"] = session.quantities()->set().names();
  return {};
}

}  // namespace

TypeEntry<Request> describe_request() { return request_entry<Describe>(); }

}  // namespace sheave::live
