#include "python/bindings/arguments.h"

#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "python/bindings/errors.h"

namespace sheave::python {
namespace {

/// The appearance of a value in a message.
std::string shown(py::handle value) {
  constexpr std::size_t longest = 80;
  std::string text = "<" + std::string(Py_TYPE(value.ptr())->tp_name) + ">";
  // An object's repr may be invalid Unicode, or fail.
  const auto own = py::reinterpret_steal<py::object>(PyObject_Repr(value.ptr()));
  const char* const utf8 = own ? PyUnicode_AsUTF8(own.ptr()) : nullptr;
  if (utf8 != nullptr) text = utf8;
  PyErr_Clear();
  for (char& c : text) {
    if (c == '\n') c = ' ';
  }
  if (text.size() <= longest) return text;
  std::size_t end = longest;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  return text.substr(0, end) + "...";
}

/// Reads a number as a double; false if the value is no number.
bool read(py::handle value, double& number) {
  if (PyFloat_CheckExact(value.ptr())) {
    number = PyFloat_AS_DOUBLE(value.ptr());
    return true;
  }
  if (PyUnicode_Check(value.ptr()) || value.is_none()) return false;
  // NumPy would convert an array with a single element to that number.
  if (py::isinstance<py::array>(value) && py::reinterpret_borrow<py::array>(value).ndim() > 0) {
    return false;
  }
  number = PyFloat_AsDouble(value.ptr());
  if (number != -1.0 || PyErr_Occurred() == nullptr) return true;
  PyErr_Clear();
  return false;
}

/// Whether NumPy can use the memory of the value directly: an array, a buffer, a column of pandas.
bool is_array(py::handle value) {
  return py::isinstance<py::array>(value) || PyObject_CheckBuffer(value.ptr()) != 0 ||
         PyObject_HasAttrString(value.ptr(), "__array__") != 0;
}

/// The items of a sequence other than an array. Converting an item to a number may run Python code
/// that empties a list while NumPy reads it; a tuple cannot change.
std::optional<py::tuple> items_of(py::handle value) {
  if (is_array(value) || PyUnicode_Check(value.ptr()) || PySequence_Check(value.ptr()) == 0) {
    return {};
  }
  auto items = py::reinterpret_steal<py::object>(PySequence_Tuple(value.ptr()));
  if (!items) {
    PyErr_Clear();
    return {};
  }
  return py::reinterpret_borrow<py::tuple>(items);
}

/// A truth value of Python or NumPy.
std::optional<bool> truth_value(py::handle item) {
  if (PyBool_Check(item.ptr())) return item.ptr() == Py_True;
  if (std::string_view(Py_TYPE(item.ptr())->tp_name) != "numpy.bool_") return {};
  return PyObject_IsTrue(item.ptr()) == 1;
}

/// Exactly `Count` finite numbers.
template <std::size_t Count>
std::array<double, Count> components(py::handle value, const char* name, const char* allowed) {
  std::array<double, Count> read_ones{};
  if (PyUnicode_Check(value.ptr()) || PySequence_Check(value.ptr()) == 0) {
    refuse(name, value, allowed);
  }
  const auto items = py::reinterpret_steal<py::object>(PySequence_Fast(value.ptr(), ""));
  if (!items) {
    PyErr_Clear();
    refuse(name, value, allowed);
  }
  for (std::size_t i = 0; i < Count; ++i) {
    // Converting an item to a number may run Python code that changes the list.
    if (PySequence_Fast_GET_SIZE(items.ptr()) != static_cast<Py_ssize_t>(Count)) {
      refuse(name, value, allowed);
    }
    const auto item = py::reinterpret_borrow<py::object>(
        PySequence_Fast_GET_ITEM(items.ptr(), static_cast<Py_ssize_t>(i)));
    if (!read(item, read_ones[i]) || !std::isfinite(read_ones[i])) refuse(name, value, allowed);
  }
  return read_ones;
}

}  // namespace

void refuse(const char* name, py::handle value, const std::string& allowed) {
  raise("ArgumentError", std::string(name) + ": must be " + allowed + ", was " + shown(value));
}

double number(py::handle value, const char* name) {
  double result = 0.0;
  if (!read(value, result)) refuse(name, value, "a number");
  return result;
}

std::optional<double> optional_number(py::handle value, const char* name) {
  if (value.is_none()) return {};
  double result = 0.0;
  if (!read(value, result)) refuse(name, value, "a number or None");
  return result;
}

std::int64_t integer(py::handle value, const char* name, std::int64_t least, std::int64_t most) {
  const auto index = py::reinterpret_steal<py::object>(PyNumber_Index(value.ptr()));
  long long read_one = 0;
  int overflow = 0;
  if (index) {
    read_one = PyLong_AsLongLongAndOverflow(index.ptr(), &overflow);
  } else {
    PyErr_Clear();
  }
  if (!index || overflow != 0 || read_one < least || read_one > most) {
    refuse(name, value, "an integer from " + std::to_string(least) + " to " + std::to_string(most));
  }
  return read_one;
}

bool truth(py::handle value, const char* name) {
  if (value.is_none() || PyUnicode_Check(value.ptr())) refuse(name, value, "True or False");
  const int result = PyObject_IsTrue(value.ptr());
  if (result < 0) {
    PyErr_Clear();
    refuse(name, value, "True or False");
  }
  return result != 0;
}

std::string text(py::handle value, const char* name) {
  if (!PyUnicode_Check(value.ptr())) refuse(name, value, "a string");
  Py_ssize_t size = 0;
  const char* data = PyUnicode_AsUTF8AndSize(value.ptr(), &size);
  if (data == nullptr) {
    PyErr_Clear();
    refuse(name, value, "a string of valid Unicode");
  }
  return {data, static_cast<std::size_t>(size)};
}

void check_callback(py::handle value, const char* name) {
  if (!value.is_none() && PyCallable_Check(value.ptr()) == 0) {
    refuse(name, value, "a function of the simulation, or None");
  }
}

std::vector<std::string> texts(py::handle value, const char* name) {
  if (PyUnicode_Check(value.ptr()) || PySequence_Check(value.ptr()) == 0) {
    refuse(name, value, "a list of strings");
  }
  const auto items = py::reinterpret_steal<py::object>(PySequence_Tuple(value.ptr()));
  if (!items) {
    PyErr_Clear();
    refuse(name, value, "a list of strings");
  }
  std::vector<std::string> result;
  for (const py::handle item : py::reinterpret_borrow<py::tuple>(items)) {
    if (!PyUnicode_Check(item.ptr())) refuse(name, value, "a list of strings");
    result.push_back(text(item, name));
  }
  return result;
}

Vector3 vector(py::handle value, const char* name) {
  const auto v = components<3>(value, name, "three finite numbers (x, y, z)");
  return {v[0], v[1], v[2]};
}

std::optional<Vector3> optional_vector(py::handle value, const char* name) {
  if (value.is_none()) return {};
  return vector(value, name);
}

Quaternion quaternion(py::handle value, const char* name) {
  constexpr const char* allowed = "a quaternion of length 1 (w, x, y, z)";
  const auto q = components<4>(value, name, allowed);
  const Quaternion result(q[0], q[1], q[2], q[3]);
  constexpr double slop = 1e-6;
  if (!(std::abs(result.norm() - 1.0) < slop)) refuse(name, value, allowed);
  return result;
}

std::optional<Quaternion> optional_quaternion(py::handle value, const char* name) {
  if (value.is_none()) return {};
  return quaternion(value, name);
}

DriveTarget target(py::handle value, py::handle over, py::handle rate) {
  DriveTarget result(number(value, "value"));
  result.over = optional_number(over, "over");
  result.rate = optional_number(rate, "rate");
  return result;
}

std::vector<double> numbers(py::handle value, const char* name, std::size_t count,
                            const char* each) {
  double one = 0.0;
  const std::string allowed =
      "a number, or one for each of the " + std::to_string(count) + " " + each;
  if (PyUnicode_Check(value.ptr()) || PyBytes_Check(value.ptr())) refuse(name, value, allowed);
  if (const auto items = items_of(value)) {
    std::vector<double> result;
    for (const py::handle item : *items) {
      if (!read(item, one)) refuse(name, value, allowed);
      result.push_back(one);
    }
    if (result.size() != count) refuse(name, value, allowed);
    return result;
  }
  if (!is_array(value)) {
    if (!read(value, one)) refuse(name, value, allowed);
    return std::vector<double>(count, one);
  }
  const auto array = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(value);
  if (!array) {
    PyErr_Clear();
    refuse(name, value, allowed);
  }
  if (array.ndim() == 0) return std::vector<double>(count, *array.data());
  if (array.ndim() != 1 || static_cast<std::size_t>(array.size()) != count) {
    refuse(name, value, allowed);
  }
  return {array.data(), array.data() + array.size()};
}

std::vector<char> mask(py::handle value, const char* name, std::size_t count) {
  if (value.is_none()) return std::vector<char>(count, 1);
  const std::string allowed = "None, or " + std::to_string(count) + " truth values";
  if (const auto items = items_of(value)) {
    std::vector<char> result;
    for (const py::handle item : *items) {
      const std::optional<bool> truth = truth_value(item);
      if (!truth) refuse(name, value, allowed);
      result.push_back(*truth ? 1 : 0);
    }
    if (result.size() != count) refuse(name, value, allowed);
    return result;
  }
  if (!is_array(value)) refuse(name, value, allowed);
  const auto array = py::array::ensure(value);
  if (!array) PyErr_Clear();
  if (!array || array.dtype().kind() != 'b' || array.ndim() != 1 ||
      static_cast<std::size_t>(array.size()) != count) {
    refuse(name, value, allowed);
  }
  const auto flags = py::array_t<bool, py::array::c_style | py::array::forcecast>::ensure(array);
  return {flags.data(), flags.data() + flags.size()};
}

py::tuple tuple_of(const Vector3& v) { return py::make_tuple(v.x(), v.y(), v.z()); }
py::tuple tuple_of(const Quaternion& q) { return py::make_tuple(q.w(), q.x(), q.y(), q.z()); }

}  // namespace sheave::python
