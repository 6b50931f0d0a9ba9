#include "python/bindings/errors.h"

#include <pybind11/stl.h>

namespace sheave::python {
namespace {

py::object class_called(const char* name) {
  return py::module_::import("sheave._errors").attr(name);
}

[[noreturn]] void throw_exception(const py::object& exception) {
  PyErr_SetObject(py::type::handle_of(exception).ptr(), exception.ptr());
  throw py::error_already_set();
}

py::dict fault_of(const SceneError& error) {
  py::dict fault;
  fault["file"] = error.file;
  fault["line"] = error.line;
  fault["column"] = error.column;
  fault["pointer"] = error.pointer;
  fault["code"] = std::string(code_name(error.code));
  fault["message"] = error.message;
  fault["value"] = error.value;
  fault["allowed"] = error.allowed;
  return fault;
}

}  // namespace

void raise(const char* kind, const std::string& message) {
  throw_exception(class_called(kind)(message));
}

void raise(const char* kind, const Errors& errors) {
  std::string text;
  py::list faults;
  for (const Error& error : errors) {
    if (!text.empty()) text += '\n';
    if (!error.path.empty()) text += error.path + ": ";
    text += error.message;
    SceneError fault;
    fault.pointer = error.path;
    fault.message = error.message;
    faults.append(fault_of(fault));
  }
  throw_exception(class_called(kind)(text, faults));
}

void raise_scene_error(const std::vector<SceneError>& errors) {
  std::string text;
  py::list faults;
  for (const SceneError& error : errors) {
    if (!text.empty()) text += '\n';
    text += to_string(error);
    faults.append(fault_of(error));
  }
  throw_exception(class_called("SceneError")(text, faults));
}

void raise_scene_error(const std::string& file, const Errors& errors) {
  std::vector<SceneError> faults;
  for (const Error& error : errors) {
    SceneError fault;
    fault.file = file;
    fault.pointer = error.path;
    fault.message = error.message;
    faults.push_back(std::move(fault));
  }
  raise_scene_error(faults);
}

}  // namespace sheave::python
