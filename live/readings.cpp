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

QuantityIndex::QuantityIndex(const Simulation& simulation) : set_(simulation) {
  const std::vector<std::string>& names = set_.names();
  indices_.reserve(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) indices_.emplace(names[i], static_cast<int>(i));
}

Result<int> QuantityIndex::find(const std::string& name) const {
  const auto found = indices_.find(name);
  if (found != indices_.end()) return found->second;
  constexpr std::size_t longest = 300;  // two names of 128 characters and the text between them
  if (name.size() > longest) return Error{"", "there is no quantity of this name"};
  return set_.index_of(name);
}

Result<Readings> Readings::create(const QuantityIndex& index, const Names& names,
                                  const std::vector<std::string>& quantities,
                                  const std::vector<std::string>& poses) {
  Readings readings;
  Errors errors;
  check_twice(quantities, "quantities", errors);
  check_twice(poses, "poses", errors);
  constexpr std::size_t enough = 20;  // suggestions take time
  for (std::size_t i = 0; i < quantities.size() && errors.size() < enough; ++i) {
    const Result<int> found = index.find(quantities[i]);
    if (found) readings.indices_.push_back(*found);
    if (!found) {
      errors.push_back({fmt::format("/quantities/{}", i), found.errors().front().message});
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

void Readings::find_again(const QuantityIndex& index, const Names& names) {
  for (std::size_t i = 0; i < indices_.size(); ++i) {
    const Result<int> found = index.find(quantities_[i]);
    indices_[i] = found ? *found : -1;
  }
  for (std::size_t i = 0; i < handles_.size(); ++i) {
    const Result<BodyHandle> found = names.body(bodies_[i]);
    handles_[i] = found ? *found : BodyHandle{};
  }
}

void Readings::read(const QuantityIndex& index, const LiveWorld& world, Json& answer) const {
  if (!indices_.empty()) {
    std::vector<int> known;
    for (const int quantity : indices_) {
      if (quantity >= 0) known.push_back(quantity);
    }
    std::vector<double> values(known.size());
    index.set().sample(world.simulation(), known, values);
    const bool at_start = world.state().steps == 0;
    Json object = Json::object();
    std::size_t next = 0;
    for (std::size_t i = 0; i < indices_.size(); ++i) {
      const double value = indices_[i] >= 0 ? values[next++] : std::nan("");
      const bool told =
          std::isfinite(value) && (!at_start || index.set().known_at_start(indices_[i]));
      append(object, quantities_[i], told ? Json(value) : Json());
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
