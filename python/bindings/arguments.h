#pragma once
// Reads arguments, and says of a wrong one which it is, what it was, and what is allowed.

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
/// None gives none.
[[nodiscard]] std::optional<double> optional_number(py::handle value, const char* name);
[[nodiscard]] std::int64_t integer(py::handle value, const char* name, std::int64_t least,
                                   std::int64_t most);
[[nodiscard]] bool truth(py::handle value, const char* name);
[[nodiscard]] std::string text(py::handle value, const char* name);
/// Raises if it is neither None nor can be called.
void check_callback(py::handle value, const char* name);
[[nodiscard]] std::vector<std::string> texts(py::handle value, const char* name);
/// Three numbers.
[[nodiscard]] Vector3 vector(py::handle value, const char* name);
[[nodiscard]] std::optional<Vector3> optional_vector(py::handle value, const char* name);
/// Four numbers w, x, y, z.
[[nodiscard]] Quaternion quaternion(py::handle value, const char* name);
[[nodiscard]] std::optional<Quaternion> optional_quaternion(py::handle value, const char* name);
/// Where a drive is to go.
[[nodiscard]] DriveTarget target(py::handle value, py::handle over, py::handle rate);

/// So many numbers, or one for all.
[[nodiscard]] std::vector<double> numbers(py::handle value, const char* name, std::size_t count);
/// So many truth values; None: all.
[[nodiscard]] std::vector<char> mask(py::handle value, const char* name, std::size_t count);

[[nodiscard]] py::tuple tuple_of(const Vector3& v);
/// w, x, y, z.
[[nodiscard]] py::tuple tuple_of(const Quaternion& q);

}  // namespace sheave::python
