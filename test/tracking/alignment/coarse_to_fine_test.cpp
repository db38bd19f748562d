// SPDX-License-Identifier: BSD-3-Clause
#include "alignment/coarse_to_fine.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/se3.hpp"

namespace photonav {
namespace {

/// Comparisons whose gradients are prescribed: by the step along x that they ask for, in standard
/// deviations. Each is better than the one before.
class Prescribed : public Comparison {
  public:
    /// @param x of the camera, in standard deviations
    std::function<double(int comparison, double x)> step;
    double slope = 1.;  ///< true change of the image divided by that of J
    int slopes = 0;     ///< how often it was measured

    std::size_t levels() const override { return 1; }
    const Camera& camera(std::size_t) const override { return camera_; }
    std::size_t pixels() const override { return kPixels; }
    double robustSigma() const override { return kNoise; }

    NormalEquations compare(std::size_t, const Pose& T_c_w, const Exposure&, const Loss&) override {
        NormalEquations e = informative();
        e.Atr[0] = e.AtA(0, 0) * kUnit * step(++comparisons_, logSE3(T_c_w)[0] / kUnit);
        e.loss = e.sumSquares * std::pow(0.9, comparisons_);
        return e;
    }

    std::vector<ImageBlock> blocks(std::size_t, const Pose&, const Exposure&,
                                   const Loss&) override {
        return {};
    }

    AgainstPrediction predictionAsImage(std::size_t, const Pose& T_image_w) override {
        ++slopes;
        return [=, this](const Pose& T_c_w) {
            NormalEquations e = informative();
            e.Atr.head<6>() = -slope * e.AtA(0, 0) * logSE3(T_c_w * T_image_w.inverse());
            return e;
        };
    }

    /// Standard deviations of the pose [m, rad].
    static constexpr double kUnit = 2e-4;

  private:
    static constexpr std::size_t kPixels = 10000;
    static constexpr double kNoise = 0.02;

    static NormalEquations informative() {
        NormalEquations e;
        e.AtA = kNoise * kNoise / (kUnit * kUnit) * Matrix8::Identity();
        e.count = kPixels;
        e.sumSquares = kPixels * kNoise * kNoise;
        e.sumPredicted = 0.5 * kPixels;
        e.sumPredictedSquares = 0.3 * kPixels;
        e.meanInverseDepth = 1.;
        return e;
    }

    Camera camera_ = makeCamera(100, 100, 1.);
    int comparisons_ = 0;
};

TEST(CoarseToFine, ConvergesWhenStepsBecomeSmall) {
    Prescribed comparison;
    comparison.step = [](int, double x) { return 10. - x; };
    const Alignment a = alignCoarseToFine(comparison, {}, Pose::Identity(), nullptr);
    EXPECT_EQ(a.verdict, Verdict::converged);
    EXPECT_NEAR(a.T_c_w.translation().x(), 10. * Prescribed::kUnit, 0.1 * Prescribed::kUnit);
}

/// Steps that stay as long as they are have found no minimum, however many there were.
TEST(CoarseToFine, ALongStepIsNotSmallAfterManyIterations) {
    Prescribed comparison;
    comparison.step = [](int k, double) { return k % 2 == 0 ? 3. : -3.; };
    const Alignment a = alignCoarseToFine(comparison, {}, Pose::Identity(), nullptr);
    EXPECT_EQ(a.verdict, Verdict::lostDivergence);
}

/// Where the slope is flatter than J, the prior counts for more, and the search goes on.
TEST(CoarseToFine, ADescentThatFailsAfterTheSlopeWasMeasuredIsNoMinimum) {
    const UncertainPose prior{Pose::Identity(),
                              9. * Prescribed::kUnit * Prescribed::kUnit * Matrix6::Identity()};
    for (const bool fails : {false, true}) {
        Prescribed comparison;
        comparison.slope = 0.3;
        comparison.step = [&](int k, double x) {
            if (!fails || comparison.slopes == 0) return 0.3 * (15. - x);
            return k % 2 == 0 ? 10. : -10.;
        };
        const Alignment a = alignCoarseToFine(comparison, {}, prior.mean, &prior);
        EXPECT_EQ(a.verdict, fails ? Verdict::lostDivergence : Verdict::converged);
        EXPECT_GE(comparison.slopes, 1);
    }
}

}  // namespace
}  // namespace photonav
