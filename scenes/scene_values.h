#pragma once
// The settings of a scene as numbers of expressions: "/bodies/load/mass", "/gravity/1", and its
// parameters by their names.

#include <string>
#include <string_view>

#include "engine/result.h"
#include "scenes/expression.h"
#include "scenes/scene.h"

namespace sheave {

/// The numbers among the settings of a scene, by the pointers of --set, with defaults. Controls do
/// not change these settings. Settings of pictures and checks are no such numbers.
class SceneValues {
 public:
  explicit SceneValues(Scene scene) : scene_(std::move(scene)) {}

  /// The number at a pointer, or of the parameter with this name, with its unit. `names` are those
  /// of the scene: units of triggers and controllers follow from their quantities. The error names
  /// the part of the pointer that leads nowhere, and a similar name.
  [[nodiscard]] Result<ExpressionNumber> find(std::string_view pointer,
                                              const QuantityNames& names) const;
  /// ", did you mean ...?" with the name of a parameter, or nothing.
  [[nodiscard]] std::string suggestion(std::string_view name) const;

 private:
  Scene scene_;
};

}  // namespace sheave
