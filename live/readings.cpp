#include "live/readings.h"

#include <cmath>
#include <unordered_set>

#include <fmt/format.h>

#include "engine/index.h"
#include "live/names.h"

namespace sheave::live {
namespace {

/// Appends a member without checking whether it exists: Json's own method takes time proportional
/// to their number.
void append(Json& object, std::string_view key, Json value) {
  using Members = std::vector<std::pair<const std::string, Json>>;
  static_cast<Members&>(object.get_ref<Json::object_t&>())
      .emplace_back(std::string(key), std::move(value));
}

Json vector_json(const Vector3& v) { return {v.x(), v.y(), v.z()}; }

Json pose_json(const BodyPose& pose) {
  const Quaternion& q = pose.orientation;
  return {{"position", vector_json(pose.position)},
          {"orientation", {q.w(), q.x(), q.y(), q.z()}},
          {"velocity", vector_json(pose.velocity)},
          {"angular_velocity", vector_json(pose.angular_velocity)}};
}

/// Reports names that occur twice.
void check_twice(const std::vector<std::string>& names, const char* list, Errors& errors) {
  std::unordered_set<std::string_view> known;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (known.insert(names[i]).second) continue;
    errors.push_back({fmt::format("/{}/{}", list, i), "is in the list twice"});
  }
}

}  // namespace

Result<Readings> Readings::create(const QuantityIndexPointer& index, const Names& names,
                                  const std::vector<std::string>& quantities,
                                  const std::vector<std::string>& poses) {
  Readings readings(index);
  Errors errors;
  check_twice(quantities, "quantities", errors);
  check_twice(poses, "poses", errors);
  constexpr std::size_t enough = 20;  // suggestions take time
  for (std::size_t i = 0; i < quantities.size() && errors.size() < enough; ++i) {
    readings.places_.push_back(static_cast<int>(readings.list_.size()));
    const Errors faults = readings.list_.add(quantities[i]);
    if (!faults.empty()) {
      errors.push_back({fmt::format("/quantities/{}", i), faults.front().message});
    }
  }
  for (std::size_t i = 0; i < poses.size() && errors.size() < enough; ++i) {
    const Result<BodyHandle> body = names.body(poses[i], fmt::format("/poses/{}", i));
    if (body) readings.handles_.push_back(*body);
    if (!body) errors.push_back(body.errors().front());
  }
  readings.quantities_ = quantities;
  readings.bodies_ = poses;
  if (!errors.empty()) return errors;
  return readings;
}

void Readings::find_again(const QuantityIndexPointer& index, const Names& names) {
  list_ = QuantityList(index);
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const auto place = static_cast<int>(list_.size());
    places_[i] = list_.add(quantities_[i]).empty() ? place : -1;
  }
  for (std::size_t i = 0; i < handles_.size(); ++i) {
    const Result<BodyHandle> found = names.body(bodies_[i]);
    handles_[i] = found ? *found : BodyHandle{};
  }
}

void Readings::read(const LiveWorld& world, Json& answer) const {
  if (!quantities_.empty()) {
    std::vector<double> values(list_.size());
    list_.observe(world.simulation(), values);
    Json object = Json::object();
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const double value = places_[i] >= 0 ? values[at(places_[i])] : std::nan("");
      append(object, quantities_[i], std::isfinite(value) ? Json(value) : Json());
    }
    answer["values"] = std::move(object);
  }
  if (!handles_.empty()) {
    Json object = Json::object();
    for (std::size_t i = 0; i < handles_.size(); ++i) {
      const Result<BodyPose> pose = world.pose(handles_[i]);
      append(object, bodies_[i], pose ? pose_json(*pose) : Json());
    }
    answer["poses"] = std::move(object);
  }
}

}  // namespace sheave::live
