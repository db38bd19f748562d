// SPDX-License-Identifier: BSD-3-Clause
// How uncertain is a pose after ten uncertain motions? Positions spread along a banana; a Gaussian
// on the Lie algebra bends with it. Second and fourth order against 10 000 samples.
#include <cstdio>
#include <numbers>
#include <random>

#include "exercises.hpp"
#include "geometry/constants.hpp"
#include "geometry/se3.hpp"
#include "geometry/uncertain_pose.hpp"
#include "plot/figure.hpp"

using namespace photonav;

namespace {

constexpr int kMotions = 10;
constexpr int kSamples = 10000;

//! [motion]
/// The robot moves 1 m forward, with an uncertain turn [rad^2]. T_b_a maps the old body frame a to
/// the new one b, hence the minus.
UncertainPose oneMetreForward(double yawVariance) {
    UncertainPose T_b_a;
    T_b_a.mean.translation() << -1., 0., 0.;
    T_b_a.covariance(5, 5) = yawVariance;
    return T_b_a;
}
//! [motion]

//! [propagate]
/// The belief after a number of such motions. It starts at the world's origin, without uncertainty.
UncertainPose afterMotions(int count, const UncertainPose& motion, PropagationOrder order) {
    UncertainPose T_k_w;
    for (int k = 0; k < count; ++k) T_k_w = compound(motion, T_k_w, order);
    return T_k_w;
}
//! [propagate]

std::vector<Exercise> exercises() {
    const auto after = [](int count, double yawSigma) {
        return afterMotions(count, oneMetreForward(yawSigma * yawSigma), PropagationOrder::fourth)
            .covariance;
    };
    return {{[=] { return after(20, std::sqrt(0.03)).trace(); }},
            {[=] { return std::sqrt(after(10, 5. * kDegree)(1, 1)); }, 0.05}};
}

Eigen::Vector2d position(const Pose& T_k_w) { return T_k_w.inverse().translation().head<2>(); }

//! [samples]
/// Samples of the true poses: the errors of the motions are independent, and each motion starts
/// where the last one ended.
std::vector<Pose> samplePoses(const UncertainPose& motion) {
    std::mt19937 random(1);
    std::normal_distribution<double> yawError(0., std::sqrt(motion.covariance(5, 5)));
    std::vector<Pose> poses(kSamples, Pose::Identity());
    for (Pose& T_k_w : poses) {
        for (int k = 0; k < kMotions; ++k) {
            T_k_w = expSE3(yawError(random) * Vector6::Unit(5)) * motion.mean * T_k_w;
        }
    }
    return poses;
}
//! [samples]

//! [covariance]
/// The covariance of the samples about the mean, in the Lie algebra.
Matrix6 sampleCovariance(const std::vector<Pose>& poses, const Pose& mean) {
    Matrix6 covariance = Matrix6::Zero();
    for (const Pose& T : poses) {
        const Vector6 xi = logSE3(T * mean.inverse());
        covariance += xi * xi.transpose() / static_cast<double>(poses.size());
    }
    return covariance;
}
//! [covariance]

//! [contour]
/// Three standard deviations of (x, y), with the yaw that is most likely there, carried to
/// positions by exp: an ellipse on the Lie algebra, bent as the samples are.
Plot::Points contour(const UncertainPose& belief) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(
        belief.covariance.topLeftCorner<2, 2>());
    Eigen::Matrix<double, 6, 2> axes = Eigen::Matrix<double, 6, 2>::Zero();
    for (int i = 0; i < 2; ++i) {
        const double sigma = std::sqrt(std::max(0., eigen.eigenvalues()[i]));
        if (sigma < 1e-6) continue;  // second order: no spread along x at all
        axes.col(i) = belief.covariance.leftCols<2>() * eigen.eigenvectors().col(i) / sigma;
    }
    Plot::Points points;
    for (int i = 0; i <= 360; ++i) {
        const double t = i * std::numbers::pi / 180.;
        const Vector6 xi = 3. * axes * Eigen::Vector2d(std::cos(t), std::sin(t));
        points.push_back(position(expSE3(xi) * belief.mean));
    }
    return points;
}
//! [contour]

/// Three standard deviations of a Gaussian in x and y.
Plot::Points flatEllipse(const Plot::Points& positions) {
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    Eigen::Matrix2d square = Eigen::Matrix2d::Zero();
    for (const auto& p : positions) mean += p / kSamples;
    for (const auto& p : positions) square += (p - mean) * (p - mean).transpose() / kSamples;
    return ellipse(mean, square, 3.);
}

}  // namespace

int main(int argc, char** argv) {
    if (const auto code = checkAnswers(argc, argv, exercises())) return *code;
    const UncertainPose motion = oneMetreForward(0.03);  // a standard deviation of 10 degrees
    const UncertainPose second = afterMotions(kMotions, motion, PropagationOrder::second);
    const UncertainPose fourth = afterMotions(kMotions, motion, PropagationOrder::fourth);

    const std::vector<Pose> samples = samplePoses(motion);
    const Matrix6 truth = sampleCovariance(samples, fourth.mean);
    std::printf("trace of the covariance after %d motions of 1 m\n", kMotions);
    std::printf("  samples       %7.3f\n", truth.trace());
    for (const auto& [name, belief] :
         {std::pair{"second order", second}, {"fourth order", fourth}}) {
        std::printf("  %s  %7.3f   Frobenius error %.3f\n", name, belief.covariance.trace(),
                    (belief.covariance - truth).norm());
    }

    Plot::Points positions;
    for (const Pose& T_k_w : samples) positions.push_back(position(T_k_w));
    Plot plot = Plot::map({Eigen::Vector2d(-1., -9.), Eigen::Vector2d(13., 9.)}, 800.);
    plot.dots(positions, {.color = {70, 130, 180},
                          .width = 4.,
                          .opacity = 0.35,
                          .name = "10 000 sampled positions"});
    plot.curve(flatEllipse(positions),
               {.color = {110, 110, 110}, .name = "Gaussian in x and y, 3σ", .dashed = true});
    plot.curve(contour(fourth), {.color = {20, 60, 160}, .name = "fourth order on SE(3), 3σ"});
    plot.curve(contour(second), {.color = {230, 120, 20}, .name = "second order on SE(3), 3σ"});
    plot.curve({{0., 0.}, position(fourth.mean)}, {.name = "mean motion"});
    const Figure figure{"Ten uncertain motions of 1 m", {{plot}}};
    for (const std::string ending : {".png", ".svg", ".pdf"})
        figure.save("pose_uncertainty" + ending);
    std::puts("wrote pose_uncertainty.png, .svg and .pdf");
}
