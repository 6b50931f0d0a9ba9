#pragma once
// The settings of a scene as numbers of expressions: "/bodies/load/mass", "/gravity/1".

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "cable/cable.h"
#include "engine/model.h"
#include "engine/result.h"
#include "scenes/expression.h"

namespace sheave {

class LoadDef;

/// The numbers among the settings of a model with cables and loads, by the pointers of --set, with
/// defaults. Controls do not change these settings.
class SceneValues {
 public:
  SceneValues(Model model, std::vector<CableDef> cables,
              std::vector<std::shared_ptr<const LoadDef>> loads)
      : model_(std::move(model)), cables_(std::move(cables)), loads_(std::move(loads)) {}

  /// The number at a pointer, with the unit of its field table. The error names the part of the
  /// pointer that leads nowhere, and a similar name.
  [[nodiscard]] Result<ExpressionNumber> find(std::string_view pointer) const;

 private:
  Model model_;
  std::vector<CableDef> cables_;
  std::vector<std::shared_ptr<const LoadDef>> loads_;
};

}  // namespace sheave
