#pragma once
// Models of the tests, and the results of MuJoCo for them (bench/peers/import/reference_main.cpp).

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "scenes/import/import.h"
#include "scenes/import/mjcf/model.h"
#include "scenes/import/mjcf/pose.h"
#include "scenes/scene.h"

namespace sheave::test {

/// The path of tests/import/models/NAME.
[[nodiscard]] std::string model_path(const std::string& name);
/// The text of a model without limits, which differ in meaning, and, but for "couplings", without
/// armature, which MuJoCo's masses do not have.
[[nodiscard]] std::string plain_model(const std::string& name);
/// The references of a model.
[[nodiscard]] nlohmann::json references(const std::string& name);

/// The text with a keyframe of the name "test".
[[nodiscard]] std::string with_keyframe(const std::string& text, const std::vector<double>& qpos,
                                        const std::vector<double>& qvel);
/// The scene of the text in its keyframe "test"; throws with all faults.
[[nodiscard]] Scene scene_in_keyframe(const std::string& text, const std::string& name);
/// The model of a text, to follow its coordinates; throws with all faults.
class ReadModel {
 public:
  explicit ReadModel(const std::string& text);
  ReadModel(const ReadModel&) = delete;
  ReadModel& operator=(const ReadModel&) = delete;
  ~ReadModel();
  [[nodiscard]] const import::mjcf::Model& operator*() const;
  [[nodiscard]] const import::mjcf::Model* operator->() const { return &**this; }

 private:
  struct Content;
  std::unique_ptr<Content> content_;
};

/// Numbers of a list.
[[nodiscard]] std::vector<double> numbers(const nlohmann::json& list);
[[nodiscard]] Vector3 vector_at(const nlohmann::json& list, std::size_t first);

/// The coordinates after a time at these rates: q + q' t + q'' t^2 / 2, and for quaternions the
/// turn by that vector; the rates with them.
void move_on(const import::mjcf::Model& model, double time,
             const std::vector<double>& accelerations, std::vector<double>& positions,
             std::vector<double>& velocities);

}  // namespace sheave::test
