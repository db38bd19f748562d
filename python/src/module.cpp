// SPDX-License-Identifier: BSD-3-Clause
// The Python module photonav; python/photonav/__init__.pyi documents it.
#include <ompl/util/Console.h>

#include "bindings.hpp"
#include "io/error.hpp"

PYBIND11_MODULE(_photonav, module) {
    using namespace photonav::python;
    ompl::msg::noOutputHandler();
    module.attr("__version__") = PHOTONAV_VERSION;
    py::register_exception<photonav::InputError>(module, "InputError", PyExc_ValueError)
        .attr("__doc__") =
        "A file, option or value that cannot be used; the message is \"FILE: KEY: REASON\".";
    bindGeometry(module);
    bindViews(module);
    bindPlanning(module);
    bindReplay(module);
}
