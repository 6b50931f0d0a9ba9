#pragma once
// Reads arguments. The error for a wrong one names the argument, its value and the allowed values.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "engine/control_requests.h"
#include "engine/vector.h"

namespace sheave::python {

namespace py = pybind11;

/// Raises sheave.ArgumentError: "name: must be <allowed>, was <value>".
[[noreturn]] void refuse(const char* name, py::handle value, const std::string& allowed);

[[nodiscard]] double number(py::handle value, const char* name);
/// None gives nullopt.
[[nodiscard]] std::optional<double> optional_number(py::handle value, const char* name);
[[nodiscard]] std::int64_t integer(py::handle value, const char* name, std::int64_t least,
                                   std::int64_t most);
[[nodiscard]] bool truth(py::handle value, const char* name);
[[nodiscard]] std::string text(py::handle value, const char* name);
/// Raises if the value is neither None nor callable.
void check_callback(py::handle value, const char* name);
[[nodiscard]] std::vector<std::string> texts(py::handle value, const char* name);
/// Three numbers.
[[nodiscard]] Vector3 vector(py::handle value, const char* name);
[[nodiscard]] std::optional<Vector3> optional_vector(py::handle value, const char* name);
/// Four numbers w, x, y, z.
[[nodiscard]] Quaternion quaternion(py::handle value, const char* name);
[[nodiscard]] std::optional<Quaternion> optional_quaternion(py::handle value, const char* name);
/// The target of a drive.
[[nodiscard]] DriveTarget target(py::handle value, py::handle over, py::handle rate);

/// `count` numbers, or one number for all; `each`: the things that have one number each.
[[nodiscard]] std::vector<double> numbers(py::handle value, const char* name, std::size_t count,
                                          const char* each = "worlds");
/// `count` truth values; None: all true.
[[nodiscard]] std::vector<char> mask(py::handle value, const char* name, std::size_t count);

[[nodiscard]] py::tuple tuple_of(const Vector3& v);
/// w, x, y, z.
[[nodiscard]] py::tuple tuple_of(const Quaternion& q);

}  // namespace sheave::python
