#pragma once
// The numbers of a muscle that MuJoCo finds itself where a model does not give them: lengthrange,
// and the force scale / acc0.

#include "scenes/import/log.h"
#include "scenes/import/mjcf/model.h"

namespace sheave::import::mjcf {

/// Sets force and lengthrange of all muscles without them, after find_masses(). Muscles for which
/// they cannot be had are skipped, and the log tells why.
void complete_muscles(Model& model, Log& log);

}  // namespace sheave::import::mjcf
