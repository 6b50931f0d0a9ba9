#pragma once

#include <string>
#include <vector>

#include <pybind11/pybind11.h>

#include "scenes/scene.h"

namespace sheave::python {

/// Overrides from a dict of pointers and JSON texts, which python/sheave/_load.py makes.
[[nodiscard]] std::vector<Override> overrides_of(const pybind11::dict& texts);

}  // namespace sheave::python
