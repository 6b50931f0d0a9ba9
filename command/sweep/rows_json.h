#pragma once
// The rows of a sweep or a tune as JSON.

#include <nlohmann/json.hpp>

#include "command/sweep/table.h"

namespace sheave::command {

/// One object per row: values, measures, status, certificate, message.
[[nodiscard]] nlohmann::ordered_json sweep_rows_json(const SweepTable& table);

}  // namespace sheave::command
