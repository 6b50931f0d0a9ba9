#pragma once
// Errors of the library as Python exceptions (python/sheave/_errors.py).

#include <string>
#include <utility>
#include <vector>

#include <pybind11/pybind11.h>

#include "engine/result.h"
#include "scenes/scene.h"

namespace sheave::python {

namespace py = pybind11;

/// Raises sheave.<kind>(message), a class of sheave._errors.
[[noreturn]] void raise(const char* kind, const std::string& message);
/// Raises sheave.<kind> with all messages; its `faults` has one entry per error.
[[noreturn]] void raise(const char* kind, const Errors& errors);
/// Raises sheave.SceneError with all faults.
[[noreturn]] void raise_scene_error(const std::vector<SceneError>& errors);
/// The same for faults with a path in the scene instead of a position in a text.
[[noreturn]] void raise_scene_error(const std::string& file, const Errors& errors);

/// Raises sheave.<kind> if `errors` is not empty.
inline void check(const Errors& errors, const char* kind = "Error") {
  if (!errors.empty()) raise(kind, errors);
}

/// The value of the result, or raises sheave.<kind>.
template <class T>
T value_of(Result<T> result, const char* kind = "Error") {
  if (!result) raise(kind, result.errors());
  return std::move(result).value();
}

}  // namespace sheave::python
