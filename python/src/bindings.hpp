// SPDX-License-Identifier: BSD-3-Clause
// The parts of the module.
#pragma once

#include <pybind11/pybind11.h>

namespace photonav::python {

namespace py = pybind11;

void bindGeometry(py::module_& module);
void bindViews(py::module_& module);
void bindPlanning(py::module_& module);
void bindReplay(py::module_& module);

}  // namespace photonav::python
