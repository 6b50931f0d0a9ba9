// Places a body.

#include <array>
#include <vector>

#include "engine/index.h"
#include "live/names.h"
#include "live/request.h"
#include "live/session_state.h"

namespace sheave::live {
namespace {

constexpr std::array<std::string_view, 2> keep_names{"length", "tension"};

class Place final : public Request {
 public:
  std::string body;
  Vector3 position = Vector3::Zero();
  Quaternion orientation{0.0, 0.0, 0.0, 0.0};  // all zeros: unchanged
  Keep keep = Keep::length;

  static constexpr std::string_view type_name = "place";
  static constexpr std::string_view type_meaning =
      "moves a free, planar or slider body that no joint holds, with the bodies mounted on it; the "
      "answer has the effects on energy and on the lengths of cables";
  static std::span<const Field> field_table() {
    static const std::array table{
        field<&Place::body>("body", "", {}, required, "name of the body"),
        field<&Place::position>("position", "m", any_number(), required,
                                "new position of its origin"),
        field<&Place::orientation>("orientation", "", {}, optional,
                                   "new orientation; default: the present one"),
        choice_field<&Place::keep>(
            "keep", keep_names, optional,
            "quantity that cables keep: their lengths, or their tensions and slack"),
    };
    return table;
  }
  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] std::vector<AnswerKey> answer_keys() const override { return consequence_keys(); }
  [[nodiscard]] Errors run(SessionState& session, Json& answer) const override {
    const Result<BodyHandle> handle = session.names.body(body);
    if (!handle) return handle.errors();
    const std::optional<Quaternion> turned =
        orientation.coeffs().isZero(0.0) ? std::nullopt : std::optional(orientation);
    const Result<Placement> placed = session.world.place(*handle, position, turned, keep);
    if (!placed) {
      Errors errors = placed.errors();
      for (Error& error : errors) error.path.clear();
      return errors;
    }
    answer["energy"] = placed->energy;
    Json cables = Json::array();
    for (const Placement::Cable& cable : placed->cables) {
      cables.push_back({{"cable", *session.world.name(cable.cable)}, {"added", cable.added}});
    }
    answer["cables"] = std::move(cables);
    return {};
  }
};

}  // namespace

TypeEntry<Request> place_request() { return request_entry<Place>(); }

}  // namespace sheave::live
