// SPDX-License-Identifier: BSD-3-Clause
// Between numpy arrays and our types.
#pragma once

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "geometry/types.hpp"
#include "photometry/view.hpp"

namespace photonav::python {

namespace py = pybind11;

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;
using FloatArray = py::array_t<float, py::array::c_style | py::array::forcecast>;

/// @throws std::invalid_argument naming the argument unless it is a finite 4x4 rigid motion
Pose poseOf(const Array& array, const char* name);
Array arrayOf(const Pose& pose);

/// @throws std::invalid_argument naming the argument unless it is finite, symmetric, 6x6
Matrix6 matrixOf(const Array& array, const char* name);

/// @throws std::invalid_argument unless it has so many finite numbers
Eigen::VectorXd vectorOf(const Array& array, py::ssize_t size, const char* name);

FloatArray arrayOf(const ImageF& image);
/// @param image grey values in [0, 1], or bytes, which are divided by 255
/// @throws std::invalid_argument unless both are finite and of the camera's size, and the grey
///         values are in their range, give or take noise
View viewOf(const py::object& image, const FloatArray& depth, const Camera& camera);

Array stacked(const std::vector<Pose>& poses);              ///< (N, 4, 4)
Array stacked(const std::vector<Matrix6>& matrices);        ///< (N, 6, 6)
Array stacked(const std::vector<Eigen::Vector3d>& points);  ///< (N, 3)
Array stacked(const std::vector<double>& numbers);          ///< (N,)

/// A str or os.PathLike.
std::string pathOf(const py::object& path);

/// Dictionaries, lists, numbers and texts; null becomes None.
py::object objectOf(const nlohmann::json& json);

}  // namespace photonav::python
