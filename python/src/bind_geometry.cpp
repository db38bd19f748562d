// SPDX-License-Identifier: BSD-3-Clause
// Cameras, poses and covariances.
#include <fmt/format.h>

#include "bindings.hpp"
#include "config/config_keys.hpp"
#include "conversions.hpp"
#include "geometry/camera.hpp"
#include "geometry/constants.hpp"
#include "geometry/se3.hpp"
#include "geometry/uncertain_pose.hpp"

namespace photonav::python {
namespace {

Array cameraPose(const Array& position, double yaw, const py::object& mount) {
    const auto degrees = mountDegrees(py::str(mount));
    if (!degrees) {
        throw py::value_error(
            "mount: expected down, front45, forward or degrees below the horizon");
    }
    return arrayOf(lookFrom(vectorOf(position, 3, "position"), *degrees * kDegree, yaw));
}

Matrix6 covarianceOf(const Array& array, const char* name) {
    const Matrix6 matrix = matrixOf(array, name);
    if (!isCovariance(matrix)) {
        throw py::value_error(std::string(name) + ": not positive semi-definite");
    }
    return matrix;
}

}  // namespace

void bindGeometry(py::module_& module) {
    using namespace py::literals;
    py::class_<Camera>(module, "Camera",
                       "An undistorted pinhole camera with square pixels, principal point in the "
                       "centre.")
        .def(py::init([](unsigned width, unsigned height, double hfov) {
                 return makeCamera(width, height, hfov * kDegree);
             }),
             "width"_a = 188, "height"_a = 120, "hfov"_a = 70.,
             "hfov: horizontal field of view in degrees.")
        .def_readonly("width", &Camera::width, "Columns of an image.")
        .def_readonly("height", &Camera::height, "Rows of an image.")
        .def_property_readonly("fx", &Camera::fx, "Focal length along x [pixels].")
        .def_property_readonly("fy", &Camera::fy, "Focal length along y [pixels].")
        .def_property_readonly("cx", &Camera::cx, "Principal point, column [pixels].")
        .def_property_readonly("cy", &Camera::cy, "Principal point, row [pixels].")
        .def("__repr__", [](const Camera& c) {
            return fmt::format("<Camera {}x{}, fx {:.1f}, fy {:.1f}, cx {:.1f}, cy {:.1f}>",
                               c.width, c.height, c.fx(), c.fy(), c.cx(), c.cy());
        });
    module.def("camera_pose", &cameraPose, "position"_a, "yaw"_a = 0., "mount"_a = "down",
               "T_c_w of a camera on a level body at a position [m] with a heading [rad]. mount: "
               "down, front45, forward or degrees below the horizon.");
    module.def(
        "exp_se3", [](const Array& xi) { return arrayOf(expSE3(vectorOf(xi, 6, "xi"))); }, "xi"_a,
        "The rigid motion (4, 4) of a twist (6,): translation [m], then rotation [rad].");
    module.def(
        "log_se3", [](const Array& T) -> Vector6 { return logSE3(poseOf(T, "T")); }, "T"_a,
        "The twist (6,) of a rigid motion (4, 4), of at most half a turn: the inverse of "
        "exp_se3().");
    module.def(
        "adjoint", [](const Array& T) -> Matrix6 { return adjoint(poseOf(T, "T")); }, "T"_a,
        "Ad(T) (6, 6), which maps twists between frames: T exp(xi) T^-1 = exp(Ad(T) xi).");
    module.def(
        "compound",
        [](const Array& T_c_b, const Array& motion, const Array& T_b_a, const Array& covariance) {
            const UncertainPose T_c_a =
                compound({poseOf(T_c_b, "T_c_b"), covarianceOf(motion, "motion")},
                         {poseOf(T_b_a, "T_b_a"), covarianceOf(covariance, "covariance")});
            return py::make_tuple(arrayOf(T_c_a.mean), T_c_a.covariance);
        },
        "T_c_b"_a, "motion"_a, "T_b_a"_a, "covariance"_a,
        "T_c_a = T_c_b T_b_a with its covariance, to fourth order.");
    module.def(
        "update",
        [](const Array& covariance, const Array& information) -> Matrix6 {
            return updateCovariance(covarianceOf(covariance, "covariance"),
                                    covarianceOf(information, "information"));
        },
        "covariance"_a, "information"_a,
        "Covariance after a measurement: (information + covariance^-1)^-1, also for singular "
        "ones.");
}

}  // namespace photonav::python
