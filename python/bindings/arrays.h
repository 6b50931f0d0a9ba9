#pragma once
// NumPy arrays that are copies of vectors and matrices.

#include <algorithm>

#include <pybind11/numpy.h>

#include "statics/modes.h"

namespace sheave::python {

namespace py = pybind11;

[[nodiscard]] inline py::array_t<double> array_of(const ModalVector& values) {
  py::array_t<double> array(values.size());
  std::copy_n(values.data(), values.size(), array.mutable_data());
  return array;
}

[[nodiscard]] inline py::array_t<double> array_of(const ModalMatrix& values) {
  py::array_t<double> array({values.rows(), values.cols()});
  for (Eigen::Index r = 0; r < values.rows(); ++r) {
    for (Eigen::Index c = 0; c < values.cols(); ++c) array.mutable_at(r, c) = values(r, c);
  }
  return array;
}

}  // namespace sheave::python
