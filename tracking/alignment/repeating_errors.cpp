// SPDX-License-Identifier: BSD-3-Clause
#include "alignment/repeating_errors.hpp"

#include <algorithm>
#include <cmath>

#include "alignment/light_field.hpp"
#include "geometry/se3.hpp"

namespace photonav {
namespace {

using Eigen::MatrixXd;

constexpr double kFieldLength = 0.25;  // correlation length of gain and displacement [image widths]

/// The blocks of an image, and the light field that was eliminated from them.
struct BlockImage {
    const std::vector<ImageBlock>& blocks;
    const LightField& light;
    Eigen::Array2i size;  ///< [blocks]
};

/// Scatter of Atr by a field over the image that varies slowly: sum_ab k_ab h_a h_b^T with k_ab the
/// covariance of the field. Independent bumps exp(-|p - c|^2 / l^2), a length l apart, with
/// variances of 2 / pi of the field's, add up to correlations of about exp(-|p - q|^2 / (2 l^2)).
/// @param effect h of a block: what one unit of the field does to its Atr
template <class Effect>
Matrix8 scatterOfField(const BlockImage& image, double variance, const Effect& effect) {
    if (variance == 0.) return Matrix8::Zero();
    const Eigen::Array2i& size = image.size;
    const double length = kFieldLength * size.x();  // [blocks]
    const Eigen::Array2i nodes = (size.cast<double>() / length).ceil().cast<int>() + 3;
    const auto bumps = [&](int axis) {  // of a node (row) at a block (column)
        return MatrixXd::NullaryExpr(
                   nodes[axis], size[axis],
                   [&](auto node, auto block) {
                       return std::exp(-std::pow((block + 0.5) / length + 1. - node, 2));
                   })
            .eval();
    };
    const MatrixXd bumpsX = bumps(0), bumpsY = bumps(1);
    std::vector<Vector8> pull(std::size_t(nodes.prod()), Vector8::Zero());
    for (const ImageBlock& block : image.blocks) {
        const Vector8 h = image.light.unexplained(block, effect(block));
        for (int j = 0; j < nodes.y(); ++j) {
            const double byRow = bumpsY(j, block.index.y());
            if (byRow < 1e-3) continue;
            for (int i = 0; i < nodes.x(); ++i) {
                pull[std::size_t(j) * nodes.x() + i] += byRow * bumpsX(i, block.index.x()) * h;
            }
        }
    }
    Matrix8 sum = Matrix8::Zero();
    for (const Vector8& p : pull) sum += p * p.transpose();
    return 2. / EIGEN_PI * variance * sum;
}

/// Gains that vary slowly over the image, but faster than the light field: those of the blocks, and
/// their variance.
class Shading {
  public:
    /// @param x the step to the minimum of the image alone
    Shading(const BlockImage& image, const Vector8& x) : image_(image) {
        std::vector<const ImageBlock*> at(std::size_t(image.size.prod()), nullptr);
        for (const ImageBlock& block : image.blocks) at[number(block.index)] = &block;
        double product = 0., weight = 0.;
        for (const ImageBlock& block : image.blocks) {
            for (const Eigen::Array2i& step : {Eigen::Array2i(1, 0), Eigen::Array2i(0, 1)}) {
                const Eigen::Array2i next = block.index + step;
                if ((next >= image.size).any() || at[number(next)] == nullptr) continue;
                const ImageBlock& other = *at[number(next)];
                const double w = std::min(block.AtA(6, 6), other.AtA(6, 6));
                product += w * gain(block, x) * gain(other, x);
                weight += w;
            }
        }
        variance_ = weight > 0. ? std::max(0., product / weight) : 0.;
    }

    /// Effect of the gains on Atr, squared.
    Matrix8 scatter() const {
        return scatterOfField(image_, variance_,
                              [](const ImageBlock& block) -> Vector8 { return block.AtA.col(6); });
    }

  private:
    std::size_t number(const Eigen::Array2i& index) const {
        return std::size_t(index.y()) * image_.size.x() + index.x();
    }
    /// By the residuals of the block alone.
    double gain(const ImageBlock& block, const Vector8& x) const {
        return image_.light.residual(block, x)[6] / std::max(block.AtA(6, 6), 1e-12);
    }

    const BlockImage& image_;
    double variance_ = 0.;
};

/// Pixel in the middle of a block.
Eigen::Array2d middleOf(const ImageBlock& block, double side) {
    return side * (block.index.cast<double>() + 0.5) - 0.5;
}

/// The image's content displaced by a field of a standard deviation of `sigma` pixels. A rotation
/// of the camera displaces a block in the same way.
Matrix8 scatterByDisplacement(const BlockImage& image, const Camera& camera, double sigma) {
    const double side = ImageBlock::side(camera);
    Matrix8 sum = Matrix8::Zero();
    for (int axis = 0; axis < 2; ++axis) {
        const auto byRotating = [&](const ImageBlock& block) -> Vector8 {
            const Eigen::Array2d pixel = middleOf(block, side);
            const Eigen::Vector3d p = camera.unproject(pixel.x(), pixel.y());
            const Eigen::Matrix2d byRotation =  // pixels by radians about x and y
                (camera.projectionJacobian(p) * -hat(p)).leftCols<2>();
            return block.AtA.middleCols<2>(3) * byRotation.inverse().col(axis);
        };
        sum += scatterOfField(image, sigma * sigma, byRotating);
    }
    return sum;
}

/// Images blurrier, or less blurred, than the model.
Matrix8 scatterByBlur(const BlockImage& image, double sigma) {
    return scatterOfField(image, sigma * sigma,
                          [](const ImageBlock& block) -> Vector8 { return block.byBlur.Atb; });
}

/// All surfaces displaced along their normals by the same distance.
Matrix8 scatterBySurface(const BlockImage& image, double sigma) {
    if (sigma == 0.) return Matrix8::Zero();
    Vector8 sum = Vector8::Zero();
    for (const ImageBlock& block : image.blocks) {
        sum += image.light.unexplained(block, block.AtA.leftCols<3>() * block.normal);
    }
    return sigma * sigma * sum * sum.transpose();
}

}  // namespace

Matrix6 covarianceByScale(double share, const Pose& motion) {
    const Vector6 xi = logSE3(motion);
    Vector6 variance;
    variance << Eigen::Vector3d::Constant(xi.head<3>().squaredNorm()),
        Eigen::Vector3d::Constant(xi.tail<3>().squaredNorm());
    return (share * share * variance).asDiagonal();
}

Matrix8 scatterOfRepeatingErrors(const std::vector<ImageBlock>& blocks, const LightField& light,
                                 const Vector8& x, const ModelErrors& errors,
                                 const Camera& camera) {
    const BlockImage image{blocks, light, ImageBlock::numberIn(camera)};
    return Shading(image, x).scatter() + light.priorScatter() +
           scatterByDisplacement(image, camera, errors.displacement) +
           scatterByBlur(image, errors.blur) + scatterBySurface(image, errors.surface);
}

}  // namespace photonav
