// SPDX-License-Identifier: BSD-3-Clause
#include "conversions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>

namespace photonav::python {
namespace {

constexpr double kRigid = 1e-6;     // of R^T R - 1, that numbers of files have
constexpr float kMostNoise = 0.1F;  // of grey values beyond 0 and 1

template <int N>
Eigen::Matrix<double, N, N> squareOf(const Array& array, const char* name) {
    if (array.ndim() != 2 || array.shape(0) != N || array.shape(1) != N) {
        throw std::invalid_argument(
            fmt::format("{}: expected an array of shape ({}, {})", name, N, N));
    }
    using RowMajor = Eigen::Matrix<double, N, N, Eigen::RowMajor>;
    const Eigen::Matrix<double, N, N> matrix = Eigen::Map<const RowMajor>(array.data());
    if (!matrix.allFinite()) throw std::invalid_argument(fmt::format("{}: not finite", name));
    return matrix;
}

template <int Rows, int Columns, typename Value>
Array stackedMatrices(const std::vector<Value>& values) {
    Array array({static_cast<py::ssize_t>(values.size()), py::ssize_t{Rows}, py::ssize_t{Columns}});
    double* out = array.mutable_data();
    for (const Value& value : values) {
        using RowMajor = Eigen::Matrix<double, Rows, Columns, Eigen::RowMajor>;
        Eigen::Map<RowMajor>{out} = value.matrix();
        out += Rows * Columns;
    }
    return array;
}

std::span<float> pixelsOf(ImageF& image) { return {image.bitmap, image.getSize()}; }

/// An image without what computations would pass over in silence.
ImageF imageOf(const FloatArray& array, const char* name, const Camera& camera) {
    if (array.ndim() != 2 || array.shape(0) != camera.height || array.shape(1) != camera.width) {
        throw std::invalid_argument(fmt::format("{}: expected the camera's shape ({}, {})", name,
                                                camera.height, camera.width));
    }
    ImageF image(camera.height, camera.width);
    std::copy(array.data(), array.data() + array.size(), image.bitmap);
    if (std::ranges::all_of(pixelsOf(image), [](float v) { return std::isfinite(v); })) {
        return image;
    }
    throw std::invalid_argument(
        fmt::format("{}: not finite (a depth of 0 stands for no surface)", name));
}

}  // namespace

Pose poseOf(const Array& array, const char* name) {
    const Eigen::Matrix4d matrix = squareOf<4>(array, name);
    const Eigen::Matrix3d R = matrix.topLeftCorner<3, 3>();
    const bool isRigid = (R.transpose() * R).isIdentity(kRigid) && R.determinant() > 0. &&
                         matrix.row(3).isApprox(Eigen::RowVector4d(0., 0., 0., 1.), kRigid);
    if (!isRigid) throw std::invalid_argument(fmt::format("{}: not a rigid motion", name));
    Pose pose = Pose::Identity();
    pose.linear() = Eigen::Quaterniond(R).normalized().toRotationMatrix();
    pose.translation() = matrix.topRightCorner<3, 1>();
    return pose;
}

Array arrayOf(const Pose& pose) {
    Array array({4, 4});
    Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>{array.mutable_data()} = pose.matrix();
    return array;
}

Matrix6 matrixOf(const Array& array, const char* name) {
    const Matrix6 matrix = squareOf<6>(array, name);
    if (!matrix.isApprox(matrix.transpose(), 1e-9) && !matrix.isZero(0.)) {
        throw std::invalid_argument(fmt::format("{}: not symmetric", name));
    }
    return 0.5 * (matrix + matrix.transpose());
}

Eigen::VectorXd vectorOf(const Array& array, py::ssize_t size, const char* name) {
    if (array.ndim() != 1 || array.shape(0) != size) {
        throw std::invalid_argument(fmt::format("{}: expected {} numbers", name, size));
    }
    const Eigen::VectorXd vector = Eigen::Map<const Eigen::VectorXd>(array.data(), size);
    if (!vector.allFinite()) throw std::invalid_argument(fmt::format("{}: not finite", name));
    return vector;
}

FloatArray arrayOf(const ImageF& image) {
    FloatArray array(
        {static_cast<py::ssize_t>(image.getHeight()), static_cast<py::ssize_t>(image.getWidth())});
    std::copy(image.bitmap, image.bitmap + image.getSize(), array.mutable_data());
    return array;
}

View viewOf(const py::object& image, const FloatArray& depth, const Camera& camera) {
    const FloatArray pixels = FloatArray::ensure(image);
    if (!pixels) {
        PyErr_Clear();
        throw std::invalid_argument("image: expected an array of numbers");
    }
    const py::array given = py::array::ensure(image);
    const bool isBytes = given.dtype().kind() == 'u' && given.itemsize() == 1;
    View view{imageOf(pixels, "image", camera), imageOf(depth, "depth", camera)};
    if (isBytes) {
        for (float& grey : pixelsOf(view.intensity)) grey /= 255.F;
    }
    const auto [least, most] = std::ranges::minmax_element(pixelsOf(view.intensity));
    if (*least < -kMostNoise || *most > 1.F + kMostNoise) {
        throw std::invalid_argument(fmt::format(
            "image: expected grey values in [0, 1], found {:.4g} to {:.4g}", *least, *most));
    }
    return view;
}

Array stacked(const std::vector<Pose>& poses) { return stackedMatrices<4, 4>(poses); }
Array stacked(const std::vector<Matrix6>& matrices) { return stackedMatrices<6, 6>(matrices); }

Array stacked(const std::vector<Eigen::Vector3d>& points) {
    Array array({static_cast<py::ssize_t>(points.size()), py::ssize_t{3}});
    double* out = array.mutable_data();
    for (const Eigen::Vector3d& point : points)
        out = std::copy(point.data(), point.data() + 3, out);
    return array;
}

Array stacked(const std::vector<double>& numbers) {
    return Array(static_cast<py::ssize_t>(numbers.size()), numbers.data());
}

std::string pathOf(const py::object& path) {
    return py::module_::import("os").attr("fspath")(path).cast<std::string>();
}

py::object objectOf(const nlohmann::json& json) {
    return py::module_::import("json").attr("loads")(
        json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

}  // namespace photonav::python
