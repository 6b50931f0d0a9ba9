#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/constraint_batch.h"
#include "engine/model.h"
#include "engine/substep.h"

namespace sheave {

/// One named stage of a substep.
struct Stage {
  std::string name;
  std::function<void(Substep&)> run;
};

/// The stages of a substep of this model with these features, in order. Features that are absent
/// have no stage. `features` must outlive the stages.
[[nodiscard]] std::vector<Stage> substep_stages(
    const Model& model, std::span<const std::unique_ptr<ConstraintBatch>> features);

}  // namespace sheave
