// SPDX-License-Identifier: BSD-3-Clause
#include "alignment/light_field.hpp"

#include <gtest/gtest.h>

#include "alignment/dense_aligner.hpp"
#include "estimation/calibration.hpp"
#include "tracking/rooms.hpp"

namespace photonav {
namespace {

constexpr double kPixelVariance = 4e-4, kFieldSigma = 0.05;

Camera fieldCamera() { return makeCamera(188, 120, 1.2); }

/// Blocks all over the image, with the sums of some random pixels.
std::vector<ImageBlock> randomBlocks() {
    std::srand(1);
    const Eigen::Array2i size = ImageBlock::numberIn(fieldCamera());
    std::vector<ImageBlock> blocks;
    for (int i = 0; i < size.prod(); i += 3) {
        const Eigen::Matrix<double, 12, 8> A = Eigen::Matrix<double, 12, 8>::Random();
        ImageBlock& block = blocks.emplace_back();
        block.index = {i % size.x(), i / size.x()};
        block.AtA = A.transpose() * A;
        block.Atr = A.transpose() * Eigen::Matrix<double, 12, 1>::Random();
    }
    return blocks;
}

/// The field's terms at a block, written out.
Eigen::Matrix<double, 5, 1> termsAt(const ImageBlock& block) {
    const Eigen::Array2i size = ImageBlock::numberIn(fieldCamera());
    const double x = (2. * block.index.x() + 1.) / size.x() - 1.;
    const double y = (2. * block.index.y() + 1.) / size.y() - 1.;
    return Eigen::Matrix<double, 5, 1>{x, y, (3. * x * x - 1.) / 2., (3. * y * y - 1.) / 2., x * y};
}

TEST(LightField, EliminationIsTheSchurComplement) {
    using Dense = Eigen::Matrix<double, 13, 13>;
    const std::vector<ImageBlock> blocks = randomBlocks();
    Dense H = Dense::Zero();
    Eigen::Matrix<double, 13, 1> g = Eigen::Matrix<double, 13, 1>::Zero();
    for (const ImageBlock& block : blocks) {
        Eigen::Matrix<double, 8, 13> whole = Eigen::Matrix<double, 8, 13>::Zero();
        whole.leftCols<8>().setIdentity();
        whole.block<1, 5>(6, 8) = termsAt(block).transpose();  // the field is a gain
        H += whole.transpose() * block.AtA * whole;
        g += whole.transpose() * block.Atr;
    }
    const LightField light(blocks, fieldCamera(), kFieldSigma, kPixelVariance);
    EXPECT_GT(light.noise(), kPixelVariance);  // the blocks do not look like one field
    H.diagonal().tail<5>().array() += light.noise() / (kFieldSigma * kFieldSigma);
    const Eigen::Matrix<double, 8, 5> toField =
        H.topRightCorner<8, 5>() * H.bottomRightCorner<5, 5>().inverse();
    const Matrix8 schur = H.topLeftCorner<8, 8>() - toField * H.bottomLeftCorner<5, 8>();
    const Vector8 right = g.head<8>() - toField * g.tail<5>();

    Matrix8 AtA = light.priorAtA();
    Vector8 Atr = light.priorAtr();
    for (const ImageBlock& block : light.eliminatedFrom(blocks)) {
        AtA += block.AtA;
        Atr += block.Atr;
    }
    EXPECT_LT((AtA - schur).norm(), 1e-10 * schur.norm());
    EXPECT_LT((Atr - right).norm(), 1e-10 * right.norm());
    NormalEquations whole;
    whole.AtA = H.topLeftCorner<8, 8>();
    whole.Atr = g.head<8>();
    const NormalEquations eliminated = light.eliminatedFrom(whole);
    EXPECT_LT((eliminated.AtA - schur).norm(), 1e-10 * schur.norm());
    EXPECT_LT((eliminated.Atr - right).norm(), 1e-10 * right.norm());
    const double gained = g.tail<5>().dot(H.bottomRightCorner<5, 5>().ldlt().solve(g.tail<5>()));
    EXPECT_NEAR(eliminated.loss, -gained, 1e-10 * gained);
    EXPECT_NEAR(eliminated.sumSquares, -gained, 1e-10 * gained);

    // What is left of the blocks at a step and its field is what is left of the dense equations.
    const Vector8 x = Vector8::Random();
    const Eigen::Matrix<double, 5, 1> field =
        H.bottomRightCorner<5, 5>().ldlt().solve(g.tail<5>() - H.bottomLeftCorner<5, 8>() * x);
    Vector8 residual = Vector8::Zero();
    for (const ImageBlock& block : blocks) residual += light.residual(block, x);
    const Vector8 dense =
        g.head<8>() - H.topLeftCorner<8, 8>() * x - H.topRightCorner<8, 5>() * field;
    EXPECT_LT((residual - dense).norm(), 1e-10 * g.norm());
}

/// Fields as large as the prior says do to the estimate what their covariance says.
TEST(LightField, OnlyThePriorIsLeftOfAField) {
    const std::vector<ImageBlock> blocks = randomBlocks();
    for (const double noise : {1., 1e3}) {
        const LightField light(blocks, fieldCamera(), kFieldSigma, noise);
        Matrix8 expected = Matrix8::Zero();
        for (int term = 0; term < 5; ++term) {
            Vector8 sum = Vector8::Zero();
            for (const ImageBlock& block : blocks) {
                const Vector8 change = kFieldSigma * termsAt(block)[term] * block.AtA.col(6);
                sum += light.unexplained(block, change);
            }
            expected += sum * sum.transpose();
        }
        const Matrix8 scatter = light.priorScatter();
        EXPECT_LT((scatter - expected).norm(), 1e-8 * expected.norm());
        EXPECT_GT(scatter.norm(), 0.);
    }
}

TEST(LightField, IsNoneWithoutSigma) {
    const std::vector<ImageBlock> blocks = randomBlocks();
    const LightField none(blocks, fieldCamera(), 0., kPixelVariance);
    EXPECT_EQ(none.eliminatedFrom(blocks)[7].AtA, blocks[7].AtA);
    EXPECT_EQ(none.unexplained(blocks[7], blocks[7].Atr), blocks[7].Atr);
    EXPECT_TRUE(none.priorAtA().isZero(0.));
}

/// A lens that loses a sixth of the light in the corners, light from the side, and over little
/// texture: where the field is not estimated, the pose absorbs it.
TEST(LightField, MakesUpForALensAndForLightFromTheSide) {
    const MeshRenderer floor(test::floorOf(valueNoise(
        {.size = {20., 20.}, .cells = {1.5, 0.5, 0.2}, .amplitudes = {0.15, 0.1, 0.1}})));
    std::mt19937_64 random(2);
    const auto meanError = [&](double light, double& nees) {  // [m]
        AlignmentOptions options = realCameraOptions();
        options.modelErrors.light = light;
        DenseAligner aligner(floor, fieldCamera(), options);
        constexpr int kCount = 10;
        double error = 0.;
        nees = 0.;
        for (int i = 0; i < kCount; ++i) {
            const Pose truth = lookFrom({0.3 * i, -0.2 * i, 1.5}, test::kDown);
            ImageF image = test::photographed(floor, fieldCamera(), truth).intensity;
            for (unsigned v = 0; v < image.getHeight(); ++v) {
                for (unsigned u = 0; u < image.getWidth(); ++u) {
                    const double x = u / 93.5 - 1., y = v / 59.5 - 1.;
                    image[v][u] *= float((1. - 0.08 * (x * x + y * y)) * (1. + 0.1 * x - 0.05 * y));
                }
            }
            const UncertainPose prior{truth, 1e-2 * Matrix6::Identity()};
            const Alignment a = aligner.align(test::noisy(image, 0.005, random), prior);
            if (light > 0.) {
                EXPECT_EQ(a.verdict, Verdict::converged) << describe(a);
            }
            error += (a.T_c_w * truth.inverse()).translation().norm() / kCount;
            nees += test::neesOf(a, truth) / kCount;
        }
        return error;
    };
    double nees = 0., neesWithout = 0.;
    const double with = meanError(realCameraOptions().modelErrors.light, nees);
    const double without = meanError(0., neesWithout);
    std::cout << "errors [m]: " << with << ", not estimated " << without
              << "; NEES per dof: " << nees << ", " << neesWithout << '\n';
    EXPECT_LT(with, 0.1 * without);
    EXPECT_GT(nees, 0.2);
    EXPECT_LT(nees, 2.);
}

/// Over texture that is as weak as the vignetting, the pose absorbs it unless it is estimated, and
/// no residual shows it.
TEST(LightField, VignettingOverLittleTextureIsEstimated) {
    const MeshRenderer floor(test::floorOf(valueNoise(
        {.size = {20., 20.}, .cells = {1.5, 0.5, 0.2}, .amplitudes = {0.012, 0.006, 0.006}})));
    const Camera camera = makeCamera(188, 120, 1.2217);
    std::mt19937_64 random(1);
    const auto errorAndNees = [&](double light) -> Eigen::Vector2d {  // means
        AlignmentOptions options = realCameraOptions();
        options.modelErrors.light = light;
        DenseAligner aligner(floor, camera, options);
        constexpr int kCount = 10;
        Eigen::Vector2d sum = Eigen::Vector2d::Zero();
        for (int i = 0; i < kCount; ++i) {
            const Pose truth = lookFrom({0.3 * i, -0.2 * i, 1.5}, test::kDown);
            ImageF image = test::photographed(floor, camera, truth).intensity;
            for (unsigned v = 0; v < image.getHeight(); ++v) {
                for (unsigned u = 0; u < image.getWidth(); ++u) {
                    const Eigen::Vector2d centre(0.5 * camera.width, 0.5 * camera.height);
                    const double share = (Eigen::Vector2d(u, v) - centre).norm() / centre.norm();
                    image[v][u] *= static_cast<float>(1. - 0.03 * share * share);
                }
            }
            image = test::noisy(image, 0.005, random);
            const UncertainPose prior{truth, 1e-2 * Matrix6::Identity()};
            const Alignment a = aligner.align(image, prior);
            const double error = (a.T_c_w * truth.inverse()).translation().norm();
            sum += Eigen::Vector2d(error, test::neesOf(a, truth)) / kCount;
        }
        return sum;
    };
    const Eigen::Vector2d with = errorAndNees(realCameraOptions().modelErrors.light);
    const Eigen::Vector2d without = errorAndNees(0.);
    std::cout << "error [m] and NEES per dof: " << with.transpose() << ", not estimated "
              << without.transpose() << '\n';
    EXPECT_LT(with[0], 0.5 * without[0]);
    EXPECT_LT(with[1], 2.);
}

}  // namespace
}  // namespace photonav
