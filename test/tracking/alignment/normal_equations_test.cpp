// SPDX-License-Identifier: BSD-3-Clause
#include "alignment/normal_equations.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "alignment/image_pyramid.hpp"
#include "analytic_plane.hpp"
#include "tracking/rooms.hpp"

namespace photonav {
namespace {

const Camera& tinyCamera() {
    static const Camera small = makeCamera(94, 61, 1.2);
    return small;
}

View viewAt(const Pose& T_c_w) {
    View view;
    test::room().render(tinyCamera(), T_c_w, view);
    return view;
}

const Pose kViewpoint = lookFrom({2., 3., 1.5}, 0.5);

double relative(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
    return (a - b).norm() / b.norm();
}

/// The plain sums, pixel by pixel, with pixelJacobian().
NormalEquations byPixels(const View& view, const ImageF& observed, const Exposure& exposure,
                         const std::function<double(double)>& weight) {
    NormalEquations e;
    for (unsigned v = 1; v + 1 < tinyCamera().height; ++v) {
        for (unsigned u = 1; u + 1 < tinyCamera().width; ++u) {
            const Vector6 J = pixelJacobian(view, tinyCamera(), u, v);
            if (J.isZero(0.)) continue;
            const double I = view.intensity[v][u];
            const double r = observed[v][u] - (exposure.gain * I + exposure.offset);
            Vector8 A;
            A << -exposure.gain * J, I, 1.;
            const ImageF& at = view.intensity;
            const double b = 0.5 * exposure.gain *
                             (at[v][u + 1] + at[v][u - 1] + at[v + 1][u] + at[v - 1][u] - 4. * I);
            e.byBlur.Atb += weight(r) * A * b;
            e.byBlur.btb += weight(r) * b * b;
            e.byBlur.btr += weight(r) * b * r;
            e.AtA += weight(r) * A * A.transpose();
            e.Atr += weight(r) * A * r;
            e.count += 1.;
            e.sumSquares += r * r;
            e.sum += r;
        }
    }
    return e;
}

TEST(NormalEquations, InformationIsThatOfThePlanner) {
    const View view = viewAt(kViewpoint);
    const PhotometricOptions options;
    ViewComparison compare(tinyCamera(), options);
    const NormalEquations e = compare(view, view.intensity, {}, {});
    const Matrix6 information = e.AtA.topLeftCorner<6, 6>() / (options.sigma * options.sigma);
    EXPECT_LT(relative(information, photometricInformation(view, tinyCamera(), options)), 1e-6);
    EXPECT_EQ(e.sumSquares, 0.);
}

TEST(NormalEquations, AgreeWithTheSumOverPixels) {
    const View view = viewAt(kViewpoint);
    std::mt19937_64 random(1);
    const ImageF observed = test::noisy(view.intensity, 0.1, random);
    const Exposure exposure{1.2, -0.05};
    ViewComparison compare(tinyCamera(), {});
    for (const RobustWeight kind : {RobustWeight::none, RobustWeight::huber, RobustWeight::tukey}) {
        const Loss loss{kind, 0.06};
        const auto weight = [&](double r) {
            const double k = loss.width();
            if (kind == RobustWeight::huber) return std::min(1., k / std::abs(r));
            if (kind == RobustWeight::tukey) return std::pow(std::max(0., 1. - r * r / k / k), 2);
            return 1.;
        };
        const NormalEquations fast = compare(view, observed, exposure, loss);
        const NormalEquations plain = byPixels(view, observed, exposure, weight);
        EXPECT_LT(relative(fast.AtA, plain.AtA), 1e-5);
        EXPECT_LT(relative(fast.Atr, plain.Atr), 1e-4);
        EXPECT_LT(relative(fast.byBlur.Atb, plain.byBlur.Atb), 1e-4);
        EXPECT_NEAR(fast.byBlur.btb / plain.byBlur.btb, 1., 1e-4);
        EXPECT_NEAR(fast.byBlur.btr / plain.byBlur.btr, 1., 1e-3);
        EXPECT_NEAR(fast.count, plain.count, 0.002 * plain.count);  // flat pixels count in one
        EXPECT_NEAR(fast.sumSquares / plain.sumSquares, 1., 2e-3);
        EXPECT_GT(plain.count, 2000.);
    }
}

/// Eliminated, the blur leaves pose and exposure where the equations with nine unknowns have them.
TEST(NormalEquations, ABlurThatIsNotKnownIsEliminated) {
    using Vector9 = Eigen::Matrix<double, 9, 1>;
    const View view = viewAt(kViewpoint);
    std::mt19937_64 random(2);
    const ImageF observed = test::noisy(widened(view.intensity, 0.2), 0.05, random);
    ViewComparison compare(tinyCamera(), {});
    const NormalEquations e = compare(view, observed, {}, {});
    constexpr double kSigma = 0.1, kNoise = 0.05 * 0.05;
    Eigen::Matrix<double, 9, 9> H;
    H << e.AtA, e.byBlur.Atb, e.byBlur.Atb.transpose(), e.byBlur.btb + kNoise / (kSigma * kSigma);
    Vector9 right;
    right << e.Atr, e.byBlur.btr;
    const Vector9 all = H.ldlt().solve(right);
    const NormalEquations eliminated = withoutBlur(e, kSigma, kNoise);
    const Vector8 x = eliminated.AtA.ldlt().solve(eliminated.Atr);
    EXPECT_LT((x - all.head<8>()).norm(), 1e-6 * x.norm());
    EXPECT_GT(all[8], 0.1);  // the image is blurrier by 0.2
    // What is left of the residuals, at the minimum of both.
    EXPECT_NEAR(eliminated.loss - x.dot(eliminated.Atr), e.loss - all.dot(right), 1e-9 * e.loss);
    // A blur that is known changes nothing.
    EXPECT_EQ(withoutBlur(e, 0., kNoise).AtA, e.AtA);
    // The blocks have the residuals of the likeliest blur without motion.
    Vector8 ofBlocks = Vector8::Zero();
    for (const ImageBlock& block : withoutBlur(compare.blocks({}, {}), kSigma, kNoise)) {
        ofBlocks += block.Atr;
    }
    EXPECT_LT(relative(ofBlocks, eliminated.Atr), 1e-3);
}

/// The derivative of the loss is the weighted residual: the two are written apart.
TEST(NormalEquations, WeightsAreTheDerivativeOfTheLoss) {
    View view = viewAt(kViewpoint);
    view.intensity = ImageF(tinyCamera().height, tinyCamera().width, 0.5F);
    ViewComparison compare(tinyCamera(), {});
    for (const RobustWeight kind : {RobustWeight::none, RobustWeight::huber, RobustWeight::tukey}) {
        for (const double r : {0.01, 0.05, 0.09, 0.2, 0.4}) {
            const auto at = [&](double offset) {
                const ImageF observed(tinyCamera().height, tinyCamera().width,
                                      static_cast<float>(0.5 + offset));
                return compare(view, observed, {}, {kind, 0.05});
            };
            const double step = 1e-3;
            const double slope = (at(r + step).loss - at(r - step).loss) / (2. * step);
            const NormalEquations e = at(r);
            EXPECT_NEAR(slope, 2. * e.Atr[7], 0.02 * e.count * 0.05) << r;
        }
    }
}

/// Observed at exp(xi) T, predicted at T: the residual is A (xi, dg, do) to first order.
TEST(NormalEquations, ResidualChangesAsTheJacobianSays) {
    AnalyticPlane plane;
    const Exposure exposure{1.3, -0.1};
    const Camera fine = makeCamera(376, 240, 1.2);
    const Pose T = lookFrom({0.1, 0.5, 1.5}, 0.9, -0.7);
    const View view = plane.view(fine, T);
    ViewComparison compare(fine, {});
    for (int i = 0; i < 8; ++i) {
        const double step = i < 6 ? 1e-4 : 1e-3;
        const auto observe = [&](double by) {
            const Pose moved = i < 6 ? expSE3(by * Vector6::Unit(i)) * T : T;
            const double gain = exposure.gain + (i == 6 ? by : 0.);
            const double offset = exposure.offset + (i == 7 ? by : 0.);
            View seen = plane.view(fine, moved);
            for (unsigned k = 0; k < seen.intensity.getSize(); ++k) {
                seen.intensity.bitmap[k] =
                    static_cast<float>(gain * seen.intensity.bitmap[k] + offset);
            }
            return compare(view, seen.intensity, exposure, {});
        };
        // d (A^T r) / d x_i = A^T A e_i; central differences of the residual.
        const NormalEquations plus = observe(step);
        const NormalEquations minus = observe(-step);
        const Vector8 column = (plus.Atr - minus.Atr) / (2. * step);
        const Vector8 scale = plus.AtA.diagonal().cwiseSqrt();
        const Vector8 error =
            (column - plus.AtA.col(i)).cwiseQuotient(scale) / std::sqrt(plus.AtA(i, i));
        EXPECT_LT(error.cwiseAbs().maxCoeff(), 0.01) << "column " << i;
    }
}

TEST(NormalEquations, RobustSigmaIgnoresOutliers) {
    std::mt19937_64 random(3);
    std::normal_distribution<float> noise(0.F, 0.03F);
    std::vector<float> residuals(5000);
    for (float& r : residuals) r = noise(random);
    for (int i = 0; i < 1000; ++i) residuals[5 * i] = 0.9F;
    residuals.resize(9000, 4.F);
    EXPECT_NEAR(robustSigmaOf(residuals), 0.03, 0.012);
    residuals.assign(100, 4.F);
    EXPECT_EQ(robustSigmaOf(residuals), 0.);
}

/// Wherever the first comparison is stopped, the next one is that of a new object.
TEST(NormalEquations, CanBeStoppedAtEveryRow) {
    const View view = viewAt(kViewpoint);
    const NormalEquations expected = ViewComparison(tinyCamera(), {})(view, view.intensity, {}, {});
    for (const int stopAt : {1, 2, 3, 4, 5, 60, 66, 120}) {
        int asked = 0;
        ViewComparison comparison(tinyCamera(), {}, [&] { return ++asked == stopAt; });
        EXPECT_THROW(comparison(view, view.intensity, {}, {}), Interrupted) << stopAt;
        const NormalEquations equations = comparison(view, view.intensity, {}, {});
        EXPECT_EQ(equations.AtA, expected.AtA) << stopAt;
        EXPECT_EQ(equations.count, expected.count) << stopAt;
    }
}

TEST(NormalEquations, RefuseWhatDoesNotFit) {
    EXPECT_THROW(ViewComparison(makeCamera(2, 9, 1.), {}), std::invalid_argument);
    PhotometricOptions sparse;
    sparse.stride = 2;
    EXPECT_THROW(ViewComparison(tinyCamera(), sparse), std::invalid_argument);
    ViewComparison compare(tinyCamera(), {});
    const View view = viewAt(kViewpoint);
    EXPECT_THROW(compare(view, ImageF(10, 10), {}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace photonav
